#include "motion/cycle_retarget.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "motion/cycle_leg.h"
#include "motion/cycle_standing.h"
#include "motion/cycle_upper_body.h"
#include "motion/tracks.h"

namespace gaitpad {
namespace {

constexpr double kMostToeOut = 45.0 * kDegree;

// The frame with the lowest score.
template <class Score>
const MotionFrame& best_frame(const Motion& motion, Score score) {
  const auto world = std::make_unique<JointFrames>();
  std::size_t best = 0;
  double least = 0.0;
  for (std::size_t f = 0; f < motion.frames.size(); ++f) {
    forward_kinematics(motion, motion.frames[f], *world);
    const double s = score(world->position_m);
    if (f == 0 || s < least) {
      least = s;
      best = f;
    }
  }
  return motion.frames[best];
}

using Places = std::array<vec3, kMaxJoints>;
double foot_height_m(const Places& at, const LegJoints& leg) {
  return at[leg.ankle].y + at[leg.toe].y;
}

// Both feet low and both legs long.
const MotionFrame& standing_frame(const Motion& motion) {
  return best_frame(motion, [&](const Places& at) {
    double score = 0.0;
    for (const LegJoints& leg : motion.legs) {
      score += foot_height_m(at, leg) - glm::distance(at[leg.hip], at[leg.ankle]);
    }
    return score;
  });
}

// Where a foot is lowest it lies flat; where it lies across, it is turned forward.
void take_over_foot(const Motion& motion, Side side, CapturedLeg& leg) {
  const LegJoints& j = motion.legs[side];
  const auto& frame = best_frame(motion, [&j](const Places& at) { return foot_height_m(at, j); });
  const CapturedLeg flat = captured_pose(motion, frame).leg[side];
  const double out_rad = heading_of(flat.toe_m.front() - flat.ankle_m.front());
  const quat turn = std::abs(out_rad) > kMostToeOut ? rotation_y(-out_rad) : kIdentity;
  leg.ankle.assign(kCycleSamples, turn * flat.ankle.front());
  leg.toe.assign(kCycleSamples, turn * flat.toe.front());
}

// The character's build and standing pose.
Result<GaitCycle> body_of(const Motion& character) {
  if (Result<GaitCycle> own_walk = gait_cycle(character)) return own_walk;
  CapturedCycle pose = captured_pose(character, standing_frame(character));
  for (const Side side : {kLeftSide, kRightSide}) take_over_foot(character, side, pose.leg[side]);
  GaitCycle body;
  const Result<double> floor_m = build_standing(pose, body);
  if (!floor_m) return Error{fmt::format("{}: {}", character.name, floor_m.error().message)};
  return body;
}

vec3 mean_hip_m(const GaitCycle& cycle) { return 0.5 * (cycle.leg[0].hip_m + cycle.leg[1].hip_m); }

double mean_ankle_height_m(const GaitCycle& cycle) {
  return -0.5 * (cycle.leg[0].heel_m.y + cycle.leg[1].heel_m.y);
}

// Takes a body's place in `source`'s walk; samples and locals are still the body's own.
void take_over_events(const GaitCycle& source, double ratio, GaitCycle& out) {
  out.name = source.name;
  out.metres_per_unit = source.metres_per_unit;
  out.duration_s = source.duration_s * std::sqrt(ratio);  // as a pendulum
  out.stride_m = source.stride_m * ratio;
  out.strike = source.strike;
  out.toe_off = source.toe_off;
  for (int side = 0; side < 2; ++side) {
    out.step_m[side] = source.step_m[side] * ratio;
    out.track_m[side] =
        source.track_m[side] * ratio + out.leg[side].hip_m.x - source.leg[side].hip_m.x * ratio;
  }
}

// Hips and heels run where the source's do, `ratio` times as large; feet stand as far beside the
// hips as there.
void take_over_samples(const GaitCycle& source, double ratio, GaitCycle& out) {
  const vec3 from_hips = mean_hip_m(source), to_hips = mean_hip_m(out);
  // The hips stand no higher than the shorter leg reaches.
  const double shorter_m = mean_leg_m(out) - std::min(out.leg[0].length_m(), out.leg[1].length_m());
  const double higher_m =
      mean_ankle_height_m(out) - ratio * mean_ankle_height_m(source) - shorter_m;
  out.samples = source.samples;
  vec3 middle(0.0);
  for (CycleSample& at : out.samples) {
    at.pelvis_m = ratio * (at.pelvis_m + at.pelvis * from_hips) - at.pelvis * to_hips;
    at.pelvis_m.y += higher_m;
    middle += vec3(at.pelvis_m.x, 0.0, at.pelvis_m.z) / double(kCycleSamples);
    for (int side = 0; side < 2; ++side) {
      const LegModel &from = source.leg[side], &to = out.leg[side];
      LegSample& leg = at.leg[side];
      leg.ankle_m = ratio * (leg.ankle_m + leg.foot * from.heel_m) - leg.foot * to.heel_m;
      leg.ankle_m.x += to.hip_m.x - ratio * from.hip_m.x;
    }
  }
  for (CycleSample& at : out.samples) {
    at.pelvis_m -= middle;
    for (LegSample& leg : at.leg) leg.ankle_m -= middle;
  }
}

// Local rotations at the turn's sample i.
void pose_sample(const UpperBodyTurn& turn, int i, GaitCycle& out) {
  const std::size_t joints = out.skeleton.joints.size();
  const CycleSample& at = out.samples[i];
  quat* local = out.local.data() + i * joints;
  std::vector<quat> world(joints, kIdentity);
  for (std::size_t j = 0; j < joints; ++j) {
    const int parent = out.skeleton.joints[j].parent;
    const quat above = parent < 0 ? kIdentity : world[parent];
    world[j] = above * out.standing_local[j];
    if (static_cast<int>(j) == out.pelvis) world[j] = at.pelvis * out.pelvis_standing;
    if (turn.has(static_cast<int>(j))) world[j] = turn.world(static_cast<int>(j));
    local[j] = glm::normalize(glm::conjugate(above) * world[j]);
  }
  for (int side = 0; side < 2; ++side) {
    const LegSample& leg = at.leg[side];
    const LegPose pose = leg_pose(out.leg[side], at.pelvis_m, at.pelvis, leg.angles, leg.toe_x);
    set_leg_locals(out.skeleton, out.leg[side], pose, local);
  }
  for (std::size_t j = 0; i > 0 && j < joints; ++j) {
    if (glm::dot(local[j], local[j - joints]) < 0.0) local[j] = -local[j];
  }
}

}  // namespace

double mean_leg_m(const GaitCycle& cycle) noexcept {
  return 0.5 * (cycle.leg[0].length_m() + cycle.leg[1].length_m());
}

Result<GaitCycle> cycle_on_skeleton(const GaitCycle& source, const Motion& character) {
  Result<GaitCycle> out = body_of(character);
  if (!out) return out;
  const double ratio = mean_leg_m(*out) / mean_leg_m(source);
  take_over_events(source, ratio, *out);
  take_over_samples(source, ratio, *out);
  const UpperBody body = upper_body(source, *out);
  stand_alike(body, *out);
  UpperBodyTurn turn(source, body, *out);
  out->local.assign(kCycleSamples * out->skeleton.joints.size(), kIdentity);
  for (int i = 0; i < kCycleSamples; ++i) {
    turn.set_sample(i);
    pose_sample(turn, i, *out);
  }
  return out;
}

}  // namespace gaitpad
