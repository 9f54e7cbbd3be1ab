// Walk events, mixing a walk into the caller's pose, and poses as the caller's floats.
#include "gaitpad/walk_output.h"

#include <algorithm>
#include <optional>

#include "walk/sound_input.h"
#include "walk/walk_frame.h"

namespace gaitpad {
namespace {

// The foot whose step is running.
std::optional<Side> steps_of(Stage stage, Side swing) noexcept {
  if (stage == Stage::flight) return swing;
  if (stage == Stage::roll) return other(swing);
  return std::nullopt;
}

quat turned_back(const Placement& model, const quat& world) noexcept {
  return glm::conjugate(rotation_y(model.heading_rad)) * world;
}

int bones_of(std::span<const int> joints, std::span<float> out, std::size_t floats) noexcept {
  return static_cast<int>(std::min(joints.size(), out.size() / floats));
}

}  // namespace

WalkEvents walk_events(const WalkSteps& before, const WalkState& state) noexcept {
  const WalkSteps now = walk_steps(state);
  WalkEvents events;
  // Place of an event: the heel or toe where the foot stands, or stood last.
  const Block<1>& walk = state.walk;
  const Placement step = placement_of(walk.origin[0]);
  const auto planted_m = [&](WalkEventKind kind, Side side) {
    const bool swings = (side == kRightSide) == (walk.state.right_swings != 0.0f);
    if (!swings) return step.place_m;
    return to_world(step,
                    kind == WalkEventKind::toe_off
                        ? vec3(walk.state.toe_x_m, walk.footing.toe_y_m, walk.state.toe_z_m)
                        : vec3(walk.state.print_x_m, walk.footing.print_y_m, walk.state.print_z_m));
  };
  const auto add = [&](WalkEventKind kind, Side side) {
    events.event[events.count++] = {kind, side, to_world(state.placed, planted_m(kind, side))};
  };
  for (const Side side : {kLeftSide, kRightSide}) {
    if (now.steps[side] > before.steps[side]) add(WalkEventKind::heel_strike, side);
  }
  const auto steps = steps_of(now.stage, now.swing);
  // After the last landing of a stop the roll belongs to no step.
  if (!steps || walk.change.stands != 0.0f) return events;
  if (steps != steps_of(before.stage, before.swing)) add(WalkEventKind::step_begin, *steps);
  const bool flew = before.stage == Stage::flight && before.swing == now.swing;
  if (now.stage == Stage::flight && !flew) add(WalkEventKind::toe_off, *steps);
  return events;
}

std::vector<float> legs_and_pelvis(const WalkModel& model) {
  const std::vector<Joint>& joints = model.cycle.skeleton.joints;
  std::vector<float> weights(joints.size(), 0.0f);
  for (const LegBuild& leg : model.leg) weights[leg.joint[0].joint] = 1.0f;
  for (std::size_t j = 1; j < joints.size(); ++j)
    weights[j] = std::max(weights[j], weights[joints[j].parent]);
  for (const LegBuild& leg : model.leg) {
    for (int j = joints[leg.joint[0].joint].parent; j >= 0; j = joints[j].parent) weights[j] = 1.0f;
  }
  return weights;
}

void mix_pose(std::span<const float> weights, const Pose& walk, Pose& own) noexcept {
  const int count = std::min({static_cast<int>(weights.size()), walk.joint_count, own.joint_count});
  for (int j = 0; j < count; ++j) {
    const double weight = weights[j];
    if (!(weight > 0.0)) continue;
    if (weight >= 1.0) {
      own.local[j] = walk.local[j];
      if (j == 0) own.root_m = walk.root_m;
      continue;
    }
    own.local[j] = nlerp(own.local[j], walk.local[j], weight);
    if (j == 0) own.root_m = mix(own.root_m, walk.root_m, weight);
  }
}

int write_rotations(const Pose& pose, const Placement& model, std::span<const int> joints,
                    std::span<float> out, std::array<float, 3>& root_m) noexcept {
  if (!is_finite(model)) return 0;
  const vec3 place_m = from_world(model, pose.root_m);
  for (int axis = 0; axis < 3; ++axis) root_m[axis] = static_cast<float>(place_m[axis]);
  const int count = bones_of(joints, out, 4);
  for (int bone = 0; bone < count; ++bone) {
    const int j = joints[bone];
    if (j < 0 || j >= pose.joint_count) continue;
    const quat q = j == 0 ? turned_back(model, pose.local[0]) : pose.local[j];
    float* to = out.data() + 4 * bone;
    to[0] = static_cast<float>(q.x), to[1] = static_cast<float>(q.y);
    to[2] = static_cast<float>(q.z), to[3] = static_cast<float>(q.w);
  }
  return count;
}

int write_matrices(const Skeleton& skeleton, const Pose& pose, const Placement& model,
                   std::span<const int> joints, std::span<float> out) noexcept {
  if (!is_finite(model)) return 0;
  Pose seen = pose;
  seen.joint_count = std::min(pose.joint_count, static_cast<int>(skeleton.joints.size()));
  seen.root_m = from_world(model, pose.root_m);
  seen.local[0] = turned_back(model, pose.local[0]);
  JointFrames frames;
  forward_kinematics(skeleton, seen, frames);
  const int count = bones_of(joints, out, 16);
  for (int bone = 0; bone < count; ++bone) {
    const int j = joints[bone];
    if (j < 0 || j >= seen.joint_count) continue;
    const mat3 turn = glm::mat3_cast(frames.rotation[j]);
    float* to = out.data() + 16 * bone;
    for (int column = 0; column < 4; ++column) {
      const vec3& axis = column < 3 ? turn[column] : frames.position_m[j];
      for (int row = 0; row < 3; ++row) *to++ = static_cast<float>(axis[row]);
      *to++ = column < 3 ? 0.0f : 1.0f;
    }
  }
  return count;
}

}  // namespace gaitpad
