// Chest, head and arms where a walk changes, and which joints a tick writes. Thumbs take 60 ms.
#include <gtest/gtest.h>

#include "tests/minimum_jerk.h"
#include "tests/walk/made_block.h"

namespace gaitpad {
namespace {

constexpr int kThumb = kRate * 6 / 100, kMoments = 6;

StyleValues style_of(std::initializer_list<std::pair<const char*, double>> values) {
  StyleValues style;
  for (const auto& [key, value] : values) EXPECT_TRUE(set_value(style, key, value)) << key;
  return style;
}

vec3 turned_by(const quat& from, const quat& to) {
  return rotation_vector(to * glm::conjugate(from));
}

// The greatest angular acceleration of a segment over 4 ticks, degrees/s^2.
class Turning {
 public:
  void add(const quat& world) {
    for (int i = 8; i > 0; --i) last_[i] = last_[i - 1];
    last_[0] = world;
    if (++ticks_ < 9) return;
    const vec3 now = turned_by(last_[4], last_[0]), before = turned_by(last_[8], last_[4]);
    most_deg_s2 = std::max(most_deg_s2, glm::length(now - before) * kRate * kRate / 16.0 / kDegree);
  }
  // The second difference of the last three ticks, degrees/tick^2.
  double bend_deg() const {
    return glm::length(turned_by(last_[1], last_[0]) - turned_by(last_[2], last_[1])) / kDegree;
  }
  double most_deg_s2 = 0.0;

 private:
  std::array<quat, 9> last_;
  int ticks_ = 0;
};

// A walk from a stand on, steered by a thumb.
class Walker {
 public:
  explicit Walker(const StyleValues& style = {}, const WalkModel& model = adult())
      : model_(model), style_(style), tables_(tables_of(model, kDt)) {
    stand(tables_, Origin{}, block);
    pose.joint_count = static_cast<int>(model.cycle.skeleton.joints.size());
  }
  // The thumb moves there.
  void push(const vec2& to) {
    const vec2 from = stick_;
    for (int tick = 1; tick <= kThumb; ++tick) {
      stick_ = from + (to - from) * minimum_jerk(double(tick) / kThumb);
      step();
    }
  }
  void hold(int ticks) {
    for (int tick = 0; tick < ticks; ++tick) step();
  }
  void step() {
    Stick stick;
    stick.left = stick_;
    const GaitParams params = gait_params(stick, style_, gait_limits(model_));
    ask(params, block);
    quat* local = pose.local.data();
    vec3* root = &pose.root_m;
    const bool eased = block.poise.acts != 0.0f;
    advance(tables_, block, Poses{&local, &root, 1});
    forward_kinematics(model_.cycle.skeleton, pose, frames_);
    of_chest.add(chest()), of_head.add(head()), of_pelvis.add(pelvis());
    if (!eased && block.poise.acts != 0.0f) begins_deg = of_chest.bend_deg();
  }
  void forget() {
    for (Turning* turning : {&of_chest, &of_head, &of_pelvis}) turning->most_deg_s2 = 0.0;
  }

  quat head() const { return frames_.rotation[model_.body.head_path.back()]; }
  quat chest() const {
    const UpperBodyModel& body = model_.body;
    return frames_.rotation[model_.cycle.skeleton.joints[body.head_path[body.neck_at]].parent];
  }
  quat pelvis() const { return frames_.rotation[model_.cycle.pelvis]; }
  vec3 at(int joint) const { return frames_.position_m[joint]; }
  vec3 shoulder(Side side) const { return at(model_.body.arm[side].joints.shoulder); }
  vec3 hand(Side side) const {
    const ArmBuild& arm = model_.body.arm[side];
    return at(arm.joints.wrist) + frames_.rotation[arm.joints.wrist] * arm.grip_m;
  }
  Pose pose;
  Block<1> block;
  Turning of_chest, of_head, of_pelvis;
  double begins_deg = 0.0;  // bend_deg() of the chest where easing last began

 private:
  const WalkModel& model_;
  StyleValues style_;
  Tables tables_;
  JointFrames frames_;
  vec2 stick_{0.0, 0.0};
};

// --- Where a walk changes ------------------------------------------------------------------------

struct Accelerations {
  double chest = 0.0, head = 0.0, pelvis = 0.0;
  void add(const Walker& walker) {
    chest = std::max(chest, walker.of_chest.most_deg_s2);
    head = std::max(head, walker.of_head.most_deg_s2);
    pelvis = std::max(pelvis, walker.of_pelvis.most_deg_s2);
  }
};
Accelerations steady(const vec2& stick) {
  Walker walker(style_of({{"idle", 0.0}}));
  walker.push(stick);
  walker.hold(4 * kRate);
  walker.forget();
  walker.hold(3 * kRate);
  Accelerations most;
  most.add(walker);
  return most;
}

// From the one stick to the other, at some moments of a step; with a stand that does not move.
Accelerations changing(const vec2& from, const vec2& to) {
  Accelerations most;
  for (int moment = 0; moment < kMoments; ++moment) {
    Walker walker(style_of({{"idle", 0.0}}));
    walker.push(from);
    walker.hold(3 * kRate + moment * kRate * 11 / 10 / kMoments);
    walker.forget();
    walker.push(to);
    walker.hold(3 * kRate);
    most.add(walker);
  }
  return most;
}

class Changes : public testing::TestWithParam<std::array<vec2, 2>> {};

TEST_P(Changes, TurnChestAndHeadAtMostTwiceAsHardAsTheSteadyWalk) {
  constexpr double kMost = 2.0;
  const auto [from, to] = GetParam();
  const Accelerations changes = changing(from, to), before = steady(from), after = steady(to);
  const double chest = std::max(before.chest, after.chest),
               head = std::max(before.head, after.head);
  std::printf("chest %.0f, steady %.0f; head %.0f, steady %.0f degrees/s^2\n", changes.chest, chest,
              changes.head, head);
  EXPECT_LE(changes.chest, kMost * chest);
  EXPECT_LE(changes.head, kMost * head);
}
constexpr vec2 kRest(0.0, 0.0);
INSTANTIATE_TEST_SUITE_P(
    Start, Changes,
    testing::Values(std::array{kRest, vec2(0.0, 0.3)}, std::array{kRest, vec2(0.0, 0.8)},
                    std::array{kRest, vec2(0.0, 1.0)}, std::array{kRest, vec2(0.0, -1.0)},
                    std::array{kRest, vec2(-0.3, 0.8)}, std::array{kRest, vec2(0.7, 0.7)}));
INSTANTIATE_TEST_SUITE_P(
    Stop, Changes,
    testing::Values(std::array{vec2(0.0, 0.3), kRest}, std::array{vec2(0.0, 0.8), kRest},
                    std::array{vec2(0.0, 1.0), kRest}, std::array{vec2(0.0, -1.0), kRest},
                    std::array{vec2(-0.3, 0.8), kRest}, std::array{vec2(0.7, 0.7), kRest}));
INSTANTIATE_TEST_SUITE_P(Other, Changes,
                         testing::Values(std::array{vec2(0.0, 0.3), vec2(0.0, 1.0)},
                                         std::array{vec2(0.0, 1.0), vec2(0.0, 0.3)},
                                         std::array{vec2(0.0, 0.8), vec2(0.5, 0.8)},
                                         std::array{vec2(-0.5, 0.8), vec2(0.5, 0.8)},
                                         std::array{vec2(0.0, 1.0), vec2(0.0, -1.0)}));

// The pelvis itself turns harder there than in any walk, and chest and head are ahead of it.
TEST(TurnInPlace, TurnsChestAndHeadAtMostTwiceAsHardAsThePelvis) {
  constexpr double kMost = 2.0;
  for (const double x : {0.9, -0.4}) {
    for (const bool starts : {true, false}) {
      const vec2 turn(x, 0.0);
      const Accelerations most = starts ? changing(kRest, turn) : changing(turn, kRest);
      std::printf("chest %.0f, head %.0f, pelvis %.0f degrees/s^2\n", most.chest, most.head,
                  most.pelvis);
      EXPECT_LE(most.chest, kMost * most.pelvis);
      EXPECT_LE(most.head, kMost * most.pelvis);
    }
  }
}

// Where a turn begins, the chest goes on with the rate at which a style leans it to both sides.
TEST(Turn, BeginsWithTheRateOfALeaningTrunk) {
  const StyleValues sways =
      style_of({{"idle", 0.0}, {"trunk.over_left_deg", 20.0}, {"trunk.over_right_deg", 20.0}});
  constexpr double kMost_deg = 0.008;  // a tick^2
  double most_deg = 0.0;
  for (int moment = 0; moment < 2 * kMoments; ++moment) {
    Walker walker(sways);
    walker.push(vec2(0.0, 0.8));
    walker.hold(4 * kRate + moment * kRate * 11 / 20 / kMoments);
    ASSERT_EQ(walker.block.poise.acts, 0.0f);
    walker.push(vec2(0.3, 0.8));
    ASSERT_NE(walker.block.poise.acts, 0.0f);
    most_deg = std::max(most_deg, walker.begins_deg);
  }
  std::printf("%.4f degrees/tick^2\n", most_deg);
  EXPECT_LT(most_deg, kMost_deg);
}

// A walk that begins in the middle of a glance: the head goes on from how it moves.
TEST(Glance, EndsInAWalkWithoutAJump) {
  constexpr double kGlance_deg_s2 = 420.0;  // of a glance itself
  Accelerations most;
  for (int wait = kRate; wait < 9 * kRate; wait += kRate / 4) {
    Walker walker;
    walker.hold(wait);
    walker.forget();
    walker.push(vec2(0.0, 0.8));
    walker.hold(2 * kRate);
    most.add(walker);
  }
  std::printf("head %.0f degrees/s^2\n", most.head);
  EXPECT_LE(most.head, kGlance_deg_s2);
}

TEST(UpperBody, ShowsAPushWithinATenthOfASecond) {
  constexpr double kSeen = kDegree, kMost_s = 0.1;
  for (const vec2& stick : {vec2(0.0, 0.3), vec2(0.0, 0.8), vec2(0.0, 1.0), vec2(0.9, 0.0)}) {
    Walker walker;
    walker.hold(60);
    const quat chest = walker.chest(), head = walker.head();
    walker.push(stick);
    int ticks = kThumb;
    const auto shows = [&] {
      return glm::length(turned_by(chest, walker.chest())) > kSeen ||
             glm::length(turned_by(head, walker.head())) > kSeen;
    };
    for (; !shows() && ticks < kRate; ++ticks) walker.step();
    std::printf("stick (%.1f, %.1f): %.3f s\n", stick.x, stick.y, ticks * kDt);
    EXPECT_LE(ticks * kDt, kMost_s);
  }
}

// Seconds after which head, chest and pelvis have turned.
std::array<double, 3> turned_after_s(const vec2& from, const vec2& to, double turned_rad) {
  // Beside a walk that does not turn: its own sway is no turn.
  Walker turns, straight;
  for (Walker* walker : {&turns, &straight}) {
    walker->push(from);
    walker->hold(3 * kRate);
  }
  std::array<double, 3> at_s{};
  for (int tick = 0; tick < 2 * kRate; ++tick) {
    if (tick == 0) turns.push(to), straight.push(from);
    turns.step(), straight.step();
    const auto turned = [&](const quat& a, const quat& b) {
      return std::abs(wrapped(heading_of(b * kForward) - heading_of(a * kForward)));
    };
    const std::array<double, 3> rad = {turned(straight.head(), turns.head()),
                                       turned(straight.chest(), turns.chest()),
                                       turned(straight.pelvis(), turns.pelvis())};
    for (int k = 0; k < 3; ++k)
      if (at_s[k] == 0.0 && rad[k] > turned_rad) at_s[k] = (kThumb + tick) * kDt;
  }
  std::printf("(%.1f, %.1f): head %.3f, chest %.3f, pelvis %.3f s\n", to.x, to.y, at_s[0], at_s[1],
              at_s[2]);
  return at_s;
}

TEST(UpperBody, TurnsHeadThenChestThenPelvis) {
  for (const auto& [from, to] :
       {std::array{kRest, vec2(0.9, 0.0)}, std::array{kRest, vec2(-0.9, 0.0)},
        std::array{vec2(0.0, 0.8), vec2(0.5, 0.8)}, std::array{vec2(0.0, 0.8), vec2(-0.7, 0.6)}}) {
    const std::array<double, 3> at_s = turned_after_s(from, to, 5.0 * kDegree);
    EXPECT_LT(at_s[0], at_s[1]);
    EXPECT_LT(at_s[1], at_s[2]);
  }
}

// In the middle of a turn the head is 0.3 s ahead; early in a sharp one, where its bound holds it
// back, at least this.
TEST(UpperBody, TurnsTheHeadWellAheadInASharpTurn) {
  for (const double side : {1.0, -1.0}) {
    const vec2 from(0.0, 0.9), to(0.95 * side, 0.3);
    const std::array<double, 3> early_s = turned_after_s(from, to, 10.0 * kDegree),
                                half_s = turned_after_s(from, to, 30.0 * kDegree);
    EXPECT_LE(early_s[0], early_s[2] - 0.15);
    EXPECT_LE(early_s[1], early_s[2] - 0.07);
    EXPECT_LE(half_s[0], half_s[2] - 0.27);
    EXPECT_LE(half_s[1], half_s[2] - 0.10);
  }
}

// A head that led a turn on the spot stops with the body: it is past the body's last heading by at
// most half of its lead, and not for long.
TEST(UpperBody, StopsTheHeadWithTheBodyAfterATurnOnTheSpot) {
  constexpr double kNear_rad = 4.0 * kDegree;
  constexpr int kBack = 7 * kRate / 10;  // ticks after the thumb
  for (const double side : {1.0, -1.0}) {
    Walker walker;
    walker.hold(kRate);
    const quat stood = walker.head(), body = walker.pelvis();
    const auto head_rad = [&] {
      return heading_of(walker.head() * glm::conjugate(stood) * kForward);
    };
    const auto body_rad = [&] {
      return heading_of(walker.pelvis() * glm::conjugate(body) * kForward);
    };
    walker.push(vec2(side, 0.0));
    walker.hold(4 * kRate);
    const double lead_rad = std::abs(wrapped(head_rad() - body_rad()));
    walker.push(kRest);
    std::vector<double> heading_rad(2 * kRate);
    for (double& at_rad : heading_rad) {
      walker.step();
      at_rad = head_rad();
    }
    const double last_rad = body_rad();
    double past_rad = 0.0, late_rad = 0.0;
    for (int tick = 0; tick < std::ssize(heading_rad); ++tick) {
      const double over_rad = wrapped(heading_rad[tick] - last_rad);
      past_rad = std::max(past_rad, std::abs(over_rad));
      if (tick >= kBack) late_rad = std::max(late_rad, std::abs(over_rad));
    }
    std::printf("past by %.1f, after 0.7 s by %.1f degrees\n", past_rad / kDegree,
                late_rad / kDegree);
    EXPECT_LT(past_rad, 0.5 * lead_rad);
    EXPECT_LT(late_rad, kNear_rad);
  }
}

// The arm on the outer side of a walk that turns is carried forward, the other one stays behind.
TEST(UpperBody, CarriesArmsWithTheTrunkInASharpTurn) {
  constexpr double kLeast_m = 0.13;
  for (const double side : {1.0, -1.0}) {
    Walker walker;
    walker.push(vec2(0.0, 0.9));
    walker.hold(2 * kRate);
    walker.push(vec2(0.95 * side, 0.3));
    walker.hold(kRate);
    double outer_m = 0.0;
    const int ticks = 4 * kRate;
    for (int tick = 0; tick < ticks; ++tick) {
      walker.step();
      const vec3 left = walker.hand(kLeftSide) - walker.hand(kRightSide);
      const double heading_rad =
          walker.block.origin[0].heading_rad + static_cast<double>(walker.block.state.heading_rad);
      const SinCos ahead = gaitpad::sin_cos(heading_rad);
      outer_m += side * (left.x * ahead.sin + left.z * ahead.cos) / ticks;
    }
    std::printf("outer hand ahead by %.3f m\n", outer_m);
    EXPECT_GT(outer_m, kLeast_m);
  }
}

TEST(UpperBody, SwingsArmsAgainstTheLegsFromTheFirstStepOn) {
  const int hip[2] = {adult().leg[0].joint[0].joint, adult().leg[1].joint[0].joint},
            ankle[2] = {adult().leg[0].joint[2].joint, adult().leg[1].joint[2].joint};
  for (const double y : {0.3, 0.6, 1.0}) {
    Walker walker;
    walker.hold(60);
    walker.push(vec2(0.0, y));
    double product = 0.0, most_m = 0.0;
    for (int steps = 0, tick = 0; steps < 2 && tick < 3 * kRate; ++tick) {
      walker.step();
      steps += walker.block.state.tick == 0.0f && walker.block.state.flies == 0.0f ? 1 : 0;
      const double legs_m = (walker.at(ankle[0]) - walker.at(hip[0])).z -
                            (walker.at(ankle[1]) - walker.at(hip[1])).z,
                   arms_m = (walker.hand(kLeftSide) - walker.shoulder(kLeftSide)).z -
                            (walker.hand(kRightSide) - walker.shoulder(kRightSide)).z;
      most_m = std::max(most_m, std::abs(legs_m));
      if (std::abs(legs_m) < 0.3 * most_m) continue;
      product += legs_m * arms_m;
      if (std::abs(legs_m) > 0.9 * most_m && steps > 0) {
        EXPECT_LT(legs_m * arms_m, 0.0) << y;
      }
    }
    EXPECT_LT(product, 0.0) << y;
  }
}

// --- Joints that the walk alone writes -----------------------------------------------------------

// Into a pose that holds nothing: every joint is written in every tick, with the bits of one that
// is written on. Returns the root's rotation.
quat last_root(const WalkModel& model, const Placement& placed) {
  Alone walk(model);
  place(placed, 0, walk.block);
  const GaitParams params = params_of(0.2, 0.8);
  walk.walk(params, 4 * kRate);
  for (int tick = 0; tick < 2 * kRate; ++tick) {
    Block<1> same = walk.block;
    Pose pose;
    pose.local.fill(quat(0.0, 0.0, 0.0, 0.0));
    quat* local = pose.local.data();
    vec3* root = &pose.root_m;
    advance(walk.tables, same, Poses{&local, &root, 1});
    walk.step(params);
    for (int j = 0; j < walk.pose.joint_count; ++j) {
      EXPECT_NEAR(glm::length(pose.local[j]), 1.0, 1e-6) << j;
      EXPECT_EQ(pose.local[j], walk.pose.local[j]) << model.cycle.skeleton.joints[j].name;
    }
  }
  return walk.pose.local[0];
}

TEST(Joints, AreAllWritten) { last_root(adult(), {vec3(2.0, 0.0, 1.0), 0.5}); }

TEST(Joints, BetweenRootAndPelvisTurnWithTheHeading) {
  Motion m = procedural_motion();
  const int pelvis = m.pelvis;
  m.skeleton.joints.insert(m.skeleton.joints.begin(), {"Reference", -1, vec3(0.0), false});
  for (std::size_t j = 1; j < m.skeleton.joints.size(); ++j) ++m.skeleton.joints[j].parent;
  m.pelvis = pelvis + 1;
  for (LegJoints& leg : m.legs)
    for (int* joint : {&leg.hip, &leg.knee, &leg.ankle, &leg.toe, &leg.toe_end}) ++*joint;
  for (MotionFrame& frame : m.frames) {
    frame.local.insert(frame.local.begin(), rotation_y(0.7));
    frame.translation_m.clear();
    for (const Joint& joint : m.skeleton.joints) frame.translation_m.push_back(joint.offset_m);
    frame.translation_m[1] = frame.root_m;
    frame.root_m = vec3(0.0);
  }
  const WalkModel model = model_of(value_of(gait_cycle(m)));
  ASSERT_GT(model.cycle.pelvis, 0);
  const Placement placed{vec3(2.0, 0.0, 1.0), 0.5};
  const quat root = last_root(model, placed);
  // The root itself does not move in the data.
  Alone walk(model);
  place(placed, 0, walk.block);
  walk.walk(params_of(0.2, 0.8), 6 * kRate);
  const double heading_rad =
      0.5 + walk.block.origin[0].heading_rad + static_cast<double>(walk.block.state.heading_rad);
  EXPECT_LT(glm::length(turned_by(rotation_y(heading_rad) * model.cycle.local[0], root)), 1e-5);
}

}  // namespace
}  // namespace gaitpad
