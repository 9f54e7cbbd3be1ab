#include "paper/flight_rules.h"

#include <algorithm>

#include "motion/leg_pose.h"

namespace gaitpad {
namespace {

struct Turn {
  int frame = 0;
  bool is_low = false;
};

// Sign changes of the gradient; a plateau is judged by the gradients before and after it.
std::vector<Turn> turns_of(const std::vector<double>& heights) {
  std::vector<Turn> turns;
  int direction = 0;
  for (std::size_t f = 1; f < heights.size(); ++f) {
    const double gradient = heights[f] - heights[f - 1];
    if (gradient == 0.0) continue;
    const int now = gradient > 0.0 ? 1 : -1;
    if (direction != 0 && now != direction) turns.push_back({static_cast<int>(f) - 1, now > 0});
    direction = now;
  }
  return turns;
}

// The pose in the sagittal plane: only flexions and the pelvis' tilt.
LegPose flat_pose(const GaitCycle& cycle, const CycleSample& at, Side side) {
  const vec3 ahead = at.pelvis * kForward;
  const double tilt = atan2(-ahead.y, std::sqrt(ahead.x * ahead.x + ahead.z * ahead.z));
  LegAngles angles = at.leg[side].angles;
  for (const int j : {kHipZ, kHipY, kAnkleZ, kAnkleY}) angles[j] = 0.0;
  return leg_pose(cycle.leg[side], vec3(0.0), rotation_x(tilt), angles, at.leg[side].toe_x);
}

double lowest_m(const LegPose& p) { return std::min({p.heel_m.y, p.toe_m.y, p.toe_end_m.y}); }

}  // namespace

std::optional<FlightTargets> flight_targets(const std::vector<double>& heights,
                                            const FlightRule& rule) {
  if (heights.size() < 3) return std::nullopt;
  const auto [low, high] = std::ranges::minmax(heights);
  const double band = kFlightBand * (high - low);
  std::vector<int> found;
  for (const Turn& turn : turns_of(heights)) {
    const double h = heights[static_cast<std::size_t>(turn.frame)];
    const bool in_band = !rule.has_bands || (turn.is_low ? h <= low + band : h >= high - band);
    if (!in_band) continue;
    if (rule.takes_last && found.size() == 1 && turn.is_low) found[0] = turn.frame;
    if (turn.is_low == (found.size() != 1)) found.push_back(turn.frame);
    if (found.size() == 3) return FlightTargets{found[0], found[1], found[2]};
  }
  return std::nullopt;
}

std::vector<double> stride_heights(const GaitCycle& cycle, Side side, FootPoint point,
                                   int samples_a_stride) {
  std::vector<double> heights;
  for (int i = 0; i <= 2 * samples_a_stride; ++i) {
    const double own = static_cast<double>(i) / samples_a_stride;
    const CycleSample sample = sample_at(cycle, own + cycle.strike[side]);
    const LegPose mine = flat_pose(cycle, sample, side),
                  rival = flat_pose(cycle, sample, other(side));
    const vec3& at = point == FootPoint::ankle  ? mine.ankle_m
                     : point == FootPoint::heel ? mine.heel_m
                                                : mine.toe_end_m;
    heights.push_back(at.y - std::min(lowest_m(mine), lowest_m(rival)));
  }
  return heights;
}

void add_standing_jitter(std::vector<double>& heights, int samples_a_stride) {
  constexpr double kFrom = 0.04, kTo = 0.40, kJitter_m = 0.004;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double own = static_cast<double>(i) / samples_a_stride;
    const double phase = own - std::floor(own);
    if (phase > kFrom && phase < kTo && i % 2 == 1) heights[i] += kJitter_m;
  }
}

std::vector<double> blip_curve(double blip_m) {
  constexpr double kPeak_m = 0.2, kHalf_m = 0.1;
  constexpr int kFrames = 50, kLift = 4, kPeak = 14, kStill = kBlipFrame - 1, kGo = kBlipFrame + 1,
                kLand = 40;
  std::vector<double> heights;
  for (int f = 0; f < kFrames; ++f) {
    double h = kPeak_m * smoothstep(kLift, kPeak, f);
    if (f < kLift) h = 0.001 * (kLift - f);
    if (f > kPeak) h = kPeak_m - kHalf_m * smoothstep(kPeak, kStill, f);
    if (f >= kStill) h = kHalf_m + (f > kStill ? blip_m : 0.0);
    if (f > kGo) h = (kHalf_m + blip_m) * (1.0 - smoothstep(kGo, kLand, f));
    if (f > kLand) h = 0.001 * (f - kLand);
    heights.push_back(h);
  }
  return heights;
}

}  // namespace gaitpad
