// The procedural walk on other skeletons: larger ones, ones that only stand, ones in a T pose.
#include <gtest/gtest.h>

#include <map>

#include "files/bvh_text.h"
#include "gaitpad/gait_cycle.h"
#include "gaitpad/motion_file.h"
#include "motion/leg_pose.h"
#include "motion/made_motion.h"
#include "tests/shared_data.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

// A body with one frame, in which it stands still.
Motion standing_body(const GaitCycle& cycle) {
  Motion m = procedural_motion();
  m.name = "still.bvh";
  m.frames.resize(1);
  m.frames[0].local = cycle.standing_local;
  m.frames[0].root_m = vec3(0.3, cycle.leg[0].length_m() - cycle.leg[0].heel_m.y, -2.0);
  m.frames[0].root_m.y -= cycle.leg[0].hip_m.y;
  return m;
}

Motion grown(Motion m, double factor) {
  for (Joint& joint : m.skeleton.joints) joint.offset_m *= factor;
  for (MotionFrame& frame : m.frames) frame.root_m *= factor;
  return m;
}

// Height of the toe end above the floor: a bare skeleton's lowest joint counts as the sole, but the
// procedural toe end rests above the floor.
vec3 flesh(const GaitCycle& source) { return source.leg[0].toe_end_rest_m * kUp; }

// World rotations of all joints in sample i of a cycle.
std::vector<quat> sample_rotations(const GaitCycle& c, int i) {
  const std::size_t joints = c.skeleton.joints.size();
  return world_rotations(c.skeleton, std::span(c.local).subspan(i * joints, joints));
}

TEST(CycleOnSkeleton, OnItsOwnSkeletonIsTheSameWalk) {
  const GaitCycle source = procedural_gait();
  const auto same = cycle_on_skeleton(source, standing_body(source));
  ASSERT_TRUE(same);
  EXPECT_DOUBLE_EQ(same->stride_m, source.stride_m);
  for (int i = 0; i < kCycleSamples; ++i) {
    EXPECT_LT(glm::distance(same->samples[i].pelvis_m + flesh(source), source.samples[i].pelvis_m),
              1e-9);
    for (int side = 0; side < 2; ++side) {
      const LegPose a = pose_of(*same, same->samples[i], side),
                    b = pose_of(source, source.samples[i], side);
      EXPECT_LT(glm::distance(a.ankle_m + flesh(source), b.ankle_m), 1e-9);
      EXPECT_LT(glm::distance(a.toe_m + flesh(source), b.toe_m), 1e-9);
    }
  }
  for (std::size_t k = 0; k < source.local.size(); ++k) {
    EXPECT_GT(std::abs(glm::dot(same->local[k], source.local[k])), 1.0 - 1e-9) << k;
  }
}

TEST(CycleOnSkeleton, HipsAndHeelsRunAsManyTimesLargerAsTheLegs) {
  const GaitCycle source = procedural_gait();
  const auto large = cycle_on_skeleton(source, grown(standing_body(source), 1.7));
  ASSERT_TRUE(large);
  EXPECT_NEAR(mean_leg_m(*large), 1.7 * mean_leg_m(source), 1e-12);
  EXPECT_NEAR(large->stride_m, 1.7 * source.stride_m, 1e-12);
  EXPECT_NEAR(large->duration_s, std::sqrt(std::sqrt(1.7)) * source.duration_s, 1e-12);
  for (int i = 0; i < kCycleSamples; i += 8) {
    const CycleSample &to = large->samples[i], &from = source.samples[i];
    EXPECT_LT(glm::distance(to.pelvis_m, 1.7 * (from.pelvis_m - flesh(source))), 1e-9);
    const vec3 to_heel = to.leg[0].ankle_m + to.leg[0].foot * large->leg[0].heel_m;
    const vec3 from_heel = from.leg[0].ankle_m + from.leg[0].foot * source.leg[0].heel_m;
    EXPECT_LT(glm::distance(to_heel, 1.7 * from_heel), 1e-9);
  }
}

TEST(CycleOnSkeleton, TheHeadingOfTheFileDoesNotMatter) {
  const GaitCycle source = procedural_gait();
  Motion turned = standing_body(source);
  turned.frames[0].local[0] = rotation_y(2.0) * turned.frames[0].local[0];
  const auto cycle = cycle_on_skeleton(source, turned);
  ASSERT_TRUE(cycle);
  for (int side = 0; side < 2; ++side) {
    EXPECT_LT(glm::distance(cycle->leg[side].toe_m, source.leg[side].toe_m), 1e-9);
    EXPECT_LT(glm::distance(cycle->leg[side].hip_m, source.leg[side].hip_m), 1e-9);
  }
}

// A bone's direction at sample i of a cycle, by the joints' names.
vec3 bone(const GaitCycle& c, int i, const std::string& from, const std::string& to) {
  const auto world = sample_rotations(c, i);
  vec3 v(0.0);
  for (int j = c.skeleton.find(to); j != c.skeleton.find(from); j = c.skeleton.joints[j].parent) {
    v += world[c.skeleton.joints[j].parent] * c.skeleton.joints[j].offset_m;
  }
  return glm::normalize(v);
}

// A joint's world rotation relative to the standing pose.
quat turn_of(const GaitCycle& c, int i, const std::string& name) {
  const auto joint = static_cast<std::size_t>(c.skeleton.find(name));
  const auto now = sample_rotations(c, i);
  return now[joint] * glm::conjugate(world_rotations(c.skeleton, c.standing_local)[joint]);
}

double angle_between_deg(const quat& a, const quat& b) {
  return glm::length(rotation_vector(glm::conjugate(a) * b)) / kDegree;
}

GaitCycle on_skeleton(const GaitCycle& source, const Motion& body) {
  return value_of(cycle_on_skeleton(source, body));
}

// Pairs of a name in the procedural skeleton and in the other one.
using Names = std::vector<std::pair<std::string, std::string>>;
const Names kArmsAndLegs = {{"LeftUpLeg", "LeftLeg"},
                            {"LeftShoulder", "LeftArm"},
                            {"LeftArm", "LeftForeArm"},
                            {"LeftForeArm", "LeftHand"},
                            {"RightArm", "RightForeArm"},
                            {"Spine", "Chest"},
                            {"Neck", "Head"}};

// Raises the arms: 0 degrees are hanging arms, 90 a T pose.
Motion with_arms_raised(Motion body, double degrees) {
  auto& local = body.frames[0].local;
  local[body.skeleton.find("LeftArm")] = rotation_z(degrees * kDegree);
  local[body.skeleton.find("RightArm")] = rotation_z(-degrees * kDegree);
  local[body.skeleton.find("LeftShoulder")] = rotation_z(0.1 * degrees * kDegree);
  return body;
}

TEST(CycleOnSkeleton, TPoseAndAPoseOfOneBodyWalkAlike) {
  const GaitCycle source = procedural_gait();
  const GaitCycle t = on_skeleton(source, with_arms_raised(standing_body(source), 90.0));
  const GaitCycle a = on_skeleton(source, with_arms_raised(standing_body(source), 40.0));
  for (int i = 0; i < kCycleSamples; i += 5) {
    for (const auto& [from, to] : kArmsAndLegs) {
      EXPECT_LT(glm::distance(bone(t, i, from, to), bone(a, i, from, to)), 1e-9) << from;
      EXPECT_LT(glm::distance(bone(t, i, from, to), bone(source, i, from, to)), 1e-9) << from;
    }
  }
}

Motion renamed(Motion body, const Names& names) {
  for (const auto& [from, to] : names) body.skeleton.joints[body.skeleton.find(from)].name = to;
  return body;
}

TEST(CycleOnSkeleton, ArmsOfOtherNamesTurnAsInTheSource) {
  const GaitCycle source = procedural_gait();
  const Names kOthers[] = {
      {{"LeftShoulder", "lclavicle"},
       {"LeftArm", "lhumerus"},
       {"LeftForeArm", "lradius"},
       {"LeftHand", "lhand"},
       {"RightShoulder", "rclavicle"},
       {"RightArm", "rhumerus"},
       {"RightForeArm", "rradius"},
       {"RightHand", "rhand"},
       {"Spine", "lowerback"},
       {"Chest", "thorax"},
       {"Neck", "lowerneck"},
       {"Head", "head"}},
      {{"LeftShoulder", "a"},
       {"LeftArm", "b"},
       {"LeftForeArm", "c"},
       {"LeftHand", "d"},
       {"RightShoulder", "e"},
       {"RightArm", "f"},
       {"RightForeArm", "g"},
       {"RightHand", "h"},
       {"Spine", "i"},
       {"Chest", "j"},
       {"Neck", "k"},
       {"Head", "l"}},
  };
  for (const Names& names : kOthers) {
    const Motion body = renamed(with_arms_raised(standing_body(source), 90.0), names);
    const GaitCycle cycle = on_skeleton(source, body);
    const auto other = [&names](const std::string& name) {
      for (const auto& [from, to] : names) {
        if (from == name) return to;
      }
      return name;
    };
    for (int i = 0; i < kCycleSamples; i += 9) {
      for (const auto& [from, to] : kArmsAndLegs) {
        // A raised collar bone of the other body stays raised.
        if (from == "LeftShoulder") continue;
        EXPECT_LT(glm::distance(bone(cycle, i, other(from), other(to)), bone(source, i, from, to)),
                  1e-9)
            << other(from);
      }
      EXPECT_LT(angle_between_deg(turn_of(cycle, i, other("Head")), turn_of(source, i, "Head")),
                1e-6);
    }
  }
}

// Inserts a joint at `share` of the way from the parent of `name` to it.
Motion with_joint_before(Motion body, const std::string& name, const std::string& added,
                         double share) {
  auto& joints = body.skeleton.joints;
  const int at = body.skeleton.find(name);
  Joint joint{added, joints[at].parent, share * joints[at].offset_m, false};
  joints[at].offset_m *= 1.0 - share;
  joints.insert(joints.begin() + at, joint);
  for (std::size_t j = at + 1; j < joints.size(); ++j) {
    if (joints[j].parent >= at) ++joints[j].parent;
  }
  joints[at + 1].parent = at;
  for (MotionFrame& frame : body.frames) frame.local.insert(frame.local.begin() + at, kIdentity);
  for (LegJoints& leg : body.legs) {
    for (int* j : {&leg.hip, &leg.knee, &leg.ankle, &leg.toe, &leg.toe_end}) *j += *j >= at;
  }
  return body;
}

TEST(CycleOnSkeleton, ExtraTwistJointsRestAndChangeNothing) {
  const GaitCycle source = procedural_gait();
  Motion body = with_arms_raised(standing_body(source), 90.0);
  const GaitCycle plain = on_skeleton(source, body);
  body = with_joint_before(body, "LeftForeArm", "LeftArmTwist", 0.5);
  body = with_joint_before(body, "RightHand", "RightForeArmTwist", 0.3);
  body = with_joint_before(body, "LeftLeg", "LeftUpLegTwist", 0.5);
  const GaitCycle twisted = on_skeleton(source, body);
  const int twist = twisted.skeleton.find("LeftArmTwist");
  for (int i = 0; i < kCycleSamples; i += 7) {
    for (const auto& [from, to] : kArmsAndLegs) {
      EXPECT_LT(glm::distance(bone(twisted, i, from, to), bone(plain, i, from, to)), 1e-9) << from;
    }
    const quat rest = twisted.local[i * twisted.skeleton.joints.size() + twist];
    EXPECT_GT(std::abs(rest.w), 1.0 - 1e-12);
  }
}

TEST(CycleOnSkeleton, ChestAndHeadTurnAsTheSourcesOnBacksOfAnyNumberOfJoints) {
  const GaitCycle source = procedural_gait();
  Motion more = with_joint_before(standing_body(source), "Chest", "Spine1", 0.5);
  more = with_joint_before(with_joint_before(more, "Chest", "Spine2", 0.5), "Head", "Neck1", 0.5);
  const GaitCycle longer = on_skeleton(source, more);
  const GaitCycle shorter = on_skeleton(longer, standing_body(source));
  for (int i = 0; i < kCycleSamples; i += 7) {
    for (const char* joint : {"Chest", "Head"}) {
      EXPECT_LT(angle_between_deg(turn_of(longer, i, joint), turn_of(source, i, joint)), 1e-6);
      EXPECT_LT(angle_between_deg(turn_of(shorter, i, joint), turn_of(source, i, joint)), 1e-6);
    }
    const double whole = angle_between_deg(turn_of(longer, i, "Hips"), turn_of(longer, i, "Chest"));
    const double half = angle_between_deg(turn_of(longer, i, "Hips"), turn_of(longer, i, "Spine1"));
    EXPECT_NEAR(half, 0.5 * whole, 0.05 * whole + 1e-6) << "spread along the back";
  }
}

TEST(CycleOnSkeleton, MissingToesAreNoHindrance) {
  const GaitCycle source = procedural_gait();
  Motion toeless = standing_body(source);
  for (LegJoints& leg : toeless.legs) {
    toeless.skeleton.joints[leg.toe].is_end_site = true;
    toeless.skeleton.joints[leg.toe_end].offset_m = vec3(0.0);
    leg.toe_end = leg.toe;
  }
  const GaitCycle without = on_skeleton(source, toeless);
  const GaitCycle with = on_skeleton(without, standing_body(source));
  for (int i = 0; i < kCycleSamples; i += 4) {
    for (int side = 0; side < 2; ++side) {
      const LegPose a = pose_of(source, source.samples[i], side),
                    b = pose_of(without, without.samples[i], side);
      const LegPose c = pose_of(with, with.samples[i], side);
      EXPECT_LT(glm::distance(a.ankle_m, b.ankle_m), 0.025) << "within the flesh below the toe";
      EXPECT_LT(angle_between_deg(a.foot, c.foot), 5.0);
    }
  }
}

TEST(CycleOnSkeleton, ABodyOfLegsAloneWalks) {
  const auto walker = motion_from_bvh(WalkerText().text(), "walker.bvh");
  ASSERT_TRUE(walker);
  const auto cycle = cycle_on_skeleton(procedural_gait(), *walker);
  ASSERT_TRUE(cycle);
  EXPECT_EQ(cycle->skeleton.joints[0].name, "Hips");
  EXPECT_NEAR(cycle->leg[0].thigh_m, 40 * walker->metres_per_unit, 1e-12);
  EXPECT_NEAR(cycle->leg[0].heel_m.y, -8 * walker->metres_per_unit, 1e-12) << "toes on the floor";
}

TEST(CycleOnSkeleton, AFootThatIsNowhereFlatStillPointsForward) {
  std::string text = WalkerText().text();
  text = replaced(text, "OFFSET 0 -8 12\n", "OFFSET 0 -8 -12\n");
  const auto walker = motion_from_bvh(text, "backward.bvh");
  ASSERT_TRUE(walker);
  const auto cycle = cycle_on_skeleton(procedural_gait(), *walker);
  ASSERT_TRUE(cycle);
  for (const LegModel& leg : cycle->leg) EXPECT_GT(leg.toe_m.z, 0.05);
}

// Walks of six sources on each other's skeletons.
TEST(CycleOnSkeleton, SharedBodiesTakeTheWalksOfOneAnother) {
  GAITPAD_NEEDS(kCapturedMotions);
  struct Body {
    const char* file;
    std::string chest, head, arm, elbow, hand;
  };
  const Body kBodies[] = {
      {"cmu_07_01.amc", "thorax", "head", "lhumerus", "lradius", "lhand"},
      {"endorphin_walking.amc", "UpperSpineJoint", "UpperNeckJoint", "LeftShoulderJoint",
       "LeftElbowJoint", "LeftWristJoint"},
      {"freebvh_mixamo_names.bvh", "mixamorig:Spine2", "mixamorig:Head", "mixamorig:LeftArm",
       "mixamorig:LeftForeArm", "mixamorig:LeftHand"},
      {"cmu_006_01_iclone.bvh", "CC_Base_Spine02", "CC_Base_Head", "CC_Base_L_Upperarm",
       "CC_Base_L_Forearm", "CC_Base_L_Hand"},
      {"bvhparser_sample.bvh", "chest", "head", "lShldr", "lForeArm", "lHand"},
      {"cmu_m21_walk.bvh", "Spine1", "Head", "LeftArm", "LeftForeArm", "LeftHand"},
  };
  std::map<std::string, Motion> motions;
  for (const Body& body : kBodies)
    motions[body.file] = value_of(load_motion(kCapturedMotions + body.file));
  for (const Body& from : kBodies) {
    const auto source = gait_cycle(motions[from.file]);
    ASSERT_TRUE(source) << source.error().message;
    for (const Body& to : kBodies) {
      const GaitCycle cycle = on_skeleton(*source, motions[to.file]);
      for (int i = 0; i < kCycleSamples; i += 16) {
        const std::string what = std::string(from.file) + " on " + to.file;
        EXPECT_LT(angle_between_deg(turn_of(cycle, i, to.chest), turn_of(*source, i, from.chest)),
                  1e-6)
            << what;
        EXPECT_LT(angle_between_deg(turn_of(cycle, i, to.head), turn_of(*source, i, from.head)),
                  1e-6)
            << what;
        EXPECT_LT(
            glm::distance(bone(cycle, i, to.arm, to.elbow), bone(*source, i, from.arm, from.elbow)),
            1e-6)
            << what;
        EXPECT_LT(glm::distance(bone(cycle, i, to.elbow, to.hand),
                                bone(*source, i, from.elbow, from.hand)),
                  0.18)
            << what;
      }
    }
  }
}

}  // namespace
}  // namespace gaitpad
