// One arm by weighted half-Jacobian IK: shoulder 3, elbow 1, wrist 2; the end-effector is the
// middle of the hand. With the wrist as end-effector weights would change next to nothing, as with
// the ankle: the distance from shoulder to wrist is the elbow's angle.
#include "animation/walk_body_parts.h"
#include "motion/cycle_leg.h"

namespace gaitpad {
namespace {

constexpr RobustOptions kRobust = {.tolerance_m = 1e-6, .max_iterations = 40, .max_tries = 1};
constexpr double kFarthest = 0.985, kSoftFar = 0.03;  // of the stretched arm: a hand's place
constexpr double kNearest = 0.3, kSoftNear = 0.1;
constexpr double kRailAhead_m = 0.15;  // of the shoulder, where a hand takes hold of a rail
// Shoulder of a held hand's arm: what the solver starts from, of a left arm (a right one's z and y
// are mirrored). Elbows point down and a little out where a tray is carried, back beside a rail.
using ShoulderAngles = std::array<double, 3>;
constexpr ShoulderAngles kCarrying = {-15.0 * kDegree, 12.0 * kDegree, -15.0 * kDegree};
constexpr ShoulderAngles kAtRail = {25.0 * kDegree, 4.0 * kDegree, 5.0 * kDegree};
// Beside the style's weights: held hands are brought about by shoulder and elbow.
constexpr ArmWeights kHeldWeights = {1.0, 1.0, 0.7, 1.0, 0.25, 0.25};

// One arm as it stands in a pose.
struct Arm {
  const ArmBuild& build;
  quat base = kIdentity;                              // the walker's axes at the shoulder
  quat upper = kIdentity, fore = kIdentity;           // hanging axes of both bones
  quat fore_rest = kIdentity, hand_rest = kIdentity;  // joint frames in those of the forearm
  vec3 shoulder_m{0.0};
  IkChain chain;
  IkAngles angles{};
  vec3 grip_m{0.0};  // in the forearm's hanging axes

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

bool has_uneven_weights(const BodyParams& now, Side side) noexcept {
  const ArmWeights& weight = now.arm_weight[side];
  const auto [low, high] = std::minmax_element(weight.begin(), weight.end());
  return *high - *low >= kEvenBodySpread;
}

double sign_of(Side side) noexcept { return side == kLeftSide ? 1.0 : -1.0; }

double upper_m(const Arm& arm) noexcept { return glm::length(arm.chain.dof[kShoulderY].link_m); }
double lower_m(const Arm& arm) noexcept {
  return glm::length(arm.chain.dof[kElbowX].link_m + arm.grip_m);
}

// The place within what the arm reaches around its shoulder.
vec3 within_reach(const Arm& arm, const vec3& place_m) noexcept {
  const double full = upper_m(arm) + lower_m(arm);
  const vec3 way = place_m - arm.shoulder_m;
  const double far = glm::length(way);
  if (far < 1e-9) return arm.shoulder_m + arm.base * vec3(0.0, 0.0, kNearest * full);
  const double near = soft_max(far, kNearest * full, kSoftNear * full);
  return arm.shoulder_m + way * (soft_min(near, kFarthest * full, kSoftFar * full) / far);
}

// Before the chest: in the upright frame that turns with the shoulders, so what both hands hold
// stays level.
vec3 carried_place(const HandParams& hand, const BodyModel& body, Side side,
                   const Shoulders& shoulders) noexcept {
  const double scale = body.arm_m / kReferenceArm_m;
  return shoulders.middle_m +
         shoulders.upright * (scale * vec3(sign_of(side) * hand.x_m, hand.y_m, hand.z_m));
}

// On a rail that runs along with the hips' path.
vec3 rail_place(const WalkModel& model, const WalkState& state, const HandParams& hand,
                Side side) noexcept {
  const double scale = model.body.shoulder_height_m / kReferenceShoulder_m;
  const vec3 forward = heading_direction(state.heading_rad), left = glm::cross(kUp, forward);
  vec3 place = state.hips_m + left * (sign_of(side) * scale * hand.rail_side_m) +
               forward * (scale * kRailAhead_m);
  place.y = state.body.rail_ground_m[side] + scale * hand.rail_height_m;
  return place;
}

// Where the solver starts for a held hand: out, bent as far as the place is away, and the wrist as
// in the data.
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

// Joints of small weight hold on to the middle of their swing; the others make up for it, so that
// the hand goes as far forward and aside as it went. Its height gives way: with it the shoulder's
// angle would follow from the path alone.
void stiffen(const ArmBuild& build, const ArmWeights& weights, Arm& arm) noexcept {
  const double largest = std::max(1e-6, *std::max_element(weights.begin(), weights.end()));
  for (int d = 0; d < kArmDofs; ++d) {
    const double w = std::clamp(weights[d] / largest, 0.0, 1.0);
    arm.chain.dof[d].weight = w;
    arm.angles[d] += held_back(w) * (build.middle_rad[d] - arm.angles[d]);
  }
}

// Turns the whole arm at the shoulder towards the goal (from the shoulder, base frame): so little
// is left to the solver that it needs a third of the time, and the wrist stays as it is.
void aim(const vec3& goal_m, Arm& arm) noexcept {
  const IkFrame end = end_frame(arm.chain, arm.angles);
  const vec3 hand_m = end.position_m + end.rotation * arm.grip_m;
  const double far = glm::length(hand_m), goal_far = glm::length(goal_m);
  if (far < 1e-6 || goal_far < 1e-6) return;
  const quat upper =
      rotation_xzy({arm.angles[kShoulderX], arm.angles[kShoulderZ], arm.angles[kShoulderY]});
  const AnglesXzy to = angles_xzy(rotation_between(hand_m / far, goal_m / goal_far) * upper);
  arm.angles[kShoulderX] += wrapped(to.x - arm.angles[kShoulderX]);
  arm.angles[kShoulderZ] = to.z;
  arm.angles[kShoulderY] += wrapped(to.y - arm.angles[kShoulderY]);
}

// Brings the hand from where it swings to where it is to be.
void hold(const WalkModel& model, const WalkState& state, Side side, const Shoulders& shoulders,
          Arm& arm) noexcept {
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
  aim(goal, arm);
  solve_robust(arm.chain, point_goal(arm.grip_m, goal), kRobust, arm.angles);
}

void write_arm(const Skeleton& skeleton, const Arm& arm, Pose& pose, JointFrames& world) noexcept {
  const ArmChain& j = arm.build.joints;
  const quat upper =
      arm.base * (rotation_x(arm.angles[kShoulderX]) * rotation_z(arm.angles[kShoulderZ]) *
                  rotation_y(arm.angles[kShoulderY]));
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

}  // namespace

bool is_arm_free(const BodyParams& now, Side side) noexcept {
  return !has_uneven_weights(now, side) && now.hand[side].carry <= 0.0 &&
         now.hand[side].rail <= 0.0;
}

vec3 hand_place(const ArmBuild& arm, const JointFrames& world) noexcept {
  return world.position_m[arm.joints.wrist] + world.rotation[arm.joints.wrist] * arm.grip_m;
}

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

void pose_arm(const WalkModel& model, const WalkState& state, Side side, const Shoulders& shoulders,
              const vec3& own_m, Pose& pose, JointFrames& world) noexcept {
  const ArmBuild& build = model.body.arm[side];
  const BodyParams& now = state.body.now;
  Arm arm = arm_of(build, model.cycle.skeleton, world);
  if (has_uneven_weights(now, side)) {
    stiffen(build, now.arm_weight[side], arm);
    const vec3 own = glm::conjugate(arm.base) * (own_m - arm.shoulder_m);
    const std::array<IkRow, 2> path = {IkRow{arm.grip_m, kLeft, own.x},
                                       IkRow{arm.grip_m, kForward, own.z}};
    solve_robust(arm.chain, path, kRobust, arm.angles);
  }
  hold(model, state, side, shoulders, arm);
  write_arm(model.cycle.skeleton, arm, pose, world);
}

}  // namespace gaitpad
