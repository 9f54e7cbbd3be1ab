// For portable_test.py: walks with gaitpad::core alone, and where GAITPAD_HAS_FILES is defined with
// gaitpad::files, and prints a hash of each second of each walk, so that builds for other
// processors and libraries can be compared. The strides are solved, not read.
#include <cstdio>
#ifdef GAITPAD_HAS_FILES
#include <sstream>

#include "gaitpad/bvh.h"
#include "gaitpad/config_files.h"
#include "gaitpad/motion_file.h"
#endif

#include "base/lanes.h"
#include "base/text.h"
#include "gaitpad/clean_strides.h"
#include "gaitpad/control.h"
#include "gaitpad/hash.h"
#include "strides/solver_input.h"
#include "tests/walk/made_crowd.h"

namespace gaitpad {
namespace {

constexpr int kRate_hz = 240;

void print_hash(const char* name, int second, const WordHash& hash) {
  const auto value = static_cast<unsigned long long>(hash.value());
  std::printf("%s, second %d: %016llx\n", name, second, value);
}

// Stands, walks, turns, walks backwards, and stops, one after the other.
Stick stick_at(int tick) {
  constexpr vec2 kSticks[] = {vec2(0.0),      vec2(0.0, 0.8),  vec2(-0.5, 0.7),
                              vec2(1.0, 0.0), vec2(0.3, -0.8), vec2(0.0, 0.3)};
  return {.left = kSticks[tick / (2 * kRate_hz) % std::size(kSticks)]};
}

void walk(const char* name, const WalkModel& model, const StyleValues& style, IkMode ik) {
  const GaitLimits limits = gait_limits(model);
  Pose pose;
  WalkState state = standing(model, vec3(0.3, 0.0, 0.2), 0.1, pose);
  WordHash hash;
  for (int tick = 0; tick < 14 * kRate_hz; ++tick) {
    advance(model, gait_params(stick_at(tick), style, limits), ik, 1.0 / kRate_hz, state, pose);
    for (int axis = 0; axis < 3; ++axis) hash.add(pose.root_m[axis]);
    for (int j = 0; j < pose.joint_count; ++j) {
      const quat& q = pose.local[j];
      hash.add(q.w), hash.add(q.x), hash.add(q.y), hash.add(q.z);
    }
    if ((tick + 1) % kRate_hz == 0) print_hash(name, tick / kRate_hz, hash);
  }
}

Ground waves(const void*, double x_m, double z_m) noexcept {
  return {0.1 * sin_cos(0.8 * x_m).sin + 0.1 * sin_cos(0.8 * z_m).sin};
}

// A style with every value of the upper body that differs from the even style's.
StyleValues busy_style() {
  StyleValues style;
  style.stride[kLeftSide] = {.length = 0.7, .speed = 1.2, .flight_height = 0.7};
  style.weight[kRightSide][kKneeX] = 0.3;
  style.body.arm_weight[kLeftSide][0] = 0.3;
  style.body.spine_weight[0] = 0.4;
  style.body.hand[kLeftSide].carry = 1.0;
  style.body.hand[kRightSide].rail = 1.0;
  style.body.head.look_at = 1.0;
  return style;
}

void walk_everywhere(const char* name, const GaitCycle& cycle) {
  WordHash strides;
  for_each_number(*cycle.strides, [&strides](double number) { strides.add(number); });
  print_hash(name, 0, strides);
  Character character;
  character.leg_ratio = 0.9;
  WalkModel model = value_of(walk_model(cycle, character));
  walk("level, robust", model, StyleValues{}, IkMode::robust);
  walk("level, paper", model, StyleValues{}, IkMode::paper);
  Terrain sections;
  for (const SectionShape& shape :
       {SectionShape(FlatSection{1.0}), SectionShape(SlopeSection{2.5, 0.15, 0.5}),
        SectionShape(StairsSection{0.17, 0.28, 4}),
        SectionShape(rough_section(6.0, 0.03, 2.0, 1.0, 7))}) {
    add_section(sections, shape);
  }
  model.terrain = std::make_shared<Terrain>(sections);
  walk("sections", model, busy_style(), IkMode::robust);
  Terrain asked;
  asked.asked = {&waves};
  model.terrain = std::make_shared<Terrain>(asked);
  walk("asked ground", model, StyleValues{}, IkMode::robust);
}

void walk_crowd() {
  use_lanes(4);  // four floats in a register, which every processor has or can imitate
  MadeCrowd made(16);
  WordHash hash;
  for (int tick = 0; tick < 20 * kCrowdRate; ++tick) {
    made.step(tick);
    made.add_to(hash);
    if ((tick + 1) % kCrowdRate == 0) print_hash("crowd", tick / kCrowdRate, hash);
  }
}

// Prints numbers as text, which standard libraries write and read in their own ways.
void print_numbers() {
  for (const double value : {0.1, -2.5e-7, 123456.789, 1e15 / 3.0, 6.02214076e23})
    std::printf("%s %s\n", fixed(value, 3).c_str(), fixed(value, 17).c_str());
  for (const char* text : {"0.1", "-.5", "1e-400", "123456.7890123456789", "1e3x", "1e400", "5."})
    std::printf("%s: %a\n", text, parse_bounded(text).value_or(-1.0));
  Character tiny;
  tiny.scale = 1e-9 / 3.0;
  std::puts(check(tiny)->message.c_str());
}

#ifdef GAITPAD_HAS_FILES
// The procedural walk, written as BVH text and read again.
GaitCycle cycle_from_text() {
  const Motion motion = procedural_motion();
  std::ostringstream out;
  BvhLayout layout;
  layout.frame_time_s = motion.frame_time_s;
  BvhWriter writer(out, motion.skeleton, layout);
  for (const MotionFrame& frame : motion.frames) {
    Pose pose;
    pose.root_m = frame.root_m;
    pose.joint_count = static_cast<int>(frame.local.size());
    std::copy(frame.local.begin(), frame.local.end(), pose.local.begin());
    writer.write(pose);
  }
  writer.finish();
  const Motion read = value_of(motion_from_bvh(out.str(), "walk.bvh"));
  return value_of(with_clean_strides(value_of(gait_cycle(read))));
}
#endif

void print_hashes() {
  print_numbers();
  walk_everywhere("built-in strides", value_of(with_clean_strides(procedural_gait())));
  walk_crowd();
#ifdef GAITPAD_HAS_FILES
  walk_everywhere("strides of a file", cycle_from_text());
  std::printf("%g m long\n", length_m(value_of(parsed_terrain(
                                 "[[section]]\nkind = \"flat\"\nlength_m = 2.5\n", "t.toml"))));
#endif
}

}  // namespace
}  // namespace gaitpad

int main() { gaitpad::print_hashes(); }
