// Every shared motion loads, and walks or gives the known reason; a motion in two formats gives the
// same poses.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <memory>

#include "gaitpad/gait_cycle.h"
#include "gaitpad/motion.h"
#include "gaitpad/motion_file.h"
#include "tests/shared_data.h"

namespace gaitpad {
namespace {
namespace fs = std::filesystem;

class SharedMotions : public testing::Test {
 protected:
  void SetUp() override { GAITPAD_NEEDS(kCapturedMotions); }
};

// The reason why a file is not a walk, by the data's index. All others walk.
const std::map<std::string, std::string> kNoWalks = {
    // Files of kicks, jumps and runs.
    {"cmu_002_03_iclone.bvh", "both feet are in the air for 0.14 s before a strike, it is a run"},
    {"cmu_01_01.amc", "holds no walk: both feet leave the floor, it is a run"},
    {"cmu_01_01.bvh", "holds no walk: both feet leave the floor, it is a run"},
    {"cmu_11_01.amc", "holds no walk whose events are in order: the left toe leaves"},
    {"cmu_11_01_motionbuilder.bvh", "holds no walk: both feet leave the floor, it is a run"},
    {"mass_run.bvh", "the hips go 2.92 m in 0.55 s, it is a run"},
    // Files of single poses.
    {"skeleton.asf", "has fewer than 6 frames"},
    {"daz3d_170_joints.bvh", "has fewer than 6 frames"},
    {"geno_bind_6channels.bvh", "has fewer than 6 frames"},
    {"geno_stance_6channels.bvh", "has fewer than 6 frames"},
    {"wisc_example.bvh", "has fewer than 6 frames"},
    // on the spot, or no stride long
    {"bvhfiles_example.bvh", "holds no full walking stride of both feet: the hips go"},
    {"cmu_m21_old1.bvh", "holds no full walking stride of both feet: the hips go"},
    {"cmu_m21_strutting1.bvh", "holds no walk: both feet leave the floor, it is a run"},
    {"makehuman_walk1.bvh", "walks on the spot: the hips go"},
    {"mocapbank_test.bvh", "holds no full walking stride of both feet: the hips go"},
    {"mocapbank_test_crlf.bvh", "holds no full walking stride of both feet: the hips go"},
    {"pybvh_example.bvh", "walks on the spot: the hips go"},
    {"pybvh_test2.bvh", "holds no full walking stride of both feet: the hips go"},
};

TEST_F(SharedMotions, AllLoadAndWalkOrSayWhyNot) {
  int files = 0;
  for (const auto& entry : fs::directory_iterator(kCapturedMotions)) {
    const std::string name = entry.path().filename().string();
    const auto motion = load_motion(entry.path().string());
    ASSERT_TRUE(motion) << motion.error().message;
    const double leg_m = leg_length_m(*motion);
    EXPECT_TRUE(leg_m > 0.65 && leg_m < 1.05) << name << ": " << leg_m << " m of leg";
    const auto cycle = gait_cycle(*motion);
    // An .asf file alone is a skeleton: one frame.
    const bool is_skeleton = entry.path().extension() == ".asf";
    const auto known = kNoWalks.find(is_skeleton ? "skeleton.asf" : name);
    const std::string reason = cycle ? "" : cycle.error().message;
    if (!cycle) fmt::print("{}\n", reason);
    EXPECT_EQ(known == kNoWalks.end(), bool(cycle)) << name << " " << reason;
    if (known != kNoWalks.end()) {
      EXPECT_NE(reason.find(known->second), std::string::npos) << reason;
    }
    ++files;
  }
  EXPECT_GE(files, 50);
}

struct Pair {
  Motion amc, bvh;
};
Pair loaded(const std::string& amc, const std::string& bvh) {
  const auto a = load_motion(kCapturedMotions + amc), b = load_motion(kCapturedMotions + bvh);
  EXPECT_TRUE(a && b);
  return {*a, *b};
}

std::array<int, 8> leg_joints(const Motion& m) {
  const auto& [l, r] = m.legs;
  return {l.hip, l.knee, l.ankle, l.toe, r.hip, r.knee, r.ankle, r.toe};
}

// Frame k of the AMC file, counted from 1, is frame k of the BVH counted from 0, whose frame 0 is a
// T pose.
TEST_F(SharedMotions, TheSameMotionInBothFormatsPutsTheLegsWithinAMillimetre) {
  const Pair pair = loaded("cmu_01_01.amc", "cmu_01_01.bvh");
  const auto from = leg_joints(pair.amc), to = leg_joints(pair.bvh);
  const auto a = joint_tracks_m(pair.amc, from), b = joint_tracks_m(pair.bvh, to);
  ASSERT_EQ(a[0].size() + 1, b[0].size());
  double worst_m = 0.0;
  for (std::size_t j = 0; j < a.size(); ++j) {
    for (std::size_t f = 0; f < a[j].size(); ++f) {
      worst_m = std::max(worst_m, glm::distance(a[j][f], b[j][f + 1]));
    }
  }
  fmt::print("cmu_01_01: legs' joints differ by {:.4f} mm at most\n", 1e3 * worst_m);
  EXPECT_LT(worst_m, 1e-3);
}

TEST_F(SharedMotions, ASubjectsSkeletonHasTheBonesOfItsConvertedMotion) {
  const Pair pair = loaded("cmu_12.asf", "cmu_12_01_walk.bvh");
  const auto from = leg_joints(pair.amc), to = leg_joints(pair.bvh);
  const auto a = joint_tracks_m(pair.amc, from), b = joint_tracks_m(pair.bvh, to);
  for (const std::size_t j : {0u, 1u, 2u, 4u, 5u, 6u}) {
    const double bone_m = glm::distance(a[j][0], a[j + 1][0]);
    EXPECT_NEAR(bone_m, glm::distance(b[j].back(), b[j + 1].back()), 1e-3) << j;
  }
}

}  // namespace
}  // namespace gaitpad
