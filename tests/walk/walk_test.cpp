// The walk written anew, beside the old one and beside itself in other widths.
#include "walk/walk.h"

#include <gtest/gtest.h>

#include "tests/animation/made_walker.h"
#include "tests/walk/old_walk.h"

namespace gaitpad::anew {
namespace {

constexpr double kBound_deg = 0.1, kPlanted_m = 1e-5;

GaitParams params_of(double x, double y) {
  Stick stick;
  stick.left = vec2(x, y);
  return gait_params(stick, StyleValues{}, gait_limits(adult()));
}

// The old walk and the new one, from the same strike on.
class BothWalks {
 public:
  BothWalks(double x, double y)
      : params_(params_of(x, y)),
        tables_(tables_of(adult(), kDt)),
        old_(standing(adult(), vec3(0.0), old_pose)) {
    for (int tick = 0; tick < 8 * kRate || !has_just_struck(old_); ++tick) step_old();
    block_ = taken_over(old_, params_);
    pose = old_pose;
  }
  void step() {
    step_old();
    quat* local = pose.local.data();
    vec3* root = &pose.root_m;
    advance(*tables_, block_, Poses{&local, &root, 1});
  }
  void steer(double x, double y) {
    params_ = params_of(x, y);
    ask(params_, block_.state.asked);
  }
  const WalkState& old() const { return old_; }
  const Block<1>& block() const { return block_; }
  const Tables& tables() const { return *tables_; }
  Pose old_pose, pose;

 private:
  void step_old() { gaitpad::advance(adult(), params_, IkMode::robust, kDt, old_, old_pose); }
  GaitParams params_;
  std::unique_ptr<const Tables> tables_;
  WalkState old_;
  Block<1> block_;
};

double turned_deg(const quat& a, const quat& b) {
  return glm::length(rotation_vector(glm::conjugate(a) * b)) / kDegree;
}

vec3 point_of(const Pose& pose, int joint, const vec3& in_joint_m) {
  static JointFrames frames;
  forward_kinematics(adult().cycle.skeleton, pose, frames);
  return frames.position_m[joint] + frames.rotation[joint] * in_joint_m;
}

class Pace : public testing::TestWithParam<vec2> {};

TEST_P(Pace, WalksAsTheOldWalkDoes) {
  BothWalks walks(GetParam().x, GetParam().y);
  constexpr std::array<const char*, 4> kName = {"hip", "knee", "ankle", "toe"};
  std::array<double, 4> squares{}, most{};
  double upper = 0.0, root = 0.0, pelvis = 0.0, slid_m = 0.0;
  std::array<std::array<vec3, 2>, 2> anchor{};
  std::array<std::array<bool, 2>, 2> planted{};
  const int ticks = 8 * kRate;
  for (int tick = 0; tick < ticks; ++tick) {
    walks.step();
    for (const Side side : {kLeftSide, kRightSide}) {
      const LegBuild& leg = adult().leg[side];
      for (int j = 0; j < 4; ++j) {
        if (leg.joint[j].joint < 0) continue;
        const double off = turned_deg(walks.old_pose.local[leg.joint[j].joint],
                                      walks.pose.local[leg.joint[j].joint]);
        squares[j] += off * off / (2.0 * ticks);
        most[j] = std::max(most[j], off);
      }
      const std::array<bool, 2> now = {walks.old().frame.heel_planted[side],
                                       walks.old().frame.toe_planted[side]};
      for (int end : {0, 1}) {
        const vec3 place = point_of(walks.pose, leg.model.joints.ankle,
                                    glm::conjugate(leg.model.standing[2]) *
                                        (end == 0 ? leg.model.heel_m : leg.model.toe_m));
        if (now[end] && !planted[side][end]) anchor[side][end] = place;
        if (now[end]) slid_m = std::max(slid_m, glm::distance(place, anchor[side][end]));
        planted[side][end] = now[end];
      }
    }
    for (const UpperJoint& joint : walks.tables().upper)
      if (joint.joint != walks.tables().pelvis)
        upper = std::max(
            upper, turned_deg(walks.old_pose.local[joint.joint], walks.pose.local[joint.joint]));
    const int at = walks.tables().pelvis;
    pelvis = std::max(pelvis, turned_deg(walks.old_pose.local[at], walks.pose.local[at]));
    root = std::max(root, glm::distance(walks.old_pose.root_m, walks.pose.root_m));
  }
  for (int j = 0; j < 4; ++j) {
    std::printf("%s %.3f most %.3f deg; ", kName[j], std::sqrt(squares[j]), most[j]);
    if (j < 3) {
      EXPECT_LE(std::sqrt(squares[j]), kBound_deg) << kName[j];
    }
  }
  std::printf("pelvis %.3f, upper body %.3f deg; root %.3f mm; planted points move %.5f mm\n",
              pelvis, upper, root * 1e3, slid_m * 1e3);
  EXPECT_LE(slid_m, kPlanted_m);
  EXPECT_LE(upper, kBound_deg);
}
INSTANTIATE_TEST_SUITE_P(Straight, Pace,
                         testing::Values(vec2(0.0, 0.3), vec2(0.0, 0.8), vec2(0.0, 1.0)));
INSTANTIATE_TEST_SUITE_P(Backward, Pace, testing::Values(vec2(0.0, -0.5), vec2(0.0, -1.0)));
INSTANTIATE_TEST_SUITE_P(Turning, Pace, testing::Values(vec2(-0.3, 0.8), vec2(0.7, 0.7)));

// The greatest second difference of the legs' rotations, degrees a tick^2.
class Jerks {
 public:
  void add(const Pose& pose) {
    for (int side : {0, 1}) {
      for (int j = 0; j < 3; ++j) {
        std::array<quat, 3>& q = last_[side][j];
        q = {pose.local[adult().leg[side].joint[j].joint], q[0], q[1]};
        if (ticks_ < 2) continue;
        const vec3 now = rotation_vector(glm::conjugate(q[1]) * q[0]),
                   before = rotation_vector(glm::conjugate(q[2]) * q[1]);
        most_deg = std::max(most_deg, glm::length(now - before) / kDegree);
      }
    }
    ++ticks_;
  }
  double most_deg = 0.0;

 private:
  std::array<std::array<std::array<quat, 3>, 3>, 2> last_;
  int ticks_ = 0;
};

// From the one stick to the other, at ten moments of a step: no rougher than the old walk, and hips
// no lower than in the steady walks.
class Change : public testing::TestWithParam<std::array<double, 2>> {};

TEST_P(Change, LeadsOverMoreSoftlyThanTheOldWalkDoes) {
  constexpr double kMostDip_m = 0.01;
  const auto [from, to] = GetParam();
  double old_bend = 0.0, bend = 0.0, old_dip_m = 0.0, dip_m = 0.0;
  for (int wait = 0; wait < kRate; wait += kRate / 10) {
    BothWalks walks(0.0, from);
    Jerks old_jerks, jerks;
    double old_low_m = 9.0, low_m = 9.0, steady_m = 9.0;
    const int ticks = wait + 6 * kRate;
    for (int tick = 0; tick < ticks + kRate; ++tick) {
      if (tick == kRate + wait) walks.steer(0.0, to);
      walks.step();
      old_jerks.add(walks.old_pose);
      jerks.add(walks.pose);
      if (tick < kRate || tick >= ticks) steady_m = std::min(steady_m, walks.pose.root_m.y);
      old_low_m = std::min(old_low_m, walks.old_pose.root_m.y);
      low_m = std::min(low_m, walks.pose.root_m.y);
    }
    old_bend = std::max(old_bend, old_jerks.most_deg);
    bend = std::max(bend, jerks.most_deg);
    old_dip_m = std::max(old_dip_m, steady_m - old_low_m);
    dip_m = std::max(dip_m, steady_m - low_m);
  }
  std::printf("second differences %.3f, old %.3f deg/tick^2; hips %.1f, old %.1f mm lower\n", bend,
              old_bend, dip_m * 1e3, old_dip_m * 1e3);
  EXPECT_LE(bend, old_bend);
  EXPECT_LE(dip_m, kMostDip_m);
}
INSTANTIATE_TEST_SUITE_P(OfPace, Change,
                         testing::Values(std::array<double, 2>{0.3, 1.0},
                                         std::array<double, 2>{1.0, 0.3},
                                         std::array<double, 2>{0.8, 1.0}));

TEST(Stand, WaitsWhetherAFaintPushIsMeantAsLongAsTheOldWalkDoes) {
  const auto tables = tables_of(adult(), kDt);
  for (const double faint : {0.1, 0.3, 1.0}) {
    GaitParams params = params_of(0.0, 0.3);
    for (StrideParams& stride : params.stride) stride.length_m *= faint;
    Pose old_pose, pose;
    WalkState old = standing(adult(), vec3(0.0), old_pose);
    Block<1> block;
    stand(*tables, Origin{}, block);
    ask(params, block.state.asked);
    quat* local = pose.local.data();
    vec3* root = &pose.root_m;
    for (int tick = 0; tick < kRate / 2; ++tick) {
      gaitpad::advance(adult(), params, IkMode::robust, kDt, old, old_pose);
      advance(*tables, block, Poses{&local, &root, 1});
      ASSERT_EQ(block.change.stands == 0.0f, old.clock.started) << faint << " tick " << tick;
    }
  }
}

// Walks of different phases, in a block of that width and alone: the same numbers to the bit.
template <int kWidth>
void expect_same_bits() {
  BothWalks walks(0.2, 0.8);
  std::vector<Block<1>> alone;
  std::array<Pose, kWidth> pose;
  Pose one;
  Block<kWidth> block{};
  for (int w = 0; w < kWidth; ++w) {
    for (int tick = 0; tick < 11 * w + 3; ++tick) walks.step();
    alone.push_back(walks.block());
    alone.back().state.asked.length_m[0] += 0.01f * static_cast<float>(w);
    if (w % 3 == 1) alone.back().state.asked.length_m[1] *= 0.7f;
    if (w % 4 == 2) alone.back().state.asked.walks = 0.0f;
    if (w % 4 == 3) alone.back().state.asked.backward = 1.0f;
    copy_walk(alone.back(), 0, block, w);
  }
  std::array<quat*, kWidth> local;
  std::array<vec3*, kWidth> root;
  for (int w = 0; w < kWidth; ++w) local[w] = pose[w].local.data(), root[w] = &pose[w].root_m;
  for (int tick = 0; tick < 600; ++tick) {
    if (tick == 400) {  // those that have stopped start again
      block.state.asked.walks = all<Floats<kWidth>>(1.0f);
      for (Block<1>& one_walk : alone) one_walk.state.asked.walks = 1.0f;
    }
    advance(walks.tables(), block, Poses{local.data(), root.data(), kWidth});
    for (int w = 0; w < kWidth; ++w) {
      quat* to = one.local.data();
      vec3* root_m = &one.root_m;
      advance(walks.tables(), alone[w], Poses{&to, &root_m, 1});
      Block<1> lane_of;
      copy_walk(block, w, lane_of, 0);
      ASSERT_EQ(std::memcmp(&lane_of, &alone[w], kStateNumbers<float> * sizeof(float)), 0)
          << "tick " << tick << " walk " << w;
      ASSERT_EQ(one.root_m, pose[w].root_m);
      for (const LegBuild& leg : adult().leg)
        ASSERT_EQ(one.local[leg.joint[0].joint], pose[w].local[leg.joint[0].joint]);
    }
  }
}
TEST(Widths, FourWalksHaveTheBitsOfOneAlone) { expect_same_bits<4>(); }
TEST(Widths, EightWalksHaveTheBitsOfOneAlone) {
  if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "this processor has no AVX2";
  expect_same_bits<8>();
}
TEST(Widths, SixteenWalksHaveTheBitsOfOneAlone) {
  if (!__builtin_cpu_supports("avx512dq")) GTEST_SKIP() << "this processor has no AVX-512";
  expect_same_bits<16>();
}

TEST(State, OfALevelWalkFitsIn512Bytes) { EXPECT_LE(sizeof(State<float>), 512u); }

}  // namespace
}  // namespace gaitpad::anew
