// Sticks of all kinds, drawn by number, and what the issue asks of what is found about them.
#pragma once
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "stick/made_stick.h"
#include "stick/statistics.h"

namespace gaitpad {

inline double step_of(const MadeStick& stick) {
  return stick.bits == 0 ? 0.0 : 2.0 / (std::exp2(stick.bits) - 1.0);
}
inline StickStatistics statistics_of(const MadeStick& stick, const StickTrack& track) {
  return stick_statistics(std::vector<StickTrack>{track}, vec2(step_of(stick)));
}
inline StickStatistics statistics_of(const MadeStick& stick) {
  return statistics_of(stick, made_track(stick));
}

inline std::string name_of(const MadeStick& s) {
  const auto text = [](double x) { return std::to_string(x); };
  return "seed " + text(s.seed) + ", " + text(s.bits) + " bits, sigma " + text(s.sigma.x) + " " +
         text(s.sigma.y) + ", hysteresis " + text(s.hysteresis) + ", " + text(s.rate_hz) +
         " Hz, jitter " + text(s.jitter_ms) + " ms, drops " + text(s.drop_chance) + ", spikes " +
         text(s.spike_chance) + (s.reports_changes_only ? ", changes only" : "");
}

// Sticks of all kinds, each drawn from its own seed.
class Draw {
 public:
  explicit Draw(std::uint32_t seed) : random_(seed) { stick_.seed = seed; }
  double within(double least, double most) {
    return least + (most - least) * static_cast<double>(random_()) / 4294967296.0;
  }
  bool chance(double share) { return within(0.0, 1.0) < share; }
  template <std::size_t kCount>
  double one_of(const std::array<double, kCount>& values) {
    return values[random_() % kCount];
  }
  MadeStick stick() {
    MadeStick& s = stick_;
    s.centre = vec2(within(-0.2, 0.2), within(-0.2, 0.2));
    s.bits = static_cast<int>(one_of(std::array{0.0, 8.0, 10.0, 12.0, 16.0}));
    const double sigma = chance(0.2) ? 0.0 : std::exp(within(std::log(5e-4), std::log(0.03)));
    s.sigma = vec2(sigma, sigma * within(0.5, 1.0));
    s.hysteresis = chance(0.5) ? 0.0 : within(0.01, 0.15);
    s.gate = std::array{Gate::circle, Gate::square, Gate::ellipse}[random_() % 3];
    s.reach_x = within(0.85, 1.0);
    s.reach_y = within(0.85, 1.0);
    s.rate_hz = one_of(std::array{66.0, 125.0, 250.0, 1000.0});
    s.jitter_ms = within(0.0, 0.2) * 1000.0 / s.rate_hz;
    s.drop_chance = chance(0.5) ? 0.0 : within(0.0, 0.05);
    s.spike_chance = chance(0.5) ? 0.0 : within(0.0, 0.002);
    s.reports_changes_only = chance(0.4);
    return s;
  }
  vec2 direction() {
    const double angle = within(-kPi, kPi);
    return {std::cos(angle), std::sin(angle)};
  }

 private:
  std::mt19937 random_;
  MadeStick stick_;
};

// The larger of a step and 4 sigma / sqrt(resting reports), with hysteresis a quarter of it.
// 1e-4 is as good as a 14-bit stick.
inline double centre_bound(const MadeStick& stick, const StickStatistics& s) {
  const double reports = std::max(s.rest_s * stick.rate_hz, 1.0);
  const double sigma = std::max(stick.sigma.x, stick.sigma.y);
  return std::max(
      {step_of(stick), 4.0 * sigma / std::sqrt(reports), 0.25 * stick.hysteresis, 1e-4});
}

inline void expect_centre(const MadeStick& stick, const StickStatistics& s, const vec2& truth) {
  ASSERT_TRUE(s.centre) << name_of(stick);
  const vec2 off = *s.centre - truth;
  EXPECT_LE(std::max(std::fabs(off.x), std::fabs(off.y)), centre_bound(stick, s)) << name_of(stick);
}

inline void let_go_from(MadeMoves& moves, double angle_rad, double rest_s = 0.6) {
  moves.push(angle_rad);
  moves.hold(0.1);
  moves.release();
  moves.rest(rest_s);
}

}  // namespace gaitpad
