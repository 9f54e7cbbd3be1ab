// Assertions 18-20: figure 5b, an injured left leg.
#include <fmt/format.h>

#include <algorithm>

#include "paper/claims.h"

namespace gaitpad {
namespace {

constexpr const char* kSection = "4, figure 5b";
constexpr double kSteady_s = 3.5;                 // after the start
constexpr double kMidFrom = 0.25, kMidTo = 0.75;  // of a flight

double forward_m(const WalkFrame& frame, const vec3& v) {
  return glm::dot(v, heading_direction(frame.heading_rad));
}

struct FlightFigures {
  double ticks = 0.0, peak_m = 0.0;
  double reach_m = 0.0;      // the heel's way over the ground
  double clearance_m = 0.0;  // the toe's least height in mid-flight
  double step_m = 0.0;       // standing heel to landing heel
};

// Means over the steady flights of a foot.
FlightFigures flight_figures(const Walk& walk, Side side) {
  FlightFigures sum;
  int count = 0;
  for (const Ticks& f : flights(walk, side, kSteady_s)) {
    double peak = 0.0, clearance = 1e9;
    for (std::size_t k = f.begin; k < f.end; ++k) {
      const WalkFrame& frame = walk.samples[k].frame;
      const double u = static_cast<double>(k - f.begin) / static_cast<double>(f.count());
      peak = std::max(peak, frame.heel_m[side].y);
      if (u > kMidFrom && u < kMidTo) clearance = std::min(clearance, frame.toe_m[side].y);
    }
    const WalkFrame &lift = walk.samples[f.begin].frame, &land = walk.samples[f.end].frame;
    std::size_t stood = f.begin;  // where the other heel stood last
    while (stood > 0 && !walk.samples[stood].frame.heel_planted[other(side)]) --stood;
    sum.step_m +=
        forward_m(land, land.heel_m[side] - walk.samples[stood].frame.heel_m[other(side)]);
    sum.reach_m += forward_m(land, land.heel_m[side] - lift.heel_m[side]);
    sum.ticks += static_cast<double>(f.count());
    sum.peak_m += peak;
    sum.clearance_m += clearance;
    ++count;
  }
  const double n = count;
  return {sum.ticks / n, sum.peak_m / n, sum.reach_m / n, sum.clearance_m / n, sum.step_m / n};
}

double least_hips_speed(const Walk& walk) {
  double slowest = 1e9;
  for (std::size_t k = 1; k < walk.samples.size(); ++k) {
    if (static_cast<double>(k) < kSteady_s * kPaperRate_hz) continue;
    const WalkSample &a = walk.samples[k - 1], &b = walk.samples[k];
    slowest = std::min(slowest, forward_m(b.frame, b.hips_m - a.hips_m) * kPaperRate_hz);
  }
  return slowest;
}

}  // namespace

std::vector<Claim> limp_claims(const LimpWalks& walks, IkMode mode) {
  ClaimList list(kSection, mode);
  const FlightFigures even = flight_figures(*walks.even, kLeftSide),
                      even_right = flight_figures(*walks.even, kRightSide),
                      left = flight_figures(*walks.limp, kLeftSide),
                      right = flight_figures(*walks.limp, kRightSide);
  list.add("18 left heel's peak of the limp over even's", left.peak_m / even.peak_m,
           within(0.44, 0.56),
           fmt::format("{:.0f} against {:.0f} mm; the right one {:.0f} mm", 1e3 * left.peak_m,
                       1e3 * even.peak_m, 1e3 * right.peak_m));
  list.add("18 left step of the limp over its right step", left.step_m / right.step_m,
           within(0.49, 0.51), fmt::format("{:.3f} and {:.3f} m", left.step_m, right.step_m));
  list.add("18 ticks of the left flight off even's / 1.3", std::fabs(left.ticks - even.ticks / 1.3),
           at_most(1.0), fmt::format("{:.1f} against {:.1f} at 240 Hz", left.ticks, even.ticks));
  list.add("18 right step of the limp over even's", right.step_m / even_right.step_m,
           within(0.98, 1.02));
  list.add("18 right heel's peak of the limp over even's", right.peak_m / even_right.peak_m,
           within(0.98, 1.02),
           "beside a lame foot the hips are lower where the right heel leaves the floor, which is "
           "where its flight begins");
  list.add("19 left toe's clearance in mid-flight over the right one's",
           left.clearance_m / right.clearance_m, less_than(1.0),
           fmt::format("{:.0f} and {:.0f} mm{}", 1e3 * left.clearance_m, 1e3 * right.clearance_m,
                       mode == IkMode::paper ? "; in paper mode a flying toe has no goal" : ""));
  list.add("19 left heel's peak over the right one's", left.peak_m / right.peak_m, less_than(1.0),
           "the paper: \"the left-hand side trail barely skims the ground\"");
  list.add("19 right step over the left one", right.step_m / left.step_m, more_than(1.0));
  list.add(
      "19 ground that the right foot covers in a flight over the left's",
      right.reach_m / left.reach_m, more_than(1.01),
      "the paper: the right trail \"travels further per stride\"; in a straight walk both feet "
      "cover left + right step in every cycle, only the heel's lift-off place may differ");
  list.add("19 least forward speed of the limping hips, m/s", least_hips_speed(*walks.limp),
           more_than(0.0));
  return list.take();
}

std::vector<Claim> limp_weight_claims(const LimpWalks& walks, const Ticks& stride, IkMode mode) {
  ClaimList list(kSection, mode);
  const auto range = [&](const Walk* w, LegJoint j) {
    return joint_range(*w, stride, kLeftSide, j).size();
  };
  const double hip = range(walks.limp_hip, LegJoint::hip), red = range(walks.limp, LegJoint::hip);
  list.add("20 left hip's range of limp_left_hip over limp_left", hip / red, less_than(1.0),
           fmt::format("{:.2f} against {:.2f} deg; 3-D prototype: only 0.2 to 0.4 deg less with "
                       "the ends of a flight pinned to the plan",
                       hip, red));
  list.add("20 left knee's range of limp_left_knee over limp_left",
           range(walks.limp_knee, LegJoint::knee) / range(walks.limp, LegJoint::knee),
           less_than(1.0));
  double most = 0.0;
  for (const Walk* other : {walks.limp_hip, walks.limp_knee}) {
    for (std::size_t k = stride.begin; k < stride.end; ++k) {
      for (int j = 0; j < kLegDofs; ++j) {
        const double d = other->samples[k].angles_rad[kRightSide][j] -
                         walks.limp->samples[k].angles_rad[kRightSide][j];
        most = std::max(most, std::fabs(d) / kDegree);
      }
    }
  }
  list.add("20 right leg's angles change by, deg", most, at_most(1.0),
           "3-D prototype 0.06 (built-in and walk01) to 0.6 (m21)");
  return list.take();
}

}  // namespace gaitpad
