#include "gaitpad/flight.h"

#include <algorithm>
#include <cmath>

#include "base/numeric.h"
#include "gaitpad/motion.h"

namespace gaitpad {
namespace {

// A foot in the air moves fast along the ground, a standing foot hardly. So a swing is a run of
// frames in which the ankle's smoothed horizontal speed is above a share of its usual fast speed;
// from there its ends are followed to where the speed is low. Heights are used unsmoothed, for the
// highest point and for the moment in which the heel begins to rise.

constexpr double kJump_legs_s = 12.0;  // faster than any foot: the data jump
constexpr double kSmooth_s = 0.020, kMaxSmoothFrames = 20.0;
constexpr double kMovingShare = 0.30;  // of the usual fast speed
constexpr double kEdgeShare = 0.20;    // of a swing's greatest speed: lift and land
constexpr double kMinSwing_s = 0.15, kMaxSwing_s = 1.8;
constexpr double kMinSwing_legs = 0.25, kMaxSwing_legs = 2.6;
constexpr double kMaxGap_s = 0.06;   // a shorter rest does not end a swing
constexpr double kEnd_s = 0.035;     // a swing so near to an end of the file may be cut
constexpr double kHeelOff_s = 0.6;   // how long before the lift the heel may rise
constexpr double kLoop_legs = 0.12;  // the joints of a loop's first and last pose are this near
constexpr double kBand = 0.10;       // of the range of heights, the paper's 10 %

struct Track {
  std::vector<vec3> ankle_m;         // smoothed, within stretches without a jump
  std::vector<double> height_m;      // of the ankle, as in the file
  std::vector<double> speed_m_s;     // of ankle_m, horizontal
  std::vector<bool> jump_before;     // the frame does not continue the one before it
  double low_m = 0.0, high_m = 0.0;  // of height_m
  double frame_s = 0.0, leg_m = 0.0;
  int frames() const { return static_cast<int>(ankle_m.size()); }
  int count(double time_s) const { return static_cast<int>(time_s / frame_s + 0.5); }
};

// exp(-x^2/2) for |x| <= 3 by (1 - x^2/2n)^n: no libm, so the same frames everywhere.
double bell(double x) {
  double y = 1.0 - x * x / 128.0;
  for (int i = 0; i < 6; ++i) y *= y;
  return y;
}

// Gaussian mean over the frame's own stretch.
std::vector<vec3> smoothed(const std::vector<vec3>& raw, const std::vector<bool>& jump_before,
                           double sigma_frames) {
  const int n = static_cast<int>(raw.size());
  const int reach = static_cast<int>(3.0 * sigma_frames);
  std::vector<vec3> out(raw);
  for (int f = 0; f < n; ++f) {
    double weight = 1.0;
    for (int step = -1; step <= 1; step += 2) {
      for (int d = 1; d <= reach; ++d) {
        const int g = f + step * d;
        if (g < 0 || g >= n || jump_before[step > 0 ? g : g + 1]) break;
        const double w = bell(d / sigma_frames);
        out[f] += w * raw[g];
        weight += w;
      }
    }
    out[f] /= weight;
  }
  return out;
}

std::vector<double> speeds(const Track& t) {
  std::vector<double> out(t.ankle_m.size(), 0.0);
  const int n = t.frames();
  for (int f = 0; f < n; ++f) {
    const int a = f > 0 && !t.jump_before[f] ? f - 1 : f;
    const int b = f + 1 < n && !t.jump_before[f + 1] ? f + 1 : f;
    if (a < b) out[f] = horizontal_length(t.ankle_m[b] - t.ankle_m[a]) / ((b - a) * t.frame_s);
  }
  return out;
}

// The ankle's track over `copies` of the clip in a row, each moved on by the pelvis' travel over
// one.
Track track_of(const Motion& motion, Side side, int copies) {
  const std::array<int, 2> joints = {motion.legs[side].ankle, motion.pelvis};
  const auto tracks = joint_tracks_m(motion, joints);
  vec3 travel = tracks[1].back() - tracks[1].front();
  travel.y = 0.0;
  Track t;
  t.frame_s = motion.frame_time_s;
  t.leg_m = leg_length_m(motion);
  std::vector<vec3> raw;
  const double limit = kJump_legs_s * t.leg_m * t.frame_s;
  for (int copy = 0; copy < copies; ++copy) {
    // A loop's last frame is its first one again.
    for (std::size_t f = copy > 0 ? 1 : 0; f < tracks[0].size(); ++f) {
      raw.push_back(tracks[0][f] + static_cast<double>(copy) * travel);
      const bool is_jump = f > 0 && (glm::distance(tracks[0][f], tracks[0][f - 1]) > limit ||
                                     glm::distance(tracks[1][f], tracks[1][f - 1]) > limit);
      t.jump_before.push_back(is_jump);
    }
  }
  for (const vec3& p : raw) t.height_m.push_back(p.y);
  const auto [low, high] = std::ranges::minmax_element(t.height_m);
  t.low_m = *low;
  t.high_m = *high;
  t.ankle_m = smoothed(raw, t.jump_before, std::min(kSmooth_s / t.frame_s, kMaxSmoothFrames));
  t.speed_m_s = speeds(t);
  return t;
}

// The 95th percentile of all speeds that a foot can have.
double usual_fast_speed(const Track& t) {
  std::vector<double> sane;
  for (const double v : t.speed_m_s) {
    if (v < kJump_legs_s * t.leg_m) sane.push_back(v);
  }
  return sane.empty() ? 0.0 : percentile(std::move(sane), 95);
}

struct Run {
  int first, last;  // both moving
};

std::vector<Run> moving_runs(const Track& t, double threshold_m_s) {
  std::vector<Run> runs;
  for (int f = 0; f < t.frames(); ++f) {
    if (!(t.speed_m_s[f] > threshold_m_s)) continue;
    const bool is_joined = !runs.empty() && (f - runs.back().last - 1) * t.frame_s < kMaxGap_s;
    if (is_joined)
      runs.back().last = f;
    else
      runs.push_back({f, f});
  }
  return runs;
}

// True for a run that is whole and as long as a step.
bool is_swing(const Track& t, const Run& run) {
  if (run.first == 0 || run.last + 1 >= t.frames()) return false;
  for (int f = run.first; f <= run.last + 1; ++f) {
    if (t.jump_before[f]) return false;
  }
  const double time_s = (run.last - run.first + 1) * t.frame_s;
  const double legs = horizontal_length(t.ankle_m[run.last] - t.ankle_m[run.first]) / t.leg_m;
  return time_s >= kMinSwing_s && time_s <= kMaxSwing_s && legs >= kMinSwing_legs &&
         legs <= kMaxSwing_legs;
}

// The frame of the lift (`step` -1) or the landing (+1): from the run's end outwards or inwards to
// where the speed crosses kEdgeShare of its greatest. Where the foot does not become that slow, its
// slowest frame before `stop`.
int edge(const Track& t, const Run& run, int step, int stop) {
  double fastest = 0.0;
  for (int f = run.first; f <= run.last; ++f) fastest = std::max(fastest, t.speed_m_s[f]);
  const double level = kEdgeShare * fastest;
  int f = step < 0 ? run.first : run.last;
  while (t.speed_m_s[f] < level) f -= step;  // ends at the fastest frame at the latest
  int slowest = f;
  for (; f != stop && !t.jump_before[f]; f += step) {
    if (t.speed_m_s[f] < level) return f;
    if (t.speed_m_s[f] < t.speed_m_s[slowest]) slowest = f;
  }
  return slowest;
}

// The frame in which the heel begins to rise: backwards from the lift, but not beyond `stop`, the
// ankle's first low within the band; where there is none, its lowest frame. Heights are not
// smoothed: a standing ankle's lows are a fraction of a millimetre deep.
int heel_off_frame(const Track& t, int lift, int stop) {
  const double limit_m = t.low_m + kBand * (t.high_m - t.low_m);
  const int first = std::max(stop, lift - t.count(kHeelOff_s));
  int lowest = lift;
  for (int f = lift - 1; f >= first && !t.jump_before[f + 1]; --f) {
    const double y = t.height_m[f];
    if (y < t.height_m[lowest]) lowest = f;
    const bool is_low = f > 0 && y <= t.height_m[f - 1] && y < t.height_m[f + 1];
    if (is_low && y <= limit_m) return f;
  }
  return lowest;
}

std::vector<Swing> swings_in(const Track& t) {
  std::vector<Swing> found;
  const std::vector<Run> runs = moving_runs(t, kMovingShare * usual_fast_speed(t));
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (!is_swing(t, runs[i])) continue;
    const int before = i > 0 ? runs[i - 1].last : 0;
    const int after = i + 1 < runs.size() ? runs[i + 1].first : t.frames() - 1;
    Swing s;
    s.lift = edge(t, runs[i], -1, before);
    s.land = edge(t, runs[i], 1, after);
    const int margin = t.count(kEnd_s);
    if (s.lift < margin || s.land + margin >= t.frames()) continue;
    s.peak = s.lift;
    for (int f = s.lift; f <= s.land; ++f) {
      if (t.height_m[f] > t.height_m[s.peak]) s.peak = f;
    }
    s.heel_off = heel_off_frame(t, s.lift, before);
    found.push_back(s);
  }
  return found;
}

// True if the first and the last pose agree in all joints' places relative to the pelvis.
bool is_loop(const Motion& motion) {
  if (motion.frames.size() < 3) return false;
  std::vector<JointFrames> ends(2);
  forward_kinematics(motion, motion.frames.front(), ends[0]);
  forward_kinematics(motion, motion.frames.back(), ends[1]);
  const double limit = kLoop_legs * leg_length_m(motion);
  for (std::size_t j = 0; j < motion.skeleton.joints.size(); ++j) {
    std::array<vec3, 2> at;
    for (int i = 0; i < 2; ++i) at[i] = ends[i].position_m[j] - ends[i].position_m[motion.pelvis];
    if (glm::distance(at[0], at[1]) > limit) return false;
  }
  return true;
}

}  // namespace

std::vector<Swing> swings(const Motion& motion, Side side) {
  if (motion.frames.size() < 3) return {};
  std::vector<Swing> found = swings_in(track_of(motion, side, 1));
  if (!found.empty() || !is_loop(motion)) return found;
  found = swings_in(track_of(motion, side, 2));
  const int frames = static_cast<int>(motion.frames.size());
  std::erase_if(found, [&](const Swing& s) { return s.lift >= frames; });
  return found;
}

std::optional<Swing> robust_flight(const Motion& motion, Side side) {
  const std::vector<Swing> all = swings(motion, side);
  if (all.empty()) return std::nullopt;
  const Track t = track_of(motion, side, 2);
  std::vector<double> times, lengths;
  for (const Swing& s : all) {
    times.push_back(s.land - s.lift);
    lengths.push_back(horizontal_length(t.ankle_m[s.land] - t.ankle_m[s.lift]));
  }
  const double time = median(times), length = median(lengths);
  std::size_t best = 0;
  double least = 1e300;
  for (std::size_t i = 0; i < all.size(); ++i) {
    double off = std::abs(times[i] / time - 1.0) + std::abs(lengths[i] / length - 1.0);
    const bool begins_before = all[i].heel_off < 1 || t.jump_before[all[i].heel_off] ||
                               all[i].heel_off == all[i].lift;  // its stance is cut
    if (begins_before) off += 1.0;
    if (off < least) {
      least = off;
      best = i;
    }
  }
  return all[best];
}

std::optional<Swing> paper_flight(const std::vector<double>& heights) {
  if (heights.size() < 3) return std::nullopt;
  const auto [low, high] = std::ranges::minmax(heights);
  const double band = kBand * (high - low);
  std::array<int, 3> target{};
  int found = 0, direction = 0;  // sign of the last gradient that was not 0
  for (std::size_t f = 1; f < heights.size() && found < 3; ++f) {
    const double gradient = heights[f] - heights[f - 1];
    if (gradient == 0.0) continue;
    const int now = gradient > 0.0 ? 1 : -1;
    const double turn_m = heights[f - 1];
    const bool is_target = found == 1 ? direction > 0 && now < 0 && turn_m >= high - band
                                      : direction < 0 && now > 0 && turn_m <= low + band;
    if (is_target) target[found++] = static_cast<int>(f) - 1;
    direction = now;
  }
  if (found < 3) return std::nullopt;
  return Swing{.heel_off = target[0], .lift = target[0], .peak = target[1], .land = target[2]};
}

std::optional<Swing> paper_flight(const Motion& motion, Side side) {
  const std::array<int, 1> joints = {motion.legs[side].ankle};
  const auto tracks = joint_tracks_m(motion, joints);
  std::vector<double> heights;
  for (const vec3& p : tracks[0]) heights.push_back(p.y);
  return paper_flight(heights);
}

}  // namespace gaitpad
