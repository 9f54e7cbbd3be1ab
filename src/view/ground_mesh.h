// Uneven ground as triangles, and its height as a camera follows it.
#pragma once
#include <cstdint>
#include <vector>

#include "gaitpad/terrain.h"

namespace gaitpad {

inline constexpr float kEdge_m = 1.0f;

struct GroundVertex {
  float x = 0.0f, y = 0.0f, z = 0.0f;  // counted from GroundMesh::origin_m
  float normal_x = 0.0f, normal_y = 1.0f, normal_z = 0.0f;
  // Metres on the surface to the upper edge of the nearest riser and to the lower one, where that
  // edge is this surface's own, at most kEdge_m.
  float to_nose_m = kEdge_m, to_foot_m = kEdge_m;
};
struct GroundMesh {
  vec3 origin_m{0.0};
  std::vector<GroundVertex> vertices;
  std::vector<std::uint32_t> indices;  // of triangles
};
// A square of it, `half_m` to each side of a place. Its vertices stand at whole multiples of
// `step_m`, so that they do not swim when the place moves, and at both edges of every riser, which
// is a face of its own.
GroundMesh ground_mesh(const Terrain& terrain, const vec2& centre_m, double half_m, double step_m);

// Over a step's length along z: without jumps where there are risers. Its own height where it is
// level all round.
double mean_ground_m(const Terrain& terrain, double x_m, double z_m) noexcept;

}  // namespace gaitpad
