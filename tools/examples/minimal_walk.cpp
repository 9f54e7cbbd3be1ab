// Walks ten seconds with the stick held forward and prints where both feet are at each tick.
//   minimal_walk walk.bvh 0.8 > feet.csv
#include <gaitpad/clean_strides.h>
#include <gaitpad/control.h>
#include <gaitpad/motion_file.h>
#include <gaitpad/walk.h>

#include <cstdio>
#include <cstdlib>

namespace {

constexpr int kRate_hz = 240;

int print_error(const gaitpad::Error& error) {
  std::fprintf(stderr, "minimal_walk: %s\n", error.message.c_str());
  return 1;
}

void print_point(const gaitpad::vec3& point_m) {
  std::printf(",%.6f,%.6f,%.6f", point_m.x, point_m.y, point_m.z);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: minimal_walk MOTION STICK\n", stderr);
    return 2;
  }
  // Set-up may fail and may allocate. The motion becomes a periodic stride, the stride a character.
  const auto motion = gaitpad::load_motion(argv[1]);
  if (!motion) return print_error(motion.error());
  auto cycle = gaitpad::gait_cycle(*motion);
  if (cycle) cycle = gaitpad::with_clean_strides(std::move(*cycle));
  if (!cycle) return print_error(cycle.error());
  const auto model = gaitpad::walk_model(*cycle, gaitpad::Character{});
  if (!model) return print_error(model.error());

  const gaitpad::Stick stick = {.left = gaitpad::vec2(0.0, std::atof(argv[2]))};
  const gaitpad::StyleValues style;
  const gaitpad::GaitLimits limits = gaitpad::gait_limits(*model);

  // A tick neither fails nor allocates. `state` and `pose` are plain data of the caller's.
  gaitpad::Pose pose;
  gaitpad::WalkState state = gaitpad::standing(*model, gaitpad::vec3(0.0), pose);
  std::puts(
      "time_s,left_heel_x_m,left_heel_y_m,left_heel_z_m,left_toe_x_m,left_toe_y_m,left_toe_z_m,"
      "right_heel_x_m,right_heel_y_m,right_heel_z_m,right_toe_x_m,right_toe_y_m,right_toe_z_m");
  for (int tick = 0; tick < 10 * kRate_hz; ++tick) {
    const gaitpad::GaitParams params = gaitpad::gait_params(stick, style, limits);
    gaitpad::advance(*model, params, gaitpad::IkMode::robust, 1.0 / kRate_hz, state, pose);
    std::printf("%.6f", double(tick) / kRate_hz);
    const gaitpad::WalkFrame frame = gaitpad::walk_frame(*model, state, pose);
    for (const gaitpad::Side side : {gaitpad::kLeftSide, gaitpad::kRightSide}) {
      print_point(frame.heel_m[side]);
      print_point(frame.toe_m[side]);
    }
    std::putchar('\n');
  }
}
