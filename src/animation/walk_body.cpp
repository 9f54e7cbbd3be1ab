#include "animation/walk_body.h"

#include <bit>

#include "animation/walk_body_parts.h"
#include "animation/walk_parts.h"

namespace gaitpad {
namespace {

constexpr double kSmoothing = 0.22;  // s at the reference leg
constexpr double kSettled = 40.0;    // of these: what is left is no number any more
constexpr double kMostExtra = 0.4;   // swing beyond the data's that pace alone can give
constexpr double kLeastPace = 0.5;   // below it the data's posture fades, and the swing with it
constexpr double kSoftElbow = 0.1;
constexpr double kRailProbe_m = 0.035;  // between two probes of the ground under a rail;
constexpr int kRailProbes = 15;         // 0.56 m to either side: a mean over two treads is even
constexpr double kRailSmoothing = 0.06;

// Where the values are all at their goals already, this costs one comparison.
void settle(const Tick& tick, BodyState& body) noexcept {
  const BodyParams& goal = tick.params.body;
  const double tau = kSmoothing * tick.model.time_scale;
  if (!(goal == body.goal)) {
    body.goal = goal;
    body.unsettled_ticks = static_cast<int>(std::min(kSettled * tau / tick.dt_s, 1e6));
  }
  if (body.unsettled_ticks <= 0) return;
  const auto to = std::bit_cast<BodyValues>(goal);
  auto now = std::bit_cast<BodyValues>(body.now);
  --body.unsettled_ticks;
  for (std::size_t i = 0; i < to.size(); ++i) {
    Damped<double> value{now[i], body.per_s[i]};
    value.advance(to[i], tau, tick.dt_s);
    const bool is_there = body.unsettled_ticks == 0;
    now[i] = is_there ? to[i] : value.x;
    body.per_s[i] = is_there ? 0.0 : value.v;
  }
  body.now = std::bit_cast<BodyParams>(now);
}

// The arms swing as far as the speed is above or below the data's (Boulic et al. 1990: amplitude
// proportional to speed), in bounds: 1 at the data's own pace.
double pace_swing(const Tick& tick, const WalkState& state) noexcept {
  const double own_s = tick.model.body.own_step_s;
  const double quicker = own_s / std::max(state.step_time_s.x, 0.25 * own_s);
  const double extra = std::max(state.pace.x, kLeastPace) * quicker - 1.0;
  return 1.0 + (extra > 0.0 ? extra / (1.0 + extra / kMostExtra) : extra);
}

// A rail rises evenly over stairs: the ground's mean along the way under the hand, as far ahead as
// the filter is late.
void follow_rail(const Tick& tick, Side side, WalkState& state) noexcept {
  BodyState& body = state.body;
  const HandParams& hand = body.now.hand[side];
  const double scale = tick.model.body.shoulder_height_m / kReferenceShoulder_m;
  const double smoothing_s = kRailSmoothing * tick.model.time_scale;
  const vec3 forward = heading_direction(state.heading_rad), left = glm::cross(kUp, forward);
  const vec3 under = state.hips_m + state.hips_velocity_m_s * (2.0 * smoothing_s) +
                     left * (scale * (side == kLeftSide ? hand.rail_side_m : -hand.rail_side_m));
  double sum = 0.0, weights = 0.0;
  for (int i = -kRailProbes; i <= kRailProbes && !tick.flat; ++i) {
    const vec3 at = under + forward * (i * kRailProbe_m * tick.model.size);
    const double weight = kRailProbes + 1.0 - std::abs(i);
    sum += weight * ground_at(*tick.model.terrain, at.x, at.z).height_m;
    weights += weight;
  }
  const double mean_m = tick.flat ? 0.0 : sum / weights;
  Damped<double> ground{body.rail_ground_m[side], body.rail_ground_m_s[side]};
  ground.advance(mean_m, smoothing_s, tick.dt_s);
  if (hand.rail <= 0.0) ground = {mean_m, 0.0};  // nobody holds it yet
  body.rail_ground_m[side] = ground.x;
  body.rail_ground_m_s[side] = ground.v;
}

}  // namespace

quat between(const quat& from, const quat& to, double share) noexcept {
  const double sign = glm::dot(from, to) < 0.0 ? -1.0 : 1.0;
  return glm::normalize(from * (1.0 - share) + to * (sign * share));
}

void carry_path(const Skeleton& skeleton, const std::vector<int>& path, const Pose& pose,
                JointFrames& world) noexcept {
  for (const int j : path) {
    const Joint& joint = skeleton.joints[j];
    if (joint.parent < 0) {
      world.position_m[j] = pose.root_m;
      world.rotation[j] = pose.local[j];
      continue;
    }
    world.position_m[j] =
        world.position_m[joint.parent] + world.rotation[joint.parent] * joint.offset_m;
    world.rotation[j] = world.rotation[joint.parent] * pose.local[j];
  }
}

void smooth_body(const Tick& tick, IkMode mode, WalkState& state) noexcept {
  BodyState& body = state.body;
  settle(tick, body);
  const double pace = mode == IkMode::paper ? 1.0 : pace_swing(tick, state);
  for (const Side side : {kLeftSide, kRightSide}) {
    body.swing[side] = pace * body.now.arm_swing[side];
    if (body.now.hand[side].rail > 0.0 || body.goal.hand[side].rail > 0.0)
      follow_rail(tick, side, state);
  }
}

void swing_arms(const WalkModel& model, const WalkState& state, Pose& pose) noexcept {
  for (const Side side : {kLeftSide, kRightSide}) {
    const ArmBuild& arm = model.body.arm[side];
    const double swing = state.body.swing[side];
    if (!arm.is_there || swing == 1.0) continue;
    quat& shoulder = pose.local[arm.joints.shoulder];
    quat& elbow = pose.local[arm.joints.elbow];
    shoulder = between(arm.swing_shoulder, shoulder, swing);
    elbow = between(arm.swing_elbow, elbow, soft_min(swing, arm.most_elbow_swing, kSoftElbow));
  }
}

void pose_body(const WalkModel& model, const WalkState& state, Pose& pose) noexcept {
  const BodyParams& now = state.body.now;
  const Skeleton& skeleton = model.cycle.skeleton;
  const bool moves_spine = model.body.spine.size() > 1 && !is_spine_even(now);
  std::array<bool, 2> moves_arm;
  for (const Side side : {kLeftSide, kRightSide})
    moves_arm[side] = model.body.arm[side].is_there && !is_arm_free(now, side);
  const bool moves_head = !model.body.head_path.empty() && !is_head_free(now.head);
  if (!moves_spine && !moves_arm[0] && !moves_arm[1] && !moves_head) return;

  JointFrames world;
  HandPlaces own_m{};
  for (const Side side : {kLeftSide, kRightSide}) {
    if (!model.body.arm[side].is_there || !(moves_arm[0] || moves_arm[1])) continue;
    carry_path(skeleton, model.body.arm[side].path, pose, world);
    own_m[side] = hand_place(model.body.arm[side], world);
  }
  if (moves_spine) {
    pose_spine(model.body, skeleton, now.spine_weight, pose, world);
    for (const Side side : {kLeftSide, kRightSide}) {
      if (moves_arm[side]) carry_path(skeleton, model.body.arm[side].path, pose, world);
    }
  }
  Shoulders shoulders;
  if (moves_arm[0] || moves_arm[1]) shoulders = shoulders_of(model, world);
  for (const Side side : {kLeftSide, kRightSide}) {
    if (moves_arm[side]) pose_arm(model, state, side, shoulders, own_m[side], pose, world);
  }
  if (moves_head) pose_head(model, state, pose, world);
}

}  // namespace gaitpad
