// Made recordings of sticks with known properties, which the analysis must find.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "stick/statistics.h"

namespace gaitpad {

// Random numbers that are the same with every library: the standard fixes its generators, but not
// its distributions.
class Chance {
 public:
  explicit Chance(std::uint32_t seed) : random_(seed) {}
  double within(double least, double most) {
    return least + (most - least) * static_cast<double>(random_()) / 4294967296.0;
  }
  double uniform() { return within(0.0, 1.0); }
  double normal() {  // a normally distributed number, by Box and Muller
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * kPi * uniform());
  }
  // Draws y first with every compiler; the arguments of a call would be evaluated in any order.
  vec2 normal_of_both() {
    const double y = normal();
    return {normal(), y};
  }
  vec2 within_of_both(double least, double most) {
    const double y = within(least, most);
    return {within(least, most), y};
  }
  std::size_t below(std::size_t count) { return random_() % count; }

 private:
  std::mt19937 random_;
};

// Square: half its side is `reach_x`, and the stick reaches the corners.
enum class Gate { circle, square, ellipse };

// The true properties of a stick. Positions are raw fractions under the thumb (+x right, +y
// forward); `frame` says how the pad reports them. Reports are clipped to -1..1.
struct MadeStick {
  vec2 centre{0.0};
  vec2 sigma{0.0};          // standard deviation of the Gaussian noise of each report
  double hysteresis = 0.0;  // the stick rests half of this towards the side of the release
  vec2 drift_per_s{0.0};    // drift of positions; `centre` is true half-way through
  double creep = 0.0;       // offset after a release; it decays with time constant 0.3 s
  double wander = 0.0;      // random walk of all positions: standard deviation after one second
  Gate gate = Gate::circle;
  double reach_x = 1.0, reach_y = 1.0;      // radii of the gate about `centre`; circle: reach_x
  int bits = 0;                             // bits of a position in -1..1; 0: not quantised
  double rate_hz = 250.0, jitter_ms = 0.0;  // standard deviation of the intervals
  double drop_chance = 0.0;                 // probability that a report is lost
  double spike_chance = 0.0;                // probability of 1 to `spike_reports` wrong reports
  int spike_reports = 3;
  // Faults. Their times are drawn from the seed.
  double roam = 0.0, roam_s = 1.0;  // moves without a touch: standard deviation and time constant
  double displaced = 0.0;           // distance from the usual rest after `displaced_times` releases
  int displaced_times = 0;          // number of such releases among the first 12
  int drop_outs = 0;                // number of lost contacts: an axis shows its end
  double drop_out_s = 0.04;         // time of a drop-out, times 0.5 to 1.5
  int freezes = 0;                  // number of times that one axis or both stand still
  double freeze_s = 0.2;
  int frozen_axes = 1;  // axes that stand still, as bits: 1 x, 2 y
  // Middle, width and reach of a sector that reaches less far.
  double weak_rad = 0.0, weak_width_rad = 0.0, weak_reach = 0;
  StickFrame frame;  // raw axes swapped and inverted: in_frame(frame, raw) is the truth
  bool reports_changes_only = false;
  std::uint32_t seed = 1;
};

// Radius of the gate about `centre` in a direction, without noise, limited to what reports can
// express.
inline double gate_radius(const MadeStick& stick, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  double radius = stick.reach_x;
  if (stick.gate == Gate::square) radius /= std::max(std::fabs(c), std::fabs(s));
  if (stick.gate == Gate::ellipse) radius = 1.0 / std::hypot(c / stick.reach_x, s / stick.reach_y);
  if (std::fabs(wrapped(angle_rad - stick.weak_rad)) < 0.5 * stick.weak_width_rad)
    radius = std::min(radius, stick.weak_reach);
  if (c != 0.0) radius = std::min(radius, ((c > 0.0 ? 1.0 : -1.0) - stick.centre.x) / c);
  if (s != 0.0) radius = std::min(radius, ((s > 0.0 ? 1.0 : -1.0) - stick.centre.y) / s);
  return radius;
}

// Circularity error (%) by its formula, from dense samples of the gate without noise.
inline double true_circularity_error(const MadeStick& stick) {
  std::array<double, 48> greatest{};
  for (int i = 0; i < 48000; ++i) {
    const double angle = 2.0 * kPi * i / 48000.0, radius = gate_radius(stick, angle);
    const double x = stick.centre.x + radius * std::cos(angle);
    const double y = stick.centre.y + radius * std::sin(angle);
    const double bin = std::round(std::atan2(y, x) / (2.0 * kPi) * 48.0);
    double& g = greatest[static_cast<std::size_t>(bin + 48.0) % 48];
    g = std::max(g, std::hypot(x, y));
  }
  double sum = 0.0, bins = 0.0;
  for (const double g : greatest) {
    if (g <= 0.2) continue;
    sum += (g - 1.0) * (g - 1.0);
    bins += 1.0;
  }
  return 100.0 * std::sqrt(sum / bins);
}

// Makes the positions of the stick, report by report, before noise, drift and rounding.
class MadeMoves {
 public:
  explicit MadeMoves(const MadeStick& stick) : stick_(stick), random_(stick.seed * 7919u + 1u) {
    // The side of the last release before the recording is random.
    home_ = home_after(random_.within(-kPi, kPi));
    at_ = home_;
  }
  const std::vector<vec2>& path() const { return path_; }

  void hold(double seconds) {
    for (int n = reports(seconds); n > 0; --n) path_.push_back(at_);
  }
  void rest(double seconds) {  // rests; call it after release()
    for (int k = 0, n = reports(seconds); k < n; ++k) {
      const double rest = creep_ * std::exp(-k / stick_.rate_hz / 0.3);
      path_.push_back(home_ + vec2(rest * std::cos(angle_), rest * std::sin(angle_)));
    }
    at_ = path_.empty() ? home_ : path_.back();
  }
  // Pushes to a fraction of the gate's radius in this direction.
  void push(double angle_rad, double seconds = 0.12, double fraction = 1.0) {
    angle_ = angle_rad;
    move(on_gate(angle_rad, fraction), seconds);
  }
  void release() {
    home_ = home_after(angle_);
    constexpr int kReleases = 12;
    const int left = kReleases - releases_++;
    if (left > 0 && random_.uniform() * left < stick_.displaced_times - displaced_) {
      ++displaced_;
      const double side = random_.within(-kPi, kPi);
      home_ += stick_.displaced * vec2(std::cos(side), std::sin(side));
    }
    creep_ = stick_.creep;
    move(home_ + vec2(creep_ * std::cos(angle_), creep_ * std::sin(angle_)), 0.05);
  }
  // Turns along the rim, counter-clockwise, as unevenly as a hand does.
  void turn(double turns, double seconds_a_turn = 1.5, double fraction = 1.0) {
    const double first = angle_, whole = 2.0 * kPi * turns;
    const int n = reports(turns * seconds_a_turn);
    for (int k = 1; k <= n; ++k) {
      const double u = whole * k / n;
      angle_ = first + u + 0.1 * std::sin(2.0 * u);
      path_.push_back(at_ = on_gate(angle_, fraction));
    }
  }
  void move(const vec2& to, double seconds) {
    const vec2 from = at_;
    const int n = reports(seconds);
    for (int k = 1; k <= n; ++k) {
      const double u = smoothstep(0.0, 1.0, static_cast<double>(k) / n);
      path_.push_back(from + (to - from) * u);
    }
    at_ = to;
  }

 private:
  int reports(double seconds) const {
    return static_cast<int>(std::lround(seconds * stick_.rate_hz));
  }
  vec2 on_gate(double angle_rad, double fraction) const {
    const double radius = fraction * gate_radius(stick_, angle_rad);
    return stick_.centre + vec2(radius * std::cos(angle_rad), radius * std::sin(angle_rad));
  }
  vec2 home_after(double angle_rad) const {
    const double away = 0.5 * stick_.hysteresis;
    return stick_.centre + vec2(away * std::cos(angle_rad), away * std::sin(angle_rad));
  }

  MadeStick stick_;
  Chance random_;
  int releases_ = 0, displaced_ = 0;
  std::vector<vec2> path_;
  vec2 home_{0.0}, at_{0.0};
  // Direction of the last push; the remaining creep after the last release.
  double angle_ = 0.0, creep_ = 0.0;
};

namespace made {

inline vec2 raw_of(const StickFrame& frame, const vec2& meant) {
  // The inverse of a turn or mirror is its transpose.
  const vec2 x = in_frame(frame, vec2(1.0, 0.0)), y = in_frame(frame, vec2(0.0, 1.0));
  return {x.x * meant.x + x.y * meant.y, y.x * meant.x + y.y * meant.y};
}

inline double quantised(double position, int bits) {
  const double clamped = std::clamp(position, -1.0, 1.0);
  if (bits <= 0) return clamped;
  const double half = 0.5 * (std::exp2(bits) - 1.0);  // 127.5
  return (std::round((clamped + 1.0) * half) - half) / half;
}

// An interval of reports in a path.
struct Stretch {
  std::size_t first = 0, last = 0;
};

// Intervals at random places that `fits` accepts, without overlaps; fewer if there is no room.
template <typename Fits>
std::vector<Stretch> stretches(Chance& random, std::size_t size, double rate_hz, int count,
                               double least_s, double most_s, const Fits& fits) {
  std::vector<Stretch> found;
  for (int tries = 0; tries < 10000 && static_cast<int>(found.size()) < count; ++tries) {
    const auto reports = static_cast<std::size_t>(
        std::max(std::lround(random.within(least_s, most_s) * rate_hz), 1L));
    if (size < reports + 2) break;
    const std::size_t first = 1 + random.below(size - reports - 1);
    const Stretch stretch{first, first + reports - 1};
    const std::size_t apart = reports + static_cast<std::size_t>(0.1 * rate_hz);
    const bool is_free = std::none_of(found.begin(), found.end(), [&](const Stretch& other) {
      return stretch.first < other.last + apart && other.first < stretch.last + apart;
    });
    if (is_free && fits(stretch)) found.push_back(stretch);
  }
  return found;
}

// Distance of each axis from its frozen value when it is free again.
inline vec2 behind(const std::vector<vec2>& path, const Stretch& s) {
  return glm::abs(path[std::min(s.last + 1, path.size() - 1)] - path[s.first - 1]);
}

}  // namespace made

// The path as the stick reports it.
inline StickTrack reported(const MadeStick& stick, std::vector<vec2> path) {
  Chance random(stick.seed), faults(stick.seed * 31u + 5u);
  const double interval_ns = 1e9 / stick.rate_hz;
  // A freeze is visible only if the axis moved on and another one moved as well.
  const auto freezes = made::stretches(
      faults, path.size(), stick.rate_hz, stick.freezes, stick.freeze_s, 1.3 * stick.freeze_s,
      [&](const made::Stretch& s) {
        const vec2 far = made::behind(path, s);
        if (stick.frozen_axes == 3)
          return std::min(glm::length(path[s.first - 1]), glm::length(path[s.last])) > 0.5 &&
                 glm::length(far) > 0.2;
        return (stick.frozen_axes == 1 ? far.x : far.y) > 0.15 &&
               (stick.frozen_axes == 1 ? far.y : far.x) > 0.15;
      });
  const auto drop_outs =
      made::stretches(faults, path.size(), stick.rate_hz, stick.drop_outs, 0.5 * stick.drop_out_s,
                      1.5 * stick.drop_out_s, [&](const made::Stretch& s) {
                        return glm::length(path[s.first]) < 0.6 && glm::length(path[s.last]) < 0.6;
                      });
  StickTrack track;
  vec2 walk(0.0), spike(0.0), frozen(0.0);
  vec2 roam = stick.roam * faults.normal_of_both();
  int spike_left = 0;
  for (std::size_t k = 0; k < path.size(); ++k) {
    const double n = static_cast<double>(k), middle = 0.5 * static_cast<double>(path.size() - 1);
    const double time_s = (n - middle) / stick.rate_hz;
    const double stride = stick.wander / std::sqrt(stick.rate_hz);
    walk += stride * random.normal_of_both();
    if (stick.roam > 0.0) {
      const double kept = std::exp(-1.0 / (stick.rate_hz * stick.roam_s));
      const double fresh = stick.roam * std::sqrt(1.0 - kept * kept);
      roam = kept * roam + fresh * faults.normal_of_both();
    }
    vec2 at =
        path[k] + stick.drift_per_s * time_s + walk + roam + stick.sigma * random.normal_of_both();
    // An interval is the difference of two time stamps, so each gets 1/sqrt(2) of the jitter.
    const double late_ns = stick.jitter_ms * 1e6 / std::sqrt(2.0) * random.normal();
    if (spike_left == 0 && random.uniform() < stick.spike_chance) {
      spike_left = 1 + static_cast<int>(stick.spike_reports * random.uniform());
      do {
        spike = random.within_of_both(-1.0, 1.0);
      } while (glm::length(spike - at) < 0.3);
    }
    if (spike_left > 0) {
      --spike_left;
      at = spike;
    }
    for (const made::Stretch& s : drop_outs) {
      if (k >= s.first && k <= s.last) at[s.first % 2] = s.first % 4 < 2 ? 1.0 : -1.0;
    }
    bool is_frozen = false;
    for (const made::Stretch& s : freezes) is_frozen |= k >= s.first && k <= s.last;
    for (int axis = 0; axis < 2; ++axis) {
      if (is_frozen && (stick.frozen_axes >> axis & 1) != 0) at[axis] = frozen[axis];
    }
    frozen = at;
    if (random.uniform() < stick.drop_chance) continue;
    const vec2 raw = made::raw_of(stick.frame, at);
    StickSample sample{
        static_cast<std::int64_t>(n * interval_ns + late_ns),
        vec2(made::quantised(raw.x, stick.bits), made::quantised(raw.y, stick.bits))};
    if (!track.empty()) {
      if (stick.reports_changes_only && sample.raw == track.back().raw) continue;
      sample.time_ns = std::max(sample.time_ns, track.back().time_ns);
    }
    track.push_back(sample);
  }
  return track;
}

// Makes the reports of a whole session: rest; `releases` pushes to the rim in different directions,
// each with a rest of `rest_s` after it; `turns` full circles of 1.5 s and a release; pushes
// forward, right, back and left, held for half a second, with a short rest after each.
inline StickTrack made_track(const MadeStick& stick, int releases = 8, double rest_s = 0.6,
                             double turns = 3.0) {
  MadeMoves moves(stick);
  moves.rest(rest_s);
  for (int k = 0; k < releases; ++k) {
    moves.push(2.0 * kPi * k / releases);
    moves.hold(0.1);
    moves.release();
    moves.rest(rest_s);
  }
  if (turns > 0.0) {
    moves.push(0.0);
    moves.turn(turns);
    moves.release();
    moves.rest(rest_s);
  }
  for (const double degrees : {90.0, 0.0, -90.0, 180.0}) {
    moves.push(degrees * kDegree, 0.15);
    moves.hold(0.5);
    moves.release();
    moves.rest(0.4);
  }
  return reported(stick, moves.path());
}

// Makes a guided session: 12 releases from random sides, the last rest longer; turns; the four
// pushes.
inline StickTrack made_session(const MadeStick& stick) {
  MadeMoves moves(stick);
  Chance hand(stick.seed * 17u + 3u);
  moves.rest(1.0);
  for (int k = 0; k < 12; ++k) {
    const double time_s = hand.within(0.08, 0.2);
    moves.push(2.0 * kPi * k / 12 + hand.within(-0.3, 0.3), time_s);
    moves.hold(hand.within(0.05, 0.3));
    moves.release();
    moves.rest(k == 11 ? 2.6 : hand.within(0.6, 1.0));
  }
  moves.push(hand.within(-kPi, kPi));
  moves.turn(3.0, hand.within(1.2, 2.0));
  moves.release();
  moves.rest(0.6);
  for (const double degrees : {90.0, 0.0, -90.0, 180.0}) {
    moves.push(degrees * kDegree, 0.15);
    moves.hold(0.5);
    moves.release();
    moves.rest(0.5);
  }
  return reported(stick, moves.path());
}

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

// Draws sticks of all kinds, each from its own seed.
class Draw {
 public:
  explicit Draw(std::uint32_t seed) : random_(seed) { stick_.seed = seed; }
  double within(double least, double most) { return random_.within(least, most); }
  bool chance(double share) { return within(0.0, 1.0) < share; }
  template <std::size_t kCount>
  double one_of(const std::array<double, kCount>& values) {
    return values[random_.below(kCount)];
  }
  MadeStick stick() {
    MadeStick& s = stick_;
    s.centre = random_.within_of_both(-0.2, 0.2);
    s.bits = static_cast<int>(one_of(std::array{0.0, 8.0, 10.0, 12.0, 16.0}));
    const double sigma = chance(0.2) ? 0.0 : std::exp(within(std::log(5e-4), std::log(0.03)));
    s.sigma = vec2(sigma, sigma * within(0.5, 1.0));
    s.hysteresis = chance(0.5) ? 0.0 : within(0.01, 0.15);
    s.gate = std::array{Gate::circle, Gate::square, Gate::ellipse}[random_.below(3)];
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
  Chance random_;
  MadeStick stick_;
};

// Allowed error of the centre: the largest of a step of the range, 4 sigma / sqrt(resting reports),
// a quarter of the hysteresis, and 1e-4, which is the resolution of a 14-bit stick.
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
