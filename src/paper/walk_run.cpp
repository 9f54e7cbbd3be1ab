#include "paper/walk_run.h"

namespace gaitpad {
namespace {

void keep_joints(const WalkModel& model, const WalkState& state, const Pose& pose,
                 JointFrames& frames, WalkSample& sample) {
  forward_kinematics(model.cycle.skeleton, pose, frames);
  sample.joints_m.assign(frames.position_m.begin(), frames.position_m.begin() + pose.joint_count);
  const quat pelvis =
      frames.rotation[model.cycle.pelvis] * glm::inverse(model.cycle.pelvis_standing);
  sample.pelvis_yaw_rad = wrapped(heading_of(pelvis * kForward) - state.heading_rad);
}

vec2 stick_at(const std::vector<StickAt>& stick, double time_s) {
  vec2 now(0.0);
  for (const StickAt& s : stick) {
    if (s.time_s <= time_s) now = s.left;
  }
  return now;
}

bool is_landing(const Walk& walk, std::size_t tick, Side side) {
  if (tick == 0) return false;
  const WalkFrame &before = walk.samples[tick - 1].frame, &now = walk.samples[tick].frame;
  return now.stage == Stage::roll && now.swing == side && before.stage == Stage::flight;
}

}  // namespace

Walk walked(const WalkCase& what, const EachTick& each) {
  const WalkModel& model = *what.model;
  const GaitLimits limits = gait_limits(model.leg_length_m);
  Pose pose;
  JointFrames frames;
  WalkState state = standing(model, vec3(0.0), pose);
  Walk walk;
  const int ticks = static_cast<int>(what.end_s * kPaperRate_hz);
  walk.samples.resize(static_cast<std::size_t>(std::max(ticks, 0)));
  for (int tick = 0; tick < ticks; ++tick) {
    Stick stick;
    stick.left = stick_at(what.stick, static_cast<double>(tick) / kPaperRate_hz);
    advance(model, gait_params(stick, what.style, limits), what.ik, 1.0 / kPaperRate_hz, state,
            pose);
    WalkSample& sample = walk.samples[static_cast<std::size_t>(tick)];
    sample.frame = state.frame;
    sample.angles_rad = state.angles_rad;
    sample.phase = state.phase;
    sample.hips_m = state.hips_m;
    if (what.keeps_joints) keep_joints(model, state, pose, frames, sample);
    if (each) each(state, pose);
  }
  return walk;
}

double joint_deg(const LegAngles& angles_rad, LegJoint joint) noexcept {
  switch (joint) {
    case LegJoint::hip:
      return -angles_rad[kHipX] / kDegree;
    case LegJoint::knee:
      return angles_rad[kKneeX] / kDegree;
    case LegJoint::ankle:
      break;
  }
  return -angles_rad[kAnkleX] / kDegree;
}

std::vector<Ticks> strides(const Walk& walk, Side side) {
  std::vector<Ticks> found;
  std::size_t begin = 0;
  for (std::size_t k = 1; k < walk.samples.size(); ++k) {
    if (!is_landing(walk, k, side)) continue;
    if (begin > 0) found.push_back({begin, k});
    begin = k;
  }
  return found;
}

Ticks stride_after(const Walk& walk, Side side, double time_s) {
  for (const Ticks& stride : strides(walk, side)) {
    if (static_cast<double>(stride.begin) >= time_s * kPaperRate_hz) return stride;
  }
  return {};
}

std::vector<Ticks> flights(const Walk& walk, Side side, double time_s) {
  std::vector<Ticks> found;
  Ticks now;
  for (std::size_t k = 0; k < walk.samples.size(); ++k) {
    const WalkFrame& frame = walk.samples[k].frame;
    const bool flies = frame.stage == Stage::flight && frame.swing == side;
    if (flies && now.end != k) now.begin = k;
    if (flies) now.end = k + 1;
    const bool is_over = !flies && now.end == k && k > 0;
    if (is_over && static_cast<double>(now.begin) >= time_s * kPaperRate_hz) found.push_back(now);
  }
  return found;
}

double joint_deg(const Walk& walk, std::size_t tick, Side side, LegJoint joint) noexcept {
  return joint_deg(walk.samples[tick].angles_rad[side], joint);
}

Range joint_range(const Walk& walk, const Ticks& ticks, Side side, LegJoint joint) noexcept {
  Range range{1e9, -1e9};
  for (std::size_t k = ticks.begin; k < ticks.end; ++k) {
    const double angle = joint_deg(walk, k, side, joint);
    range.min = std::min(range.min, angle);
    range.max = std::max(range.max, angle);
  }
  return range;
}

double joint_rms(const Walk& a, const Walk& b, const Ticks& ticks, Side side,
                 LegJoint joint) noexcept {
  double squares = 0.0;
  for (std::size_t k = ticks.begin; k < ticks.end; ++k) {
    const double d = joint_deg(b, k, side, joint) - joint_deg(a, k, side, joint);
    squares += d * d;
  }
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(ticks.count(), 1)));
}

}  // namespace gaitpad
