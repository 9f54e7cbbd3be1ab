// Assertion 22: uneven ground, "including climbing and descending steps".
#include <fmt/format.h>

#include <algorithm>

#include "paper/claims.h"

namespace gaitpad {
namespace {

constexpr double kStick = 0.5, kEnd_s = 16.0;
constexpr double kGrade = 0.176;                   // 10 degrees
constexpr double kRise_m = 0.17, kTread_m = 0.28;  // of a stair
constexpr int kStairs = 8;
constexpr int kSolePoints = 5;

struct Ground22 {
  const char* name;
  SectionShape shape;
};
const std::array<Ground22, 5> kGrounds = {
    Ground22{"flat", FlatSection{8.0}}, Ground22{"10 deg up", SlopeSection{6.0, kGrade, 0.5}},
    Ground22{"10 deg down", SlopeSection{6.0, -kGrade, 0.5}},
    Ground22{"17 cm stairs up", StairsSection{kRise_m, kTread_m, kStairs}},
    Ground22{"17 cm stairs down", StairsSection{-kRise_m, kTread_m, kStairs}}};

// The walk's two metres on the flat, then the shape.
std::optional<Terrain> terrain_of(const Ground22& ground) {
  Terrain terrain;
  terrain.name = ground.name;
  for (const SectionShape& shape : {SectionShape(FlatSection{2.0}), ground.shape}) {
    if (add_section(terrain, shape)) return std::nullopt;
  }
  return terrain;
}

struct Footing {
  double planted_mm = 0.0, sunk_mm = 0.0, hips_mm = 0.0;
  int failed = 0, legs = 0;
};
struct Worst {
  double value = 0.0;
  std::string where;
  void take(double v, const char* name) {
    if (v > value || where.empty()) value = v, where = name;
  }
};

double above_m(const Terrain& terrain, const vec3& p) {
  return p.y - ground_at(terrain, p.x, p.z).height_m;
}

// Points of the sole between heel and toe, each against its own height of rest.
double sunk_m(const Terrain& terrain, const WalkFrame& f, Side side, double toe_rest_m) {
  double most = 0.0;
  for (int i = 0; i < kSolePoints; ++i) {
    const double t = static_cast<double>(i) / (kSolePoints - 1);
    const vec3 p = f.heel_m[side] * (1.0 - t) + f.toe_m[side] * t;
    most = std::max(most, t * toe_rest_m - above_m(terrain, p));
  }
  return most;
}

Footing footing_of(const Walk& walk, const Terrain& terrain, const FootBuild& build) {
  Footing found;
  for (const WalkSample& sample : walk.samples) {
    const WalkFrame& f = sample.frame;
    for (const Side side : {kLeftSide, kRightSide}) {
      const double heel = std::fabs(above_m(terrain, f.heel_m[side])),
                   toe = std::fabs(above_m(terrain, f.toe_m[side]) - build.toe_rest_m[side]);
      if (f.heel_planted[side]) found.planted_mm = std::max(found.planted_mm, 1e3 * heel);
      if (f.toe_planted[side]) found.planted_mm = std::max(found.planted_mm, 1e3 * toe);
      const double sunk = sunk_m(terrain, f, side, build.toe_rest_m[side]);
      found.sunk_mm = std::max(found.sunk_mm, 1e3 * sunk);
      found.failed += f.ik_failed[side];
      ++found.legs;
    }
  }
  const vec3 from = walk.samples.front().frame.pelvis_m, to = walk.samples.back().frame.pelvis_m;
  found.hips_mm = 1e3 * std::fabs(above_m(terrain, to) - above_m(terrain, from));
  return found;
}

}  // namespace

std::vector<Claim> terrain_claims(const Study& study, IkMode mode) {
  ClaimList list("3.3", mode);
  Worst planted, sunk, hips, failed;
  for (const Ground22& ground : kGrounds) {
    const auto terrain = terrain_of(ground);
    if (!terrain) continue;
    WalkModel model = study.model();
    model.terrain = std::make_shared<const Terrain>(*terrain);
    WalkCase what;
    what.model = &model;
    what.ik = mode;
    what.stick = {{0.5, vec2(0.0, kStick)}, {kEnd_s - 2.5, vec2(0.0)}};
    what.end_s = kEnd_s;
    const Footing f = footing_of(walked(what), *terrain, foot_build(model));
    planted.take(f.planted_mm, ground.name);
    sunk.take(f.sunk_mm, ground.name);
    hips.take(f.hips_mm, ground.name);
    failed.take(static_cast<double>(f.failed) / f.legs, ground.name);
  }
  const char* kGroundNames =
      "flat, 10 deg up and down, 8 stairs of 17 / 28 cm up and down; worst: ";
  list.add("22 planted heels and toes off the ground, mm", planted.value, at_most(5.0),
           kGroundNames + planted.where);
  list.add("22 soles below the ground, mm", sunk.value, at_most(5.0), kGroundNames + sunk.where);
  list.add("22 solves that miss their tolerance, share", failed.value, at_most(0.01),
           kGroundNames + failed.where);
  list.add("22 standing hips over the ground at the end and at the start differ, mm", hips.value,
           at_most(10.0), kGroundNames + hips.where);
  return list.take();
}

}  // namespace gaitpad
