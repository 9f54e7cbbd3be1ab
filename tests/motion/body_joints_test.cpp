#include <gtest/gtest.h>

#include <filesystem>
#include <memory>

#include "gaitpad/anatomy.h"
#include "gaitpad/motion.h"
#include "gaitpad/motion_file.h"
#include "tests/shared_data.h"

namespace gaitpad {
namespace {

// A skeleton given as name, parent, place in the world; the legs are the last six of it.
struct Made {
  Skeleton skeleton;
  std::vector<vec3> at;
  std::array<LegJoints, 2> legs;
  int pelvis = 0;

  int add(const std::string& name, int parent, const vec3& place_m, bool is_end = false) {
    const vec3 offset = parent < 0 ? vec3(0.0) : place_m - at[parent];
    skeleton.joints.push_back({name, parent, offset, is_end});
    at.push_back(place_m);
    return static_cast<int>(at.size()) - 1;
  }
  void add_legs(int hips) {
    for (int side = 0; side < 2; ++side) {
      const double x = side == 0 ? 0.1 : -0.1;
      LegJoints& leg = legs[side];
      leg.hip = add("a", hips, {x, 0.9, 0.0});
      leg.knee = add("b", leg.hip, {x, 0.5, 0.0});
      leg.ankle = add("c", leg.knee, {x, 0.1, 0.0});
      leg.toe = leg.toe_end = add("d", leg.ankle, {x, 0.0, 0.1});
    }
  }
  UpperBodyJoints found() const { return find_upper_body(skeleton, legs, pelvis, at); }
};

struct Names {
  std::string collar, shoulder, elbow, wrist;  // of the left; "L" stands for the side
};
std::string sided(std::string name, char side) {
  for (char& c : name) c = c == '#' ? side : c;
  return name;
}
std::string sided(std::string name, const std::string& side) {
  const auto at = name.find('#');
  return at == std::string::npos ? name : name.replace(at, 1, side);
}

template <class Side>
Made made(const Names& names, const Side& left, const Side& right) {
  Made m;
  const int hips = m.add("Hips", -1, {0.0, 1.0, 0.0});
  const int spine = m.add("Spine", hips, {0.0, 1.2, 0.0});
  for (int side = 0; side < 2; ++side) {
    const double x = side == 0 ? 1.0 : -1.0;
    int above = spine;
    const auto name = [&](const std::string& n) { return sided(n, side == 0 ? left : right); };
    if (!names.collar.empty()) above = m.add(name(names.collar), spine, {0.05 * x, 1.45, 0.0});
    const int shoulder = m.add(name(names.shoulder), above, {0.2 * x, 1.45, 0.0});
    const int elbow = m.add(name(names.elbow), shoulder, {0.2 * x, 1.15, 0.0});
    m.add(name(names.wrist), elbow, {0.2 * x, 0.9, 0.0});
  }
  const int neck = m.add("Neck", spine, {0.0, 1.5, 0.0});
  m.add("Head", neck, {0.0, 1.6, 0.0});
  m.add_legs(hips);
  return m;
}

TEST(UpperBodyJoints, AreFoundByTheNamesThatSkeletonsUse) {
  const std::vector<Names> all = {
      {"#Shoulder", "#Arm", "#ForeArm", "#Hand"},
      {"mixamorig:#Shoulder", "mixamorig:#Arm", "mixamorig:#ForeArm", "mixamorig:#Hand"},
      {"#Collar", "#Shoulder", "#Elbow", "#Wrist"},
      {"#Collar", "#UpArm", "#LowArm", "#Hand"},
      {"", "#Shoulder", "#Elbow", "#Hand"},
  };
  for (const Names& names : all) {
    const Made m = made(names, std::string("Left"), std::string("Right"));
    const UpperBodyJoints found = m.found();
    for (int side = 0; side < 2; ++side) {
      const auto name = [&](const std::string& n) {
        return sided(n, side == 0 ? std::string("Left") : std::string("Right"));
      };
      EXPECT_EQ(found.arm[side].shoulder, m.skeleton.find(name(names.shoulder))) << names.shoulder;
      EXPECT_EQ(found.arm[side].elbow, m.skeleton.find(name(names.elbow)));
      EXPECT_EQ(found.arm[side].wrist, m.skeleton.find(name(names.wrist)));
      EXPECT_EQ(found.arm[side].collar, m.skeleton.find(name(names.collar)));
    }
    EXPECT_EQ(found.head, m.skeleton.find("Head"));
    EXPECT_EQ(found.neck, std::vector<int>{m.skeleton.find("Neck")});
    EXPECT_EQ(found.spine, std::vector<int>{m.skeleton.find("Spine")});
  }
}

TEST(UpperBodyJoints, AreFoundWhereTheSideIsALetter) {
  const std::vector<Names> all = {
      {"#clavicle", "#humerus", "#radius", "#wrist"},
      {"#collar", "#Shldr", "#ForeArm", "#Hand"},
      {"CC_Base_#_Clavicle", "CC_Base_#_Upperarm", "CC_Base_#_Forearm", "CC_Base_#_Hand"},
      {"Clavicle_#", "UpArm_#", "LoArm_#", "Hand_#"},
      {"Bip01 # Clavicle", "Bip01 # UpperArm", "Bip01 # Forearm", "Bip01 # Hand"},
      {"shoulder.#", "upper_arm.#", "forearm.#", "hand.#"},
      {"clavicle_#", "upperarm_#", "lowerarm_#", "hand_#"},
      {"J_#_Clavicle", "J_#_Shoulder", "J_#_Elbow", "J_#_Hand"},
  };
  for (const Names& names : all) {
    const bool is_small = names.shoulder[0] == '#';
    const char left = is_small ? 'l' : 'L', right = is_small ? 'r' : 'R';
    const Made m = made(names, left, right);
    const UpperBodyJoints found = m.found();
    EXPECT_EQ(found.arm[0].shoulder, m.skeleton.find(sided(names.shoulder, left)))
        << names.shoulder;
    EXPECT_EQ(found.arm[1].elbow, m.skeleton.find(sided(names.elbow, right))) << names.elbow;
    EXPECT_EQ(found.arm[1].wrist, m.skeleton.find(sided(names.wrist, right))) << names.wrist;
    EXPECT_EQ(found.arm[0].collar, m.skeleton.find(sided(names.collar, left))) << names.collar;
  }
}

TEST(UpperBodyJoints, AreFoundByShapeWhereNamesSayNothing) {
  const Made m = made({"p#", "q#", "s#", "t#"}, '1', '2');
  const UpperBodyJoints found = m.found();
  EXPECT_EQ(found.arm[0].shoulder, m.skeleton.find("q1"));
  EXPECT_EQ(found.arm[0].elbow, m.skeleton.find("s1"));
  EXPECT_EQ(found.arm[0].wrist, m.skeleton.find("t1"));
  EXPECT_EQ(found.arm[1].shoulder, m.skeleton.find("q2"));
}

TEST(UpperBodyJoints, OfOneThatIsOnlyLegsAreNone) {
  Made m;
  m.add("Hips", -1, {0.0, 1.0, 0.0});
  m.add_legs(0);
  const UpperBodyJoints found = m.found();
  EXPECT_FALSE(found.arm[0].is_found() || found.arm[1].is_found());
  EXPECT_TRUE(found.spine.empty());
  EXPECT_TRUE(found.neck.empty());
}

TEST(UpperBodyJoints, TwistJointsAndFingersAreNotTheArm) {
  Made m;
  const int hips = m.add("hip", -1, {0.0, 1.0, 0.0});
  const int chest = m.add("chestUpper", hips, {0.0, 1.3, 0.0});
  for (const char side : {'l', 'r'}) {
    const double x = side == 'l' ? 1.0 : -1.0;
    const auto name = [side](const std::string& n) { return side + n; };
    const int collar = m.add(name("Collar"), chest, {0.05 * x, 1.45, 0.0});
    const int bend = m.add(name("ShldrBend"), collar, {0.2 * x, 1.45, 0.0});
    const int twist = m.add(name("ShldrTwist"), bend, {0.2 * x, 1.3, 0.0});
    const int fore = m.add(name("ForearmBend"), twist, {0.2 * x, 1.15, 0.0});
    const int roll = m.add(name("ForearmTwist"), fore, {0.2 * x, 1.0, 0.0});
    const int hand = m.add(name("Hand"), roll, {0.2 * x, 0.9, 0.0});
    m.add(name("Thumb1"), hand, {0.2 * x, 0.85, 0.05});
  }
  m.add("head", chest, {0.0, 1.6, 0.0});
  m.add_legs(hips);
  const UpperBodyJoints found = m.found();
  EXPECT_EQ(found.arm[0].shoulder, m.skeleton.find("lShldrBend"));
  EXPECT_EQ(found.arm[0].elbow, m.skeleton.find("lForearmBend"));
  EXPECT_EQ(found.arm[1].wrist, m.skeleton.find("rHand"));
  EXPECT_TRUE(found.neck.empty());
}

// Every motion that there is: two arms with joints of the right order, a head above them.
TEST(UpperBodyJoints, OfRealMotionsAreArmsSpineAndHead) {
  GAITPAD_NEEDS(kCapturedMotions);
  int count = 0;
  for (const std::string& file : files_in(kCapturedMotions, ".bvh")) {
    const auto motion = load_motion(file);
    if (!motion) continue;
    const auto world = std::make_unique<JointFrames>();
    Pose pose;
    pose.joint_count = static_cast<int>(motion->skeleton.joints.size());
    const MotionFrame& frame = motion->frames[motion->frames.size() / 2];
    std::copy(frame.local.begin(), frame.local.end(), pose.local.begin());
    forward_kinematics(motion->skeleton, pose, *world);
    const UpperBodyJoints found =
        find_upper_body(motion->skeleton, motion->legs, motion->pelvis,
                  std::span(world->position_m.data(), motion->skeleton.joints.size()));
    SCOPED_TRACE(std::filesystem::path(file).filename().string());
    ++count;
    for (const ArmChain& arm : found.arm) {
      EXPECT_TRUE(arm.is_found());
      if (!arm.is_found()) continue;
      EXPECT_LT(arm.shoulder, arm.elbow);
      EXPECT_LT(arm.elbow, arm.wrist);
    }
    EXPECT_GE(found.head, 0);
    EXPECT_FALSE(found.spine.empty());
  }
  EXPECT_GT(count, 0);
}

TEST(UpperBodyJoints, AJointNamedWristAboveTheHandTurnsTheForearm) {
  Made m = made({"#clavicle", "#humerus", "#radius", "#wrist"}, 'l', 'r');
  const int wrist = m.skeleton.find("lwrist");
  Joint hand{"lhand", wrist, vec3(0.0, -0.1, 0.0), false};
  m.skeleton.joints.insert(m.skeleton.joints.begin() + wrist + 1, hand);
  m.at.insert(m.at.begin() + wrist + 1, m.at[wrist] + hand.offset_m);
  for (std::size_t j = wrist + 2; j < m.skeleton.joints.size(); ++j) {
    int& parent = m.skeleton.joints[j].parent;
    if (parent > wrist) ++parent;
  }
  for (LegJoints& leg : m.legs) {
    for (int* j : {&leg.hip, &leg.knee, &leg.ankle, &leg.toe, &leg.toe_end}) ++*j;
  }
  EXPECT_EQ(m.found().arm[0].wrist, m.skeleton.find("lhand"));
  EXPECT_EQ(m.found().arm[1].wrist, m.skeleton.find("rwrist"));
}

}  // namespace
}  // namespace gaitpad
