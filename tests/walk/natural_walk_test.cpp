// Compares how a walk begins, ends, turns and changes its pace with what people do. Hips and knees
// are read from the posed skeleton, the rest from the tick's report. The built-in motion, level
// ground.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "tests/walk/made_walker.h"

namespace gaitpad {
namespace {

constexpr double kWindow_s = 1.0 / 14.0;
constexpr double kGentle_m_s2 = 4.0, kGravity_m_s2 = 9.81;
constexpr int kMoments = 24;
// Ticks, 21 ms: a landing within this time belongs to a step that had begun before.
constexpr int kJustLanding = 5;

// A walker that also records the places of its hips.
struct Posed {
  MadeWalker walker;
  std::vector<vec3> hips_m;  // middles between both hip joints, one for each tick
  explicit Posed(IkMode mode = IkMode::robust) : walker(adult(), mode) {}

  const JointFrames& joints() const {
    static JointFrames world;
    forward_kinematics(adult().cycle.skeleton, walker.pose(), world);
    return world;
  }
  vec3 joint_m(Side side, int LegJoints::*joint) const {
    return joints().position_m[adult().leg[side].model.joints.*joint];
  }
  vec3 middle_of_hips_m() const {
    return 0.5 * (joint_m(kLeftSide, &LegJoints::hip) + joint_m(kRightSide, &LegJoints::hip));
  }
  void walk(double x, double y, int ticks) {
    for (int i = 0; i < ticks; ++i) {
      walker.walk(x, y, 1);
      hips_m.push_back(middle_of_hips_m());
    }
  }
  double knee_deg(Side side) const {
    const vec3 knee = joint_m(side, &LegJoints::knee);
    const vec3 thigh = glm::normalize(knee - joint_m(side, &LegJoints::hip)),
               shank = glm::normalize(joint_m(side, &LegJoints::ankle) - knee);
    return gaitpad::atan2(glm::length(glm::cross(thigh, shank)), glm::dot(thigh, shank)) / kDegree;
  }
  // The greatest horizontal acceleration of the hips, over 1/14 s.
  double jolt_m_s2(int from, int to) const {
    constexpr double kWindow = kWindow_s * kRate;  // length of the window in ticks
    constexpr int kWhole = static_cast<int>(kWindow);
    const auto at = [this](int tick, int side) {
      const vec3 near = hips_m[tick + side * kWhole], far = hips_m[tick + side * (kWhole + 1)];
      return near + (far - near) * (kWindow - kWhole);
    };
    double greatest = 0.0;
    for (int k = std::max(from, kWhole + 1); k < to - kWhole - 1; ++k) {
      const vec3 change = at(k, -1) - 2.0 * hips_m[k] + at(k, 1);
      greatest =
          std::max(greatest, glm::length(vec2(change.x, change.z)) / (kWindow_s * kWindow_s));
    }
    return greatest;
  }
  int steps() const { return walker.last().steps[0] + walker.last().steps[1]; }
};

// The worst values over many moments at which a stick is released: the first ones within the first
// steps, the others over more than a stride of the steady walk.
struct Stops {
  double jolt_m_s2 = 0.0;
  int steps = 0;
  bool all_stand = true;
};
const Stops& stops_from(double stick) {
  static std::map<double, Stops> known;
  const auto [place, is_new] = known.try_emplace(stick);
  Stops& worst = place->second;
  if (!is_new) return worst;
  for (int moment = 0; moment < kMoments; ++moment) {
    const int first = kMoments / 3;
    const int until = moment < first ? 12 + 23 * moment : 5 * kRate + 19 * (moment - first);
    Posed walk;
    walk.walk(0, stick, until + 1);
    walk.walk(0, 0, kJustLanding);
    const int before = walk.steps();
    walk.walk(0, 0, 4 * kRate);
    worst.steps = std::max(worst.steps, walk.steps() - before);
    worst.jolt_m_s2 = std::max(worst.jolt_m_s2, walk.jolt_m_s2(until, until + 4 * kRate));
    worst.all_stand = worst.all_stand && walk.walker.last().stage == Stage::idle;
  }
  return worst;
}

double start_m_s2(double stick) {
  Posed walk;
  walk.walk(0, 0, kRate / 2);
  walk.walk(0, stick, 2 * kRate);
  return walk.jolt_m_s2(0, kRate / 2 + 2 * kRate);
}

TEST(NaturalWalk, StartsAndStopsAreGentleWheneverTheStickLetsGo) {
  for (const double stick : {0.3, 0.6, 0.8}) EXPECT_LE(start_m_s2(stick), kGentle_m_s2) << stick;
  for (const double stick : {0.4, 0.6, 0.8})
    EXPECT_LE(stops_from(stick).jolt_m_s2, kGentle_m_s2) << stick;
}

// People need up to 6 m/s^2 from and to a brisk walk.
TEST(NaturalWalk, AtFullStickStartsAndStopsAreLittleHarder) {
  EXPECT_LE(start_m_s2(1.0), 1.1 * kGentle_m_s2);
  EXPECT_LE(stops_from(1.0).jolt_m_s2, 1.15 * kGentle_m_s2);
}

TEST(NaturalWalk, AWalkStandsWithinTwoStepsWheneverTheStickLetsGo) {
  for (const double stick : {0.4, 0.6, 0.8, 1.0}) {
    const Stops& stops = stops_from(stick);
    EXPECT_TRUE(stops.all_stand) << stick;
    EXPECT_LE(stops.steps, 2) << stick;
  }
}

TEST(NaturalWalk, StandingKneesAreNearlyStraight) {
  Posed walk;
  walk.walk(0, 0, 1);
  for (const double stick : {0.0, 0.4, 1.0}) {  // the starts from rest, and then after a walk
    walk.walk(0, stick, 3 * kRate);
    walk.walk(0, 0, 4 * kRate);
    for (const Side side : {kLeftSide, kRightSide}) {
      EXPECT_GE(walk.knee_deg(side), 2.0) << stick;
      EXPECT_LE(walk.knee_deg(side), 7.0) << stick;
    }
  }
}

TEST(NaturalWalk, KneesAreNearlyStraightAfterAStopAtAnyMoment) {
  for (int moment = 0; moment < 240; moment += 24) {
    Posed walk;
    walk.walk(0, 1.0, 3 * kRate + moment);
    walk.walk(0, 0, 2 * kRate);
    for (const Side side : {kLeftSide, kRightSide}) EXPECT_LE(walk.knee_deg(side), 7.0) << moment;
  }
}

struct Manner {
  double both_feet = 0.0;       // share of the time in which both feet stand
  double swing_knee_deg = 0.0;  // largest bend of a swinging knee
};
Manner manner_at(double stick) {
  Posed walk;
  walk.walk(0, stick, 5 * kRate);
  Manner manner;
  int rolls = 0, ticks = 0, from = walk.steps();
  // Measures whole strides: from a landing to one of the same foot.
  while (walk.steps() == from) walk.walk(0, stick, 1);
  for (from = walk.steps(); walk.steps() < from + 8; ++ticks) {
    rolls += walk.walker.last().stage == Stage::roll;
    walk.walk(0, stick, 1);
    if (walk.walker.last().stage == Stage::flight)
      manner.swing_knee_deg =
          std::max(manner.swing_knee_deg, walk.knee_deg(walk.walker.last().swing));
  }
  manner.both_feet = static_cast<double>(rolls) / ticks;
  return manner;
}

TEST(NaturalWalk, DoubleSupportFallsFromAThirdOfAStrollToAFifthOfABriskWalk) {
  double before = 1.0;
  for (const double stick : {0.4, 0.55, 0.7, 0.85, 1.0}) {
    const double now = manner_at(stick).both_feet;
    EXPECT_LT(now, before) << "stick " << stick;
    if (stick == 0.4) EXPECT_NEAR(now, 0.35, 0.04);
    before = now;
  }
  EXPECT_NEAR(before, 0.20, 0.035);
}

// People's hips swing over each leg like a pendulum that stands on its foot.
TEST(NaturalWalk, TheHipsAreFastestAboutTheStrikesAsPeoplesAre) {
  for (const double stick : {0.5, 0.8, 1.0}) {
    Posed walk;
    walk.walk(0, stick, 5 * kRate);
    std::vector<int> strikes;
    for (int before = walk.steps(); strikes.size() < 5; before = walk.steps()) {
      walk.walk(0, stick, 1);
      if (walk.steps() != before) strikes.push_back(static_cast<int>(walk.hips_m.size()) - 1);
    }
    for (std::size_t i = 0; i + 1 < strikes.size(); ++i) {
      const int from = strikes[i], ticks = strikes[i + 1] - from;
      const auto way_m = [&](int k) {
        return walk.hips_m[from + k].z - walk.hips_m[from + k - 1].z;
      };
      int fastest = 0, slowest = 0;
      double sum_m = 0.0;
      for (int k = 0; k < ticks; ++k) {
        if (way_m(k) > way_m(fastest)) fastest = k;
        if (way_m(k) < way_m(slowest)) slowest = k;
        sum_m += way_m(k);
      }
      const double from_strike = std::min(fastest, ticks - fastest) / double(ticks),
                   faster = way_m(fastest) * ticks / sum_m;
      EXPECT_LT(from_strike, 0.2) << stick;
      EXPECT_GT(slowest, 0.15 * ticks) << stick;
      EXPECT_LT(slowest, 0.6 * ticks) << stick;
      EXPECT_GT(faster, 1.05) << stick;
      EXPECT_LT(faster, 1.2) << stick;
    }
  }
}

TEST(NaturalWalk, TheSwingingKneeBendsLessInShortSteps) {
  double least_deg = 0.0, before_deg = 0.0;
  for (const double stick : {0.1, 0.25, 0.5, 0.8}) {
    const double now_deg = manner_at(stick).swing_knee_deg;
    EXPECT_GT(now_deg, before_deg) << "stick " << stick;
    if (stick == 0.1) least_deg = now_deg;
    before_deg = now_deg;
  }
  EXPECT_GT(before_deg - least_deg, 10.0);
}

// Degrees to the left by which pelvis and trunk lean, and the speed and turn that they lean for,
// as means over eight steps.
struct Lean {
  double pelvis_deg = 0.0, body_deg = 0.0, asked_deg = 0.0;
};
Lean lean_in(double x, double y, IkMode mode) {
  Posed walk(mode);
  walk.walk(x, y, 6 * kRate);
  Lean lean;
  int ticks = 0, from = walk.steps();
  while (walk.steps() == from) walk.walk(x, y, 1);
  for (from = walk.steps(); walk.steps() < from + 8; ++ticks) {
    walk.walk(x, y, 1);
    const WalkFrame& frame = walk.walker.last();
    const vec3 left = rotation_y(frame.heading_rad) * vec3(1.0, 0.0, 0.0);
    const JointFrames& joints = walk.joints();
    const auto leftwards_deg = [&left](const vec3& up) {
      return gaitpad::atan2(glm::dot(up, left), up.y) / kDegree;
    };
    const auto shoulder_m = [&](int side) {
      return joints.position_m[adult().body.arm[side].joints.shoulder];
    };
    const vec3 across =
        walk.joint_m(kLeftSide, &LegJoints::hip) - walk.joint_m(kRightSide, &LegJoints::hip);
    lean.pelvis_deg -= gaitpad::atan2(across.y, glm::dot(across, left)) / kDegree;
    lean.body_deg += leftwards_deg(0.5 * (shoulder_m(0) + shoulder_m(1)) - walk.middle_of_hips_m());
    lean.asked_deg +=
        gaitpad::atan2(frame.speed_m_s * frame.turn_rate_rad_s, kGravity_m_s2) / kDegree;
  }
  lean.pelvis_deg /= ticks, lean.body_deg /= ticks, lean.asked_deg /= ticks;
  return lean;
}

TEST(NaturalWalk, TheBodyLeansIntoATurnAsItsSpeedAsks) {
  for (const double x : {-0.6, -0.3, 0.3, 0.6}) {
    for (const double y : {0.5, 0.8}) {
      const Lean lean = lean_in(x, y, IkMode::robust);
      // With the stick to the right the walk turns right, so it does not lean to the left.
      EXPECT_GT(lean.asked_deg * -x, 0.0);
      EXPECT_NEAR(lean.pelvis_deg, lean.asked_deg, 1.0) << x << ", " << y;
      EXPECT_NEAR(lean.body_deg, lean.asked_deg, 1.0) << x << ", " << y;
    }
  }
  // In paper mode the body does not lean.
  const Lean lean = lean_in(-0.6, 0.8, IkMode::paper);
  EXPECT_GT(lean.asked_deg, 3.0);
  EXPECT_NEAR(lean.pelvis_deg, 0.0, 0.2);
  // Not exactly 0, because the data's spine is not quite mirrored.
  EXPECT_NEAR(lean.body_deg, 0.0, 1.0);
}

// Moves a slider at several moments of a walk. At most of these moments some joint has changed
// within 100 ms (not where the sway that a factor multiplies passes through 0), and no leg ever
// jerks.
void expect_to_show_soon(const char* key, double value, double most_turn_deg = 1.0) {
  StyleValues style;
  ASSERT_TRUE(set_value(style, key, value)) << key;
  std::vector<double> change_deg;
  MadeWalker same;
  same.walk(0.0, 0.8, 5 * kRate);
  for (int moment = 0; moment < 8; ++moment) {
    same.walk(0.0, 0.8, 17);
    MadeWalker plain = same, changed = same;
    double most_rad = 0.0;
    for (int k = 0; k < kRate / 10; ++k) {
      plain.walk(0.0, 0.8, 1);
      changed.walk(0.0, 0.8, 1, style);
      for (int j = 0; j < plain.pose().joint_count; ++j) {
        const quat turn = glm::conjugate(plain.pose().local[j]) * changed.pose().local[j];
        most_rad = std::max(most_rad, 2.0 * glm::length(vec3(turn.x, turn.y, turn.z)));
      }
    }
    change_deg.push_back(most_rad / kDegree);
    changed.walk(0.0, 0.8, kRate, style);
    EXPECT_LE(changed.sharpest_turn_rad(), most_turn_deg * kDegree) << key << ", moment " << moment;
  }
  std::ranges::sort(change_deg);
  EXPECT_GT(change_deg[3], 0.1) << key;
}

TEST(NaturalWalk, SlidersShowWithinATenthOfASecondAndWithoutAHitch) {
  const std::pair<const char*, double> sliders[] = {
      {"hip_sway", 2.0},          {"hip_bounce", 1.5},
      {"legs.weight.hip", 0.3},   {"legs.weight.knee", 0.3},
      {"legs.weight.ankle", 0.3}, {"legs.stride_length", 0.7},
      {"arms.swing", 0.3},        {"arms.out_deg", 15.0},
      {"trunk.lean_deg", 10.0},   {"trunk.over_left_deg", 10.0}};
  for (const auto& [key, value] : sliders) expect_to_show_soon(key, value);
  // Hips that bounce twice as far stretch the legs fully, so knees turn more sharply in each step.
  expect_to_show_soon("hip_bounce", 2.0, 1.6);
}

}  // namespace
}  // namespace gaitpad
