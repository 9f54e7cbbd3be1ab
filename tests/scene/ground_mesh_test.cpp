#include "scene/ground_mesh.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gaitpad {
namespace {

Terrain stairs() {
  Terrain terrain;
  EXPECT_FALSE(add_section(terrain, FlatSection{2.0}));
  EXPECT_FALSE(add_section(terrain, StairsSection{0.17, 0.28, 4}));
  EXPECT_FALSE(add_section(terrain, rough_section(9.0, 0.05, 2.0, 3.0, 5)));
  EXPECT_FALSE(add_section(terrain, StairsSection{-0.17, 0.28, 4}));
  return terrain;
}

vec3 place_of(const GroundMesh& mesh, std::uint32_t i) {
  const GroundVertex& v = mesh.vertices[i];
  return mesh.origin_m + vec3(v.x, v.y, v.z);
}
vec3 normal_of(const GroundMesh& mesh, std::uint32_t i) {
  const GroundVertex& v = mesh.vertices[i];
  return {v.normal_x, v.normal_y, v.normal_z};
}

TEST(SceneGround, ItsTrianglesLieOnTheGroundAndFaceUpOrOutOfRisers) {
  const Terrain terrain = stairs();
  const GroundMesh mesh = ground_mesh(terrain, {0.3, 4.0}, 6.0, 0.125);
  double risers_m2 = 0.0, largest_gap_m = 0.0;
  ASSERT_EQ(mesh.indices.size() % 3, 0u);
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    const std::uint32_t* i = mesh.indices.data() + t;
    const vec3 a = place_of(mesh, i[0]), b = place_of(mesh, i[1]), c = place_of(mesh, i[2]);
    const vec3 face = glm::cross(b - a, c - a);
    const double area_m2 = 0.5 * glm::length(face);
    if (area_m2 < 1e-9) continue;  // a riser exactly at a row has faces without area
    EXPECT_GT(std::abs(glm::dot(face, normal_of(mesh, i[0]))) / (2.0 * area_m2), 0.98);
    const bool is_riser = std::abs(normal_of(mesh, i[0]).z) > 0.8;
    if (is_riser) {
      risers_m2 += area_m2;
      EXPECT_NEAR(a.z, b.z, 1e-5);
      EXPECT_NEAR(a.z, c.z, 1e-5);
      continue;
    }
    const vec3 middle = (a + b + c) / 3.0;
    const Ground ground = ground_at(terrain, middle.x, middle.z);
    largest_gap_m = std::max(largest_gap_m, std::abs(ground.height_m - middle.y));
  }
  EXPECT_LT(largest_gap_m, 0.002);
  EXPECT_NEAR(risers_m2 / (12.25 + 0.0), 4 * 0.17,
              0.02);  // four risers of 0.17 m; the others are outside of the mesh
}

TEST(SceneGround, VerticesStayWhereTheyAreWhenTheMeshMoves) {
  const Terrain terrain = stairs();
  const GroundMesh a = ground_mesh(terrain, {0.0, 6.0}, 4.0, 0.125);
  const GroundMesh b = ground_mesh(terrain, {0.0, 7.0}, 4.0, 0.125);
  for (const GroundMesh* mesh : {&a, &b}) {
    for (std::uint32_t i = 0; i < mesh->vertices.size(); ++i) {
      const double rest = std::remainder(place_of(*mesh, i).z, 0.125);
      const bool is_riser = ground_at(terrain, 0.0, place_of(*mesh, i).z - 1e-4).piece !=
                            ground_at(terrain, 0.0, place_of(*mesh, i).z + 1e-4).piece;
      EXPECT_TRUE(std::abs(rest) < 1e-5 || is_riser);
    }
  }
}

TEST(SceneGround, TheMeanGroundHasNoJumps) {
  const Terrain terrain = stairs();
  double before = mean_ground_m(terrain, 0.0, 0.0);
  EXPECT_EQ(before, 0.0);
  for (double z = 0.0; z < 16.0; z += 0.01) {
    const double now = mean_ground_m(terrain, 0.0, z);
    EXPECT_LT(std::abs(now - before), 0.025) << z;
    before = now;
  }
}

}  // namespace
}  // namespace gaitpad
