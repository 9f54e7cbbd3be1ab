// The worst generated stick is measured, calibrated as advised, and then drives a walk.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "session/made_session.h"
#include "stick/made_stick.h"
#include "stick/pad_analysis.h"

namespace gaitpad {
namespace {

constexpr int kCounts = 255;

MadeStick worst_stick(std::uint32_t seed) {
  MadeStick stick;
  stick.seed = seed;
  const double away = static_cast<double>(seed) * 2.4;  // a different direction for each seed
  stick.centre = vec2(0.15 * std::cos(away), 0.15 * std::sin(away));
  stick.sigma = vec2(0.02);
  stick.hysteresis = 0.1;
  stick.gate = Gate::ellipse;
  stick.reach_x = 0.8;
  stick.reach_y = 0.7;
  stick.bits = 8;
  return stick;
}

StickCalibration calibrated(const MadeStick& stick) {
  const StickTrack track = made_track(stick);
  const vec2 step(2.0 / kCounts);
  const StickAdvice advice = stick_advice(stick_statistics(std::span(&track, 1), step), {});
  EXPECT_EQ(advice.verdict, Verdict::worn) << advice.reason;
  return advice.calibration;
}

// Reports a stick's position with noise and rounding.
class Reported {
 public:
  explicit Reported(const MadeStick& stick) : stick_(stick), random_(stick.seed + 100) {}
  vec2 at(const vec2& place) {
    return {made::quantised(place.x + stick_.sigma.x * normal_(random_), stick_.bits),
            made::quantised(place.y + stick_.sigma.y * normal_(random_), stick_.bits)};
  }
  vec2 at_gate(double angle_rad) {
    const double radius = gate_radius(stick_, angle_rad);
    return at(stick_.centre + radius * vec2(std::cos(angle_rad), std::sin(angle_rad)));
  }

 private:
  MadeStick stick_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
};

Report report_of(const vec2& raw) {
  const double half = 0.5 * kCounts;
  return made_report(static_cast<int>(std::lround(half + half * raw.x)),
                     static_cast<int>(std::lround(half - half * raw.y)));
}

Simulation simulation_with(const StickCalibration& calibration) {
  SimulationConfig config = made_config(1);
  config.pads[0].calibration.left = calibration;
  return made_simulation(config);
}

struct Straightness {
  int strides = 0;
  double drift_m = 0.0;    // mean sideways way of a stride
  double longest_m = 0.0;  // largest sideways way of a stride
  double stride_m = 0.0;   // length of the last stride
};
// Walks `ticks` ticks with one report each. A stride lasts from one strike of the left heel to the
// next.
template <typename Raw>
Straightness straightness(const StickCalibration& calibration, int ticks, const Raw& raw) {
  Simulation simulation = simulation_with(calibration);
  Straightness found;
  double first_m = 0.0, last_m = 0.0;
  bool is_begun = false;
  for (int tick = 0; tick < ticks; ++tick) {
    simulation.step(std::vector<Report>{report_of(raw(tick))});
    const WalkState& state = simulation.walkers()[0].state;
    if (!simulation.heel_struck() || walk_steps(state).swing != kLeftSide) continue;
    const double at_m = state.root.place_m.x;
    if (is_begun) {
      ++found.strides;
      found.longest_m = std::max(found.longest_m, std::fabs(at_m - last_m));
    } else {
      first_m = at_m;
    }
    is_begun = true;
    last_m = at_m;
  }
  found.drift_m = std::fabs(last_m - first_m) / std::max(found.strides, 1);
  found.stride_m = walk_frame(simulation.walkers()[0]).stride_m[kLeftSide];
  return found;
}

constexpr std::uint32_t kSeeds = 5;  // seeds, each with a centre that is off in another direction

TEST(WornStick, WalksStraightWithTheFullStride) {
  StickCalibration ideal;
  const Straightness best = straightness(ideal, 9600, [](int) { return vec2(0.0, 1.0); });
  ASSERT_GE(best.strides, 30);
  double longest_m = 0.0, drift_m = 0.0, stride = 1.0;
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    const MadeStick stick = worst_stick(seed);
    const StickCalibration calibration = calibrated(stick);
    Reported reported(stick);
    // The thumb holds the stick forward; the worn spring shifts it sideways by up to half of the
    // hysteresis.
    const Straightness found = straightness(calibration, 9600, [&](int tick) {
      const double astray = 0.5 * stick.hysteresis * std::sin(0.002 * tick);
      return reported.at(stick.centre + vec2(astray, gate_radius(stick, 0.5 * kPi)));
    });
    EXPECT_GE(found.strides, 30);
    EXPECT_LE(found.drift_m, 0.001) << "seed " << seed;
    EXPECT_LE(found.longest_m, 0.001) << "seed " << seed;
    // Sideways noise reduces the forward part by its cosine.
    EXPECT_GE(found.stride_m, 0.999 * best.stride_m) << "seed " << seed;
    longest_m = std::max(longest_m, found.longest_m);
    drift_m = std::max(drift_m, found.drift_m);
    stride = std::min(stride, found.stride_m / best.stride_m);
  }
  std::printf(
      "worst of %u sticks: %.2f mm sideways in one stride, %.2f mm on average, stride %.4f\n",
      kSeeds, 1e3 * longest_m, 1e3 * drift_m, stride);
}

TEST(WornStick, WalksInCurvesWithoutItsCalibration) {
  const MadeStick stick = worst_stick(1);
  Reported reported(stick);
  const Straightness found =
      straightness({}, 4800, [&](int) { return reported.at_gate(0.5 * kPi); });
  EXPECT_GT(found.longest_m, 0.01);
}

}  // namespace
}  // namespace gaitpad
