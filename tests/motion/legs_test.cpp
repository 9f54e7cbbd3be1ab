#include <gtest/gtest.h>

#include "gaitpad/anatomy.h"
#include "gaitpad/motion_file.h"
#include "motion/bvh_text.h"
#include "tests/shared_data.h"

namespace gaitpad {
namespace {

std::string name_of(const Motion& m, int joint) { return m.skeleton.joints[joint].name; }

// hip knee ankle toe toe_end
std::string leg_text(const Motion& m, Side side) {
  const LegJoints& l = m.legs[side];
  return name_of(m, l.hip) + " " + name_of(m, l.knee) + " " + name_of(m, l.ankle) + " " +
         name_of(m, l.toe) + " " + name_of(m, l.toe_end);
}

TEST(LegNames, KnowTheUsualSpellings) {
  struct Case {
    const char* name;
    NamedSide side;
    NamedPart part;
  };
  constexpr auto L = NamedSide::left, R = NamedSide::right, N = NamedSide::none;
  for (const Case& c : {Case{"LeftUpLeg", L, NamedPart::hip},
                        {"mixamorig:RightLeg", R, NamedPart::knee},
                        {"Character1_LeftFoot", L, NamedPart::ankle},
                        {"CC_Base_L_ToeBase", L, NamedPart::toe},
                        {"lfemur", L, NamedPart::hip},
                        {"rtibia", R, NamedPart::knee},
                        {"rfoot", R, NamedPart::ankle},
                        {"ltoes", L, NamedPart::toe},
                        {"J_L_Bale", L, NamedPart::toe},
                        {"lThighBend", L, NamedPart::hip},
                        {"lShin", L, NamedPart::knee},
                        {"LoLeg_R", R, NamedPart::knee},
                        {"RightLowLeg", R, NamedPart::knee},
                        {"thigh.L", L, NamedPart::hip},
                        {"Bip01 R Calf", R, NamedPart::knee},
                        {"LeftUpperLeg", L, NamedPart::hip},
                        {"AnkleRight", R, NamedPart::ankle},
                        {"LHipJoint", L, NamedPart::hip},
                        {"rButtock", R, NamedPart::none},
                        {"Hips", N, NamedPart::none},
                        {"lThighTwist", N, NamedPart::none},
                        {"RL_BoneRoot", N, NamedPart::none},
                        {"LeftArm", L, NamedPart::upper_arm},
                        {"lShldr", L, NamedPart::upper_arm}}) {
    const NamedJoint n = named_joint(c.name);
    EXPECT_EQ(n.part, c.part) << c.name;
    if (c.part != NamedPart::none) {
      EXPECT_EQ(n.side, c.side) << c.name;
    }
  }
}

TEST(Legs, AreFoundByName) {
  const auto m = motion_from_bvh(WalkerText().text(), "a");
  ASSERT_TRUE(m) << m.error().message;
  EXPECT_EQ(leg_text(*m, kLeftSide), "LeftUpLeg LeftLeg LeftFoot LeftToeBase LeftToeBase_End");
  EXPECT_EQ(leg_text(*m, kRightSide),
            "RightUpLeg RightLeg RightFoot RightToeBase RightToeBase_End");
  EXPECT_EQ(name_of(*m, m->pelvis), "Hips");
}

TEST(Legs, OfUnknownNamesAreFoundByShapeAndSidesByTheToes) {
  WalkerText walker;
  walker.root = "n0";
  walker.left = "bone1";
  walker.right = "bone2";
  walker.hip = "a", walker.knee = "b", walker.ankle = "c", walker.toe = "d";
  const auto m = motion_from_bvh(walker.text(), "a");
  ASSERT_TRUE(m) << m.error().message;
  EXPECT_EQ(leg_text(*m, kLeftSide), "bone1a bone1b bone1c bone1d bone1d_End");
  // The same body facing the other way has its other leg on the left.
  const auto turned =
      motion_from_bvh(replaced(walker.text(), "OFFSET 0 -8 12", "OFFSET 0 -8 -12"), "a");
  ASSERT_TRUE(turned) << turned.error().message;
  EXPECT_EQ(leg_text(*turned, kLeftSide), "bone2a bone2b bone2c bone2d bone2d_End");
}

TEST(Legs, WithoutToeJointsEndInTheEndSite) {
  std::string text = WalkerText().text();
  text = replaced(text, "OFFSET 0 -8 12\nCHANNELS 3 Zrotation Xrotation Yrotation\n",
                  "OFFSET 0 -8 12\n");
  for (const std::string side : {"Left", "Right"}) {
    text = replaced(text, "JOINT " + side + "ToeBase\n", "End Site\n");
  }
  text = replaced(text, "OFFSET 0 -8 12\nEnd Site\n{\nOFFSET 0 0 6\n}\n", "OFFSET 0 -8 12\n");
  text = replaced(text, " 0 0 0 0 0 0\n", "\n");
  const auto m = motion_from_bvh(text, "a");
  ASSERT_TRUE(m) << m.error().message;
  EXPECT_EQ(leg_text(*m, kLeftSide), "LeftUpLeg LeftLeg LeftFoot LeftFoot_End LeftFoot_End");
}

TEST(Legs, CanBeGivenByHand) {
  LoadOptions options;
  options.legs[kLeftSide] = {"RightUpLeg", "RightLeg", "RightFoot", ""};
  options.legs[kRightSide] = {"LeftUpLeg", "LeftLeg", "LeftFoot", ""};
  const auto m = motion_from_bvh(WalkerText().text(), "a", options);
  ASSERT_TRUE(m) << m.error().message;
  EXPECT_EQ(leg_text(*m, kLeftSide), "RightUpLeg RightLeg RightFoot RightToeBase RightToeBase_End");
}

TEST(Legs, GivenByHandWrongAreOneSentence) {
  LoadOptions options;
  options.legs[kLeftSide].knee = "Elbow";
  EXPECT_EQ(motion_from_bvh(WalkerText().text(), "a.bvh", options).error().message,
            "a.bvh: no joint \"Elbow\" for the left leg");
  options.legs[kLeftSide].knee = "RightLeg";
  EXPECT_EQ(motion_from_bvh(WalkerText().text(), "a.bvh", options).error().message,
            "a.bvh: the left leg's joints are not hip, knee, ankle and toe of one chain");
}

TEST(Legs, ASkeletonWithoutTwoLegsIsRefusedWithOneSentence) {
  const std::string text =
      "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 3 Xrotation Yrotation Zrotation\nJOINT "
      "LeftLeg\n{\n"
      "OFFSET 0 -40 0\nCHANNELS 0\nEnd Site\n{\nOFFSET 0 -40 0\n}\n}\n}\n"
      "MOTION\nFrames: 1\nFrame Time: 0.01\n0 0 0\n";
  const auto m = motion_from_bvh(text, "a.bvh");
  ASSERT_FALSE(m);
  EXPECT_EQ(m.error().message,
            "a.bvh: no two legs (hip, knee, ankle and foot on two sides) in the skeleton");
  // One leg a third of the other is no pair.
  const auto odd = motion_from_bvh(
      replaced(WalkerText().text(), "RightLeg\n{\nOFFSET 0 -40 0", "RightLeg\n{\nOFFSET 0 -4 0"),
      "a.bvh");
  EXPECT_FALSE(odd);
}

struct SharedCase {
  const char* file;
  const char* pelvis;
  const char* left;
};
constexpr SharedCase kShared[] = {
    {"bvhfiles_example.bvh", "Pelvis", "J_L_Hip J_L_Knee J_L_Ankle J_L_Bale J_L_Bale_End"},
    {"bvhparser_sample.bvh", "hip", "lThigh lShin lFoot lFoot_End lFoot_End"},
    {"bvhtoolbox_walk01.bvh", "Hips", "LeftUpLeg LeftLeg LeftFoot LeftFoot_End LeftFoot_End"},
    {"cmu_007_01_iclone.bvh", "CC_Base_Pelvis",
     "CC_Base_L_Thigh CC_Base_L_Calf CC_Base_L_Foot CC_Base_L_ToeBase CC_Base_L_BigToe1_End"},
    {"cmu_12_01_walk.bvh", "Hips", "LeftUpLeg LeftLeg LeftFoot LeftToeBase LeftToeBase_End"},
    {"daz3d_170_joints.bvh", "pelvis", "lThighBend lShin lFoot lToe lBigToe_2_End"},
    {"freebvh_mixamo_names.bvh", "mixamorig:Hips",
     "mixamorig:LeftUpLeg mixamorig:LeftLeg mixamorig:LeftFoot mixamorig:LeftToeBase "
     "mixamorig:LeftToeBase_End"},
    {"geno_stance_6channels.bvh", "Hips",
     "LeftUpLeg LeftLeg LeftFoot LeftToeBase LeftToeBaseEnd_End"},
    {"makehuman_walk1.bvh", "Hips", "UpLeg_L LoLeg_L Foot_L Toe_L Toe_L_End"},
    {"mass_walk.bvh", "Character1_Hips",
     "Character1_LeftUpLeg Character1_LeftLeg Character1_LeftFoot Character1_LeftToeBase "
     "Character1_LeftToeBase_End"},
    {"mocapbank_test.bvh", "Hips", "LeftHip LeftKnee LeftAnkle LeftAnkle_End LeftAnkle_End"},
    {"sheffield_swagger.bvh", "root", "lfemur ltibia lfoot ltoes ltoes_End"},
    {"wisc_example.bvh", "Hips", "LeftUpLeg LeftLowLeg LeftFoot LeftFoot_End LeftFoot_End"}};

TEST(Legs, OfSharedFilesAreTheOnesAPersonWouldName) {
  GAITPAD_NEEDS(kCapturedMotions);
  for (const SharedCase& c : kShared) {
    const auto m = load_motion(kCapturedMotions + c.file);
    ASSERT_TRUE(m) << m.error().message;
    EXPECT_EQ(leg_text(*m, kLeftSide), c.left) << c.file;
    EXPECT_EQ(name_of(*m, m->pelvis), c.pelvis) << c.file;
  }
}

// Where names are taken away the shape finds the same joints.
TEST(Legs, OfSharedFilesAreFoundByShapeToo) {
  GAITPAD_NEEDS(kCapturedMotions);
  for (const char* file : {"bvhtoolbox_walk01.bvh", "cmu_12_01_walk.bvh", "cmu_m21_walk.bvh",
                           "dpr_walk_simple.bvh", "makehuman_walk1.bvh", "sheffield_swagger.bvh"}) {
    auto m = load_motion(kCapturedMotions + file);
    ASSERT_TRUE(m) << m.error().message;
    const auto named = m->legs;
    for (Joint& joint : m->skeleton.joints) joint.name = "x";
    const auto found = find_legs(*m);
    ASSERT_TRUE(found) << file << ": " << found.error().message;
    for (int s = 0; s < 2; ++s) {
      EXPECT_EQ((*found)[s].hip, named[s].hip) << file;
      EXPECT_EQ((*found)[s].knee, named[s].knee) << file;
      EXPECT_EQ((*found)[s].ankle, named[s].ankle) << file;
    }
  }
}

}  // namespace
}  // namespace gaitpad
