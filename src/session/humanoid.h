// A character's joints as the bones of a humanoid, the common language of avatar programs: bones of
// fixed names (those of Unity's HumanBodyBones), whose rotations are identity in a T pose that
// faces +z. So the bones of any character move any other one.
#pragma once
#include <vector>

#include "gaitpad/skeleton.h"
#include "gaitpad/walk_model.h"

namespace gaitpad {

struct HumanoidBone {
  const char* name;
  int joint = -1;           // in the skeleton
  int parent = -1;          // in Humanoid::bones, before this one; -1: the bone hangs on the root
  quat t_pose = kIdentity;  // the joint's world rotation in the T pose
};
struct Humanoid {
  std::vector<HumanoidBone> bones;  // the hips first; bones that the skeleton lacks are left out
  double hips_m = 0.0;              // their height when standing
};

// The T pose is made of the standing pose: it is turned until the hips face +z, each bone of a leg
// is turned to point down, each bone of an arm to point sideways, and each foot to point forward;
// hands and toes turn with the bone that carries them. Trunk and head keep their posture.
Humanoid humanoid_of(const WalkModel& model);

// Right-handed, y up, +x to the left, as everywhere; a bone in the frame of its parent.
struct BonePose {
  vec3 place_m{0.0};
  quat rotation = kIdentity;
};
// What `pose` is in these bones. They hang on `root`: where the walker is on the floor, and where
// it heads. One entry of `out` a bone.
void humanoid_pose(const Humanoid& humanoid, const Skeleton& skeleton, const Pose& pose,
                   const BonePose& root, std::vector<BonePose>& out);

}  // namespace gaitpad
