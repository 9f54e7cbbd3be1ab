// Uneven ground as triangles, and its smoothed height, which the camera follows.
#pragma once
#include <cstdint>
#include <vector>

#include "gaitpad/terrain.h"

namespace gaitpad {

inline constexpr float kEdge_m = 1.0f;

struct GroundVertex {
  float x = 0.0f, y = 0.0f, z = 0.0f;  // place relative to GroundMesh::origin_m
  float normal_x = 0.0f, normal_y = 1.0f, normal_z = 0.0f;
  // Distances along the surface to the upper and the lower edge of the nearest riser, if that edge
  // belongs to this surface; at most kEdge_m.
  float to_nose_m = kEdge_m, to_foot_m = kEdge_m;
};
struct GroundMesh {
  vec3 origin_m{0.0};
  std::vector<GroundVertex> vertices;
  std::vector<std::uint32_t> indices;  // three for each triangle, into the vertices
};
// A square of ground, `half_m` to each side of the centre. Vertices are at whole multiples of
// `step_m`, so that they stay in place when the centre moves, and at both edges of every riser,
// which is a separate face.
GroundMesh ground_mesh(const Terrain& terrain, const vec2& centre_m, double half_m, double step_m);

// Mean height over the length of a step along z, which does not jump at risers.
double mean_ground_m(const Terrain& terrain, double x_m, double z_m) noexcept;

}  // namespace gaitpad
