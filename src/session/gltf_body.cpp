#include "session/gltf_body.h"

#include <array>

namespace gaitpad {
namespace {

constexpr double kShortestBone_m = 1e-3;
constexpr double kWaist = 0.15;  // how far down the rod it is thickest
constexpr double kThickness = 0.09, kThinnest_m = 0.004, kThickest_m = 0.032;

void add_triangle(const vec3& a, const vec3& b, const vec3& c, int joint, GltfBody& body) {
  const vec3 normal = glm::normalize(glm::cross(b - a, c - a));
  for (const vec3& corner : {a, b, c}) {
    body.place_m.push_back(corner);
    body.normal.push_back(normal);
    body.joint.push_back(static_cast<std::uint16_t>(joint));
  }
}

// An octahedron from joint to joint.
void add_rod(const vec3& from, const vec3& to, int joint, GltfBody& body) {
  const double length_m = glm::distance(from, to);
  if (!(length_m > kShortestBone_m)) return;
  const vec3 along = (to - from) / length_m;
  const vec3 aside = std::abs(along.x) < 0.7 ? kLeft : kForward;
  const double half_m = std::clamp(kThickness * length_m, kThinnest_m, kThickest_m);
  const vec3 u = half_m * glm::normalize(glm::cross(along, aside));
  const vec3 v = glm::cross(along, u);
  const vec3 waist = from + kWaist * (to - from);
  const std::array<vec3, 4> ring = {waist + u, waist + v, waist - u, waist - v};
  for (std::size_t k = 0; k < 4; ++k) {
    const vec3 &here = ring[k], &next = ring[(k + 1) % 4];
    add_triangle(from, next, here, joint, body);
    add_triangle(here, next, to, joint, body);
  }
}

}  // namespace

GltfBody gltf_body(const Skeleton& skeleton, const JointFrames& world) {
  GltfBody body;
  for (std::size_t j = 1; j < skeleton.joints.size(); ++j) {
    const int upper = skeleton.joints[j].parent;
    add_rod(world.position_m[upper], world.position_m[j], upper, body);
  }
  return body;
}

}  // namespace gaitpad
