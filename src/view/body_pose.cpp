// Bodies and stick figures in a pose, as capsules and lines in the world.
#include "view/body.h"

namespace gaitpad {
namespace {

constexpr Colour kPale = {0.83, 0.84, 0.86};
constexpr double kPaleShare = 0.48;
constexpr double kStickLine_px = 3.2;
constexpr double kLongestEnd = 0.5,
                 kLongestLine = 0.9;  // of the leg: joints of meshes lie anywhere
constexpr double kShortestLine = 0.015, kShortestDotted = 0.045;  // of the leg: fingers have none

Colour mixed(const Colour& a, const Colour& b, double share) {
  return {mix(a.red, b.red, share), mix(a.green, b.green, share), mix(a.blue, b.blue, share),
          a.alpha};
}

// The shorter way round; the poses are a tick apart.
quat between(const quat& a, const quat& b, double share) noexcept {
  const quat near = glm::dot(a, b) < 0.0 ? -b : b;
  const quat sum = a * (1.0 - share) + near * share;
  const double length = glm::length(sum);
  return length > 1e-9 ? sum * (1.0 / length) : a;
}

// An end that is lower than its own thickness is lifted onto the floor.
void put_on_floor(vec3& end_m, double radius_m, const vec3& wide, double width) {
  const double upright = wide.y * wide.y * std::max(width * width - 1.0, 0.0);
  end_m.y = std::max(end_m.y, radius_m * std::sqrt(1.0 + upright));
}

}  // namespace

void interpolate(const Pose& before, const Pose& pose, double share, Pose& shown) noexcept {
  const double t = std::clamp(share, 0.0, 1.0);
  shown.joint_count = pose.joint_count;
  shown.root_m = before.root_m + (pose.root_m - before.root_m) * t;
  for (int j = 0; j < pose.joint_count; ++j) {
    shown.local[j] = between(before.local[j], pose.local[j], t);
  }
}

void add_body(const Body& body, const Pose& pose, const Colour& colour, SceneContent& content) {
  JointFrames frames;
  forward_kinematics(body.model->cycle.skeleton, pose, frames);
  const Colour pale = mixed(colour, kPale, kPaleShare);
  for (const BodyBone& bone : body.bones) {
    Capsule c;
    c.a_m = frames.position_m[bone.from] + frames.rotation[bone.from] * bone.from_m;
    c.b_m = frames.position_m[bone.to] + frames.rotation[bone.to] * bone.to_m;
    c.radius_a_m = bone.radius_from_m;
    c.radius_b_m = bone.radius_to_m;
    c.wide = frames.rotation[bone.from] * bone.wide;
    c.width_a = bone.width_from;
    c.width_b = bone.width_to;
    c.colour = bone.is_pale ? pale : colour;
    put_on_floor(c.a_m, c.radius_a_m, c.wide, c.width_a);
    put_on_floor(c.b_m, c.radius_b_m, c.wide, c.width_b);
    content.bodies.push_back(c);
  }
}

vec3 head_m(const Body& body, const Pose& pose) noexcept {
  JointFrames frames;
  forward_kinematics(body.model->cycle.skeleton, pose, frames);
  return frames.position_m[body.top] + frames.rotation[body.top] * body.top_m;
}

void add_stick_figure(const GaitCycle& source, double phase, double presence, const vec3& place_m,
                      double heading_rad, const Colour& colour, SceneContent& content) {
  const double share = std::clamp(presence, 0.0, 1.0);
  Pose pose;
  sample_local(source, phase, pose);
  for (int j = 0; j < pose.joint_count; ++j) {
    pose.local[j] = between(source.standing_local[j], pose.local[j], share);
  }
  const LegModel &left = source.leg[kLeftSide], &right = source.leg[kRightSide];
  const double stand_m = 0.5 * (left.length_m() - left.heel_m.y - left.hip_m.y + right.length_m() -
                                right.heel_m.y - right.hip_m.y);
  const vec3 sway_m = sample_at(source, phase).pelvis_m;
  const quat turn = rotation_y(heading_rad);
  pose.local[0] = turn * pose.local[0];
  pose.root_m = vec3(place_m.x, 0.0, place_m.z) + turn * vec3(sway_m.x, 0.0, sway_m.z) * share;
  pose.root_m.y = place_m.y + mix(stand_m, sway_m.y, share);
  JointFrames frames;
  forward_kinematics(source.skeleton, pose, frames);
  const double leg_m = left.length_m();
  for (int j = 1; j < pose.joint_count; ++j) {
    const vec3 a = frames.position_m[source.skeleton.joints[j].parent], b = frames.position_m[j];
    const double length_m = glm::distance(a, b);
    const double longest = source.skeleton.joints[j].is_end_site ? kLongestEnd : kLongestLine;
    if (length_m < kShortestLine * leg_m || length_m > longest * leg_m) continue;
    content.lines.push_back({a, b, colour, kStickLine_px});
    if (length_m > kShortestDotted * leg_m) content.joints_m.push_back(b);
  }
}

}  // namespace gaitpad
