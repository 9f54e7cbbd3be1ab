#include "scene/ground_mesh.h"

#include <algorithm>
#include <limits>

namespace gaitpad {
namespace {

constexpr int kMostSide = 400;      // greatest number of rows and of columns
constexpr double kBeside_m = 1e-6;  // distance at which the two sides of a riser are sampled

struct GroundRow {
  double z_m = 0.0;
  double look_m = 0.0;    // offset at which the height is sampled
  double riser = 0.0;     // z of the normal of a riser's face; 0: use the ground's normal
  bool is_joined = true;  // triangles connect it to the previous row
};

bool climbs(const Terrain& terrain, double riser_m) {
  return ground_at(terrain, 0.0, riser_m + kBeside_m).height_m >
         ground_at(terrain, 0.0, riser_m - kBeside_m).height_m;
}

void add_riser(const Terrain& terrain, double z_m, std::vector<GroundRow>& rows) {
  const double normal = climbs(terrain, z_m) ? -1.0 : 1.0;
  rows.push_back({z_m, -kBeside_m, 0.0, true});
  rows.push_back({z_m, -kBeside_m, normal, false});
  rows.push_back({z_m, kBeside_m, normal, true});
  rows.push_back({z_m, kBeside_m, 0.0, false});
}

std::vector<GroundRow> rows_of(const Terrain& terrain, double from_m, double to_m, double step_m) {
  std::vector<GroundRow> rows;
  const auto count = static_cast<int>(std::min(floor((to_m - from_m) / step_m), kMostSide - 1.0));
  double riser_m = piece_at(terrain, from_m).to_m;
  for (int k = 0; k <= count; ++k) {
    const double z_m = from_m + k * step_m;
    for (int n = 0; riser_m <= z_m && n < kMostSide; ++n) {
      add_riser(terrain, riser_m, rows);
      riser_m = piece_at(terrain, riser_m + kBeside_m).to_m;
    }
    rows.push_back({z_m, 0.0, 0.0, true});
  }
  if (!rows.empty()) rows.front().is_joined = false;
  return rows;
}

bool varies_sideways(const Terrain& terrain, double from_m, double to_m) {
  return std::any_of(terrain.sections.begin(), terrain.sections.end(), [&](const auto& s) {
    const bool is_seen = s.begin_m <= to_m && s.begin_m + s.length_m >= from_m;
    return is_seen && (std::holds_alternative<RoughSection>(s.shape) ||
                       std::holds_alternative<FieldSection>(s.shape));
  });
}

std::vector<double> columns_of(double from_m, double to_m, double step_m, bool is_fine) {
  if (!is_fine) return {from_m, to_m};
  std::vector<double> columns;
  const auto count = static_cast<int>(std::min(floor((to_m - from_m) / step_m), kMostSide - 1.0));
  for (int k = 0; k <= count; ++k) columns.push_back(from_m + k * step_m);
  return columns;
}

struct Edges {
  double nose_m = kEdge_m, foot_m = kEdge_m;
};
Edges edges_of(const Terrain& terrain, const GroundRow& row) {
  Edges edges;
  const double z_m = row.z_m + row.look_m;
  if (row.riser != 0.0) {
    const bool is_upper = climbs(terrain, row.z_m) == (row.look_m > 0.0);
    const double high_m = ground_at(terrain, 0.0, row.z_m - kBeside_m).height_m;
    const double rise_m = fabs(ground_at(terrain, 0.0, row.z_m + kBeside_m).height_m - high_m);
    return is_upper ? Edges{0.0, rise_m} : Edges{rise_m, 0.0};
  }
  const Stretch piece = piece_at(terrain, z_m);
  const auto see = [&](double riser_m, bool is_behind) {
    if (!(fabs(z_m - riser_m) < kEdge_m)) return;
    double& edge_m = climbs(terrain, riser_m) == is_behind ? edges.nose_m : edges.foot_m;
    edge_m = std::min(edge_m, fabs(z_m - riser_m));
  };
  see(piece.from_m, true);
  see(piece.to_m, false);
  return edges;
}

GroundVertex vertex_of(const Terrain& terrain, double x_m, const GroundRow& row, const Edges& edges,
                       const vec3& origin_m) {
  const Ground ground = ground_at(terrain, x_m, row.z_m + row.look_m);
  const vec3 place = vec3(x_m, ground.height_m, row.z_m) - origin_m;
  const vec3 normal = row.riser != 0.0 ? vec3(0.0, 0.0, row.riser) : ground.normal;
  const auto f = [](double v) { return static_cast<float>(v); };
  return {f(place.x),  f(place.y),  f(place.z),      f(normal.x),
          f(normal.y), f(normal.z), f(edges.nose_m), f(edges.foot_m)};
}

}  // namespace

GroundMesh ground_mesh(const Terrain& terrain, const vec2& centre_m, double half_m, double step_m) {
  const auto first = [&](double c) { return floor((c - half_m) / step_m) * step_m; };
  const double left_m = first(centre_m.x), near_m = first(centre_m.y);
  const double right_m = left_m + 2.0 * half_m + step_m, far_m = near_m + 2.0 * half_m + step_m;
  GroundMesh mesh;
  mesh.origin_m = vec3(centre_m.x, ground_at(terrain, centre_m.x, centre_m.y).height_m, centre_m.y);
  const std::vector<GroundRow> rows = rows_of(terrain, near_m, far_m, step_m);
  const std::vector<double> columns =
      columns_of(left_m, right_m, step_m, varies_sideways(terrain, near_m, far_m));
  mesh.vertices.reserve(rows.size() * columns.size());
  for (const GroundRow& row : rows) {
    const Edges edges = edges_of(terrain, row);
    for (const double x_m : columns)
      mesh.vertices.push_back(vertex_of(terrain, x_m, row, edges, mesh.origin_m));
  }
  const auto width = static_cast<std::uint32_t>(columns.size());
  for (std::uint32_t r = 1; r < rows.size(); ++r) {
    for (std::uint32_t c = 1; rows[r].is_joined && c < width; ++c) {
      const std::uint32_t b = r * width + c, a = b - width;
      mesh.indices.insert(mesh.indices.end(), {a - 1, b - 1, b, a - 1, b, a});
    }
  }
  return mesh;
}

double mean_ground_m(const Terrain& terrain, double x_m, double z_m) noexcept {
  constexpr int kSide = 8;
  constexpr double kApart_m = 0.05;
  double sum_m = 0.0;
  for (int k = -kSide; k <= kSide; ++k)
    sum_m += ground_at(terrain, x_m, z_m + k * kApart_m).height_m;
  return sum_m / (2 * kSide + 1);
}

}  // namespace gaitpad
