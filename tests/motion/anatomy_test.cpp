#include "gaitpad/anatomy.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>

#include "files/bvh_text.h"
#include "gaitpad/motion.h"
#include "gaitpad/motion_file.h"
#include "tests/shared_data.h"

namespace gaitpad {
namespace {

std::string name_of(const Motion& m, int joint) { return m.skeleton.joints[joint].name; }

// The names of a leg's joints: hip knee ankle toe toe_end.
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
  // If the body faces the other way, its other leg is the left one.
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

// Bone names and feet without length, as in older Acclaim files.
TEST(Legs, OfAnOlderAcclaimSkeletonAreFoundThoughItsFeetHaveNoLength) {
  std::string bones, pairs = "root leftupleg rightupleg\n";
  for (const std::string side : {"left", "right"}) {
    const auto bone = [&](const std::string& name, const std::string& way, double length) {
      bones += "begin\nname " + side + name + "\ndirection " + way + "\nlength " +
               std::to_string(length) + "\naxis 0 0 0 XYZ\ndof rx\nend\n";
    };
    bone("upleg", side == "left" ? "0.2 -0.98 0" : "-0.2 -0.98 0", 7.0);
    bone("lowleg", "0 -1 0", 7.5);
    bone("foot", "0 0 1", 0.0);
    pairs += side + "upleg " + side + "lowleg\n" + side + "lowleg " + side + "foot\n";
  }
  const std::string asf =
      ":units\nlength 0.45\nangle deg\n:root\norder TX TY TZ RX RY RZ\n:bonedata\n" + bones +
      ":hierarchy\nbegin\n" + pairs + "end\n";
  const auto m = motion_from_acclaim({"old.asf", asf}, {});
  ASSERT_TRUE(m) << m.error().message;
  EXPECT_EQ(leg_text(*m, kLeftSide), "leftupleg leftlowleg leftfoot leftfoot_End leftfoot_End");
  EXPECT_EQ(leg_text(*m, kRightSide),
            "rightupleg rightlowleg rightfoot rightfoot_End rightfoot_End");
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
  // Two legs of very different length are not a pair.
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

// Without names, the shape finds the same joints.
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

// A skeleton given by name, parent and world place of each joint; the last six are the legs.
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
  std::string collar, shoulder, elbow, wrist;  // names in which "#" stands for the side
};
std::string sided(std::string name, const std::string& side) {
  const auto at = name.find('#');
  return at == std::string::npos ? name : name.replace(at, 1, side);
}

Made made(const Names& names, const std::array<std::string, 2>& sides) {
  Made m;
  const int hips = m.add("Hips", -1, {0.0, 1.0, 0.0});
  const int spine = m.add("Spine", hips, {0.0, 1.2, 0.0});
  for (int side = 0; side < 2; ++side) {
    const double x = side == 0 ? 1.0 : -1.0;
    int above = spine;
    const auto name = [&](const std::string& n) { return sided(n, sides[side]); };
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
  using Sides = std::array<std::string, 2>;
  const Sides words = {"Left", "Right"}, small = {"l", "r"}, large = {"L", "R"};
  const std::vector<std::pair<Sides, Names>> all = {
      {words, {"#Shoulder", "#Arm", "#ForeArm", "#Hand"}},
      {words, {"mixamorig:#Shoulder", "mixamorig:#Arm", "mixamorig:#ForeArm", "mixamorig:#Hand"}},
      {words, {"#Collar", "#Shoulder", "#Elbow", "#Wrist"}},
      {words, {"#Collar", "#UpArm", "#LowArm", "#Hand"}},
      {words, {"", "#Shoulder", "#Elbow", "#Hand"}},
      {small, {"#clavicle", "#humerus", "#radius", "#wrist"}},
      {small, {"#collar", "#Shldr", "#ForeArm", "#Hand"}},
      {large, {"CC_Base_#_Clavicle", "CC_Base_#_Upperarm", "CC_Base_#_Forearm", "CC_Base_#_Hand"}},
      {large, {"Clavicle_#", "UpArm_#", "LoArm_#", "Hand_#"}},
      {large, {"Bip01 # Clavicle", "Bip01 # UpperArm", "Bip01 # Forearm", "Bip01 # Hand"}},
      {large, {"shoulder.#", "upper_arm.#", "forearm.#", "hand.#"}},
      {large, {"clavicle_#", "upperarm_#", "lowerarm_#", "hand_#"}},
      {large, {"J_#_Clavicle", "J_#_Shoulder", "J_#_Elbow", "J_#_Hand"}},
  };
  for (const auto& [sides, names] : all) {
    // A copy, because clang 14 cannot capture a structured binding.
    const auto& names_of_sides = sides;
    const Made m = made(names, sides);
    const UpperBodyJoints found = m.found();
    for (int side = 0; side < 2; ++side) {
      const auto joint = [&](const std::string& n) {
        return m.skeleton.find(sided(n, names_of_sides[side]));
      };
      EXPECT_EQ(found.arm[side].shoulder, joint(names.shoulder)) << names.shoulder;
      EXPECT_EQ(found.arm[side].elbow, joint(names.elbow)) << names.elbow;
      EXPECT_EQ(found.arm[side].wrist, joint(names.wrist)) << names.wrist;
      EXPECT_EQ(found.arm[side].collar, joint(names.collar)) << names.collar;
    }
    EXPECT_EQ(found.head, m.skeleton.find("Head"));
    EXPECT_EQ(found.neck, std::vector<int>{m.skeleton.find("Neck")});
    EXPECT_EQ(found.spine, std::vector<int>{m.skeleton.find("Spine")});
  }
}

TEST(UpperBodyJoints, AreFoundByShapeWhereNamesSayNothing) {
  const Made m = made({"p#", "q#", "s#", "t#"}, {"1", "2"});
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

// Every shared motion has two arms with joints in order and a head above them.
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

TEST(UpperBodyJoints, AHandEndsInItsLongestFingerAndAHeadInItsTop) {
  const Made bare = made({"#clavicle", "#humerus", "#radius", "#wrist"}, {"l", "r"});
  EXPECT_EQ(bare.found().arm[0].hand_end, -1);
  EXPECT_EQ(bare.found().head_top, bare.found().head);
  Made body;
  const int hips = body.add("Hips", -1, {0.0, 1.0, 0.0});
  body.add_legs(hips);
  const int chest = body.add("Spine", hips, {0.0, 1.3, 0.0});
  for (const std::string side : {"l", "r"}) {
    const double x = side == "l" ? 1.0 : -1.0;
    const int shoulder = body.add(side + "humerus", chest, {0.2 * x, 1.4, 0.0});
    const int elbow = body.add(side + "radius", shoulder, {0.2 * x, 1.1, 0.0});
    const int wrist = body.add(side + "hand", elbow, {0.2 * x, 0.85, 0.0});
    body.add(side + "thumb", wrist, {0.2 * x, 0.6, 0.2});
    const int fingers = body.add(side + "fingers", wrist, {0.2 * x, 0.75, 0.0});
    body.add(side + "fingers_End", fingers, {0.2 * x, 0.7, 0.0}, true);
  }
  const int head = body.add("Head", chest, {0.0, 1.6, 0.0});
  body.add("LeftEye", head, {0.03, 1.65, 0.1});
  const int top = body.add("Head_End", head, {0.0, 1.8, 0.0}, true);
  const UpperBodyJoints found = body.found();
  EXPECT_EQ(found.arm[0].hand_end, body.skeleton.find("lfingers_End"));
  EXPECT_EQ(found.arm[1].hand_end, body.skeleton.find("rfingers_End"));
  EXPECT_EQ(found.head, head);
  EXPECT_EQ(found.head_top, top);
}

TEST(UpperBodyJoints, AJointNamedWristAboveTheHandTurnsTheForearm) {
  Made m = made({"#clavicle", "#humerus", "#radius", "#wrist"}, {"l", "r"});
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
