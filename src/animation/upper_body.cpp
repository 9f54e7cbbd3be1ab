// The upper body of a walk. It moves as in the data, except that arms swing as far as the pace
// asks, hands and head are brought to the places that a style names, and joints follow by their
// weights (equation 5). Meredith & Maddock 2005, section 5 (future work). Nothing in here moves
// pelvis or legs.
//
// In a tick: smooth_upper_body() brings the style's values into force, and pose_upper_body() leans
// the trunk and spreads the arms, poses the spine, then the arms that hang on it, then the head.
// Joints that move as in the data are not touched, so they cost nothing and keep their bits.
#include <cstring>

#include "animation/floor.h"
#include "animation/sound_input.h"
#include "animation/walk_figure.h"
#include "base/bits.h"
#include "motion/leg_pose.h"

namespace gaitpad {
namespace {

// --- Smoothing, once a tick ----------------------------------------------------------------------

constexpr RobustOptions kRobustBody = {.tolerance_m = 1e-6, .max_iterations = 40, .max_tries = 1};
constexpr double kSmoothing = 0.22;  // time constant in seconds at the reference leg
// After this number of time constants all but 1e-9 of a change is over.
constexpr double kSettled = 24.0;
constexpr double kRailProbe_m = 0.035;  // distance of the probes of the ground under a rail
// Probes on either side, 0.56 m in all: a mean over two treads rises evenly.
constexpr int kRailProbes = 15;
constexpr double kRailSmoothing = 0.06;

// The parameters are numbers only, so all of them are smoothed as one row.
using BodyValues = std::array<double, sizeof(UpperBodyParams) / sizeof(double)>;

// Brings the values in force nearer to their goals. At the goals this costs one comparison.
void settle_values(const Tick& tick, UpperBodyState& body) noexcept {
  const UpperBodyParams& goal = tick.params.body;
  const double tau = kSmoothing * tick.model.time_scale;
  if (!is_same(goal, body.goal)) {
    body.goal = goal;
    body.unsettled_ticks = static_cast<int>(std::min(kSettled * tau / tick.dt_s, 1e6));
  }
  if (body.unsettled_ticks <= 0) return;
  const auto to = bits_as<BodyValues>(goal);
  if (--body.unsettled_ticks == 0) {
    body.now = goal;
    body.per_s = {};
    return;
  }
  using Some = Lanes<kLeastLanes>;
  const auto before = bits_as<BodyValues>(body.now);
  const BodyValues rate = body.per_s;
  BodyValues now = before;
  const Damping damping(tau, tick.dt_s);
  for (std::size_t i = 0; i < to.size(); i += kLeastLanes) {
    // The last pair of an odd count overlaps the one before.
    const std::size_t at = std::min(i, to.size() - kLeastLanes);
    Damped<Some> value;
    Some aim;
    std::memcpy(&value.x, &before[at], sizeof(Some));
    std::memcpy(&value.v, &rate[at], sizeof(Some));
    std::memcpy(&aim, &to[at], sizeof(Some));
    value.advance(aim, damping);
    std::memcpy(&now[at], &value.x, sizeof(Some));
    std::memcpy(&body.per_s[at], &value.v, sizeof(Some));
  }
  body.now = bits_as<UpperBodyParams>(now);
}

// Moves a rail's height. The rail rises evenly over stairs, so its height is that of the mean
// ground along the way under the hand. The mean is taken as far ahead as the filter after it lags.
void follow_rail(const Tick& tick, Side side, WalkState& state) noexcept {
  UpperBodyState& body = state.body;
  const HandParams& hand = body.now.hand[side];
  const double scale = tick.model.body.shoulder_height_m / kReferenceShoulder_m;
  const double smoothing_s = kRailSmoothing * tick.model.time_scale;
  const vec3 forward = heading_direction(state.path.heading_rad), left = glm::cross(kUp, forward);
  const vec3 under = state.path.hips_m + state.path.pelvis_m.v * (2.0 * smoothing_s / tick.dt_s) +
                     left * (scale * (side == kLeftSide ? hand.rail_side_m : -hand.rail_side_m));
  const Floor floor{*tick.model.terrain, tick.placed};
  double sum = 0.0, weights = 0.0;
  for (int i = -kRailProbes; i <= kRailProbes && !tick.flat; ++i) {
    const vec3 at = under + forward * (i * kRailProbe_m * tick.model.size);
    const double weight = kRailProbes + 1.0 - std::abs(i);
    sum += weight * ground_at(floor, at.x, at.z).height_m;
    weights += weight;
  }
  const double mean_m = tick.flat ? 0.0 : sum / weights;
  Damped<double> ground{body.rail_ground_m[side], body.rail_ground_m_s[side]};
  ground.advance(mean_m, smoothing_s, tick.dt_s);
  // The rail was not held yet, so there is nothing to smooth.
  if (hand.rail <= 0.0) ground = {mean_m, 0.0};
  body.rail_ground_m[side] = ground.x;
  body.rail_ground_m_s[side] = ground.v;
}

// --- Posture: a trunk that leans, arms that are spread -------------------------------------------

// 1 in the middle of the time in which a leg stands alone, 0 in that of the other leg.
double stands_alone(const WalkModel& model, const WalkState& state, Side side) noexcept {
  const std::array<double, 4>& share = model.share;
  const double middle = side == kRightSide ? share[0] + 0.5 * share[1]
                                           : share[0] + share[1] + share[2] + 0.5 * share[3];
  const double half =
      0.5 +
      0.5 * sin_cos(2.0 * kPi * (data_phase<double>(model, moment_of(model, state)) - middle)).cos;
  return half * half;
}

void hold_posture(const Tick& tick, WalkState& state) noexcept {
  UpperBodyState& body = state.body;
  const TrunkParams& trunk = body.now.trunk;
  body.forward_rad = body.left_rad = 0.0;
  body.out_rad = {};
  if (tick.mode == IkMode::paper) return;
  for (int side : {0, 1}) body.out_rad[side] = body.now.arm_out_deg[side] * kDegree;
  body.forward_rad = trunk.lean_deg * kDegree + body.push_rad.x - state.idle.breath_rad;
  if (trunk.over_left_deg == 0.0 && trunk.over_right_deg == 0.0) return;
  body.left_rad = presence(state) * kDegree *
                  (trunk.over_left_deg * stands_alone(tick.model, state, kLeftSide) -
                   trunk.over_right_deg * stands_alone(tick.model, state, kRightSide));
}

quat rotation_above(const Skeleton& skeleton, const PosePart& pose, int joint) noexcept {
  quat rotation = kIdentity;
  for (int j = skeleton.joints[joint].parent; j >= 0; j = skeleton.joints[j].parent)
    rotation = pose.local[j] * rotation;
  return rotation;
}

// Turns joints and all above them by `turn`, which is in the walker's axes at its heading.
void turn_joints(const Skeleton& skeleton, double heading_rad, const quat& turn,
                 std::span<const int> joints, const PosePart& pose) noexcept {
  const quat to = rotation_y(heading_rad), world = to * turn * glm::conjugate(to);
  quat above = kIdentity;
  for (int last = -1; const int joint : joints) {
    above = last >= 0 && skeleton.joints[joint].parent == last
                ? above * pose.local[last]
                : rotation_above(skeleton, pose, joint);
    pose.local[joint] = glm::normalize(glm::conjugate(above) * world * above * pose.local[joint]);
    last = joint;
  }
}
void turn_joint(const Skeleton& skeleton, double heading_rad, const quat& turn, int joint,
                const PosePart& pose) noexcept {
  turn_joints(skeleton, heading_rad, turn, {&joint, 1}, pose);
}

// Leans the trunk by shares of the spine's joints; the arms keep their hanging direction.
void lean_trunk(const WalkModel& model, const WalkState& state, const PosePart& pose) noexcept {
  const UpperBodyState& body = state.body;
  const std::vector<int>& spine = model.body.joints.spine;
  const double ahead = body.chest_ahead_rad.x;
  if (spine.empty() || (body.forward_rad == 0.0 && body.left_rad == 0.0 && ahead == 0.0)) return;
  const double share = 1.0 / static_cast<double>(spine.size());
  const quat turn = rotation_y(share * ahead) * rotation_z(-share * body.left_rad) *
                    rotation_x(share * body.forward_rad);
  turn_joints(model.cycle.skeleton, state.path.heading_rad, turn, spine, pose);
  const quat back = rotation_x(-body.forward_rad) * rotation_z(body.left_rad);
  for (const ArmBuild& arm : model.body.arm) {
    if (arm.is_there)
      turn_joint(model.cycle.skeleton, state.path.heading_rad, back, arm.joints.shoulder, pose);
  }
}

// When a walk begins, changes or ends, the data's chest and head may jump, so their second
// differences are bounded. The spine's joints share the chest's correction; neck and head share the
// head's.
constexpr double kMostChest_s2 = 260.0 * kDegree, kMostHead_s2 = 145.0 * kDegree,
                 kTrunkEases_s = 0.25;

// The segment's turn from standing, as a rotation vector in the walker's axes.
vec3 turn_of(const quat& world, const quat& standing, double heading_rad) noexcept {
  return rotation_vector(rotation_y(-heading_rad) * world * glm::conjugate(standing));
}

// The segment's turn after its second difference was bounded.
vec3 eased_turn(const Tick& tick, const WalkState& state, const vec3& goal, double most_s2,
                EasedOf<vec3, double>& eased) noexcept {
  const double changes = state.body.push_rad.x != 0.0 ? 1.0 : state.path.unsteady;
  const vec3 value =
      ease<double>(goal, most_s2 * tick.dt_s * tick.dt_s, 0.0,
                   kTrunkEases_s * tick.model.time_scale / tick.dt_s, changes, eased);
  keep(value, eased);
  return value;
}

void ease_chest(const Tick& tick, WalkState& state, const PosePart& pose) noexcept {
  const UpperBodyModel& build = tick.model.body;
  const std::vector<int>& spine = build.joints.spine;
  if (tick.mode == IkMode::paper || spine.empty() || build.head_path.empty()) return;
  const Skeleton& skeleton = tick.model.cycle.skeleton;
  const double heading = state.path.heading_rad;
  const quat chest = rotation_above(skeleton, pose, build.head_path[build.neck_at]);
  const vec3 goal = turn_of(chest, build.chest_standing, heading),
             value = eased_turn(tick, state, goal, kMostChest_s2, state.body.eased_chest);
  if (value == goal) return;
  const vec3 off = rotation_vector(from_rotation_vector(value) * from_rotation_vector(-goal));
  const quat turn = from_rotation_vector(off / static_cast<double>(spine.size()));
  turn_joints(skeleton, heading, turn, spine, pose);
}

void spread_arms(const WalkModel& model, const WalkState& state, const PosePart& pose) noexcept {
  for (const Side side : {kLeftSide, kRightSide}) {
    const ArmBuild& arm = model.body.arm[side];
    const double out = state.body.out_rad[side];
    if (!arm.is_there || out == 0.0) continue;
    turn_joint(model.cycle.skeleton, state.path.heading_rad,
               rotation_z(side == kLeftSide ? out : -out), arm.joints.shoulder, pose);
  }
}

// --- Spine ---------------------------------------------------------------------------------------

// The spine is solved by weighted half-Jacobian IK: its joints share the movement that brings the
// neck and the shoulders to their place in the data. Three rows, all of positions: the neck's
// sideways and fore-aft place, and the fore-aft place of a point beside it.

constexpr double kNeckLever_m = 0.2;          // distance of that point from the neck
constexpr double kMostBend = 60.0 * kDegree;  // largest bend of one joint
constexpr int kAxes = 3;                      // number of axes of a joint
static_assert(kAxes * kMaxSpineIk <= kMaxIkDofs);
constexpr std::array<vec3, kAxes> kAxis = {vec3(1, 0, 0), vec3(0, 0, 1), vec3(0, 1, 0)};

// The spine in one pose. Angles and places are in the walker's standing axes, turned with the joint
// below the spine.
struct Spine {
  quat base = kIdentity;
  IkChain chain;
  IkAngles angles{};      // angles of each joint from its standing pose
  quat last = kIdentity;  // turn of the uppermost joint
  vec3 last_m{0.0};       // place of the uppermost joint, from the lowest
};

Spine spine_of(const UpperBodyModel& body, const Skeleton& skeleton,
               const JointFrames& world) noexcept {
  const int count = static_cast<int>(body.spine.size());
  Spine spine;
  spine.base = world.rotation[skeleton.joints[body.spine.front().joint].parent] *
               glm::conjugate(body.spine_base);
  const quat to_base = glm::conjugate(spine.base);
  spine.chain.dofs = kAxes * count;
  for (int i = 0; i < count; ++i) {
    const SpineJoint& at = body.spine[i];
    const quat own = to_base * world.rotation[at.joint] * glm::conjugate(at.standing);
    const AnglesXzy turn = angles_xzy(glm::conjugate(spine.last) * own);
    const std::array<double, kAxes> turn_rad = {turn.x, turn.z, turn.y};
    for (int a = 0; a < kAxes; ++a) {
      spine.angles[kAxes * i + a] = turn_rad[a];
      spine.chain.dof[kAxes * i + a] = {
          .axis = kAxis[a], .min_rad = -kMostBend, .max_rad = kMostBend};
    }
    spine.last = own;
    if (i + 1 == count) break;
    const vec3 link = world.position_m[body.spine[i + 1].joint] - world.position_m[at.joint];
    spine.chain.dof[kAxes * i + 2].link_m = glm::conjugate(own) * (to_base * link);
  }
  spine.last_m = to_base * (world.position_m[body.spine.back().joint] -
                            world.position_m[body.spine.front().joint]);
  return spine;
}

// Pulls joints of small weight towards the standing pose.
void stiffen_spine(const UpperBodyModel& body, const SpineWeights& weight, Spine& spine) noexcept {
  const double largest = std::max({1e-6, weight[kLowerSpine], weight[kUpperSpine]});
  for (std::size_t i = 0; i < body.spine.size(); ++i) {
    const double here = mix(weight[kLowerSpine], weight[kUpperSpine], body.spine[i].upper);
    const double w = std::clamp(here / largest, 0.0, 1.0);
    for (std::size_t d = kAxes * i; d < kAxes * (i + 1); ++d) {
      spine.chain.dof[d].weight = w;
      spine.angles[d] *= 1.0 - held_back(w);
    }
  }
}

void write_spine(const UpperBodyModel& body, const Skeleton& skeleton, const Spine& spine,
                 const PosePart& pose, JointFrames& world) noexcept {
  quat segment = kIdentity;
  std::size_t i = 0;
  for (const int j : body.spine_path) {
    const int parent = skeleton.joints[j].parent;
    if (i < body.spine.size() && body.spine[i].joint == j) {
      const double* angle = &spine.angles[kAxes * i];
      segment = segment * rotation_xzy({angle[0], angle[1], angle[2]});
      const quat to = spine.base * segment * body.spine[i].standing;
      pose.local[j] = glm::normalize(glm::conjugate(world.rotation[parent]) * to);
      ++i;
    }
    if (parent >= 0) world.rotation[j] = world.rotation[parent] * pose.local[j];
  }
}

bool is_spine_even(const UpperBodyParams& now) noexcept {
  return std::abs(now.spine_weight[kLowerSpine] - now.spine_weight[kUpperSpine]) < kEvenSpread;
}

void pose_spine(const UpperBodyModel& body, const Skeleton& skeleton, const SpineWeights& weight,
                const PosePart& pose, JointFrames& world) noexcept {
  forward_kinematics(skeleton, pose.root_m, pose.local, body.spine_path, world);
  Spine spine = spine_of(body, skeleton, world);
  stiffen_spine(body, weight, spine);
  const vec3 side_point = body.neck_m + vec3(kNeckLever_m, 0.0, 0.0);
  const vec3 neck = spine.last_m + spine.last * body.neck_m;
  const vec3 beside = spine.last_m + spine.last * side_point;
  const std::array<IkRow, 3> rows = {IkRow{body.neck_m, kLeft, neck.x},
                                     IkRow{body.neck_m, kForward, neck.z},
                                     IkRow{side_point, kForward, beside.z}};
  solve_robust(spine.chain, rows, kRobustBody, spine.angles);
  write_spine(body, skeleton, spine, pose, world);
}

// --- Arms ----------------------------------------------------------------------------------------

// One arm by weighted half-Jacobian IK: shoulder 3, elbow 1, wrist 2 angles; the end-effector is
// the middle of the hand. With the wrist as end-effector weights would have nearly no effect, as
// with the ankle: the distance from shoulder to wrist determines the elbow's angle.

// Greatest distance of a hand, as a share of the stretched arm's length, and the width in which it
// is approached.
constexpr double kFarthest = 0.985, kSoftFar = 0.03;
constexpr double kNearest = 0.3, kSoftNear = 0.1;
constexpr double kRailAhead_m = 0.15;  // how far ahead of the shoulder a hand holds a rail
// Angles of a left shoulder at which the solver starts for a held hand (a right one's z and y are
// mirrored). Elbows point down and a little outwards when a tray is carried, and back beside a
// rail.
using ShoulderAngles = std::array<double, 3>;
constexpr ShoulderAngles kCarrying = {-15.0 * kDegree, 12.0 * kDegree, -15.0 * kDegree};
constexpr ShoulderAngles kAtRail = {25.0 * kDegree, 4.0 * kDegree, 5.0 * kDegree};
// Factors on the style's weights: shoulder and elbow bring a held hand to its place; the wrist
// hardly takes part.
constexpr ArmWeights kHeldWeights = {1.0, 1.0, 0.7, 1.0, 0.25, 0.25};

// One arm in a pose.
struct Arm {
  const ArmBuild& build;
  quat base = kIdentity;                              // the walker's axes at the shoulder
  quat upper = kIdentity, fore = kIdentity;           // rotations of the hanging axes of both bones
  quat fore_rest = kIdentity, hand_rest = kIdentity;  // joint frames relative to the forearm's axes
  vec3 shoulder_m{0.0};
  IkChain chain;
  IkAngles angles{};
  vec3 grip_m{0.0};  // middle of the hand, in the forearm's hanging axes

  explicit Arm(const ArmBuild& b) noexcept : build(b) {}
};

Arm arm_of(const ArmBuild& build, const Skeleton& skeleton, const JointFrames& world) noexcept {
  const ArmChain& j = build.joints;
  Arm arm(build);
  arm.base = world.rotation[skeleton.joints[j.shoulder].parent] * build.chest;
  arm.upper = world.rotation[j.shoulder] * build.hanging;
  arm.shoulder_m = world.position_m[j.shoulder];
  const AnglesXzy a = angles_xzy(glm::conjugate(arm.base) * arm.upper);
  const vec3 upper_m = glm::conjugate(arm.upper) * (world.position_m[j.elbow] - arm.shoulder_m);
  const vec3 fore_m = world.position_m[j.wrist] - world.position_m[j.elbow];
  const vec3 in_upper = glm::conjugate(arm.upper) * fore_m;
  const double bend = gaitpad::atan2(-in_upper.z, -in_upper.y);
  arm.fore = arm.upper * rotation_x(bend);
  arm.fore_rest = glm::conjugate(arm.fore) * world.rotation[j.elbow];
  arm.hand_rest = glm::conjugate(arm.fore) * world.rotation[j.wrist];
  arm.grip_m = arm.hand_rest * build.grip_m;
  arm.angles[kShoulderX] = a.x, arm.angles[kShoulderZ] = a.z, arm.angles[kShoulderY] = a.y;
  arm.angles[kElbowX] = bend;
  constexpr std::array<vec3, kArmDofs> kAxis = {vec3(1, 0, 0), vec3(0, 0, 1), vec3(0, 1, 0),
                                                vec3(1, 0, 0), vec3(1, 0, 0), vec3(0, 0, 1)};
  arm.chain.dofs = kArmDofs;
  for (int d = 0; d < kArmDofs; ++d) {
    arm.chain.dof[d] = {.axis = kAxis[d], .min_rad = build.min_rad[d], .max_rad = build.max_rad[d]};
  }
  arm.chain.dof[kShoulderY].link_m = upper_m;
  arm.chain.dof[kElbowX].link_m = glm::conjugate(arm.fore) * fore_m;
  return arm;
}

bool has_uneven_weights(const UpperBodyParams& now, Side side) noexcept {
  const ArmWeights& weight = now.arm_weight[side];
  const auto [low, high] = std::minmax_element(weight.begin(), weight.end());
  return *high - *low >= kEvenSpread;
}

bool is_arm_free(const UpperBodyParams& now, Side side) noexcept {
  return !has_uneven_weights(now, side) && now.hand[side].carry <= 0.0 &&
         now.hand[side].rail <= 0.0;
}

// The places of the hands in the data, for arms that exist.
using HandPlaces = std::array<vec3, 2>;

vec3 hand_place(const ArmBuild& arm, const JointFrames& world) noexcept {
  return world.position_m[arm.joints.wrist] + world.rotation[arm.joints.wrist] * arm.grip_m;
}

struct Shoulders {
  vec3 middle_m{0.0};        // middle between the shoulders
  quat upright = kIdentity;  // the shoulders' turn about the vertical
};
Shoulders shoulders_of(const WalkModel& model, const JointFrames& world) noexcept {
  const std::array<ArmBuild, 2>& arm = model.body.arm;
  Shoulders s;
  if (arm[0].is_there && arm[1].is_there) {
    const vec3 left = world.position_m[arm[0].joints.shoulder],
               right = world.position_m[arm[1].joints.shoulder];
    s.middle_m = 0.5 * (left + right);
    const vec3 across = left - right;
    s.upright = rotation_y(heading_of(vec3(-across.z, 0.0, across.x)));
    return s;
  }
  const ArmBuild& only = arm[arm[0].is_there ? 0 : 1];
  const quat base =
      world.rotation[model.cycle.skeleton.joints[only.joints.shoulder].parent] * only.chest;
  s.middle_m = world.position_m[only.joints.shoulder];
  s.upright = rotation_y(heading_of(base * kForward));
  return s;
}

quat upper_turn(const Arm& arm) noexcept {
  return rotation_xzy({arm.angles[kShoulderX], arm.angles[kShoulderZ], arm.angles[kShoulderY]});
}

double sign_of(Side side) noexcept { return side == kLeftSide ? 1.0 : -1.0; }

double upper_m(const Arm& arm) noexcept { return glm::length(arm.chain.dof[kShoulderY].link_m); }
double lower_m(const Arm& arm) noexcept {
  return glm::length(arm.chain.dof[kElbowX].link_m + arm.grip_m);
}

// Moves a place to where the arm can reach it: neither too far from the shoulder nor too near.
vec3 within_reach(const Arm& arm, const vec3& place_m) noexcept {
  const double full = upper_m(arm) + lower_m(arm);
  const vec3 way = place_m - arm.shoulder_m;
  const double far = glm::length(way);
  if (far < 1e-9) return arm.shoulder_m + arm.base * vec3(0.0, 0.0, kNearest * full);
  const double near = soft_max(far, kNearest * full, kSoftNear * full);
  return arm.shoulder_m + way * (soft_min(near, kFarthest * full, kSoftFar * full) / far);
}

// A place in front of the chest, in the upright frame that turns with the shoulders, so that what
// both hands hold stays level.
vec3 carried_place(const HandParams& hand, const UpperBodyModel& body, Side side,
                   const Shoulders& shoulders) noexcept {
  const double scale = body.arm_m / kReferenceArm_m;
  return shoulders.middle_m +
         shoulders.upright * (scale * vec3(sign_of(side) * hand.x_m, hand.y_m, hand.z_m));
}

// A place on a rail that runs parallel to the hips' path.
vec3 rail_place(const WalkModel& model, const WalkState& state, const HandParams& hand,
                Side side) noexcept {
  const double scale = model.body.shoulder_height_m / kReferenceShoulder_m;
  const vec3 forward = heading_direction(state.path.heading_rad), left = glm::cross(kUp, forward);
  vec3 place = state.path.hips_m + left * (sign_of(side) * scale * hand.rail_side_m) +
               forward * (scale * kRailAhead_m);
  place.y = state.body.rail_ground_m[side] + scale * hand.rail_height_m;
  return place;
}

// The solver's start for a held hand: the elbow points outwards and has the bend for the distance
// of the place; the wrist is as in the data.
IkAngles held_start(const Arm& arm, Side side, double rail, const vec3& place_m) noexcept {
  const double a = upper_m(arm), b = lower_m(arm);
  const double far = glm::distance(place_m, arm.shoulder_m);
  const double bend = gaitpad::acos((far * far - a * a - b * b) / std::max(2.0 * a * b, 1e-9));
  IkAngles start{};
  start[kShoulderX] = mix(kCarrying[0], kAtRail[0], rail);
  start[kShoulderZ] = sign_of(side) * mix(kCarrying[1], kAtRail[1], rail);
  start[kShoulderY] = sign_of(side) * mix(kCarrying[2], kAtRail[2], rail);
  start[kElbowX] = -bend;
  return start;
}

// Keeps joints of small weight near the middle of their swing. The other joints compensate, so that
// the hand goes equally far forward and sideways. Its height is left free: with three rows the path
// alone would determine the shoulder's angle.
void stiffen_arm(const ArmBuild& build, const ArmWeights& weights, Arm& arm) noexcept {
  const double largest = std::max(1e-6, *std::max_element(weights.begin(), weights.end()));
  for (int d = 0; d < kArmDofs; ++d) {
    const double w = std::clamp(weights[d] / largest, 0.0, 1.0);
    arm.chain.dof[d].weight = w;
    arm.angles[d] += held_back(w) * (build.middle_rad[d] - arm.angles[d]);
  }
}

// Turns the whole arm at the shoulder towards the goal (from the shoulder, base frame). The solver
// then starts near its answer: it needs a third of the time and leaves the wrist as it is.
void aim_arm(const vec3& goal_m, Arm& arm) noexcept {
  const IkFrame end = end_frame(arm.chain, arm.angles);
  const vec3 hand_m = end.position_m + end.rotation * arm.grip_m;
  const double far = glm::length(hand_m), goal_far = glm::length(goal_m);
  if (far < 1e-6 || goal_far < 1e-6) return;
  const quat upper = upper_turn(arm);
  const AnglesXzy to = angles_xzy(rotation_between(hand_m / far, goal_m / goal_far) * upper);
  arm.angles[kShoulderX] += wrapped(to.x - arm.angles[kShoulderX]);
  arm.angles[kShoulderZ] = to.z;
  arm.angles[kShoulderY] += wrapped(to.y - arm.angles[kShoulderY]);
}

// Moves the hand from its swing to the carried object or to the rail, by the shares of both.
void hold_hand(const WalkModel& model, const WalkState& state, Side side,
               const Shoulders& shoulders, Arm& arm) noexcept {
  const HandParams& hand = state.body.now.hand[side];
  const double carry = std::clamp(hand.carry, 0.0, 1.0), rail = std::clamp(hand.rail, 0.0, 1.0);
  const double held = 1.0 - (1.0 - carry) * (1.0 - rail);
  if (held <= 0.0) return;
  const IkFrame end = end_frame(arm.chain, arm.angles);
  vec3 place = arm.shoulder_m + arm.base * (end.position_m + end.rotation * arm.grip_m);
  if (carry > 0.0) {
    const vec3 goal = within_reach(arm, carried_place(hand, model.body, side, shoulders));
    place += carry * (goal - place);
  }
  if (rail > 0.0) {
    const vec3 goal = within_reach(arm, rail_place(model, state, hand, side));
    place += rail * (goal - place);
  }
  const IkAngles start = held_start(arm, side, rail, place);
  for (int d = 0; d < kArmDofs; ++d) {
    arm.angles[d] += held * (start[d] - arm.angles[d]);
    arm.chain.dof[d].weight *= mix(1.0, kHeldWeights[d], smoothstep(0.0, 0.1, held));
  }
  const vec3 goal = glm::conjugate(arm.base) * (place - arm.shoulder_m);
  aim_arm(goal, arm);
  solve_robust(arm.chain, point_goal(arm.grip_m, goal), kRobustBody, arm.angles);
}

void write_arm(const Skeleton& skeleton, const Arm& arm, const PosePart& pose,
               JointFrames& world) noexcept {
  const ArmChain& j = arm.build.joints;
  const quat upper = arm.base * upper_turn(arm);
  const quat fore = upper * rotation_x(arm.angles[kElbowX]);
  const quat hand = fore * (rotation_x(arm.angles[kWristX]) * rotation_z(arm.angles[kWristZ]));
  bool is_below = false;
  for (const int k : arm.build.path) {
    is_below = is_below || k == j.shoulder;
    if (!is_below) continue;
    const quat& above = world.rotation[skeleton.joints[k].parent];
    const bool is_end = skeleton.joints[k].is_end_site;
    if (k == j.shoulder)
      pose.local[k] = glm::conjugate(above) * upper * glm::conjugate(arm.build.hanging);
    if (k == j.elbow) pose.local[k] = glm::conjugate(above) * fore * arm.fore_rest;
    if (k == j.wrist && !is_end) pose.local[k] = glm::conjugate(above) * hand * arm.hand_rest;
    pose.local[k] = glm::normalize(pose.local[k]);
    world.rotation[k] = above * pose.local[k];
  }
}

// `own_m`: the place of the hand in the data.
void pose_arm(const WalkModel& model, const WalkState& state, Side side, const Shoulders& shoulders,
              const vec3& own_m, const PosePart& pose, JointFrames& world) noexcept {
  const ArmBuild& build = model.body.arm[side];
  const UpperBodyParams& now = state.body.now;
  Arm arm = arm_of(build, model.cycle.skeleton, world);
  if (has_uneven_weights(now, side)) {
    stiffen_arm(build, now.arm_weight[side], arm);
    const vec3 own = glm::conjugate(arm.base) * (own_m - arm.shoulder_m);
    const std::array<IkRow, 2> path = {IkRow{arm.grip_m, kLeft, own.x},
                                       IkRow{arm.grip_m, kForward, own.z}};
    solve_robust(arm.chain, path, kRobustBody, arm.angles);
  }
  hold_hand(model, state, side, shoulders, arm);
  write_arm(model.cycle.skeleton, arm, pose, world);
}

// --- Head: it turns to where it is to look, and the neck takes its share -------------------------

// Largest angles of the head from the trunk.
constexpr double kMostYaw = 70.0 * kDegree, kMostPitch = 40.0 * kDegree;
constexpr double kSoftYaw = 6.0 * kDegree, kSoftHeadPitch = 4.0 * kDegree;
// The head does not follow a goal behind it, because turning left and right would be equally far,
// nor one straight above or below it (kLevelFrom, kLevelTo: horizontal part of its direction).
constexpr double kBesideYaw = 105.0 * kDegree, kBehindYaw = 150.0 * kDegree;
constexpr double kLevelFrom = 0.15, kLevelTo = 0.4;
constexpr double kNeckShare = 0.45;
constexpr double kLead_s = 0.6;  // time by which a leading head looks ahead of the walk

double soft_limited(double x, double most, double soft) noexcept {
  return soft_max(soft_min(x, most, soft), -most, soft);
}

// The head's rotation if it looks along `direction` (world, unit): upright, and within the limits
// of the neck. `share` fades to 0 for goals that the head does not follow.
struct Gaze {
  quat head = kIdentity;
  double share = 1.0;
};
Gaze gaze(const UpperBodyModel& body, const quat& trunk, const vec3& direction) noexcept {
  const vec3 d = glm::conjugate(trunk) * direction;
  const double level = horizontal_length(d);
  const double yaw = heading_of(d), pitch = gaitpad::atan2(d.y, level);
  Gaze to;
  to.share = (1.0 - smoothstep(kBesideYaw, kBehindYaw, std::abs(yaw))) *
             smoothstep(kLevelFrom, kLevelTo, level);
  const SinCos y = sin_cos(soft_limited(yaw, kMostYaw, kSoftYaw));
  const SinCos p = sin_cos(soft_limited(pitch, kMostPitch, kSoftHeadPitch));
  const vec3 ahead = trunk * vec3(p.cos * y.sin, p.sin, p.cos * y.cos);
  const vec3 left = glm::normalize(glm::cross(kUp, ahead));
  to.head = from_axes(left, glm::cross(ahead, left), ahead) * body.head_standing;
  return to;
}

// Turns neck and head by `turn` (world): the neck by its share, the head by the whole turn.
void turn_head(const UpperBodyModel& body, const Skeleton& skeleton, const quat& turn,
               const PosePart& pose, JointFrames& world) noexcept {
  const int last = static_cast<int>(body.head_path.size()) - 1;
  std::array<quat, kMaxBodyPath> own;
  for (int i = body.neck_at; i <= last; ++i) own[i] = world.rotation[body.head_path[i]];
  for (int i = body.neck_at; i <= last; ++i) {
    const int j = body.head_path[i], parent = skeleton.joints[j].parent;
    const double share =
        i == last ? 1.0 : kNeckShare * (i - body.neck_at + 1) / (last - body.neck_at);
    const quat to = nlerp(kIdentity, turn, share) * own[i];
    pose.local[j] = glm::normalize(glm::conjugate(world.rotation[parent]) * to);
    world.position_m[j] =
        world.position_m[parent] + world.rotation[parent] * skeleton.joints[j].offset_m;
    world.rotation[j] = world.rotation[parent] * pose.local[j];
  }
}

// Share of the lean into a change of speed that the head does not follow.
constexpr double kHeadStays = 0.8;

bool is_head_free(const HeadParams& head) noexcept {
  return head.look <= 0.0 && head.look_at <= 0.0 && head.lead <= 0.0;
}

void pose_head(const Tick& tick, WalkState& state, const PosePart& pose,
               JointFrames& world) noexcept {
  const WalkModel& model = tick.model;
  const UpperBodyModel& body = model.body;
  const Skeleton& skeleton = model.cycle.skeleton;
  const HeadParams& now = state.body.now.head;
  forward_kinematics(skeleton, pose.root_m, pose.local, body.head_path, world);
  const int head = body.head_path.back();
  const int chest = skeleton.joints[body.head_path[body.neck_at]].parent;
  const quat trunk = world.rotation[chest] * glm::conjugate(body.chest_standing);
  // `from`: the head's rotation without this goal.
  const auto look = [&](const quat& from, const vec3& direction, double share) {
    const Gaze to = gaze(body, trunk, direction);
    const quat wanted = nlerp(from, to.head, std::clamp(share, 0.0, 1.0) * to.share);
    turn_head(body, skeleton, wanted * glm::conjugate(world.rotation[head]), pose, world);
  };
  const UpperBodyState& ahead_of = state.body;
  const IdleState& idle = state.idle;
  const double turns = ahead_of.head_ahead_rad.x - ahead_of.chest_ahead_rad.x + idle.glance_rad,
               nods = kHeadStays * (ahead_of.push_rad.x - idle.breath_rad) - idle.nod_rad;
  if (turns != 0.0 || nods != 0.0) {
    const quat to = rotation_y(state.path.heading_rad);
    turn_head(body, skeleton, to * rotation_y(turns) * rotation_x(-nods) * glm::conjugate(to), pose,
              world);
  }
  if (tick.mode != IkMode::paper) {
    const double heading = state.path.heading_rad;
    const vec3 goal = turn_of(world.rotation[head], body.head_standing, heading),
               value = eased_turn(tick, state, goal, kMostHead_s2, state.body.eased_head);
    if (value != goal) {
      const quat to = rotation_y(heading);
      turn_head(body, skeleton,
                to * from_rotation_vector(value) * from_rotation_vector(-goal) * glm::conjugate(to),
                pose, world);
    }
  }
  if (now.lead > 0.0) {
    const quat ahead = rotation_y(now.lead * kLead_s * state.gait.turn_rate.x);
    turn_head(body, skeleton, ahead, pose, world);
  }
  if (now.look > 0.0) {
    const SinCos p = sin_cos(now.pitch_deg * kDegree);
    look(world.rotation[head],
         rotation_y(state.path.heading_rad + now.yaw_deg * kDegree) * vec3(0.0, p.sin, p.cos),
         now.look);
  }
  // The head moves when it turns, so a near place is aimed at twice.
  const quat own = world.rotation[head];
  vec3 place_m(now.x_m, now.y_m, now.z_m);
  if (state.placed != Placement{}) place_m = from_world(state.placed, place_m);
  for (int pass = 0; now.look_at > 0.0 && pass < 2; ++pass) {
    const vec3 way = place_m - world.position_m[head];
    const double far = glm::length(way);
    if (far > 1e-3) look(own, way / far, now.look_at);
  }
}

}  // namespace

namespace {

// The trunk leans into a change of speed: forward while the walk is slower than asked, back while
// it is faster. kFirstPush is added, in part while more than kFirstFrom of the asked speed is
// missing and fully from kFirstAll on, so that a slow walk leans as well. Head and chest turn
// before the pelvis (in people by up to 0.3 s). Times in seconds at the reference leg.
constexpr double kPush = 3.0 * kDegree;  // lean for a missing speed of 1 m/s
constexpr double kFirstPush = 2.0 * kDegree, kFirstFrom = 0.4, kFirstAll = 0.8;
constexpr double kCalm = 0.25, kSoftCalm_m_s = 0.1;
constexpr double kPushSmoothing = 0.04, kSpeedSmoothing = 0.15;
constexpr double kHeadAhead_s = 0.30, kHeadSmoothing = 0.07;
constexpr double kChestAhead_s = 0.13, kChestSmoothing = 0.10;
constexpr double kStill_rad = 1e-7;

void settle(double goal, double time_s, double dt_s, Damped<double>& value) noexcept {
  value.advance(goal, time_s, dt_s);
  if (goal == 0.0 && std::abs(value.x) < kStill_rad) value = {};
}

void look_and_lean_ahead(const Tick& tick, WalkState& state) noexcept {
  UpperBodyState& body = state.body;
  const GaitParams& params = tick.params;
  const double scale = tick.model.time_scale, dt = tick.dt_s;
  const bool walks = walks_on(params, state);
  const std::array<StrideParams, 2>& stride = params.stride;
  const double pace = (stride[0].length_m + stride[1].length_m) /
                      std::max(stride[0].time_s + stride[1].time_s, 0.2);
  const double asked = walks ? params.backward ? -pace : pace : 0.0;
  const vec3 forward = heading_direction(state.path.heading_rad);
  body.speed_m_s.advance(glm::dot(state.path.pelvis_m.v, forward) / dt, kSpeedSmoothing * scale,
                         dt);
  const double lacks = asked - body.speed_m_s.x;
  const double calm = kCalm * std::max(std::abs(asked), std::abs(body.speed_m_s.x));
  const double size = soft_positive(std::abs(lacks) - calm - kSoftCalm_m_s, kSoftCalm_m_s);
  const double first = asked == 0.0
                           ? 0.0
                           : kFirstPush * smoothstep(kFirstFrom * std::abs(asked),
                                                     kFirstAll * std::abs(asked), std::abs(lacks)),
               push = kPush * size + first;
  settle(lacks < 0.0 ? -push : push, kPushSmoothing * scale, dt, body.push_rad);
  const double turn = walks ? params.turn_rate_rad_s : 0.0;
  settle(kChestAhead_s * turn, kChestSmoothing * scale, dt, body.chest_ahead_rad);
  settle(kHeadAhead_s * turn, kHeadSmoothing * scale, dt, body.head_ahead_rad);
}

}  // namespace

void smooth_upper_body(const Tick& tick, WalkState& state) noexcept {
  UpperBodyState& body = state.body;
  settle_values(tick, body);
  if (tick.mode != IkMode::paper) look_and_lean_ahead(tick, state);
  for (const Side side : {kLeftSide, kRightSide}) {
    if (body.now.hand[side].rail > 0.0 || body.goal.hand[side].rail > 0.0)
      follow_rail(tick, side, state);
  }
}

void pose_upper_body(const Tick& tick, WalkState& state, const PosePart& pose) noexcept {
  hold_posture(tick, state);
  const WalkModel& model = tick.model;
  const UpperBodyParams& now = state.body.now;
  const Skeleton& skeleton = model.cycle.skeleton;
  lean_trunk(model, state, pose);
  ease_chest(tick, state, pose);
  spread_arms(model, state, pose);
  const bool moves_spine = model.body.spine.size() > 1 && !is_spine_even(now);
  std::array<bool, 2> moves_arm;
  for (const Side side : {kLeftSide, kRightSide})
    moves_arm[side] = model.body.arm[side].is_there && !is_arm_free(now, side);
  const bool moves_head =
      !model.body.head_path.empty() &&
      (!is_head_free(now.head) || state.body.push_rad.x != 0.0 ||
       state.body.head_ahead_rad.x != 0.0 || state.body.chest_ahead_rad.x != 0.0 ||
       state.idle.share != 0.0 || state.path.unsteady != 0.0 || state.body.eased_head.ticks > 0.0);
  if (!moves_head && !model.body.head_path.empty() && tick.mode != IkMode::paper) {
    const int head = model.body.head_path.back();
    keep(turn_of(rotation_above(skeleton, pose, head) * pose.local[head], model.body.head_standing,
                 state.path.heading_rad),
         state.body.eased_head);
  }
  if (!moves_spine && !moves_arm[0] && !moves_arm[1] && !moves_head) return;

  JointFrames world;
  HandPlaces own_m{};
  for (const Side side : {kLeftSide, kRightSide}) {
    if (!model.body.arm[side].is_there || !(moves_arm[0] || moves_arm[1])) continue;
    forward_kinematics(skeleton, pose.root_m, pose.local, model.body.arm[side].path, world);
    own_m[side] = hand_place(model.body.arm[side], world);
  }
  if (moves_spine) {
    pose_spine(model.body, skeleton, now.spine_weight, pose, world);
    for (const Side side : {kLeftSide, kRightSide}) {
      if (moves_arm[side])
        forward_kinematics(skeleton, pose.root_m, pose.local, model.body.arm[side].path, world);
    }
  }
  Shoulders shoulders;
  if (moves_arm[0] || moves_arm[1]) shoulders = shoulders_of(model, world);
  for (const Side side : {kLeftSide, kRightSide}) {
    if (moves_arm[side]) pose_arm(model, state, side, shoulders, own_m[side], pose, world);
  }
  if (moves_head) pose_head(tick, state, pose, world);
}

}  // namespace gaitpad
