// Finds when feet strike the ground and leave it, in the frames of a file as well as in the samples
// of a closed stride.
//
// A foot *strikes* when its heel is down and still: at 0.3 m/s or less and at most 5 mm above where
// it then rests. Its *toe is off* when it begins to leave: when it last was at 0.2 m/s before it
// swings. (A toe that pushes creeps by 10 to 30 mm in most captures, so its distance is no
// criterion.) Both are found between samples. Lengths and speeds are those of an adult
// (kReferenceLeg_m); they scale with the leg. If the feet of a capture slide so far that a toe
// would leave before the other heel has struck, the limits of these two events grow together, at
// most to kMostSlide times.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "gaitpad/motion.h"
#include "gaitpad/result.h"

namespace gaitpad {

inline constexpr double kMostSlide = 4.0;  // factor: a heel 20 mm up or at 1.2 m/s does not stand

struct FootTrack {  // places of a foot's points over the ground, y up
  std::vector<vec3> ankle_m, heel_m, toe_m;
  std::vector<vec3> knee_m, toe_joint_m;  // of a motion only
};
struct SampleRange {  // the samples [first, last], which contain no jump
  int first, last;
};
struct FeetTracks {
  std::array<FootTrack, 2> foot;  // tracks by Side
  std::vector<SampleRange> ranges;
  // Place of the pelvis, and direction that the hips face, unwrapped; of a motion only.
  std::vector<vec3> pelvis_m;
  std::vector<double> heading_rad;
  double sample_s = 0.0, leg_m = 0.0;  // thigh + shank, mean of both sides
};

// One swing of a foot from its toe-off to its strike.
struct FootSwing {
  Side side = kLeftSide;
  int range = 0;  // index of the swing's range in FeetTracks::ranges
  // Events in samples, with fractions; none if the range cuts the swing there.
  std::optional<double> toe_off, strike;
  // The samples where the ankle's speed rises and falls through the limit of moving. These agree
  // best between strides, because they do not depend on how the foot touches the ground.
  std::optional<double> moves_from, moves_to;
};

// The tracks of a motion's feet. Heels are measured in frames with flat feet: behind the ankle, at
// the height of the sole.
FeetTracks feet_tracks(const Motion& motion);

// A foot swings while its ankle moves along the ground faster than this share of the usual fast
// speed (the 95th percentile of both ankles'). The second share finds slow steps in a motion that
// also has quick ones: try it if the first finds nothing.
inline constexpr std::array<double, 2> kMovingShares = {0.30, 0.18};

// All swings in order of time. A swing that is not cut by its range lasts 0.15 to 1.8 s and covers
// 0.15 to 2.6 leg lengths.
std::vector<FootSwing> foot_swings(const FeetTracks& tracks, double moving_share);

// Events of one periodic stride as phases 0 .. 1 from its first sample on.
struct StrideEvents {
  std::array<double, 2> strike{}, toe_off{};  // phases by Side
};
// `stride` holds one periodic stride in which the feet travel by `travel_m`. Error (it does not
// name the file) if a foot has no swing, or if the events are not in the order of a walk: right
// strike, left toe-off, left strike, right toe-off.
Result<StrideEvents> stride_events(const FeetTracks& stride, const vec3& travel_m);

}  // namespace gaitpad
