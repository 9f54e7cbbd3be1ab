// Wrongly filled motions and gait cycles are refused with one sentence.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "gaitpad/anatomy.h"
#include "gaitpad/clean_strides.h"
#include "gaitpad/gait_cycle.h"
#include "gaitpad/walk_model.h"
#include "tests/clean_cycle.h"

namespace gaitpad {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct BadMotion {
  const char* says;
  std::function<void(Motion&)> spoil;
};

TEST(Check, ABadMotionIsRefusedByEachFunctionThatTakesOne) {
  const Motion good = procedural_motion();
  ASSERT_FALSE(check(good));
  const std::vector<BadMotion> table = {
      {"has no frames", [](Motion& m) { m.frames.clear(); }},
      {"the number of joints is 0, outside [1, 320]", [](Motion& m) { m.skeleton.joints.clear(); }},
      {"the number of joints is 400", [](Motion& m) { m.skeleton.joints.resize(400); }},
      {"joints[3].parent is 7, outside [0, 2]", [](Motion& m) { m.skeleton.joints[3].parent = 7; }},
      {"joints[3].parent is -1, outside [0, 2]",
       [](Motion& m) { m.skeleton.joints[3].parent = -1; }},
      {"joints[0].parent is 0", [](Motion& m) { m.skeleton.joints[0].parent = 0; }},
      {"joints[2].offset_m is not finite",
       [](Motion& m) { m.skeleton.joints[2].offset_m.y = kNaN; }},
      {"pelvis is 99", [](Motion& m) { m.pelvis = 99; }},
      {"legs[1].knee is 1000", [](Motion& m) { m.legs[1].knee = 1000; }},
      {"legs[0].hip is -2", [](Motion& m) { m.legs[0].hip = -2; }},
      {"frame_time_s is 0, outside [1e-05, 10]", [](Motion& m) { m.frame_time_s = 0.0; }},
      {"frame_time_s is nan", [](Motion& m) { m.frame_time_s = kNaN; }},
      {"frames[5].local: there are 1", [](Motion& m) { m.frames[5].local.resize(1); }},
      {"frames[5].local[1] is no rotation: its length is not 1",
       [](Motion& m) { m.frames[5].local[1] = quat(0.0, 0.0, 0.0, 0.0); }},
      {"frames[7].local[2] is no rotation", [](Motion& m) { m.frames[7].local[2].w = kNaN; }},
      {"frames[0].root_m is not finite", [](Motion& m) { m.frames[0].root_m.x = kNaN; }},
      {"frames[0].translation_m: there are 3",
       [](Motion& m) { m.frames[0].translation_m.resize(3); }},
  };
  for (const BadMotion& row : table) {
    Motion bad = good;
    row.spoil(bad);
    const auto legs = find_legs(bad);
    ASSERT_FALSE(legs) << row.says;
    EXPECT_NE(legs.error().message.find(row.says), std::string::npos) << legs.error().message;
    const auto cycle = gait_cycle(bad);
    ASSERT_FALSE(cycle) << row.says;
    EXPECT_NE(cycle.error().message.find(row.says), std::string::npos) << cycle.error().message;
    EXPECT_FALSE(cycle_on_skeleton(procedural_gait(), bad)) << row.says;
  }
  Motion without_legs = good;
  without_legs.legs = {};
  EXPECT_EQ(gait_cycle(without_legs).error().message,
            good.name + ": legs are not set, see find_legs()");
}

TEST(Check, ABadCycleIsRefusedByEachFunctionThatTakesOne) {
  const GaitCycle good = clean_cycle(procedural_gait());
  ASSERT_FALSE(check(good));
  const std::vector<std::pair<const char*, std::function<void(GaitCycle&)>>> table = {
      {"samples: there are 0, not 128", [](GaitCycle& c) { c.samples.clear(); }},
      {"local: there are 5", [](GaitCycle& c) { c.local.resize(5); }},
      {"standing_local: there are 0", [](GaitCycle& c) { c.standing_local.clear(); }},
      {"local[9] is no rotation", [](GaitCycle& c) { c.local[9].x = kNaN; }},
      {"pelvis is -1", [](GaitCycle& c) { c.pelvis = -1; }},
      {"leg[0].ankle is -1", [](GaitCycle& c) { c.leg[0].joints.ankle = -1; }},
      {"leg[1].thigh_m is 0", [](GaitCycle& c) { c.leg[1].thigh_m = 0.0; }},
      {"leg[1].shank_m is nan", [](GaitCycle& c) { c.leg[1].shank_m = kNaN; }},
      {"duration_s is 0", [](GaitCycle& c) { c.duration_s = 0.0; }},
      {"stride_m is -1", [](GaitCycle& c) { c.stride_m = -1.0; }},
      {"toe_m", [](GaitCycle& c) { c.leg[0].toe_m.x = kNaN; }},
  };
  for (const auto& [says, spoil] : table) {
    GaitCycle bad = good;
    spoil(bad);
    const auto model = walk_model(bad, Character{});
    ASSERT_FALSE(model) << says;
    EXPECT_NE(model.error().message.find(says), std::string::npos) << model.error().message;
    EXPECT_FALSE(with_clean_strides(bad)) << says;
  }
}

TEST(Check, ABadBuildIsRefused) {
  const GaitCycle cycle = clean_cycle(procedural_gait());
  for (const double bad : {0.0, -1.0, kNaN, 1e-9, 1e9, std::numeric_limits<double>::infinity()}) {
    EXPECT_FALSE(walk_model(cycle, {.scale = bad})) << bad;
    EXPECT_FALSE(walk_model(cycle, {.leg_ratio = bad})) << bad;
  }
  EXPECT_FALSE(walk_model(cycle, {.scale = 10.0, .leg_ratio = 10.0}));
  EXPECT_EQ(walk_model(cycle, {.name = "dot", .scale = 1e-9}).error().message,
            "dot: scale is 1e-09, outside [0.05, 20]");
}

}  // namespace
}  // namespace gaitpad
