// What styles make of the walk written anew, beside the old one.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "gaitpad/config_files.h"
#include "tests/animation/made_walker.h"
#include "tests/folders.h"
#include "tests/walk/old_walk.h"

namespace gaitpad::anew {
namespace {

constexpr double kBound_deg = 0.1, kPlanted_m = 1e-5;

StyleValues shipped(const std::string& name) {
  return value_of(load_style(kSourceFolder + "/config/styles/" + name + ".toml"));
}
GaitParams params_of(double y, const StyleValues& style) {
  Stick stick;
  stick.left = vec2(0.0, y);
  return gait_params(stick, style, gait_limits(adult()));
}

// The old walk and the new one, from the same strike on.
class BothWalks {
 public:
  BothWalks(double y, const StyleValues& style, IkMode mode = IkMode::robust)
      : mode_(mode),
        params_(params_of(y, style)),
        tables_(tables_of(adult(), kDt)),
        old_(standing(adult(), vec3(0.0), old_pose)) {
    for (int tick = 0; tick < 12 * kRate || !has_just_struck(old_); ++tick) step_old();
    block_ = taken_over(old_, params_);
    take_style(old_, params_, block_);
    pose = old_pose;
    for (int k = 0; mode == IkMode::paper && k < 2; ++k) {
      const int stand = old_.clock.swing, side = k == 0 ? 1 - stand : stand;
      for (int j = 0; j < kLegAngles; ++j)
        block_.state.leg_rad[k][j] = static_cast<float>(old_.legs.angles_rad[side][j]);
    }
  }
  void step() {
    step_old();
    quat* local = pose.local.data();
    vec3* root = &pose.root_m;
    const Poses poses{&local, &root, 1};
    mode_ == IkMode::paper ? advance_by_paper(*tables_, block_, poses)
                           : advance(*tables_, block_, poses);
  }
  void ask_for(double y, const StyleValues& style) {
    params_ = params_of(y, style);
    ask(params_, block_.state.asked);
    ask_style(params_, block_);
  }
  const WalkState& old() const { return old_; }
  const Block<1>& block() const { return block_; }
  const Tables& tables() const { return *tables_; }
  Pose old_pose, pose;

 private:
  void step_old() { gaitpad::advance(adult(), params_, mode_, kDt, old_, old_pose); }
  IkMode mode_;
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

struct Differences {
  std::array<double, 4> rms_deg{}, most_deg{};  // hip, knee, ankle, toe
  double upper_deg = 0.0, root_m = 0.0, slid_m = 0.0;
  int upper_joint = 0;
};
// The planted end of each sole in the new walk: where the old one says that it stands.
Differences walk(BothWalks& walks, int ticks) {
  Differences off;
  std::array<std::array<vec3, 2>, 2> anchor{};
  std::array<std::array<bool, 2>, 2> planted{};
  for (int tick = 0; tick < ticks; ++tick) {
    walks.step();
    for (const Side side : {kLeftSide, kRightSide}) {
      const LegBuild& leg = adult().leg[side];
      for (int j = 0; j < 4; ++j) {
        const int joint = leg.joint[j].joint;
        if (joint < 0) continue;
        const double deg = turned_deg(walks.old_pose.local[joint], walks.pose.local[joint]);
        off.rms_deg[j] += deg * deg / (2.0 * ticks);
        off.most_deg[j] = std::max(off.most_deg[j], deg);
      }
      const WalkFrame& frame = walks.old().frame;
      const std::array<bool, 2> now = {frame.heel_planted[side], frame.toe_planted[side]};
      for (int end : {0, 1}) {
        const vec3 place = point_of(walks.pose, leg.model.joints.ankle,
                                    glm::conjugate(leg.model.standing[2]) *
                                        (end == 0 ? leg.model.heel_m : leg.model.toe_m));
        if (now[end] && !planted[side][end]) anchor[side][end] = place;
        if (now[end]) off.slid_m = std::max(off.slid_m, glm::distance(place, anchor[side][end]));
        planted[side][end] = now[end];
      }
    }
    for (const UpperJoint& joint : walks.tables().upper) {
      if (joint.joint == walks.tables().pelvis) continue;
      const double deg =
          turned_deg(walks.old_pose.local[joint.joint], walks.pose.local[joint.joint]);
      if (deg > off.upper_deg) off.upper_deg = deg, off.upper_joint = joint.joint;
    }
    off.root_m = std::max(off.root_m, glm::distance(walks.old_pose.root_m, walks.pose.root_m));
  }
  for (double& squares : off.rms_deg) squares = std::sqrt(squares);
  return off;
}
void print(const Differences& off) {
  constexpr std::array<const char*, 4> kName = {"hip", "knee", "ankle", "toe"};
  for (int j = 0; j < 4; ++j)
    std::printf("%s %.3f most %.3f; ", kName[j], off.rms_deg[j], off.most_deg[j]);
  std::printf("upper body %.3f deg (%s); root %.3f mm; planted points move %.5f mm\n",
              off.upper_deg, adult().cycle.skeleton.joints[off.upper_joint].name.c_str(),
              off.root_m * 1e3, off.slid_m * 1e3);
}
void expect_same_legs(const Differences& off) {
  for (int j = 0; j < 3; ++j) EXPECT_LE(off.rms_deg[j], kBound_deg);
  EXPECT_LE(off.root_m, 0.002);
  EXPECT_LE(off.slid_m, kPlanted_m);
}
void expect_same_body(const Differences& off) { EXPECT_LE(off.upper_deg, kBound_deg); }

class Weights : public testing::TestWithParam<std::pair<const char*, double>> {};

TEST_P(Weights, ShowInTheLegsAsInTheOldWalk) {
  const auto [key, weight] = GetParam();
  for (const double stick : {0.3, 0.8, 1.0}) {
    StyleValues style;
    ASSERT_TRUE(set_value(style, key, weight));
    BothWalks walks(stick, style), even(stick, {});
    const Differences off = walk(walks, 4 * kRate);
    print(off);
    expect_same_legs(off);
    double shows_deg = 0.0;
    for (int tick = 0; tick < kRate; ++tick) {
      walks.step();
      for (const Side side : {kLeftSide, kRightSide})
        for (int j = 0; j < kLegAngles; ++j)
          shows_deg = std::max(
              shows_deg,
              std::abs(static_cast<double>(walks.block().weighted.shift_rad[side][j])) / kDegree);
    }
    EXPECT_GT(shows_deg, 2.0) << "the weights do nothing";
  }
}
INSTANTIATE_TEST_SUITE_P(OfJoints, Weights,
                         testing::Values(std::pair{"legs.weight.hip", 0.2},
                                         std::pair{"legs.weight.knee", 0.2},
                                         std::pair{"legs.weight.ankle", 0.2},
                                         std::pair{"left_leg.weight.hip", 0.1},
                                         std::pair{"legs.weight.hip_y", 0.2}));

TEST(WeightsOfAStyle, BeginAndEndAsInTheOldWalk) {
  StyleValues stiff;
  ASSERT_TRUE(set_value(stiff, "legs.weight.hip", 0.2));
  for (const double stick : {0.3, 0.8}) {
    BothWalks walks(stick, {});
    for (int tick = 0; tick < 70; ++tick) walks.step();
    walks.ask_for(stick, stiff);
    const Differences begins = walk(walks, 3 * kRate);
    print(begins);
    expect_same_legs(begins);
    walks.ask_for(stick, {});
    const Differences ends = walk(walks, 3 * kRate);
    print(ends);
    expect_same_legs(ends);
    EXPECT_EQ(walks.block().weighted.acts, 0.0f) << "nothing is left of them";
  }
}

class Shipped : public testing::TestWithParam<const char*> {};

TEST_P(Shipped, StyleWalksAsInTheOldWalk) {
  for (const double stick : {0.3, 0.8, 1.0}) {
    BothWalks walks(stick, shipped(GetParam()));
    const Differences off = walk(walks, 4 * kRate);
    print(off);
    expect_same_legs(off);
    expect_same_body(off);
  }
}
INSTANTIATE_TEST_SUITE_P(Of, Shipped,
                         testing::Values("carry", "even", "heavy_slack", "limp_left",
                                         "limp_left_hip", "limp_left_knee", "look_down", "muscular",
                                         "rail_left", "stiff_arms", "stiff_hip", "stiff_knee",
                                         "tired", "tiring"),
                         [](const auto& info) { return std::string(info.param); });

TEST(Paper, WalksAsTheOldWalkInPaperModeDoes) {
  StyleValues stiff;
  ASSERT_TRUE(set_value(stiff, "legs.weight.hip", 0.2));
  for (const StyleValues& style : {StyleValues{}, stiff}) {
    for (const double stick : {0.3, 0.8, 1.0}) {
      BothWalks walks(stick, style, IkMode::paper);
      const Differences off = walk(walks, 4 * kRate);
      print(off);
      for (int j = 0; j < 3; ++j) EXPECT_LE(off.rms_deg[j], kBound_deg);
      expect_same_body(off);
    }
  }
}

// From the first tick on, beside the old walk, whose stand is the mirrored one: it counts its left
// foot as the one that landed last.
TEST(Stand, BreathesSwaysAndLooksRoundAsInTheOldWalk) {
  constexpr int kSeconds = 30;
  // The old one stands on its track: its legs are not upright, and its hips lower.
  constexpr double kSame_m = 1e-4, kHigher_m = 1e-3, kSame_deg = 0.02;
  const auto tables = tables_of(adult(), kDt);
  Pose old_pose, pose;
  WalkState old = standing(adult(), vec3(0.0), old_pose);
  pose = old_pose;
  Block<1> block;
  stand(*tables, Origin{}, block);
  Asked<float>& asked = block.state.asked;
  asked.lift[0] = asked.lift[1] = asked.bounce = asked.sway = 1.0f;
  quat* local = pose.local.data();
  vec3* root = &pose.root_m;
  double off_m = 0.0, higher_m = 0.0, off_deg = 0.0, sways_m = 0.0, turns_deg = 0.0;
  const int head = adult().body.head_path.back(), chest = tables->path.front().joint;
  for (int tick = 0; tick < kSeconds * kRate; ++tick) {
    gaitpad::advance(adult(), GaitParams{}, IkMode::robust, kDt, old, old_pose);
    advance(*tables, block, Poses{&local, &root, 1});
    if (tick == 0) continue;  // standing() has begun a tick before
    const vec3 mirrored(-old_pose.root_m.x, old_pose.root_m.y, old_pose.root_m.z);
    off_m = std::max(off_m, horizontal_length(pose.root_m - mirrored));
    higher_m = std::max(higher_m, std::abs(pose.root_m.y - mirrored.y));
    off_deg = std::max(off_deg, turned_deg(old_pose.local[chest], pose.local[chest]));
    sways_m = std::max(sways_m, std::abs(pose.root_m.x));
    turns_deg =
        std::max(turns_deg, turned_deg(adult().cycle.standing_local[head], pose.local[head]));
  }
  std::printf("off %.4f mm, %.4f mm higher, %.4f deg; sways %.1f mm, head turns %.1f deg\n",
              off_m * 1e3, higher_m * 1e3, off_deg, sways_m * 1e3, turns_deg);
  EXPECT_LE(off_m, kSame_m);
  EXPECT_LE(higher_m, kHigher_m);
  EXPECT_LE(off_deg, kSame_deg);
  EXPECT_GT(sways_m, 0.003);
  EXPECT_GT(turns_deg, 4.0);
}

StyleValues looking_at() {
  StyleValues style;
  for (const auto& [key, value] :
       {std::pair{"head.look_at", 0.9}, {"head.x_m", 2.0}, {"head.z_m", 30.0}})
    EXPECT_TRUE(set_value(style, key, value));
  return style;
}

// Walks of several styles and phases in a block, and alone: the same numbers to the bit. Some of
// them stop, start and turn on the way. `first`: the style of the first walk.
template <int kWidth>
void expect_same_bits(int first) {
  const std::array<StyleValues, 9> styles = {
      StyleValues{},       shipped("limp_left_hip"), shipped("heavy_slack"),
      shipped("tired"),    shipped("carry"),         shipped("rail_left"),
      shipped("muscular"), shipped("stiff_arms"),    looking_at()};
  const auto style_at = [&](int w) { return (first + w) % static_cast<int>(styles.size()); };
  std::vector<std::unique_ptr<BothWalks>> walks;
  for (const StyleValues& style : styles) walks.push_back(std::make_unique<BothWalks>(0.8, style));
  std::vector<Block<1>> alone;
  std::array<Pose, kWidth> pose;
  Pose one;
  Block<kWidth> block{};
  for (int w = 0; w < kWidth; ++w) {
    BothWalks& of_style = *walks[style_at(w)];
    for (int tick = 0; tick < 31 * w + 3; ++tick) of_style.step();
    alone.push_back(of_style.block());
    if (w % 4 == 0) alone.back().state.asked.length_m[1] *= 0.6f;
    copy_walk(alone.back(), 0, block, w);
    pose[w] = of_style.pose;
  }
  std::array<quat*, kWidth> local;
  std::array<vec3*, kWidth> root;
  for (int w = 0; w < kWidth; ++w) local[w] = pose[w].local.data(), root[w] = &pose[w].root_m;
  for (int tick = 0; tick < 600; ++tick) {
    if (tick == 300 || tick == 450) {  // a walk that had no weights gets some, then all have none
      const auto style_of = [&](int w) {
        return tick == 450 ? StyleValues{} : shipped(w == 0 ? "stiff_hip" : "stiff_knee");
      };
      for (int w = 0; w < kWidth; ++w) {
        Block<1> lane_of;
        copy_walk(block, w, lane_of, 0);
        ask_style(params_of(0.8, style_of(w)), lane_of);
        ask_style(params_of(0.8, style_of(w)), alone[w]);
        copy_walk(lane_of, 0, block, w);
      }
    }
    for (int w = 1; tick % 100 == 50 && w < kWidth; w += 2) {
      const auto steer = [&](Asked<float>& asked) {
        asked.walks = tick % 300 == 50 ? 0.0f : 1.0f;
        asked.turn_rad_s = tick % 200 == 50 ? 0.3f : 0.0f;
      };
      Block<1> lane_of;
      copy_walk(block, w, lane_of, 0);
      steer(lane_of.state.asked), steer(alone[w].state.asked);
      copy_walk(lane_of, 0, block, w);
    }
    advance(walks[0]->tables(), block, Poses{local.data(), root.data(), kWidth});
    for (int w = 0; w < kWidth; ++w) {
      quat* to = one.local.data();
      vec3* root_m = &one.root_m;
      advance(walks[0]->tables(), alone[w], Poses{&to, &root_m, 1});
      Block<1> lane_of;
      copy_walk(block, w, lane_of, 0);
      ASSERT_EQ(std::memcmp(&lane_of, &alone[w], kStateNumbers<float> * sizeof(float)), 0)
          << "tick " << tick << " walk " << w;
      ASSERT_EQ(one.root_m, pose[w].root_m);
      for (int j = 0; j < walks[0]->tables().joints; ++j)
        ASSERT_EQ(one.local[j], pose[w].local[j]) << j;
    }
  }
}
TEST(Styles, FourWalksHaveTheBitsOfOneAlone) {
  for (const int first : {0, 4, 7}) expect_same_bits<4>(first);
}
TEST(Styles, EightWalksHaveTheBitsOfOneAlone) {
  if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "this processor has no AVX2";
  for (const int first : {0, 5}) expect_same_bits<8>(first);
}
TEST(Styles, SixteenWalksHaveTheBitsOfOneAlone) {
  if (!__builtin_cpu_supports("avx512dq")) GTEST_SKIP() << "this processor has no AVX-512";
  expect_same_bits<16>(0);
}

}  // namespace
}  // namespace gaitpad::anew
