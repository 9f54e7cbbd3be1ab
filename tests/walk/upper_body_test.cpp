// The upper body of a walk: arms, spine and head.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "gaitpad/anatomy.h"
#include "gaitpad/motion_file.h"
#include "gaitpad/style.h"
#include "gaitpad/walk.h"
#include "tests/shared_data.h"
#include "tests/walk/made_walker.h"

namespace gaitpad {
namespace {

inline StyleValues style(std::initializer_list<std::pair<const char*, double>> values) {
  StyleValues s;
  for (const auto& [key, value] : values) EXPECT_TRUE(set_value(s, key, value)) << key;
  return s;
}

class MadeBody : public MadeWalker {
 public:
  using MadeWalker::MadeWalker;

  void step(const StyleValues& style, double forward, double sideways = 0.0) {
    walk(1, style, forward, sideways);
  }
  void walk(int ticks, const StyleValues& style, double forward, double sideways = 0.0) {
    MadeWalker::walk(sideways, forward, ticks, style);
    forward_kinematics(model().cycle.skeleton, pose(), *world_);
  }
  // Lets steps of `length_m` and `time_s` go on for some ticks.
  void pace(int ticks, double length_m, double time_s) {
    GaitParams params;
    params.walking = true;
    for (StrideParams& stride : params.stride) stride = {length_m, time_s, 1.0};
    MadeWalker::walk(params, ticks);
    forward_kinematics(model().cycle.skeleton, pose(), *world_);
  }
  vec3 hand(Side side) const {
    const ArmBuild& arm = model().body.arm[side];
    return at(arm.joints.wrist) + world_->rotation[arm.joints.wrist] * arm.grip_m;
  }
  vec3 shoulders() const { return 0.5 * (shoulder(kLeftSide) + shoulder(kRightSide)); }
  vec3 shoulder(Side side) const { return at(model().body.arm[side].joints.shoulder); }
  vec3 at(int joint) const { return world_->position_m[joint]; }
  vec3 gaze() const {
    const int head = model().body.head_path.back();
    return world_->rotation[head] * glm::conjugate(model().body.head_standing) * kForward;
  }
  double elbow(Side side) const {  // bend of the elbow in degrees; 0 is straight
    const ArmChain& j = model().body.arm[side].joints;
    const vec3 upper = at(j.elbow) - at(j.shoulder), fore = at(j.wrist) - at(j.elbow);
    return gaitpad::acos(glm::dot(glm::normalize(upper), glm::normalize(fore))) / kDegree;
  }
  // Angle of the upper arm against the walker's vertical, forward positive.
  double swing(Side side) const {
    const ArmChain& j = model().body.arm[side].joints;
    const vec3 upper = rotation_y(-state().root.heading_rad) * (at(j.elbow) - at(j.shoulder));
    return gaitpad::atan2(upper.z, -upper.y) / kDegree;
  }

 private:
  std::unique_ptr<JointFrames> world_ = std::make_unique<JointFrames>();
};

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
  // The goal is far behind, so the head does not follow it.
  EXPECT_LT(std::abs(heading_of(walker.gaze())) / kDegree, 10.0);
}

TEST(WalkBody, TheHeadTurnsNoFartherThanANeckDoes) {
  const StyleValues look = style({{"head.look", 1.0}, {"head.yaw_deg", 90.0}});
  MadeBody walker;
  walker.walk(1200, look, 0.7);
  for (int i = 0; i < 240; ++i) {
    walker.step(look, 0.7);
    // The trunk turns by a few degrees as well.
    EXPECT_LT(heading_of(walker.gaze()) / kDegree, 70.0 + 8.0);
    EXPECT_GT(heading_of(walker.gaze()) / kDegree, 55.0);
  }
}

TEST(WalkBody, ALeadingHeadIsAheadOfTheTurn) {
  MadeBody plain, leads;
  plain.walk(1200, {}, 0.6, 0.5);
  leads.walk(1200, style({{"head.lead", 1.0}}), 0.6, 0.5);
  const double turn_rate_rad_s = leads.state().walk.state.turn_rad_s.x;
  EXPECT_LT(turn_rate_rad_s, 0.0);
  const double ahead = wrapped(heading_of(leads.gaze()) - heading_of(plain.gaze()));
  EXPECT_NEAR(ahead, 0.6 * turn_rate_rad_s, 1.0 * kDegree);
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
    for (const int phase : {0, 91, 203}) {
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
  // The forearm becomes a stub: its bones have no length.
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

struct Range {
  double low = 1e9, high = -1e9;
  void add(double x) { low = std::min(low, x), high = std::max(high, x); }
  double width() const { return high - low; }
};

Range arm_arc(double length_m, double time_s) {
  MadeBody walker;
  walker.pace(1500, length_m, time_s);
  Range arc;
  for (int i = 0; i < 400; ++i) {
    walker.pace(1, length_m, time_s);
    arc.add(walker.swing(kLeftSide));
  }
  return arc;
}

TEST(WalkBody, HandsCarryAtTheirPlacesBeforeTheChest) {
  const StyleValues carry =
      style({{"hands.carry", 1.0}, {"hands.x_m", 0.1}, {"hands.y_m", -0.25}, {"hands.z_m", 0.4}});
  MadeBody walker;
  walker.walk(1200, carry, 0.7);
  const double scale = adult().body.arm_m / kReferenceArm_m;
  for (int i = 0; i < 300; ++i) {
    walker.step(carry, 0.7);
    vec3 across = walker.shoulder(kLeftSide) - walker.shoulder(kRightSide);
    across = glm::normalize(vec3(across.x, 0.0, across.z));
    const vec3 ahead = glm::cross(across, kUp);
    for (const Side side : {kLeftSide, kRightSide}) {
      const vec3 place = walker.shoulders() + scale * ((side == kLeftSide ? 0.1 : -0.1) * across -
                                                       0.25 * kUp + 0.4 * ahead);
      EXPECT_LT(glm::distance(walker.hand(side), place), 0.001);
    }
  }
  for (const Side side : {kLeftSide, kRightSide}) {  // elbows point downwards and outwards
    const vec3 elbow = walker.at(adult().body.arm[side].joints.elbow);
    EXPECT_LT(elbow.y, walker.shoulder(side).y - 0.2);
    EXPECT_GT((elbow.x - walker.shoulders().x) * (side == kLeftSide ? 1.0 : -1.0), 0.15);
  }
}

TEST(WalkBody, AHandSlidesAlongARailOfConstantHeight) {
  const StyleValues rail = style(
      {{"left_hand.rail", 1.0}, {"left_hand.rail_height_m", 0.95}, {"left_hand.rail_side_m", 0.4}});
  MadeBody walker;
  walker.walk(1200, rail, 0.7);
  const double scale = adult().body.shoulder_height_m / kReferenceShoulder_m;
  for (int i = 0; i < 300; ++i) {
    walker.step(rail, 0.7);
    EXPECT_NEAR(walker.hand(kLeftSide).y, 0.95 * scale, 0.001);
    EXPECT_NEAR(walker.hand(kLeftSide).x, 0.4 * scale, 0.001);
  }
}

// Twelve steps up: the rail is a straight line with the stairs' slope, and the hand on it does not
// bounce.
TEST(WalkBody, ARailRisesEvenlyOverStairs) {
  Terrain stairs;
  ASSERT_FALSE(add_section(stairs, FlatSection{3.0}));
  ASSERT_FALSE(add_section(stairs, StairsSection{0.17, 0.28, 12}));
  WalkModel model = adult();
  model.terrain = std::make_shared<const Terrain>(stairs);
  const StyleValues rail = style({{"right_hand.rail", 1.0}});
  MadeBody walker(model);
  const double scale = model.body.shoulder_height_m / kReferenceShoulder_m;
  std::vector<double> height;
  int on_stairs = 0;
  for (int i = 0; i < 4800; ++i) {
    walker.step(rail, 0.5);
    const vec3 hips = walker.state().root.place_m;
    if (hips.z < 4.0 || hips.z > 5.5) continue;
    ++on_stairs;
    const double line = 0.17 / 0.28 * (hips.z - 3.0) + 0.085;  // the mean height of the treads
    EXPECT_NEAR(walker.hand(kRightSide).y, line + 0.9 * scale, 0.03);
    height.push_back(walker.hand(kRightSide).y);
  }
  EXPECT_GT(on_stairs, 200);
  for (std::size_t i = 2; i < height.size(); ++i)
    EXPECT_LT(std::abs(height[i] - 2.0 * height[i - 1] + height[i - 2]), 0.0005);
}

TEST(WalkBody, WhatIsOutOfReachIsReachedFor) {
  const StyleValues far =
      style({{"hands.carry", 1.0}, {"hands.x_m", 1.0}, {"hands.y_m", 1.0}, {"hands.z_m", 1.0}});
  MadeBody walker;
  walker.walk(1500, far, 0.7);
  for (const Side side : {kLeftSide, kRightSide}) {
    const vec3 arm = walker.hand(side) - walker.shoulder(side);
    EXPECT_GT(arm.y, 0.2);  // the arm points up
    EXPECT_GT(arm.z, 0.2);  // the arm points ahead
    EXPECT_LT(walker.elbow(side), 45.0);
  }
}

TEST(WalkBody, ArmsSwingFartherWithLongerAndWithQuickerSteps) {
  const double own_m = adult().source_step_m, own_s = adult().body.own_step_s;
  double before = 0.0;
  for (const double share : {0.25, 0.5, 0.75, 1.0, 1.25}) {
    const double arc = arm_arc(share * own_m, own_s).width();
    EXPECT_GT(arc, before + 1.0) << share;
    before = arc;
  }
  before = 0.0;
  for (const double share : {0.7, 0.85, 1.0, 1.2, 1.4}) {
    const double arc = arm_arc(own_m, own_s / share).width();
    EXPECT_GT(arc, before + 1.0) << share;
    before = arc;
  }
}

TEST(WalkBody, AtTheDatasPaceArmsSwingAsInTheData) {
  MadeBody walker;
  walker.pace(2400, adult().source_step_m, adult().body.own_step_s);
  const double arc = arm_arc(adult().source_step_m, adult().body.own_step_s).width();
  EXPECT_GT(arc, 24.6);  // degrees: people's arc of the arm at free speed
  EXPECT_LT(arc, 32.0);
}

TEST(WalkBody, ArmsSwingAgainstEachOther) {
  for (const double forward : {0.3, 0.6, 1.0}) {
    MadeBody walker;
    walker.walk(1500, {}, forward);
    double left_mean = 0.0, right_mean = 0.0;
    std::vector<vec2> both;
    for (int i = 0; i < 720; ++i) {
      walker.step({}, forward);
      both.push_back({walker.swing(kLeftSide), walker.swing(kRightSide)});
      left_mean += both.back().x / 720.0, right_mean += both.back().y / 720.0;
    }
    double product = 0.0, left = 0.0, right = 0.0;
    for (const vec2& b : both) {
      product += (b.x - left_mean) * (b.y - right_mean);
      left += (b.x - left_mean) * (b.x - left_mean);
      right += (b.y - right_mean) * (b.y - right_mean);
    }
    EXPECT_LT(product / std::sqrt(left * right), -0.9) << forward;
  }
}

TEST(WalkBody, ArmsSwingWithTheStepsOfATurnOnTheSpot) {
  // To the right and to the left: each hand's way ahead of its shoulder, seen from the body.
  std::array<std::vector<double>, 2> ahead_m[2];
  double bend_deg[2]{}, aside_m[2]{};
  for (int turn : {0, 1}) {
    MadeBody body;
    for (int tick = 0; tick < 4 * kRate; ++tick) {
      body.step({}, 0.0, turn == 0 ? 1.0 : -1.0);
      if (tick < 2 * kRate) continue;
      const vec3 across = glm::normalize(body.shoulder(kLeftSide) - body.shoulder(kRightSide)),
                 ahead = glm::cross(across, vec3(0.0, 1.0, 0.0));
      for (Side side : {kLeftSide, kRightSide}) {
        const vec3 hand = body.hand(side) - body.shoulder(side);
        ahead_m[turn][side].push_back(glm::dot(hand, ahead));
        if (side == (turn == 0 ? kLeftSide : kRightSide))  // on the outer side
          aside_m[turn] = std::max(aside_m[turn], std::abs(glm::dot(hand, across)));
      }
      bend_deg[turn] = std::max(bend_deg[turn], body.elbow(kLeftSide));
    }
  }
  for (int turn : {0, 1}) {
    for (Side side : {kLeftSide, kRightSide}) {
      const auto [least, most] =
          std::minmax_element(ahead_m[turn][side].begin(), ahead_m[turn][side].end());
      EXPECT_GT(*most - *least, 0.1) << turn << " " << side;
      EXPECT_LT(*most - *least, 0.35) << turn << " " << side;
    }
    EXPECT_GT(bend_deg[turn], 10.0);
    EXPECT_GT(aside_m[turn], 0.04);
    // One arm is ahead while the other one is back.
    double together = 0.0;
    const double left = 0.5 * (*std::ranges::max_element(ahead_m[turn][0]) +
                               *std::ranges::min_element(ahead_m[turn][0])),
                 right = 0.5 * (*std::ranges::max_element(ahead_m[turn][1]) +
                                *std::ranges::min_element(ahead_m[turn][1]));
    for (std::size_t i = 0; i < ahead_m[turn][0].size(); ++i)
      together += (ahead_m[turn][0][i] - left) * (ahead_m[turn][1][i] - right);
    EXPECT_LT(together, 0.0);
  }
  // A mirrored stick gives the mirrored swing.
  for (std::size_t i = 0; i < ahead_m[0][0].size(); ++i)
    EXPECT_NEAR(ahead_m[0][kLeftSide][i], ahead_m[1][kRightSide][i], 1e-4) << i;
}

TEST(WalkBody, TheStylesFactorScalesTheSwing) {
  std::vector<double> arcs;
  for (const double factor : {0.0, 0.5, 1.0, 2.0, 3.0}) {
    const StyleValues swings = style({{"left_arm.swing", factor}});
    MadeBody walker;
    walker.walk(1500, swings, 0.7);
    Range arc;
    Range elbow;
    for (int i = 0; i < 400; ++i) {
      walker.step(swings, 0.7);
      arc.add(walker.swing(kLeftSide));
      elbow.add(walker.elbow(kLeftSide));
    }
    if (!arcs.empty()) {
      EXPECT_GT(arc.width(), arcs.back() + 5.0);
    }
    arcs.push_back(arc.width());
    EXPECT_GT(elbow.low, 2.0);  // no elbow is fully stretched
  }
  EXPECT_LT(arcs.front(), 5.0);  // what remains is the trunk's movement
}

TEST(WalkBody, InPaperModeItIsTheDatas) {
  MadeBody walker(adult(), IkMode::paper);
  walker.walk(2000, {}, 0.8);
  ASSERT_NEAR(presence(walker.state()), 1.0, 1e-6);
  Pose data;
  sample_local(adult().cycle, shown_phase(walker.state()), data);
  for (const ArmBuild& arm : adult().body.arm) {
    for (const int j : {arm.joints.shoulder, arm.joints.elbow, arm.joints.wrist}) {
      EXPECT_LT(
          glm::length(rotation_vector(glm::conjugate(data.local[j]) * walker.pose().local[j])),
          1e-4 * kDegree);  // floats: 4e-5
    }
  }
}

// The elbow compensates for a stiff shoulder, so that the hand keeps its path.
TEST(WalkBody, WeightsChangeTheJointsAndNotTheHandsPath) {
  const StyleValues stiff = style({{"left_arm.weight.shoulder", 0.15}});
  MadeBody plain, weighted;
  plain.walk(1500, {}, 0.8);
  weighted.walk(1500, stiff, 0.8);
  Range own, other_own, elbow, other_elbow;
  double farthest = 0.0, highest = 0.0, right_farthest = 0.0;
  for (int i = 0; i < 480; ++i) {
    plain.step({}, 0.8);
    weighted.step(stiff, 0.8);
    own.add(plain.swing(kLeftSide)), other_own.add(weighted.swing(kLeftSide));
    elbow.add(plain.elbow(kLeftSide)), other_elbow.add(weighted.elbow(kLeftSide));
    const vec3 off = plain.hand(kLeftSide) - weighted.hand(kLeftSide);
    farthest = std::max(farthest, glm::length(vec2(off.x, off.z)));
    highest = std::max(highest, std::abs(off.y));
    right_farthest =
        std::max(right_farthest, glm::distance(plain.hand(kRightSide), weighted.hand(kRightSide)));
  }
  EXPECT_LT(farthest, 0.001);
  EXPECT_LT(highest, 0.06);
  EXPECT_EQ(right_farthest, 0.0);
  EXPECT_LT(other_own.width(), own.width() - 3.0);
  EXPECT_GT(other_elbow.width(), elbow.width() + 3.0);
}

}  // namespace
}  // namespace gaitpad
