#include "motion/body_joints.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>

#include "motion/arm_names.h"
#include "motion/gait_cycle.h"
#include "motion/load.h"
#include "motion/tracks.h"

namespace gaitpad {
namespace {

TEST(ArmNames, AreUnderstoodInEveryHouseStyle) {
  const auto is = [](const char* name, NamedSide side, ArmPart part) {
    const NamedArm arm = named_arm(name);
    EXPECT_TRUE(arm.side == side && arm.part == part) << name;
  };
  constexpr NamedSide kL = NamedSide::left, kR = NamedSide::right;
  is("mixamorig:LeftArm", kL, ArmPart::upper_arm);
  is("mixamorig:LeftForeArm", kL, ArmPart::forearm);
  is("RightHand", kR, ArmPart::hand);
  is("lhumerus", kL, ArmPart::upper_arm);
  is("rradius", kR, ArmPart::forearm);
  is("rwrist", kR, ArmPart::wrist);
  is("lclavicle", kL, ArmPart::clavicle);
  is("lshoulderjoint", kL, ArmPart::shoulder);
  is("rShldrBend", kR, ArmPart::shoulder);
  is("lForearmBend", kL, ArmPart::forearm);
  is("UpArm_L", kL, ArmPart::upper_arm);
  is("LoArm_R", kR, ArmPart::forearm);
  is("UpperArm_L", kL, ArmPart::upper_arm);
  is("LeftLowArm", kL, ArmPart::forearm);
  is("LeftCollar", kL, ArmPart::clavicle);
  is("LeftElbowJoint", kL, ArmPart::forearm);
  is("CC_Base_R_Clavicle", kR, ArmPart::clavicle);
  is("J_L_Elbow", kL, ArmPart::forearm);
  for (const char* none :
       {"LeftForearmTwistJoint", "CC_Base_L_UpperarmTwist01", "LeftHandThumb1", "LeftFingerBase",
        "L_Humerus_RIGMESH", "LeftUpLeg", "Spine", "lCarpal1"}) {
    EXPECT_TRUE(named_arm(none).part == ArmPart::none) << none;
  }
  EXPECT_TRUE(is_head_name("mixamorig:Head"));
  EXPECT_FALSE(is_head_name("HeadTop_End"));
}

BodyJoints joints_of(const Motion& m) {
  const auto world = std::make_unique<JointFrames>();
  forward_kinematics(m, m.frames.back(), *world);
  const auto& place = world->position_m;
  const vec3 across = place[m.legs[0].hip] - place[m.legs[1].hip];
  const quat ahead = rotation_y(-heading_of(glm::cross(across, kUp)));
  std::vector<vec3> at;
  for (std::size_t j = 0; j < m.skeleton.joints.size(); ++j) at.push_back(ahead * place[j]);
  return body_joints(m.skeleton, m.pelvis, {m.legs[0].hip, m.legs[1].hip}, at);
}

std::vector<int> all_of(const BodyJoints& b) {
  std::vector<int> all = b.spine;
  all.insert(all.end(), b.neck.begin(), b.neck.end());
  for (const ArmJoints& a : b.arm)
    all.insert(all.end(), {a.clavicle, a.shoulder, a.elbow, a.wrist});
  return all;
}

TEST(BodyJoints, WithoutNamesTheShapeSaysTheSame) {
  Motion m = procedural_motion();
  const BodyJoints named = joints_of(m);
  EXPECT_EQ(m.skeleton.joints[named.spine.back()].name, "Chest");
  EXPECT_EQ(m.skeleton.joints[named.neck.back()].name, "Head");
  EXPECT_EQ(m.skeleton.joints[named.arm[kRightSide].elbow].name, "RightForeArm");
  EXPECT_EQ(m.skeleton.joints[named.arm[kRightSide].clavicle].name, "RightShoulder");
  for (Joint& joint : m.skeleton.joints) joint.name = "bone";
  EXPECT_EQ(all_of(joints_of(m)), all_of(named));
}

TEST(BodyJoints, ABodyWithoutArmsOrHeadIsNoError) {
  Motion m = procedural_motion();
  auto& joints = m.skeleton.joints;
  joints.resize(static_cast<std::size_t>(m.skeleton.find("Spine")));  // two legs on the hips
  for (MotionFrame& frame : m.frames) frame.local.resize(joints.size());
  const BodyJoints none = joints_of(m);
  EXPECT_FALSE(none.has_arms());
  EXPECT_TRUE(none.spine.empty() && none.neck.empty());
}

TEST(BodyJoints, AreFoundInTheSharedSkeletons) {
  const std::string folder = std::string(GAITPAD_SHARED_DATA) + "/mocap/";
  if (!std::filesystem::is_directory(folder))
    GTEST_SKIP() << "no shared data beside the repository";
  const std::pair<const char*, std::array<std::string, 6>> kKnown[] = {
      {"cmu_07_01.amc", {"thorax", "head", "lclavicle", "lhumerus", "lradius", "lhand"}},
      {"endorphin_walking.amc",
       {"UpperSpineJoint", "UpperNeckJoint", "LeftClavicleJoint", "LeftShoulderJoint",
        "LeftElbowJoint", "LeftWristJoint"}},
      {"makehuman_walk1.bvh", {"Spine3", "Head", "Clavicle_L", "UpArm_L", "LoArm_L", "Hand_L"}},
      {"daz3d_170_joints.bvh",
       {"chestUpper", "head", "lCollar", "lShldrBend", "lForearmBend", "lHand"}},
      {"bvhfiles_example.bvh",
       {"J_T1", "J_Atlas", "J_L_Clavicle", "J_L_Shoulder", "J_L_Elbow", "J_L_Hand"}},
      {"mocapbank_test.bvh",
       {"Chest2", "Head", "LeftCollar", "LeftShoulder", "LeftElbow", "LeftWrist"}},
      {"cmu_006_01_iclone.bvh",
       {"CC_Base_Spine02", "CC_Base_Head", "CC_Base_L_Clavicle", "CC_Base_L_Upperarm",
        "CC_Base_L_Forearm", "CC_Base_L_Hand"}},
      {"sheffield_swagger.bvh",
       {"upperback", "head", "lshoulderjoint", "lhumerus", "lradius", "lhand"}},
      {"cmu_m21_walk.bvh",
       {"Spine1", "Head", "LeftShoulder", "LeftArm", "LeftForeArm", "LeftHand"}},
      {"bvhparser_sample.bvh", {"chest", "head", "lCollar", "lShldr", "lForeArm", "lHand"}},
  };
  for (const auto& [file, names] : kKnown) {
    const auto m = load_motion(folder + file);
    ASSERT_TRUE(m) << m.error().message;
    const BodyJoints b = joints_of(*m);
    ASSERT_TRUE(b.has_arms() && !b.spine.empty() && !b.neck.empty()) << file;
    const ArmJoints& l = b.arm[kLeftSide];
    const std::array<int, 6> found = {b.spine.back(), b.neck.back(), l.clavicle,
                                      l.shoulder,     l.elbow,       l.wrist};
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(m->skeleton.joints[static_cast<std::size_t>(found[i])].name, names[i]) << file;
    }
  }
}

}  // namespace
}  // namespace gaitpad
