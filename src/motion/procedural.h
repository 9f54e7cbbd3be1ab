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

// Heights of the pelvis with which the lower foot stands on the floor in the first `samples` ones,
// smoothed to the lowest harmonics.
std::vector<double> heights_on_lower_foot(const GaitCycle& cycle, int samples, int harmonics);

}  // namespace gaitpad
