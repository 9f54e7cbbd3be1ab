#include "session/humanoid.h"

#include <memory>

namespace gaitpad {
namespace {

const vec3 kDown = -kUp;

// Builds the T pose bone by bone from the world frames of the standing pose.
class HumanoidBuilder {
 public:
  HumanoidBuilder(const Skeleton& skeleton, const JointFrames& standing)
      : skeleton_(skeleton), standing_(standing) {}

  // The rotation about y that makes the hips face +z.
  void face_forward(int left_hip, int right_hip) {
    const vec3 left = standing_.position_m[left_hip] - standing_.position_m[right_hip];
    facing_ = rotation_y(heading_of(kLeft) - heading_of(left));
  }
  const quat& facing() const { return facing_; }

  // World rotation that faces the body forward and then points the line from -> to along `aim`.
  quat pointing(int from, int to, const vec3& aim) const {
    const vec3 line = facing_ * (standing_.position_m[to] - standing_.position_m[from]);
    return rotation_between(glm::normalize(line), aim) * facing_;
  }
  // A rotation about y only, after which the bone from one joint to the other points forward.
  quat heading_forward(int from, int to) const {
    const vec3 line = facing_ * (standing_.position_m[to] - standing_.position_m[from]);
    return rotation_y(-heading_of(line)) * facing_;
  }

  // Adds a bone, which `turn` brings from the standing pose to the T pose, and returns its index.
  // Returns `parent` if the joint does not exist or is an end site.
  int add(const char* name, int joint, int parent, const quat& turn) {
    if (joint < 0 || skeleton_.joints[joint].is_end_site) return parent;
    bones_.push_back({name, joint, parent, turn * standing_.rotation[joint]});
    return static_cast<int>(bones_.size()) - 1;
  }
  std::vector<HumanoidBone> take() { return std::move(bones_); }

 private:
  const Skeleton& skeleton_;
  const JointFrames& standing_;
  quat facing_ = kIdentity;
  std::vector<HumanoidBone> bones_;
};

struct BonesOfLeg {
  const char *upper, *lower, *foot, *toes;
};
struct ArmNames {
  const char *shoulder, *upper, *lower, *hand;
};
// Indexed by Side.
constexpr BonesOfLeg kLegBones[2] = {{"LeftUpperLeg", "LeftLowerLeg", "LeftFoot", "LeftToes"},
                                     {"RightUpperLeg", "RightLowerLeg", "RightFoot", "RightToes"}};
constexpr ArmNames kArmNames[2] = {
    {"LeftShoulder", "LeftUpperArm", "LeftLowerArm", "LeftHand"},
    {"RightShoulder", "RightUpperArm", "RightLowerArm", "RightHand"}};

void add_leg(const LegJoints& leg, const BonesOfLeg& names, const Skeleton& skeleton, int hips,
             HumanoidBuilder& builder) {
  int bone = builder.add(names.upper, leg.hip, hips, builder.pointing(leg.hip, leg.knee, kDown));
  bone = builder.add(names.lower, leg.knee, bone, builder.pointing(leg.knee, leg.ankle, kDown));
  const bool has_toes = leg.toe >= 0 && !skeleton.joints[leg.toe].is_end_site;
  const quat foot = has_toes ? builder.heading_forward(leg.ankle, leg.toe) : builder.facing();
  bone = builder.add(names.foot, leg.ankle, bone, foot);
  builder.add(names.toes, leg.toe, bone, foot);
}

void add_arm(const ArmChain& arm, const ArmNames& names, const vec3& aside, int chest,
             HumanoidBuilder& builder) {
  if (!arm.is_found()) return;
  const int shoulder = builder.add(names.shoulder, arm.collar, chest, builder.facing());
  const quat lower = builder.pointing(arm.elbow, arm.wrist, aside);
  int bone = builder.add(names.upper, arm.shoulder, shoulder,
                         builder.pointing(arm.shoulder, arm.elbow, aside));
  bone = builder.add(names.lower, arm.elbow, bone, lower);
  builder.add(names.hand, arm.wrist, bone, lower);
}

// Adds the spine and returns the bone that carries arms and neck.
int add_spine(const std::vector<int>& spine, int hips, HumanoidBuilder& builder) {
  const std::size_t n = spine.size();
  int bone = hips;
  if (n > 0) bone = builder.add("Spine", spine.front(), bone, builder.facing());
  if (n > 1) bone = builder.add("Chest", spine[n == 2 ? 1 : n / 2], bone, builder.facing());
  if (n > 2) bone = builder.add("UpperChest", spine.back(), bone, builder.facing());
  return bone;
}

}  // namespace

Humanoid humanoid_of(const WalkModel& model) {
  const Skeleton& skeleton = model.cycle.skeleton;
  const auto standing = std::make_unique<JointFrames>();
  forward_kinematics(skeleton, model.cycle.standing_local, *standing);
  const UpperBodyJoints& upper = model.body.joints;
  HumanoidBuilder builder(skeleton, *standing);
  const auto leg = [&model](Side side) -> const LegJoints& { return model.leg[side].model.joints; };
  builder.face_forward(leg(kLeftSide).hip, leg(kRightSide).hip);
  const int hips = builder.add("Hips", model.cycle.pelvis, -1, builder.facing());
  for (const Side side : {kLeftSide, kRightSide})
    add_leg(leg(side), kLegBones[side], skeleton, hips, builder);
  const int chest = add_spine(upper.spine, hips, builder);
  const int neck_joint = upper.neck.empty() ? -1 : upper.neck.front();
  const int neck = builder.add("Neck", neck_joint, chest, builder.facing());
  builder.add("Head", upper.head, neck, builder.facing());
  for (const Side side : {kLeftSide, kRightSide})
    add_arm(upper.arm[side], kArmNames[side], side == kLeftSide ? kLeft : -kLeft, chest, builder);
  return {builder.take(), model.stand_m};
}

void humanoid_pose(const Humanoid& humanoid, const Skeleton& skeleton, const Pose& pose,
                   const BonePose& root, std::vector<BonePose>& out) {
  const auto world = std::make_unique<JointFrames>();
  forward_kinematics(skeleton, pose, *world);
  const std::size_t count = humanoid.bones.size();
  std::vector<BonePose> placed(count);  // bones placed in the world
  out.resize(count);
  for (std::size_t b = 0; b < count; ++b) {
    const HumanoidBone& bone = humanoid.bones[b];
    placed[b] = {world->position_m[bone.joint],
                 world->rotation[bone.joint] * glm::conjugate(bone.t_pose)};
    const BonePose& parent = bone.parent < 0 ? root : placed[bone.parent];
    const quat back = glm::conjugate(parent.rotation);
    out[b] = {back * (placed[b].place_m - parent.place_m),
              glm::normalize(back * placed[b].rotation)};
  }
}

}  // namespace gaitpad
