#include "gaitpad/gait_cycle.h"

#include <algorithm>
#include <cassert>

#include "base/text.h"
#include "motion/captured_cycle.h"
#include "motion/gait_events.h"
#include "motion/leg_pose.h"
#include "motion/stencil.h"

namespace gaitpad {
namespace {

// --- Reading a cycle at any phase ----------------------------------------------------------------

// The rotation between four samples; `rotation(i)` is that of sample i. Neighbouring samples differ
// by a few degrees, so it is enough to blend the components and to normalize.
template <class RotationOf>
quat blended(const Stencil& s, const RotationOf& rotation) noexcept {
  const quat& second = rotation(s.index[1]);
  quat sum = second * s.weight[1];
  for (const int k : {0, 2, 3}) sum = sum + nearer(rotation(s.index[k]), second) * s.weight[k];
  return glm::normalize(sum);
}

}  // namespace

CycleSample sample_at(const GaitCycle& cycle, double phase) noexcept {
  const Stencil s = stencil_at(phase);
  const std::vector<CycleSample>& samples = cycle.samples;
  CycleSample out;
  out.pelvis = blended(s, [&](int i) -> const quat& { return samples[i].pelvis; });
  for (int k = 0; k < 4; ++k) out.pelvis_m += samples[s.index[k]].pelvis_m * s.weight[k];
  for (int side = 0; side < 2; ++side) {
    LegSample& leg = out.leg[side];
    leg.foot = blended(s, [&](int i) -> const quat& { return samples[i].leg[side].foot; });
    for (int k = 0; k < 4; ++k) {
      const LegSample& from = samples[s.index[k]].leg[side];
      for (int d = 0; d < kLegDofs; ++d) leg.angles[d] += from.angles[d] * s.weight[k];
      leg.toe_x += from.toe_x * s.weight[k];
      leg.ankle_m += from.ankle_m * s.weight[k];
    }
  }
  return out;
}

void sample_local(const GaitCycle& cycle, double phase, Pose& pose) noexcept {
  const Stencil s = stencil_at(phase);
  const int joints = static_cast<int>(cycle.standing_local.size());
  assert(joints <= kMaxJoints);
  pose.joint_count = joints;
  for (int j = 0; j < joints; ++j)
    pose.local[j] =
        blended(s, [&](int i) -> const quat& { return cycle.local[std::size_t(i) * joints + j]; });
}

namespace {

// --- Building a cycle from a motion --------------------------------------------------------------

// Least cosine of the angle between the hips' front and the travel.
constexpr double kBackwards = 0.5;
// Share of the stride within which the toe is down after a strike.
constexpr double kLongestFlat = 0.35;
// Share of the stride with both feet in the air; more is a run.
constexpr double kMostFlight = 0.02;
// Greatest slide of a standing foot; dragging gaits reach half of it.
constexpr double kMostSlide_legs = 0.25;
constexpr double kStill_legs_s = 0.6;  // leg lengths a second: 0.5 m/s for an adult
constexpr double kInAir_legs = 0.024;  // 20 mm of an adult's leg: captured floors are that uneven

// A foot point's track over the samples, in the travel frame.
std::vector<vec3> foot_track(const GaitCycle& cycle, int side, const vec3 LegPose::*point) {
  std::vector<vec3> track;
  for (const CycleSample& at : cycle.samples) track.push_back(pose_of(cycle, side, at).*point);
  return track;
}

// Tracks of both feet over the ground.
FeetTracks feet_tracks(const GaitCycle& cycle) {
  FeetTracks tracks;
  tracks.sample_s = cycle.duration_s / kCycleSamples;
  tracks.leg_m = mean_leg_m(cycle);
  for (int side = 0; side < 2; ++side) {
    const auto over_ground = [&](const vec3 LegPose::*point) {
      std::vector<vec3> track = foot_track(cycle, side, point);
      for (int i = 0; i < kCycleSamples; ++i)
        track[i] += kForward * (cycle.stride_m * i / kCycleSamples);
      return track;
    };
    FootTrack& foot = tracks.foot[side];
    foot.ankle_m = over_ground(&LegPose::ankle_m);
    foot.heel_m = over_ground(&LegPose::heel_m);
    foot.toe_m = over_ground(&LegPose::toe_m);
  }
  return tracks;
}

// Measures step lengths and tracks from the heels' places while the feet stand flat.
void measure_steps(const CapturedCycle& captured, GaitCycle& cycle) {
  std::array<double, 2> place_m;
  for (int side = 0; side < 2; ++side) {
    const int middle = flat_foot(captured, side).middle;
    const vec3 heel_m =
        mean_around(foot_track(cycle, side, &LegPose::heel_m), middle, FlatFoot::reach);
    const double phase =
        cycle.strike[side] + fraction(double(middle) / kCycleSamples - cycle.strike[side]);
    place_m[side] = heel_m.z + phase * cycle.stride_m;
    cycle.track_m[side] = heel_m.x;
  }
  cycle.step_m[kLeftSide] = place_m[kLeftSide] - place_m[kRightSide];
  cycle.step_m[kRightSide] = cycle.stride_m - cycle.step_m[kLeftSide];
}

// In the data a toe often leaves before the other foot is flat; in Table I it leaves when the other
// toe is down. So toe-off is delayed until the toe has moved, in the data, a third of the height
// that the other toe still has to sink: both feet share the change.
void wait_for_other_toe(GaitCycle& cycle) {
  constexpr double kLeavingCosts = 3.0, kLongestWait = 0.08;
  const double step = 0.5 / kCycleSamples;  // half a sample's share of the stride
  const std::array<double, 2> off = cycle.toe_off;
  for (const Side side : {kLeftSide, kRightSide}) {
    const Side lands = other(side);
    const auto toe_at = [&](Side foot, double phase) {
      vec3 toe = pose_of(cycle, foot, sample_at(cycle, phase)).toe_m;
      toe.z += cycle.stride_m * phase;
      return toe;
    };
    double lowest_m = 1e9;
    for (double after = 0.0; after < kLongestFlat; after += step)
      lowest_m = std::min(lowest_m, toe_at(lands, cycle.strike[lands] + after).y);
    const vec3 stood = toe_at(side, off[side]);
    double wait = 0.0;
    while (wait < kLongestWait &&
           kLeavingCosts * glm::distance(toe_at(side, off[side] + wait), stood) <
               toe_at(lands, off[side] + wait).y - lowest_m)
      wait += step;
    cycle.toe_off[side] = fraction(off[side] + wait);
  }
}

// Share of the stride in which both feet are in the air: every point of the foot is higher than in
// stance and moves (a floor may be uneven, so height alone is not enough).
double flight_share(const CapturedCycle& captured, const GaitCycle& cycle) {
  const double air_m = kInAir_legs * mean_leg_m(cycle),
               still_m_s = kStill_legs_s * mean_leg_m(cycle);
  std::array<int, kCycleSamples> in_air{};
  for (int side = 0; side < 2; ++side) {
    const int flat = flat_foot(captured, side).middle;
    std::array<bool, kCycleSamples> flies;
    flies.fill(true);
    for (const auto point : {&LegPose::heel_m, &LegPose::toe_m, &LegPose::toe_end_m}) {
      const std::vector<vec3> track = foot_track(cycle, side, point);
      const std::vector<double> speed = ground_speed(captured, track);
      const double standing_m = mean_around(track, flat, FlatFoot::reach).y;
      for (int i = 0; i < kCycleSamples; ++i) {
        flies[i] = flies[i] && track[i].y - standing_m > air_m && speed[i] > still_m_s;
      }
    }
    for (int i = 0; i < kCycleSamples; ++i) in_air[i] += flies[i];
  }
  return double(std::count(in_air.begin(), in_air.end(), 2)) / kCycleSamples;
}

// Distance that the toe slides between foot flat and toe-off.
double slide_m(const CapturedCycle& captured, const GaitCycle& cycle, Side side) {
  const std::vector<vec3> toe = foot_track(cycle, side, &LegPose::toe_m);
  const int flat = flat_foot(captured, side).middle;
  const double stood = fraction(cycle.toe_off[side] - double(flat) / kCycleSamples);
  const int off = wrapped_index(flat + static_cast<int>(stood * kCycleSamples));
  return horizontal_length(toe[off] - toe[flat] + kForward * (stood * cycle.stride_m));
}

// Walk ratio: step length over cadence, in metres per (step/min).
double walk_ratio_m_min(const GaitCycle& cycle) {
  return 0.5 * cycle.stride_m * cycle.duration_s / 120.0;
}

// The end of an error sentence if no person walks at this pace, which hints at a wrong frame time;
// otherwise empty. Limits for an adult's leg, which scale with the leg's length and its root: 3
// m/s, 200 steps a minute, and a walk ratio (step length over cadence) of 1.5 cm per step/min.
// Adults have 0.6 at all speeds, captures of slow long steps up to 1.
std::string why_no_pace(const GaitCycle& cycle) {
  constexpr double kFastest_m_s = 3.0, kMostSteps_min = 200.0, kMostRatio_m_min = 0.015,
                   kRunsFrom_min = 140.0;
  const double legs = mean_leg_m(cycle) / kReferenceLeg_m, root = std::sqrt(legs);
  const double speed_m_s = cycle.stride_m / cycle.duration_s;
  const double steps_min = 120.0 / cycle.duration_s;
  if (speed_m_s <= kFastest_m_s * root && steps_min <= kMostSteps_min / root &&
      walk_ratio_m_min(cycle) <= kMostRatio_m_min * legs * root) {
    return "";
  }
  const bool may_run = speed_m_s > kFastest_m_s * root && steps_min >= kRunsFrom_min / root;
  return "nobody walks at " + fixed(speed_m_s, 2) + " m/s with " + fixed(steps_min, 0) +
         " steps a minute: " + (may_run ? "it is a run, or " : "") + "if the file's " +
         fixed(cycle.frames / cycle.duration_s, 0) +
         " frames a second are wrong, give frame_rate_hz";
}

// In a step-to limp one foot only comes up to the other. The walk divides by step lengths, so the
// shorter step becomes at least a tenth of the stride; both feet move equally for that. With less,
// joints reach 2000 degrees/s in a backward turn; with a tenth, 500.
// A foot that stays farther behind the other is no walk. Both are shares of the stride.
constexpr double kLeastStep = 0.1;
void lengthen_short_step(GaitCycle& cycle) {
  for (const Side side : {kLeftSide, kRightSide}) {
    const double least_m = kLeastStep * cycle.stride_m;
    if (cycle.step_m[side] >= least_m) continue;
    cycle.step_m[side] = least_m;
    cycle.step_m[other(side)] = cycle.stride_m - least_m;
  }
}

// The end of an error sentence; empty if the cycle is a walk.
std::string why_no_walk(const CapturedCycle& captured, const GaitCycle& cycle) {
  for (const Side side : {kLeftSide, kRightSide}) {
    const double slides_m = slide_m(captured, cycle, side);
    if (slides_m > kMostSlide_legs * mean_leg_m(cycle)) {
      return std::string("holds no walk: the ") + kSideNames[side] + " foot slides " +
             fixed(slides_m, 2) + " m while it should stand";
    }
    if (!(cycle.step_m[side] >= -kLeastStep * cycle.stride_m))
      return "holds no walk: one foot stays " + fixed(-cycle.step_m[side], 2) +
             " m behind the other";
  }
  const vec3 across = cycle.leg[kLeftSide].hip_m - cycle.leg[kRightSide].hip_m;
  if (heading_direction(hips_heading(across)).z < kBackwards) {
    return "does not walk forwards";
  }
  return why_no_pace(cycle);
}

// The cycle that begins at phase `shift` of the periodic stride, without events and steps.
struct Build {
  CapturedCycle captured;
  GaitCycle cycle;
};
Result<Build> built(const Motion& motion, const StrideWindow& window,
                    const PeriodicMotion& periodic, double shift) {
  Build b;
  b.cycle.name = motion.name;
  b.cycle.metres_per_unit = motion.metres_per_unit;
  b.cycle.pace = motion.pace;
  b.cycle.captured = true;
  b.cycle.duration_s = periodic.duration_s;
  b.cycle.stride_m = periodic.stride_m;
  b.cycle.first_frame = window.start;
  b.cycle.frames = window.period;
  b.cycle.turn_rad = window.turn_rad;
  b.captured = captured_cycle(motion, periodic, shift);
  const Result<double> floor_m = build_standing(b.captured, b.cycle);
  if (!floor_m) return floor_m.error();
  build_samples(b.captured, *floor_m, b.cycle);
  return b;
}

// Builds the cycle twice: the first pass finds the right heel's strike, and the second begins
// there, so that the strike is at phase 0.
Result<GaitCycle> cycle_of(const Motion& motion, const StrideWindow& window) {
  const PeriodicMotion periodic = periodic_motion(motion, window);
  const Result<Build> first = built(motion, window, periodic, 0.0);
  if (!first) return first.error();
  if (flight_share(first->captured, first->cycle) > kMostFlight) {
    return Error{"holds no walk: both feet leave the floor, it is a run"};
  }
  const vec3 travel_m = kForward * first->cycle.stride_m;
  const auto events = stride_events(feet_tracks(first->cycle), travel_m);
  if (!events) return events.error();
  const double shift = events->strike[kRightSide];
  Result<Build> second = built(motion, window, periodic, shift);
  if (!second) return second.error();
  GaitCycle& cycle = second->cycle;
  for (const Side side : {kLeftSide, kRightSide}) {
    cycle.strike[side] = fraction(events->strike[side] - shift);
    cycle.toe_off[side] = fraction(events->toe_off[side] - shift);
  }
  wait_for_other_toe(cycle);
  measure_steps(second->captured, cycle);
  const std::string reason = why_no_walk(second->captured, cycle);
  if (!reason.empty()) return Error{reason};
  lengthen_short_step(cycle);
  return std::move(cycle);
}

// The first of the best windows that is a walk; otherwise the error of the very best one.
Result<GaitCycle> cycle_of(const Motion& motion) {
  constexpr std::size_t kMostTries = 12;
  const Result<std::vector<StrideWindow>> windows = best_strides(motion);
  if (!windows) return windows.error();
  Result<GaitCycle> first = cycle_of(motion, windows->front());
  for (std::size_t i = 1; !first && i < std::min(windows->size(), kMostTries); ++i) {
    if (Result<GaitCycle> next = cycle_of(motion, (*windows)[i])) return next;
  }
  return first;
}

// The cycle of the motion; if that fails and the motion is a loop, of the motion twice in a row.
Result<GaitCycle> looped_cycle_of(const Motion& motion) {
  Result<GaitCycle> cycle = cycle_of(motion);
  if (cycle) return cycle;
  const Motion twice = looped_twice(motion);
  if (twice.frames.empty()) return cycle;
  Result<GaitCycle> again = cycle_of(twice);
  if (!again) return cycle;
  // Convert to frames of the single motion: in a loop, strides one round apart are equal.
  const auto round = static_cast<double>(motion.frames.size() - 1);
  if (again->first_frame >= round) again->first_frame -= round;
  again->first_frame = std::max(0.0, std::min(again->first_frame, round - again->frames));
  return again;
}

// The frame rate at which a motion without a stride would hold the most usual walk, 0 if there is
// none. Some files state 30 frames a second instead of 120, for example.
double walking_rate_hz(const Motion& motion) {
  constexpr double kUsualRatio_m_min = 0.0058;
  if (best_strides(motion)) return 0.0;
  double rate_hz = 0.0, least = 1e300;
  Motion timed = motion;
  for (const double times : {0.25, 0.5, 2.0, 4.0}) {
    timed.frame_time_s = motion.frame_time_s * times;
    const Result<GaitCycle> cycle = looped_cycle_of(timed);
    if (!cycle) continue;
    const double ratio = walk_ratio_m_min(*cycle) / kUsualRatio_m_min;
    const double off = std::max(ratio, 1.0 / ratio);
    if (off >= least) continue;
    least = off;
    rate_hz = 1.0 / timed.frame_time_s;
  }
  return rate_hz;
}

}  // namespace

Result<GaitCycle> gait_cycle(const Motion& motion) {
  if (auto problem = check(motion)) return *problem;
  if (!has_legs(motion)) return Error{motion.name + ": legs are not set, see find_legs()"};
  Result<GaitCycle> cycle = looped_cycle_of(motion);
  if (cycle) return cycle;
  std::string reason = cycle.error().message;
  if (const double rate_hz = walking_rate_hz(motion); rate_hz > 0.0) {
    reason += ", but a walk at " + fixed(rate_hz, 0) + " frames a second instead of the file's " +
              fixed(1.0 / motion.frame_time_s, 0) + ": if these are wrong, give frame_rate_hz";
  }
  return Error{motion.name + ": " + reason};
}

}  // namespace gaitpad
