// What the joints of a skeleton are, as far as a body needs it: trunk, neck and head, arms. Told by
// the standing pose, and by names where they help.
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "gaitpad/gait_cycle.h"
#include "gaitpad/session_frame.h"
#include "gaitpad/walk_model.h"
#include "view/scene.h"

namespace gaitpad {

struct ArmJoints {
  int shoulder = -1, elbow = -1, wrist = -1;
  int hand_end = -1;  // the farthest joint of the hand, -1: none below the wrist
  bool is_known() const noexcept { return shoulder >= 0; }
};
struct BodyParts {
  JointFrames standing;          // world, facing +z, the feet on the floor
  std::vector<int> trunk;        // from the pelvis or the root upwards to the head
  int head = -1, top = -1;       // top: the highest joint on the head, or the head itself; -1: none
  std::array<ArmJoints, 2> arm;  // by Side
  vec3 hips_m{0.0}, shoulders_m{0.0};  // standing, between left and right; else a guess
};
BodyParts body_parts(const WalkModel& model);

// A skeleton as something to look at: which bones it has, how thick they are, where they are in a
// pose. Any skeleton of any file: legs are known, the rest is told by its shape.

// A tapered capsule between two places, each fixed to a joint. Across, along `wide`, it is `width`
// times as thick.
struct BodyBone {
  int from = 0, to = 0;         // joints
  vec3 from_m{0.0}, to_m{0.0};  // in these joints' frames
  double radius_from_m = 0.05, radius_to_m = 0.05;
  vec3 wide{0.0};  // in the frame of `from`
  double width_from = 1.0, width_to = 1.0;
  bool is_pale = false;  // forearm, hand, head, foot: mixed with grey, so that a figure reads
};
struct Body {
  std::shared_ptr<const WalkModel> model;
  std::vector<BodyBone> bones;
  int top = 0;            // joint that carries the highest place
  vec3 top_m{0.0};        // that place, in its frame
  double height_m = 0.0;  // of it, standing
};
// Allocates; once a character. What cannot be told (arms, a head) is left out.
Body body_of(std::shared_ptr<const WalkModel> model);

// Between the two latest poses; 0: the earlier one.
void interpolate(const Pose& before, const Pose& pose, double share, Pose& shown) noexcept;
// Nothing of it is below the floor.
void add_body(const Body& body, const Pose& pose, const Colour& colour, SceneContent& content);
// Its highest point, for a name above it.
vec3 head_m(const Body& body, const Pose& pose) noexcept;

// The motion as it was captured, unadapted, as a stick figure: the source's pose at `phase`,
// standing where presence is 0, its root over `place_m` on the floor, turned to `heading_rad`.
void add_stick_figure(const GaitCycle& source, double phase, double presence, const vec3& place_m,
                      double heading_rad, const Colour& colour, SceneContent& content);

}  // namespace gaitpad
