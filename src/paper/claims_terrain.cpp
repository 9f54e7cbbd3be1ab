// Assertion 22: uneven ground, "including climbing and descending steps".
#include <fmt/format.h>

#include <algorithm>

#include "paper/claims.h"

namespace gaitpad {
namespace {

constexpr double kStick = 0.5, kEnd_s = 20.0, kStop_s = 17.0;
constexpr double kGrade = 0.176;                   // 10 degrees
constexpr double kRise_m = 0.17, kTread_m = 0.28;  // of a stair
constexpr int kStairs = 8;
constexpr double kSoleHalf_m = 0.045;  // of the reference leg

struct Ground22 {
  const char* name;
  SectionShape shape;
};
const std::array<Ground22, 5> kGrounds = {
    Ground22{"flat", FlatSection{8.0}}, Ground22{"10 deg up", SlopeSection{6.0, kGrade, 0.5}},
    Ground22{"10 deg down", SlopeSection{6.0, -kGrade, 0.5}},
    Ground22{"stairs up", StairsSection{kRise_m, kTread_m, kStairs}},
    Ground22{"stairs down", StairsSection{-kRise_m, kTread_m, kStairs}}};

// Two metres of flat ground, then the shape.
std::optional<Terrain> terrain_of(const Ground22& ground) {
  Terrain terrain;
  terrain.name = ground.name;
  for (const SectionShape& shape : {SectionShape(FlatSection{2.0}), ground.shape}) {
    if (add_section(terrain, shape)) return std::nullopt;
  }
  return terrain;
}

// How deep a place is in the ground: the shorter way out, up or through a riser's face.
double depth_m(const Terrain& terrain, const vec3& p) {
  const double up = ground_at(terrain, p.x, p.z).height_m - p.y;
  if (up <= 0.0) return 0.0;
  const Stretch piece = piece_at(terrain, p.z);
  double out = up;
  if (ground_at(terrain, p.x, piece.from_m - 1e-6).height_m <= p.y) {
    out = std::min(out, p.z - piece.from_m);
  }
  if (ground_at(terrain, p.x, piece.to_m + 1e-6).height_m <= p.y) {
    out = std::min(out, piece.to_m - p.z);
  }
  return out;
}

// The whole sole, from forward kinematics of the pose.
double sunk_m(const WalkModel& model, const JointFrames& frames, Side side) {
  const LegModel& leg = model.leg[side].model;
  const LegJoints& joints = leg.joints;
  const quat foot = frames.rotation[joints.ankle] * glm::inverse(leg.standing[2]);
  const bool has_toe = !model.cycle.skeleton.joints[joints.toe].is_end_site;
  const quat toes = has_toe ? frames.rotation[joints.toe] * glm::inverse(leg.standing[3]) : foot;
  const vec3 heel = frames.position_m[joints.ankle] + foot * leg.heel_m,
             toe = frames.position_m[joints.toe];
  const vec3 ball = toe + foot * vec3(0.0, -leg.toe_rest_m, 0.0),
             tip = toe + toes * (leg.toe_end_m - vec3(0.0, leg.toe_end_rest_m, 0.0));
  const vec3 across = foot * model.leg[side].side * (kSoleHalf_m * model.size);
  double most = 0.0;
  for (int i = 0; i <= 8; ++i) {
    const vec3 at =
        i <= 5 ? heel + (ball - heel) * (i / 5.0) : ball + (tip - ball) * ((i - 5) / 3.0);
    for (const double c : {-1.0, 0.0, 1.0}) {
      most = std::max(most, depth_m(*model.terrain, at + across * c));
    }
  }
  return most;
}

struct Footing {
  double planted_mm = 0.0, sunk_mm = 0.0, hips_mm = 0.0, failed = 0.0;
  double way_m = 0.0;
};

double off_ground_m(const Terrain& terrain, const vec3& p, double rest_m) {
  const Ground ground = ground_at(terrain, p.x, p.z);
  return std::fabs((p.y - ground.height_m) * ground.normal.y - rest_m);
}

Footing footing_of(const WalkModel& model, IkMode mode) {
  Footing found;
  const Terrain& terrain = *model.terrain;
  const FootBuild build = foot_build(model);
  WalkCase what;
  what.model = &model;
  what.ik = mode;
  what.stick = {{0.5, vec2(0.0, kStick)}, {kStop_s, vec2(0.0)}};
  what.end_s = kEnd_s;
  JointFrames frames;
  int failed = 0;
  const Walk walk = walked(what, [&](const WalkState& state, const Pose& pose) {
    forward_kinematics(model.cycle.skeleton, pose, frames);
    const WalkFrame& f = state.frame;
    for (const Side side : {kLeftSide, kRightSide}) {
      const double heel = off_ground_m(terrain, f.heel_m[side], 0.0),
                   toe = off_ground_m(terrain, f.toe_m[side], build.toe_rest_m[side]);
      if (f.heel_planted[side]) found.planted_mm = std::max(found.planted_mm, 1e3 * heel);
      if (f.toe_planted[side]) found.planted_mm = std::max(found.planted_mm, 1e3 * toe);
      found.sunk_mm = std::max(found.sunk_mm, 1e3 * sunk_m(model, frames, side));
      failed += f.ik_failed[side];
    }
  });
  const vec3 from = walk.samples.front().frame.pelvis_m, to = walk.samples.back().frame.pelvis_m;
  const auto above = [&terrain](const vec3& p) {
    return p.y - ground_at(terrain, p.x, p.z).height_m;
  };
  found.hips_mm = 1e3 * std::fabs(above(to) - above(from));
  found.failed = failed / (2.0 * static_cast<double>(walk.samples.size()));
  found.way_m = to.z - from.z;
  return found;
}

struct Worst {
  double value = -1.0;
  std::string where;
  void take(double v, const char* name) {
    if (v > value) value = v, where = name;
  }
  std::string text() const {
    return "flat, 10 deg up and down, 8 stairs of 17 / 28 cm up and down; worst: " + where;
  }
};

}  // namespace

std::vector<Claim> terrain_claims(const Study& study, IkMode mode) {
  ClaimList list("3.3", mode);
  Worst planted, sunk, hips, failed, short_of;
  for (const Ground22& ground : kGrounds) {
    const auto terrain = terrain_of(ground);
    if (!terrain) continue;
    WalkModel model = study.model();
    model.terrain = std::make_shared<const Terrain>(*terrain);
    const Footing f = footing_of(model, mode);
    planted.take(f.planted_mm, ground.name);
    sunk.take(f.sunk_mm, ground.name);
    hips.take(f.hips_mm, ground.name);
    failed.take(f.failed, ground.name);
    short_of.take(std::max(0.0, length_m(*terrain) - f.way_m), ground.name);
  }
  list.add("22 planted heels and toes off the ground, mm", planted.value, at_most(5.0),
           planted.text());
  list.add(
      "22 soles below the ground, mm", sunk.value, at_most(5.0),
      sunk.text() + (mode == IkMode::paper
                         ? "; in paper mode a flying foot has one point that keeps off the ground"
                         : ""));
  list.add("22 solves that miss their tolerance, share", failed.value, at_most(0.01),
           failed.text());
  list.add("22 ground left to walk after 20 s, m", short_of.value, equal_to(0), short_of.text());
  list.add("22 standing hips' height over the ground changes by, mm", hips.value, at_most(10.0),
           hips.text());
  return list.take();
}

}  // namespace gaitpad
