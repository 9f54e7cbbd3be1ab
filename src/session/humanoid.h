// Maps a character's joints to the bones of a humanoid, as avatar programs expect them: the names
// are those of Unity's HumanBodyBones, and all rotations are identity in a T pose that faces +z.
// Therefore the bones of one character can move any other character.
#pragma once
#include <vector>

#include "gaitpad/skeleton.h"
#include "gaitpad/walk_model.h"

namespace gaitpad {

struct HumanoidBone {
  const char* name;
  int joint = -1;           // index of the joint in the skeleton
  int parent = -1;          // index in Humanoid::bones, below this bone's; -1: the root
  quat t_pose = kIdentity;  // the joint's world rotation in the T pose
};
struct Humanoid {
  std::vector<HumanoidBone> bones;  // the hips first; without those that the skeleton lacks
  double hips_m = 0.0;              // height of the hips when standing
};

// The T pose is computed from the standing pose: the hips face +z, the bones of a leg point down,
// those of an arm sideways, and the feet forward; hands and toes turn with the bone that carries
// them. Trunk and head keep their posture.
Humanoid humanoid_of(const WalkModel& model);

// Pose of a bone in its parent's frame: right-handed, y up, +x to the left.
struct BonePose {
  vec3 place_m{0.0};
  quat rotation = kIdentity;
};
// Converts `pose` to these bones. `root` is the walker's place on the floor and its heading; the
// bones are relative to it. `out` has one entry for each bone.
void humanoid_pose(const Humanoid& humanoid, const Skeleton& skeleton, const Pose& pose,
                   const BonePose& root, std::vector<BonePose>& out);

}  // namespace gaitpad
