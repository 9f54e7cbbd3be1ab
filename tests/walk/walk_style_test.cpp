// The effects of styles on a walk: joints that flex less, hips that bounce, a trunk that leans.
#include <gtest/gtest.h>

#include <filesystem>

#include "gaitpad/config_files.h"
#include "gaitpad/motion_file.h"
#include "tests/folders.h"
#include "tests/shared_data.h"
#include "tests/walk/made_walker.h"

namespace gaitpad {
namespace {

constexpr double kStick = 0.8;
constexpr int kSteady = 5 * kRate, kEnd = 9 * kRate;  // ticks of the measurement, at a steady walk
constexpr double kPlanted_m = 1e-5;
constexpr double kSharpest = 1.0;  // largest second difference of a leg angle, degrees per tick^2

StyleValues shipped(const std::string& name) {
  return value_of(load_style(kSourceFolder + "/config/styles/" + name + ".toml"));
}

struct Steady {
  MadeWalker walker;
  explicit Steady(const StyleValues& style, IkMode mode = IkMode::robust) : walker(adult(), mode) {
    walker.walk(0.0, kStick, kEnd, style);
  }
  double range(int side, int joint) const {
    double low = 1e9, high = -1e9;
    for (int k = kSteady; k < kEnd; ++k) {
      const double angle = walker.angles_rad()[k][side][joint];
      low = std::min(low, angle), high = std::max(high, angle);
    }
    return high - low;
  }
  double travel_m() const {
    double low = 1e9, high = -1e9;
    for (int k = kSteady; k < kEnd; ++k) {
      const double y = walker.frames()[k].pelvis_m.y;
      low = std::min(low, y), high = std::max(high, y);
    }
    return high - low;
  }
  int failures() const {
    int count = 0;
    for (const WalkFrame& frame : walker.frames()) count += frame.ik_failed[0] + frame.ik_failed[1];
    return count;
  }
};

// The lean of the line from pelvis to shoulders in degrees, ahead and to the left.
struct Lean {
  double ahead_deg = 0.0, left_deg = 0.0;
};
Lean lean_of(const MadeWalker& walker) {
  static JointFrames world;
  const WalkModel& model = walker.model();
  forward_kinematics(model.cycle.skeleton, walker.pose(), world);
  const auto shoulder = [&](int side) {
    return world.position_m[model.body.arm[side].joints.shoulder];
  };
  const vec3 up = 0.5 * (shoulder(0) + shoulder(1)) - world.position_m[model.cycle.pelvis];
  return {gaitpad::atan2(up.z, up.y) / kDegree, gaitpad::atan2(up.x, up.y) / kDegree};
}

TEST(WalkStyle, AStiffHipFlexesLessAndKneeAndAnkleMakeUpForIt) {
  const Steady even({}), stiff(shipped("stiff_hip"));
  for (int side : {0, 1}) {
    EXPECT_LE(stiff.range(side, kHipX) / even.range(side, kHipX), 0.90);
    EXPECT_GE((stiff.range(side, kKneeX) + stiff.range(side, kAnkleX)) /
                  (even.range(side, kKneeX) + even.range(side, kAnkleX)),
              0.99);
  }
}

TEST(WalkStyle, TwiceTheBounceIsTwiceTheTravel) {
  std::array<StyleValues, 2> style;
  style[1].hip_bounce = 2.0;
  const Steady once(style[0]), twice(style[1]);
  EXPECT_NEAR(twice.travel_m() / once.travel_m(), 2.0, 0.1);
  EXPECT_EQ(twice.failures(), 0);
  EXPECT_LT(twice.walker.drift_m(), 1e-4);
}

TEST(WalkStyle, EveryShippedStyleWalksSmoothlyOnPlantedFeet) {
  for (const auto& file : std::filesystem::directory_iterator(kSourceFolder + "/config/styles")) {
    const std::string name = file.path().stem().string();
    const Steady walk(shipped(name));
    EXPECT_LE(walk.walker.sharpest_turn_rad(), kSharpest * kDegree) << name;
    EXPECT_LT(walk.walker.drift_m(), kPlanted_m) << name;
    EXPECT_EQ(walk.failures(), 0) << name;
  }
}

TEST(WalkStyle, AChangeOfWeightsActsWithinATenthOfASecondAndWithoutAHitch) {
  MadeWalker even, changed;
  even.walk(0.0, kStick, kSteady + kRate);
  changed.walk(0.0, kStick, kSteady);
  changed.walk(0.0, kStick, kRate, shipped("stiff_hip"));
  double after_rad = 0.0;
  // A leg whose foot stands flat cannot change; only the other one is free then.
  for (int k = kSteady; k < kSteady + kRate / 10; ++k)
    for (int side : {0, 1})
      after_rad = std::max(after_rad, std::abs(even.angles_rad()[k][side][kHipX] -
                                               changed.angles_rad()[k][side][kHipX]));
  EXPECT_GT(after_rad, 0.1 * kDegree);
  EXPECT_LE(changed.sharpest_turn_rad(), kSharpest * kDegree);
}

TEST(WalkStyle, PaperModeDoesNotChangeTheStrideByItsWeights) {
  const Steady even({}, IkMode::paper), stiff(shipped("stiff_hip"), IkMode::paper);
  for (int k = 0; k < kEnd; ++k)
    EXPECT_EQ(even.walker.frames()[k].pelvis_m, stiff.walker.frames()[k].pelvis_m) << k;
}

TEST(WalkStyle, TheTiredSlump) {
  const Steady even({}), tired(shipped("tired"));
  EXPECT_GE(lean_of(tired.walker).ahead_deg - lean_of(even.walker).ahead_deg, 8.0);
  const Steady paper(shipped("tired"), IkMode::paper), plain({}, IkMode::paper);
  EXPECT_LT(lean_of(paper.walker).ahead_deg - lean_of(plain.walker).ahead_deg, 2.0);
}

TEST(WalkStyle, AMuscularWalkersArmsAreSpread) {
  const auto width = [](const MadeWalker& walker) {
    static JointFrames world;
    forward_kinematics(walker.model().cycle.skeleton, walker.pose(), world);
    const auto& arm = walker.model().body.arm;
    return world.position_m[arm[0].joints.elbow].x - world.position_m[arm[1].joints.elbow].x;
  };
  EXPECT_GT(width(Steady(shipped("muscular")).walker), width(Steady({}).walker) + 0.08);
}

TEST(WalkStyle, ALimpLeansOverTheSoreLegWhileItStands) {
  MadeWalker walker;
  walker.walk(0.0, kStick, kSteady, shipped("limp_left"));
  double over_left = -1e9, over_right = 1e9, knee_rad = 0.0;
  Steady limping(shipped("limp_left"));
  for (int k = 0; k < 2 * kRate; ++k) {
    walker.walk(0.0, kStick, 1, shipped("limp_left"));
    const WalkState& s = walker.state();
    const WalkSteps at = walk_steps(s);
    if (at.stage != Stage::flight) continue;
    const double left = lean_of(walker).left_deg;
    if (at.swing == kRightSide) over_left = std::max(over_left, left);
    if (at.swing != kRightSide) over_right = std::min(over_right, left);
    // The knee of the uninjured leg straightens in mid-stance.
    const bool is_middle = 2.0f * s.walk.state.tick == s.walk.state.flight_ticks;
    if (at.swing == kLeftSide && is_middle)
      knee_rad = std::max(knee_rad, leg_angles(walker.model(), walker.pose())[kRightSide][kKneeX]);
  }
  EXPECT_GT(over_left, 5.0);
  EXPECT_LE(knee_rad, 12.0 * kDegree);
  EXPECT_LE(limping.travel_m(), 0.060);
}

// A captured limp's hips lurch in short rolls. A stop that begins there still ends between its
// feet.
TEST(WalkStyle, ACapturedLimpStopsWithinReachOfItsFeetWheneverTheStickIsLetGo) {
  GAITPAD_NEEDS(kCapturedMotions);
  const StyleValues style = shipped("limp_left");
  constexpr int kSecond = kRate, kBegins = kSecond / 2;
  for (const auto& [file, first_s] :
       {std::pair{"cmu_006_01_iclone.bvh", 5.82}, std::pair{"cmu_m21_walk.bvh", 5.22},
        std::pair{"bvhtoolbox_walk01.bvh", 5.81}}) {
    const WalkModel model =
        model_of(value_of(gait_cycle(value_of(load_motion(kCapturedMotions + file)))));
    for (int let_go = 0; let_go < 14; ++let_go) {
      MadeWalker walker(model);
      walker.walk(0.0, 0.0, kBegins, style);
      walker.walk(0.0, 1.0, static_cast<int>(first_s * kSecond) + let_go - kBegins, style);
      walker.walk(0.0, 0.0, 3 * kSecond, style);
      int failures = 0;
      for (const WalkFrame& frame : walker.frames())
        failures += frame.ik_failed[0] + frame.ik_failed[1];
      EXPECT_EQ(failures, 0) << file << ", let go " << let_go << " ticks after " << first_s << " s";
    }
  }
}

}  // namespace
}  // namespace gaitpad
