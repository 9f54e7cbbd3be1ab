// Draws a skeleton as a person of tapered capsules, and the source motion as a stick figure. Legs
// and arms are the joints that the walk solves (gaitpad/anatomy.h); their thickness follows an
// adult's.
#pragma once
#include <memory>
#include <vector>

#include "gaitpad/gait_cycle.h"
#include "gaitpad/walk_model.h"
#include "scene/scene.h"

namespace gaitpad {

// A tapered capsule between two places, each fixed to a joint. Along `wide` it is `width` times as
// thick.
struct MannequinBone {
  int from = 0, to = 0;         // the joints that carry the two ends
  vec3 from_m{0.0}, to_m{0.0};  // the ends, in the frames of these joints
  double radius_from_m = 0.05, radius_to_m = 0.05;
  // One direction of the standing pose in the frames of `from` and `to`.
  vec3 wide{0.0}, wide_to{0.0};
  double width_from = 1.0, width_to = 1.0;
  bool is_pale = false;  // mixed with grey, so that forearm, hand, head and foot stand out
};
struct Mannequin {
  std::shared_ptr<const WalkModel> model;
  std::vector<MannequinBone> bones;
  int top = 0;            // the joint that carries the highest place
  vec3 top_m{0.0};        // the highest place, in that joint's frame
  double height_m = 0.0;  // height of that place when standing
};
// coarse: half as many bones, for distant characters.
enum class MannequinDetail { full, coarse };
// Allocates; call it once for each character. Limbs that were not found are left out.
Mannequin mannequin_of(std::shared_ptr<const WalkModel> model,
                       MannequinDetail detail = MannequinDetail::full);

// The ends of a bone in the world.
struct BonePlace {
  vec3 from_m{0.0}, to_m{0.0};
};
BonePlace place_of(const MannequinBone& bone, const JointFrames& frames) noexcept;

// Interpolates between two rotations, one tick apart, along the shorter arc.
quat between(const quat& a, const quat& b, double share) noexcept;
// Interpolates between the two latest poses; share 0 gives the earlier one.
void interpolate(const Pose& before, const Pose& pose, double share, Pose& shown) noexcept;
// Draws no part below the ground under the feet; terrain null: level at height 0.
void add_mannequin(const Mannequin& mannequin, const Pose& pose, const Terrain* terrain,
                   const Colour& colour, SceneContent& content);
// The highest point of the mannequin, for the name above it.
vec3 head_m(const Mannequin& mannequin, const Pose& pose) noexcept;

// The captured motion, without retargeting, as a stick figure: the source's pose at `phase`,
// blended with its standing pose if `presence` is below 1. Its root is above `place_m` on the
// floor, and it faces `heading_rad`.
void add_stick_figure(const GaitCycle& source, double phase, double presence, const vec3& place_m,
                      double heading_rad, const Colour& colour, SceneContent& content);

}  // namespace gaitpad
