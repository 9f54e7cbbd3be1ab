// Three skeletons of your own walk in circles on a ground of your own, without a file; one of them
// is teleported each second. Prints how far planted feet slide and are off the ground.
#include <gaitpad/anatomy.h>
#include <gaitpad/clean_strides.h>
#include <gaitpad/control.h>
#include <gaitpad/walk.h>

#include <cstdio>
using namespace gaitpad;
static Motion bones(double leg_m) {  // a skeleton's rest pose: +x left, +y up, +z ahead
  Motion body;
  auto& joints = body.skeleton.joints;
  joints.push_back({"Hips", -1});
  for (const std::string side : {"Left", "Right"}) {
    const int hip = static_cast<int>(joints.size());
    joints.push_back({side + "UpLeg", 0, vec3(side == "Left" ? 0.1 : -0.1, 0.0, 0.0)});
    joints.push_back({side + "Leg", hip, vec3(0.0, -0.52 * leg_m, 0.0)});
    joints.push_back({side + "Foot", hip + 1, vec3(0.0, -0.48 * leg_m, 0.0)});
    joints.push_back({side + "Toe", hip + 2, vec3(0.0, -0.07, 0.14)});
    joints.push_back({side + "Tip", hip + 3, vec3(0.0, 0.0, 0.06), true});
  }
  body.frames = {{vec3(0.0, leg_m, 0.0), std::vector<quat>(joints.size(), kIdentity), {}}};
  return body;
}
static Ground ask(const void*, double x_m, double z_m) noexcept {  // waves 2.5 pi m long
  return {0.2 * sin_cos(0.8 * x_m).sin + 0.15 * sin_cos(0.8 * z_m).sin, kUp, 0};
}
int main() {
  double slide_m = 0.0, off_m = 0.0, not_finite = 0.0;
  for (const double leg_m : {0.7, 0.84, 1.0}) {
    Motion body = bones(leg_m);
    const auto legs = find_legs(body);
    if (!legs) return std::puts(legs.error().message.c_str());
    body.legs = *legs;
    auto cycle = cycle_on_skeleton(procedural_gait(), body);
    if (cycle) cycle = with_clean_strides(*cycle);
    auto model = cycle ? walk_model(*cycle, Character{}) : cycle.error();
    if (!model) return std::puts(model.error().message.c_str());
    model->terrain = std::make_shared<Terrain>(Terrain{"waves", {}, {}, {&ask, nullptr}});
    const GaitParams circle = gait_params({vec2(0.4, 0.7)}, StyleValues{}, gait_limits(*model));
    Pose pose;
    WalkState state = standing(*model, vec3(4.0 * leg_m, 0.0, 1.0), 0.5, pose);
    for (int tick = 1; tick <= 1200; ++tick) {
      if (tick % 60 == 0 && leg_m == 0.7) move_walk({vec3(2.5 * kPi, 0.0, 0.0)}, state, pose);
      const WalkFrame before = walk_frame(*model, state, pose);
      advance(*model, circle, IkMode::robust, 1.0 / 60.0, state, pose);
      not_finite += !std::isfinite(pose.root_m.x + pose.local[3].w);
      const WalkFrame now = walk_frame(*model, state, pose);
      for (const std::size_t side : {0u, 1u}) {
        const double heel_m = std::abs(now.heel_m[side].y - now.heel_ground_m[side]);
        const double toe_m = std::abs(now.toe_m[side].y - now.toe_ground_m[side]);
        off_m = std::max({off_m, now.heel_planted[side] * heel_m, now.toe_planted[side] * toe_m});
        if (now.toe_planted[side] && before.toe_planted[side])
          slide_m = std::max(slide_m, glm::distance(before.toe_m[side], now.toe_m[side]));
      }
    }
  }
  std::printf("feet slide %.4f mm, are %.4f mm off the ground, %.0f poses are not finite\n",
              1e3 * slide_m, 1e3 * off_m, not_finite);
}
