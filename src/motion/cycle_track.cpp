#include "motion/cycle_track.h"

#include <memory>

#include "motion/tracks.h"

namespace gaitpad {
namespace {

constexpr double kFastestLegsPerSecond =
    14.0;  // a sprinter's foot; a jump to another take is faster

// Across the hips from right to left, turned to the front.
double hips_heading(const vec3& left_hip, const vec3& right_hip) {
  return heading_of(glm::cross(left_hip - right_hip, kUp));
}

}  // namespace

BodyTrack body_track(const Motion& motion) {
  BodyTrack track;
  const auto world = std::make_unique<JointFrames>();
  for (const MotionFrame& frame : motion.frames) {
    forward_kinematics(motion, frame, *world);
    const auto& at = world->position_m;
    track.pelvis_m.push_back(at[motion.pelvis]);
    for (int side = 0; side < 2; ++side) {
      const LegJoints& joints = motion.legs[side];
      LegTrack& leg = track.leg[side];
      leg.hip_m.push_back(at[joints.hip]);
      leg.knee_m.push_back(at[joints.knee]);
      leg.ankle_m.push_back(at[joints.ankle]);
      leg.toe_m.push_back(at[joints.toe]);
    }
    double heading =
        hips_heading(track.leg[kLeftSide].hip_m.back(), track.leg[kRightSide].hip_m.back());
    if (!track.heading_rad.empty()) {
      heading = track.heading_rad.back() + wrapped(heading - track.heading_rad.back());
    }
    track.heading_rad.push_back(heading);
  }
  track.leg_m = leg_length_m(motion);
  return track;
}

std::vector<FrameRange> unbroken_ranges(const BodyTrack& track, double frame_time_s) {
  const double most_m = kFastestLegsPerSecond * track.leg_m * frame_time_s;
  const int frames = static_cast<int>(track.pelvis_m.size());
  const auto moves_far = [&](const std::vector<vec3>& p, int f) {
    return !(glm::distance(p[f], p[f - 1]) <= most_m);
  };
  std::vector<FrameRange> ranges;
  int first = 0;
  for (int f = 1; f <= frames; ++f) {
    const bool breaks = f == frames || moves_far(track.pelvis_m, f) ||
                        moves_far(track.leg[0].ankle_m, f) || moves_far(track.leg[1].ankle_m, f);
    if (!breaks) continue;
    if (f - first >= 2) ranges.push_back({first, f - 1});
    first = f;
  }
  return ranges;
}

}  // namespace gaitpad
