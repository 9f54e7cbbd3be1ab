#include "animation/terrain.h"

#include "animation/terrain_shapes.h"

namespace gaitpad {
namespace {

// sin_cos() is exact up to 1e5 rad; also where no place is one (NaN).
constexpr double kFar_m = 1e4;

double place(double x_m) noexcept {
  if (x_m > kFar_m) return kFar_m;
  return x_m > -kFar_m ? x_m : -kFar_m;
}

double level_of(const SectionShape& shape) noexcept {
  if (const auto* slope = std::get_if<SlopeSection>(&shape)) return rise_of(*slope);
  if (const auto* stairs = std::get_if<StairsSection>(&shape))
    return stairs->rise_m * stairs->count;
  return 0.0;
}

int risers_of(const SectionShape& shape) noexcept {
  const auto* stairs = std::get_if<StairsSection>(&shape);
  return stairs ? stairs->count : 0;
}

const TerrainSection* section_at(const Terrain& terrain, double z_m) noexcept {
  const TerrainSection* found = nullptr;
  for (const TerrainSection& s : terrain.sections) {
    if (s.begin_m > z_m) break;
    found = &s;
  }
  return found;
}

// Calls `see(z_m, is_up)` for each riser, in order.
template <class See>
void see_risers(const Terrain& terrain, const See& see) noexcept {
  for (const TerrainSection& s : terrain.sections) {
    const auto* stairs = std::get_if<StairsSection>(&s.shape);
    for (int k = 0; stairs && k < stairs->count; ++k)
      see(s.begin_m + k * stairs->tread_m, stairs->rise_m > 0.0);
  }
}

}  // namespace

Ground ground_at(const Terrain& terrain, double x_m, double z_m) noexcept {
  const double z = place(z_m);
  const TerrainSection* s = section_at(terrain, z);
  if (!s) return {};
  const double u = z - s->begin_m;
  if (u > s->length_m) return {s->end_m, kUp, s->piece + risers_of(s->shape)};
  const double x = place(x_m);
  const ShapePoint at =
      std::visit([&](const auto& shape) { return point_at(shape, x, u); }, s->shape);
  const vec3 normal = at.dx == 0.0 && at.dz == 0.0
                          ? kUp
                          : vec3(-at.dx, 1.0, -at.dz) / sqrt(1.0 + at.dx * at.dx + at.dz * at.dz);
  return {s->base_m + at.height_m, normal, s->piece + at.risers};
}

Stretch piece_at(const Terrain& terrain, double z_m) noexcept {
  Stretch stretch;
  see_risers(terrain, [&](double riser_m, bool is_up) {
    if (is_up ? riser_m <= z_m : riser_m < z_m) {
      stretch.from_m = riser_m;
    } else if (riser_m < stretch.to_m) {
      stretch.to_m = riser_m;
    }
  });
  return stretch;
}

bool is_flat(const Terrain& terrain) noexcept {
  return std::all_of(terrain.sections.begin(), terrain.sections.end(), [](const TerrainSection& s) {
    return std::holds_alternative<FlatSection>(s.shape);
  });
}

double least_tread_m(const Terrain& terrain) noexcept {
  double least = std::numeric_limits<double>::infinity(), last = -least;
  see_risers(terrain, [&](double riser_m, bool) {
    least = std::min(least, riser_m - last);
    last = riser_m;
  });
  return least;
}

double length_m(const Terrain& terrain) noexcept {
  if (terrain.sections.empty()) return 0.0;
  return terrain.sections.back().begin_m + terrain.sections.back().length_m;
}

std::optional<Error> add_section(Terrain& terrain, const SectionShape& shape) {
  if (terrain.sections.size() >= kMaxSections) return Error{"there are too many sections"};
  if (auto problem = std::visit([](const auto& s) { return problem_of(s); }, shape)) return problem;
  TerrainSection section;
  section.shape = shape;
  section.length_m = std::visit([](const auto& s) { return length_of(s); }, shape);
  if (!terrain.sections.empty()) {
    const TerrainSection& before = terrain.sections.back();
    section.begin_m = before.begin_m + before.length_m;
    section.base_m = before.end_m;
    section.piece = before.piece + risers_of(before.shape);
  }
  if (section.begin_m + section.length_m > kFar_m) return Error{"the terrain is too long"};
  section.end_m = section.base_m + level_of(shape);
  terrain.sections.push_back(std::move(section));
  return std::nullopt;
}

Terrain scaled(const Terrain& terrain, double factor) {
  Terrain t = terrain;
  for (TerrainSection& s : t.sections) {
    std::visit([factor](auto& shape) { scale(shape, factor); }, s.shape);
    for (double* length : {&s.begin_m, &s.length_m, &s.base_m, &s.end_m}) *length *= factor;
  }
  for (TerrainZone& zone : t.zones) {
    for (double* length : {&zone.from_m, &zone.to_m, &zone.left_m, &zone.right_m})
      *length *= factor;
  }
  return t;
}

std::shared_ptr<const Terrain> flat_terrain() {
  static const auto kFlat = std::make_shared<const Terrain>();
  return kFlat;
}

}  // namespace gaitpad
