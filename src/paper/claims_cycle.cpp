// Assertions 7, 8 and 30: the two-stage cycle of table I, its continuity and its endurance.

#include <fmt/format.h>

#include <algorithm>

#include "paper/claims.h"
#include "paper/study.h"

namespace gaitpad {
namespace {

constexpr std::array<Side, 2> kSides = {kLeftSide, kRightSide};
// The display's frame rate for which the paper states its bound on jumps.
constexpr double kPrintRate_hz = 60.0;

std::size_t first_tick(double after_s) { return static_cast<std::size_t>(after_s * kPaperRate_hz); }

// Counts transitions between stages that table I does not have.
int disorder(const Walk& walk) {
  int wrong = 0;
  for (std::size_t k = 1; k < walk.samples.size(); ++k) {
    const WalkFrame &a = walk.samples[k - 1].frame, &b = walk.samples[k].frame;
    if (a.stage == b.stage && (a.swing == b.swing || a.stage == Stage::idle)) continue;
    const bool lands = a.stage == Stage::flight && b.stage == Stage::roll && a.swing == b.swing;
    const bool lifts = a.stage == Stage::roll && b.stage == Stage::flight && a.swing != b.swing;
    const bool starts = a.stage == Stage::idle && b.stage == Stage::roll;
    const bool stops = a.stage == Stage::roll && b.stage == Stage::idle;
    wrong += !(lands || lifts || starts || stops);
  }
  return wrong;
}

// Counts ticks whose planted points differ from table I.
int unlike_table_1(const Walk& walk) {
  int wrong = 0;
  for (const WalkSample& sample : walk.samples) {
    const WalkFrame& f = sample.frame;
    for (const Side side : kSides) {
      const bool swings = f.swing == side, idle = f.stage == Stage::idle;
      const bool heel = idle || (f.stage == Stage::roll && swings), toe = idle || !swings;
      wrong += f.heel_planted[side] != heel || f.toe_planted[side] != toe;
    }
  }
  return wrong;
}

// Largest distance of a planted point from its place at the start of the stage, mm.
struct Drift {
  double flight_mm = 0.0, roll_mm = 0.0, roll_rise_mm = 0.0;
};
Drift planted_drift(const Walk& walk, std::size_t from) {
  Drift drift;
  std::size_t begin = from;
  std::array<double, 2> lowest{};
  for (std::size_t k = from; k < walk.samples.size(); ++k) {
    const WalkFrame& f = walk.samples[k].frame;
    const WalkFrame& before = walk.samples[k > 0 ? k - 1 : 0].frame;
    if (k == from || before.stage != f.stage || before.swing != f.swing) {
      begin = k;
      lowest = {f.toe_m[0].y, f.toe_m[1].y};
    }
    const WalkFrame& start = walk.samples[begin].frame;
    const Side stand = other(f.swing);
    const double toe = 1e3 * glm::distance(f.toe_m[stand], start.toe_m[stand]);
    if (f.stage == Stage::flight) drift.flight_mm = std::max(drift.flight_mm, toe);
    if (f.stage != Stage::roll) continue;
    const double heel = 1e3 * glm::distance(f.heel_m[f.swing], start.heel_m[f.swing]);
    drift.roll_mm = std::max({drift.roll_mm, toe, heel});
    const double y = f.toe_m[f.swing].y;
    drift.roll_rise_mm = std::max(drift.roll_rise_mm, 1e3 * (y - lowest[f.swing]));
    lowest[f.swing] = std::min(lowest[f.swing], y);
  }
  return drift;
}

double hips_speed(const Walk& walk, std::size_t k) {
  const vec3 move = walk.samples[k].frame.pelvis_m - walk.samples[k - 1].frame.pelvis_m;
  return glm::dot(move, heading_direction(walk.samples[k].frame.heading_rad)) * kPaperRate_hz;
}

// Smallest elevation of the heel-toe line at a strike, relative to standing, degrees.
double least_strike_deg(const Walk& walk, const FootBuild& build, std::size_t from) {
  double least = 1e9;
  for (const Side side : kSides) {
    for (const Ticks& stride : strides(walk, side)) {
      if (stride.begin < from) continue;
      const WalkFrame& f = walk.samples[stride.begin].frame;
      const vec3 line = f.toe_m[side] - f.heel_m[side];
      const double level = std::sqrt(line.x * line.x + line.z * line.z);
      const double rest = atan2(build.toe_rest_m[side], level);
      least = std::min(least, (atan2(line.y, level) - rest) / kDegree);
    }
  }
  return least;
}

// Largest change of a leg angle's rate at a border between stages, in degrees per frame at 60 Hz,
// from differences of neighbouring ticks.
double worst_border(const Walk& walk, std::size_t from) {
  double worst = 0.0;
  const double per_frame = kPaperRate_hz / kPrintRate_hz / kDegree;
  for (std::size_t k = std::max<std::size_t>(from, 2); k + 1 < walk.samples.size(); ++k) {
    if (walk.samples[k].frame.stage == walk.samples[k - 1].frame.stage) continue;
    for (const Side side : kSides) {
      for (int j = 0; j < kLegDofs; ++j) {
        for (const std::size_t at : {k - 1, k}) {
          const double rate_before =
              walk.samples[at].angles_rad[side][j] - walk.samples[at - 1].angles_rad[side][j];
          const double rate =
              walk.samples[at + 1].angles_rad[side][j] - walk.samples[at].angles_rad[side][j];
          worst = std::max(worst, std::fabs(rate - rate_before) * per_frame);
        }
      }
    }
  }
  return worst;
}

// Largest difference of two strides at equal phase over all leg angles, degrees.
double stride_difference(const Walk& walk, const Ticks& a, const Ticks& b) {
  double most = 0.0;
  constexpr int kPhases = 200;
  const auto angle = [&walk](const Ticks& s, double share, Side side, int j) {
    const double at = share * static_cast<double>(s.count());
    const auto k = s.begin + static_cast<std::size_t>(at);
    const double t = at - std::floor(at);
    return mix(walk.samples[k].angles_rad[side][j], walk.samples[k + 1].angles_rad[side][j], t);
  };
  for (int i = 0; i < kPhases; ++i) {
    const double share = static_cast<double>(i) / kPhases;
    for (const Side side : kSides) {
      for (int j = 0; j < kLegDofs; ++j) {
        const double d = angle(a, share, side, j) - angle(b, share, side, j);
        most = std::max(most, std::fabs(d) / kDegree);
      }
    }
  }
  return most;
}

// Assertion 24: walking straight or in a turn.

// Deflections of the stick in the walk and in the turn.
constexpr double kForwardStick = 0.6, kHalf = 0.5;
// A strike takes the hips' acceleration from phases, and a step of 130 ticks makes 0.01 mm of what
// the float of a phase has lost, 6e-8.
constexpr double kMirrored_m = 2e-5;
constexpr std::array<double, 3> kSideways = {0.25, kHalf, 0.8};
constexpr double kTurning_s = 4.0;  // time after the start from which the turn is steady

Walk turning(const WalkModel& model, IkMode mode, double x, double end_s) {
  WalkCase what;
  what.model = &model;
  what.ik = mode;
  what.stick = {{0.5, vec2(x, kForwardStick)}};
  what.end_s = end_s;
  return walked(what);
}

// Largest sideways drift of the hips in a stride, mm.
double straight_drift_mm(const Walk& walk) {
  double worst = 0.0;
  for (const Ticks& s : strides(walk, kRightSide)) {
    const vec3 move = walk.samples[s.end].hips_m - walk.samples[s.begin].hips_m;
    worst = std::max(worst, 1e3 * std::fabs(move.x));
  }
  return worst;
}

// Largest distance of heels, toes and pelvis from the other walk's mirror image.
double mirror_gap_m(const Walk& a, const Walk& b) {
  double most = 0.0;
  const auto gap = [&most](const vec3& p, vec3 q) {
    q.x = -q.x;
    most = std::max(most, glm::distance(p, q));
  };
  for (std::size_t k = 0; k < std::min(a.samples.size(), b.samples.size()); ++k) {
    const WalkFrame &f = a.samples[k].frame, &g = b.samples[k].frame;
    gap(f.pelvis_m, g.pelvis_m);
    for (const Side side : {kLeftSide, kRightSide}) {
      gap(f.heel_m[side], g.heel_m[other(side)]);
      gap(f.toe_m[side], g.toe_m[other(side)]);
    }
  }
  return most;
}

struct Circle {
  double radius_error = kNoNumber;  // error of the path's radius relative to speed / turn rate
  double closes_m = kNoNumber;
};
Circle circle_of(const Walk& walk) {
  const auto begin = static_cast<std::size_t>(kTurning_s * kPaperRate_hz);
  const double from = walk.samples[begin].frame.heading_rad;
  vec3 sum(0.0);
  std::size_t end = begin;
  while (end < walk.samples.size() &&
         std::fabs(walk.samples[end].frame.heading_rad - from) < 2.0 * kPi) {
    sum += walk.samples[end++].hips_m;
  }
  if (end == walk.samples.size()) return {};
  const double n = static_cast<double>(end - begin);
  const vec3 centre = sum / n;
  double radius = 0.0, rate = 0.0, speed = 0.0;
  for (std::size_t k = begin; k < end; ++k) {
    radius += glm::distance(walk.samples[k].hips_m, centre) / n;
    rate += std::fabs(walk.samples[k].frame.turn_rate_rad_s) / n;
    speed += walk.samples[k].frame.speed_m_s / n;
  }
  const double gap = glm::distance(walk.samples[end].hips_m, walk.samples[begin].hips_m);
  return {std::fabs(radius * rate / speed - 1.0), gap};
}

void circle_claims(const Walk& walk, ClaimList& list) {
  const Circle circle = circle_of(walk);
  list.add("24 radius of a circle off speed over turn rate, %", 100.0 * circle.radius_error,
           at_most(2.0), "path of the hips");
  list.add("24 circle closes within, mm", 1e3 * circle.closes_m, at_most(50.0));
}

// Assertion 22: uneven ground, "including climbing and descending steps".

constexpr double kStick = 0.5, kEnd_s = 20.0, kStop_s = 17.0;
constexpr double kGrade = 0.176;                   // rise / run of the slope: 10 degrees
constexpr double kRise_m = 0.17, kTread_m = 0.28;  // height and depth of a stair
constexpr int kStairs = 8;
constexpr double kSoleHalf_m = 0.045;  // half the width of a sole on the reference leg

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

// Depth of a place in the ground: the shortest distance out of it, upwards or through a riser.
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

// Depth of the sole in the ground, from the pose by forward kinematics.
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

struct GroundWalk {
  double planted_mm = 0.0, sunk_mm = 0.0, hips_mm = 0.0, failed = 0.0;
  double way_m = 0.0;
};

double off_ground_m(const Terrain& terrain, const vec3& p, double rest_m) {
  const Ground ground = ground_at(terrain, p.x, p.z);
  return std::fabs((p.y - ground.height_m) * ground.normal.y - rest_m);
}

GroundWalk ground_walk_of(const WalkModel& model, IkMode mode) {
  GroundWalk found;
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
    const WalkFrame f = walk_frame(model, state, pose);
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
  void keep_if_worse(double v, const char* name) {
    if (v > value) value = v, where = name;
  }
  std::string text() const {
    return "flat, 10 deg up and down, 8 stairs of 17 / 28 cm up and down; worst: " + where;
  }
};

}  // namespace

FootBuild foot_build(const WalkModel& model) {
  return {{model.leg[kLeftSide].model.toe_rest_m, model.leg[kRightSide].model.toe_rest_m}};
}

std::vector<Claim> table_1_claims(const Walk& walk, double after_s, IkMode mode) {
  ClaimList list("3.3.1, table I, figure 3", mode);
  const Drift drift = planted_drift(walk, first_tick(after_s));
  list.add("7 stages out of order", disorder(walk), equal_to(0));
  list.add("7 ticks whose planted points are not table I's", unlike_table_1(walk), equal_to(0));
  list.add("7 support toe moves in stage a, mm", drift.flight_mm, at_most(0.1));
  list.add("7 landed heel and support toe move in stage b, mm", drift.roll_mm, at_most(0.1));
  list.add("7 landing toe rises in stage b by, mm", drift.roll_rise_mm, at_most(0.1));
  return list.take_claims();
}

std::vector<Claim> continuity_claims(const Walk& walk, const FootBuild& build, double after_s,
                                     IkMode mode) {
  ClaimList list("3.3.1", mode);
  const std::size_t from = std::max<std::size_t>(first_tick(after_s), 1);
  double slowest = 1e9, depth = 0.0;
  for (std::size_t k = from; k < walk.samples.size(); ++k) {
    const WalkFrame& f = walk.samples[k].frame;
    slowest = std::min(slowest, hips_speed(walk, k));
    for (const Side side : kSides) {
      depth = std::max({depth, -f.heel_m[side].y, build.toe_rest_m[side] - f.toe_m[side].y});
    }
  }
  const bool is_paper = mode == IkMode::paper;
  list.add("8 least forward speed of the hips, m/s", slowest, more_than(0.0),
           "table I: \"hips move forward\" in both stages");
  list.add("8 heel or toe below its height of rest, mm", 1e3 * depth, less_than(1.0),
           is_paper
               ? "paper mode places one point of the flying foot; the other end goes where the "
                 "even step takes it"
               : "");
  list.add("8 foot's pitch at the heel's strike, deg", least_strike_deg(walk, build, from),
           more_than(5.0),
           is_paper ? "the toe of a flying foot is nobody's target in paper mode" : "");
  list.add(
      "8 jump of a leg angle's rate at a stage's border, deg per 1/60 s", worst_border(walk, from),
      less_than(3.0),
      is_paper ? "a goal begins where its end of the foot is, but not at that end's rate" : "");
  return list.take_claims();
}

std::vector<Claim> endurance_claims(const Walk& long_walk, IkMode mode) {
  ClaimList list("3.3.2", mode);
  const std::vector<Ticks> all = strides(long_walk, kRightSide);
  const char* why = mode == IkMode::paper ? "warm starts and no pull to the data: what no target "
                                            "holds drifts; planar prototype: the "
                                            "knee by 21 to 23 deg in 20 strides"
                                          : "";
  if (all.size() < 201) {
    list.add_untested("30 strides 10 and 200 differ at equal phase, deg", at_most(0.1),
                      "fewer than 201 strides");
    return list.take_claims();
  }
  const Ticks &tenth = all[9], &last = all[199];
  list.add("30 strides 10 and 200 differ at equal phase, deg",
           stride_difference(long_walk, tenth, last), at_most(0.1), why);
  double knee = 0.0;
  for (const Side side : kSides) {
    const Range a = joint_range(long_walk, tenth, side, LegJoint::knee),
                b = joint_range(long_walk, last, side, LegJoint::knee);
    knee = std::max({knee, std::fabs(a.min - b.min), std::fabs(a.max - b.max)});
  }
  list.add("30 knee's extremes drift from stride 10 to 200, deg", knee, at_most(2.0), why);
  return list.take_claims();
}

std::vector<Claim> turn_claims(const Study& study, IkMode mode) {
  ClaimList list("3.3.1", mode);
  const WalkModel& model = study.model();
  list.add("24 sideways drift without sideways stick, mm a stride",
           straight_drift_mm(turning(model, mode, 0.0, 9.0)), at_most(0.1));
  int wrong = 0, falls = 0;
  double slide = 0.0, mirror = 0.0;
  std::string text;
  for (const double sign : {-1.0, 1.0}) {
    double before = 0.0;
    for (const double x : kSideways) {
      const Walk walk = turning(model, mode, sign * x, 6.0);
      const double heading = walk.samples.back().frame.heading_rad;
      wrong += !(heading * sign < 0.0);
      falls += !(std::fabs(heading) > before);
      before = std::fabs(heading);
      slide = std::max(slide, planted_slide_mm(walk));
      text +=
          fmt::format("{}{:+.2f}: {:+.0f}", text.empty() ? "" : ", ", sign * x, heading / kDegree);
      if (sign > 0.0 && x == kHalf) mirror = mirror_gap_m(walk, turning(model, mode, -x, 6.0));
    }
  }
  list.add("24 sideways sticks that turn the wrong way", wrong, equal_to(0),
           "heading after 6 s, deg: " + text);
  list.add("24 larger sideways sticks that turn less", falls, equal_to(0));
  list.add("24 planted feet slide in turns by, mm", slide, at_most(0.1));
  if (study.source().is_adult) {
    list.add("24 mirrored stick off the mirrored walk, m", mirror, at_most(kMirrored_m),
             mode == IkMode::paper
                 ? "a solve ends within 0.01 mm of its goal, somewhere, and the next begins there"
                 : "a tick counts in floats: phases of the right foot's half of the cycle are "
                   "rounded more finely than those of the left one's");
  } else {
    list.add_untested("24 mirrored stick off the mirrored walk, m", at_most(kMirrored_m),
                      "a captured walk is not symmetric");
  }
  circle_claims(turning(model, mode, kHalf, 20.0), list);
  return list.take_claims();
}

std::vector<Claim> terrain_claims(const Study& study, IkMode mode) {
  ClaimList list("3.3", mode);
  Worst planted, sunk, hips, failed, short_of;
  for (const Ground22& ground : kGrounds) {
    const auto terrain = terrain_of(ground);
    if (!terrain) continue;
    WalkModel model = study.model();
    model.terrain = std::make_shared<const Terrain>(*terrain);
    const GroundWalk f = ground_walk_of(model, mode);
    planted.keep_if_worse(f.planted_mm, ground.name);
    sunk.keep_if_worse(f.sunk_mm, ground.name);
    hips.keep_if_worse(f.hips_mm, ground.name);
    failed.keep_if_worse(f.failed, ground.name);
    short_of.keep_if_worse(std::max(0.0, length_m(*terrain) - f.way_m), ground.name);
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
  return list.take_claims();
}

}  // namespace gaitpad
