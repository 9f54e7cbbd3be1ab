// A skeleton as something to look at: which bones it has, how thick they are, where they are in a
// pose. Any skeleton of any file: legs are known, the rest is told by its shape.
#pragma once
#include <vector>

#include "motion/gait_cycle.h"
#include "session/session_frame.h"
#include "view/scene.h"

namespace gaitpad {

struct BodyBone {
  int from = 0, to = 0;  // joints
  double radius_from_m = 0.05, radius_to_m = 0.05;
  bool is_pale = false;  // forearm, hand, head, foot: mixed with grey, so that a figure reads
};
struct Body {
  std::shared_ptr<const WalkModel> model;
  std::vector<BodyBone> bones;
  double height_m = 0.0;  // standing, to the highest joint
};
Body body_of(std::shared_ptr<const WalkModel> model);

// Between the two latest poses; 0: the earlier one.
void interpolate(const Pose& before, const Pose& pose, double share, Pose& shown) noexcept;
void add_body(const Body& body, const Pose& pose, const Colour& colour, SceneContent& content);
// Its highest point, for a name above it; the place on the ground under its root.
vec3 head_m(const Body& body, const Pose& pose) noexcept;

// The motion as it was captured, unadapted, as a stick figure: the source's pose at `phase`,
// standing where presence is 0, its root over `place_m` on the floor, turned to `heading_rad`.
void add_stick_figure(const GaitCycle& source, double phase, double presence, const vec3& place_m,
                      double heading_rad, const Colour& colour, SceneContent& content);

}  // namespace gaitpad
