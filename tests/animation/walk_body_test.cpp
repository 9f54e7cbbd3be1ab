// What is above the hips: where hands and head are, what the joints do, and that nothing below is
// touched. On the built-in motion; the last tests on the real ones where they are.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>

#include "animation/made_body.h"
#include "gaitpad/motion_file.h"
#include "gaitpad/walk.h"
#include "tests/shared_data.h"

namespace gaitpad {
namespace {

TEST(WalkBody, TheHeadLooksWhereItIsTold) {
  for (const auto& [yaw, pitch] : {std::pair{40.0, 0.0}, {-50.0, 20.0}, {10.0, -30.0}}) {
    const StyleValues look =
        style({{"head.look", 1.0}, {"head.yaw_deg", yaw}, {"head.pitch_deg", pitch}});
    MadeBody walker;
    walker.walk(1200, look, 0.7);
    for (int i = 0; i < 240; ++i) {
      walker.step(look, 0.7);
      const vec3 gaze = walker.gaze();
      EXPECT_NEAR(heading_of(gaze) / kDegree, yaw, 1.0);
      EXPECT_NEAR(gaitpad::atan2(gaze.y, std::sqrt(gaze.x * gaze.x + gaze.z * gaze.z)) / kDegree,
                  pitch, 1.0);
    }
  }
}

TEST(WalkBody, TheHeadFollowsAPlaceThatItPasses) {
  const StyleValues look =
      style({{"head.look_at", 1.0}, {"head.x_m", 4.0}, {"head.y_m", 1.2}, {"head.z_m", 8.0}});
  MadeBody walker;
  int seen = 0;
  for (int i = 0; i < 3000; ++i) {
    walker.step(look, 0.8);
    const vec3 way = vec3(4.0, 1.2, 8.0) - walker.at(adult().body.head_path.back());
    if (i < 600 || std::abs(heading_of(way)) > 55.0 * kDegree) continue;
    ++seen;
    EXPECT_LT(gaitpad::acos(glm::dot(walker.gaze(), glm::normalize(way))) / kDegree, 1.0);
  }
  EXPECT_GT(seen, 100);
  EXPECT_LT(std::abs(heading_of(walker.gaze())) / kDegree, 10.0);  // far behind: not looked at
}

TEST(WalkBody, TheHeadTurnsNoFartherThanANeckDoes) {
  const StyleValues look = style({{"head.look", 1.0}, {"head.yaw_deg", 90.0}});
  MadeBody walker;
  walker.walk(1200, look, 0.7);
  for (int i = 0; i < 240; ++i) {
    walker.step(look, 0.7);
    EXPECT_LT(heading_of(walker.gaze()) / kDegree, 70.0 + 8.0);  // the trunk turns a little
    EXPECT_GT(heading_of(walker.gaze()) / kDegree, 55.0);
  }
}

TEST(WalkBody, ALeadingHeadIsAheadOfTheTurn) {
  MadeBody plain, leads;
  plain.walk(1200, {}, 0.6, 0.5);
  leads.walk(1200, style({{"head.lead", 1.0}}), 0.6, 0.5);
  EXPECT_LT(leads.state().turn_rate.x, 0.0);
  const double ahead = wrapped(heading_of(leads.gaze()) - heading_of(plain.gaze()));
  EXPECT_NEAR(ahead, 0.6 * leads.state().turn_rate.x, 1.0 * kDegree);
}

TEST(WalkBody, SpineWeightsMoveTheBendAndNotTheNeck) {
  const StyleValues stiff = style({{"spine.weight.lower", 0.1}});
  MadeBody plain, weighted;
  plain.walk(1500, {}, 0.8);
  weighted.walk(1500, stiff, 0.8);
  const int lower = adult().body.spine.front().joint, upper = adult().body.spine.back().joint;
  double farthest = 0.0, low = 0.0, low_plain = 0.0, high = 0.0, high_plain = 0.0;
  const auto angle = [](const MadeBody& w, int j) {
    return glm::length(rotation_vector(w.pose().local[j])) / kDegree;
  };
  for (int i = 0; i < 480; ++i) {
    plain.step({}, 0.8);
    weighted.step(stiff, 0.8);
    farthest = std::max(farthest, glm::distance(plain.shoulders(), weighted.shoulders()));
    low = std::max(low, angle(weighted, lower)),
    low_plain = std::max(low_plain, angle(plain, lower));
    high = std::max(high, angle(weighted, upper));
    high_plain = std::max(high_plain, angle(plain, upper));
  }
  EXPECT_LT(farthest, 0.002);
  EXPECT_LT(low, 0.6 * low_plain);
  EXPECT_GT(high, high_plain);
}

std::vector<StyleValues> busy_styles() {
  return {style({{"hands.carry", 1.0}}),
          style({{"left_hand.rail", 1.0}}),
          style({{"hands.carry", 1.0}, {"hands.y_m", 0.3}, {"right_hand.rail", 1.0}}),
          style({{"head.look", 1.0}, {"head.yaw_deg", -90.0}, {"head.pitch_deg", 60.0}}),
          style({{"arms.weight.shoulder", 0.1}, {"spine.weight.upper", 0.2}}),
          style({{"arms.swing", 3.0}, {"head.lead", 1.0}})};
}

TEST(WalkBody, NothingJumpsWhenStylesChange) {
  const int joints = static_cast<int>(adult().cycle.skeleton.joints.size());
  double worst = 0.0;
  for (const StyleValues& busy : busy_styles()) {
    for (const int phase : {0, 37, 91, 140, 203}) {
      MadeBody walker;
      walker.walk(700 + phase, {}, 0.8);
      std::vector<vec3> rate(joints, vec3(0.0));
      Pose before = walker.pose();
      for (int i = 0; i < 1000; ++i) {
        walker.step(i < 450 ? busy : StyleValues{}, 0.8);
        for (int j = 0; j < joints; ++j) {
          const vec3 now =
              rotation_vector(glm::conjugate(before.local[j]) * walker.pose().local[j]);
          if (i > 0) worst = std::max(worst, glm::length(now - rate[j]) / kDegree);
          rate[j] = now;
        }
        before = walker.pose();
      }
    }
  }
  EXPECT_LT(worst, 1.0);
  RecordProperty("worst_deg_per_tick2", std::to_string(worst));
}

TEST(WalkBody, LegsAndPelvisKeepTheirBits) {
  for (const StyleValues& busy : busy_styles()) {
    MadeBody plain, other_way;
    for (int i = 0; i < 900; ++i) {
      plain.step({}, 0.7, i > 500 ? 0.4 : 0.0);
      other_way.step(busy, 0.7, i > 500 ? 0.4 : 0.0);
      ASSERT_EQ(std::memcmp(&plain.pose().root_m, &other_way.pose().root_m, sizeof(vec3)), 0);
      for (int j = 0; j < plain.pose().joint_count; ++j) {
        const Skeleton& s = adult().cycle.skeleton;
        const bool is_below = j == adult().cycle.pelvis ||
                              is_ancestor(s, adult().cycle.leg[0].joints.hip, j) ||
                              is_ancestor(s, adult().cycle.leg[1].joints.hip, j);
        if (!is_below) continue;
        ASSERT_EQ(std::memcmp(&plain.pose().local[j], &other_way.pose().local[j], sizeof(quat)), 0)
            << s.joints[j].name;
      }
    }
  }
}

TEST(WalkBody, OfASkeletonWithoutArmsIsLeftAlone) {
  GaitCycle cycle = procedural_gait();
  Skeleton& s = cycle.skeleton;
  // What was an arm is a stub now: its bones have no length.
  for (Joint& joint : s.joints) {
    const bool is_arm =
        joint.name.find("Arm") != std::string::npos || joint.name.find("Hand") != std::string::npos;
    if (is_arm) joint.name = "x", joint.offset_m = vec3(0.0);
  }
  const WalkModel model = model_of(cycle);
  EXPECT_FALSE(model.body.arm[0].is_there || model.body.arm[1].is_there);
  for (const StyleValues& busy : busy_styles()) {
    MadeBody walker(model);
    walker.walk(600, busy, 0.7);
    EXPECT_TRUE(std::isfinite(walker.pose().local[5].w));
  }
}

TEST(WalkBody, ChildrenAndGiantsHoldOnToo) {
  for (const double scale : {0.6, 1.6}) {
    Character character;
    character.scale = scale;
    const WalkModel model = model_of(procedural_gait(), character);
    const StyleValues both = style({{"left_hand.rail", 1.0}, {"right_hand.carry", 1.0}});
    MadeBody walker(model);
    walker.walk(1500, both, 0.7);
    EXPECT_NEAR(walker.hand(kLeftSide).y, 0.9 * model.body.shoulder_height_m / kReferenceShoulder_m,
                0.001);
    EXPECT_GT(walker.hand(kRightSide).z - walker.shoulders().z, 0.2 * scale);
  }
}

TEST(WalkBody, OfRealWalksReachesAndStaysSound) {
  GAITPAD_NEEDS(kCapturedMotions);
  int walks = 0;
  for (const std::string& file : files_in(kCapturedMotions, ".bvh")) {
    const auto motion = load_motion(file);
    if (!motion) continue;
    const auto cycle = gait_cycle(*motion);
    if (!cycle) continue;
    SCOPED_TRACE(std::filesystem::path(file).filename().string());
    ++walks;
    const WalkModel model = model_of(*cycle);
    EXPECT_TRUE(model.body.arm[0].is_there && model.body.arm[1].is_there);
    const StyleValues carry = style({{"hands.carry", 1.0}, {"head.look", 1.0}});
    const StyleValues rail = style(
        {{"left_hand.rail", 1.0}, {"left_hand.rail_height_m", 1.0}, {"arms.weight.elbow", 0.3}});
    MadeBody walker(model);
    walker.walk(700, carry, 0.7);
    EXPECT_NEAR(walker.hand(kLeftSide).y, walker.hand(kRightSide).y, 0.001);
    EXPECT_LT(std::abs(heading_of(walker.gaze())) / kDegree, 1.0);
    walker.walk(700, rail, 0.7);
    EXPECT_NEAR(walker.hand(kLeftSide).y, 1.0 * model.body.shoulder_height_m / kReferenceShoulder_m,
                0.001);
  }
  EXPECT_GT(walks, 0);
}

}  // namespace
}  // namespace gaitpad
