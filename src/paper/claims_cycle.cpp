// Assertions 7, 8 and 30: the two-stage cycle of table I, its continuity and its endurance.
#include <fmt/format.h>

#include <algorithm>

#include "paper/claims.h"

namespace gaitpad {
namespace {

constexpr std::array<Side, 2> kSides = {kLeftSide, kRightSide};
constexpr double kPrintRate_hz = 60.0;  // the notes' bound on jumps is per frame of a screen

std::size_t first_tick(double after_s) { return static_cast<std::size_t>(after_s * kPaperRate_hz); }

// Stages in an order that table I does not know.
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

// Ticks whose planted points are not exactly those of table I.
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

// How far a planted point moves from where it stood at the stage's beginning, mm.
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

// The elevation of the heel-toe line over what it has when standing, least of all strikes, degrees.
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

// Change of a leg angle's rate from one stage's last tick to the next one's first, in degrees a
// frame at 60 Hz; the rates are those of neighbouring ticks.
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

// The greatest difference of two strides at equal phase, degrees, over all leg angles.
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
  return list.take();
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
      is_paper ? "the targets change from one point of the foot to the other without a fade" : "");
  return list.take();
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
    return list.take();
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
  return list.take();
}

}  // namespace gaitpad
