// The built-in adult, and legs given as angles in the plane of travel. The procedural and the
// key-framed walks are built from both.
#pragma once
#include "gaitpad/curve.h"
#include "gaitpad/gait_cycle.h"
#include "motion/leg_pose.h"

namespace gaitpad {

// Skeleton and leg models: bones in Drillis and Contini's fractions of the stature, arms hanging,
// every joint's standing rotation identity.
GaitCycle procedural_body();

// Segment rotations about x in the travel frame (+ turns the lower end backwards), toe against
// foot.
struct SagittalLeg {
  double thigh, shank, foot, toe;
};

// Angles and toe of the right leg below the pelvis of `body`. The leg's plane is tilted about the
// line of travel so that the ankle stays `track_m` beside the middle line. The knee's hinge stays
// across the line of travel; the foot points ahead and never rolls.
LegSample right_leg_in_plane(const LegModel& model, const CycleSample& body,
                             const SagittalLeg& plane, double track_m);

LegSample mirrored(const LegSample& leg);  // Mirrors the angles and the toe.
// Height of the foot's lowest point above its height at rest.
double foot_clearance(const GaitCycle& cycle, int side, const CycleSample& at);

// The mean and the lowest harmonics of a periodic curve.
template <std::size_t kCount>
std::array<double, kCount> smoothed(const std::array<double, kCount>& curve, int harmonics) {
  const auto wave = [](int k, std::size_t i) { return sin_cos(2.0 * kPi * k * i / kCount); };
  std::array<double, kCount> out{};
  for (int k = 0; k <= harmonics; ++k) {
    double a = 0.0, b = 0.0;
    for (std::size_t i = 0; i < kCount; ++i) {
      a += curve[i] * wave(k, i).cos;
      b += curve[i] * wave(k, i).sin;
    }
    const double share = (k == 0 ? 1.0 : 2.0) / kCount;
    for (std::size_t i = 0; i < kCount; ++i)
      out[i] += share * (a * wave(k, i).cos + b * wave(k, i).sin);
  }
  return out;
}

// Heights of the pelvis with which the lower foot stands on the floor, as many as samples are asked
// for, smoothed to the lowest harmonics.
template <std::size_t kCount>
std::array<double, kCount> heights_on_lower_foot(const GaitCycle& cycle, int harmonics) {
  std::array<double, kCount> height;
  for (std::size_t i = 0; i < kCount; ++i) {
    const CycleSample& at = cycle.samples[i];
    height[i] = -std::min(foot_clearance(cycle, 0, at), foot_clearance(cycle, 1, at));
  }
  return smoothed(height, harmonics);
}

}  // namespace gaitpad
