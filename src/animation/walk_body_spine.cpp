// The spine by weighted half-Jacobian IK: its joints share the way to where the data carry the neck
// and turn the shoulders. Three rows, all of positions: the neck's sideways and fore-aft place, and
// how far ahead a point beside it is.
#include "animation/walk_body_parts.h"
#include "motion/cycle_leg.h"

namespace gaitpad {
namespace {

constexpr RobustOptions kRobust = {.tolerance_m = 1e-6, .max_iterations = 40, .max_tries = 1};
constexpr double kSideLever_m = 0.2;
constexpr double kMostBend = 60.0 * kDegree;  // of one joint
constexpr int kAxes = 3;                      // a joint
static_assert(kAxes * kMaxSpineIk <= kMaxIkDofs);
constexpr std::array<vec3, kAxes> kAxis = {vec3(1, 0, 0), vec3(0, 0, 1), vec3(0, 1, 0)};

// The spine as it stands in a pose, in the walker's axes as its foundation holds them.
struct Spine {
  quat base = kIdentity;
  IkChain chain;
  IkAngles angles{};      // how far each joint is turned from its standing pose
  quat last = kIdentity;  // the uppermost joint's turn
  vec3 last_m{0.0};       // its place, from the lowest
};

Spine spine_of(const BodyModel& body, const Skeleton& skeleton, const JointFrames& world) noexcept {
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

// Joints of small weight keep to the standing pose.
void stiffen(const BodyModel& body, const SpineWeights& weight, Spine& spine) noexcept {
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

void write_spine(const BodyModel& body, const Skeleton& skeleton, const Spine& spine, Pose& pose,
                 JointFrames& world) noexcept {
  quat segment = kIdentity;
  std::size_t i = 0;
  for (const int j : body.spine_path) {
    const int parent = skeleton.joints[j].parent;
    if (i < body.spine.size() && body.spine[i].joint == j) {
      const double* angle = &spine.angles[kAxes * i];
      segment = segment * (rotation_x(angle[0]) * rotation_z(angle[1]) * rotation_y(angle[2]));
      const quat to = spine.base * segment * body.spine[i].standing;
      pose.local[j] = glm::normalize(glm::conjugate(world.rotation[parent]) * to);
      ++i;
    }
    if (parent >= 0) world.rotation[j] = world.rotation[parent] * pose.local[j];
  }
}

}  // namespace

bool is_spine_even(const BodyParams& now) noexcept {
  return std::abs(now.spine_weight[kLowerSpine] - now.spine_weight[kUpperSpine]) < kEvenBodySpread;
}

void pose_spine(const BodyModel& body, const Skeleton& skeleton, const SpineWeights& weight,
                Pose& pose, JointFrames& world) noexcept {
  carry_path(skeleton, body.spine_path, pose, world);
  Spine spine = spine_of(body, skeleton, world);
  stiffen(body, weight, spine);
  const vec3 side_point = body.neck_m + vec3(kSideLever_m, 0.0, 0.0);
  const vec3 neck = spine.last_m + spine.last * body.neck_m;
  const vec3 beside = spine.last_m + spine.last * side_point;
  const std::array<IkRow, 3> rows = {IkRow{body.neck_m, kLeft, neck.x},
                                     IkRow{body.neck_m, kForward, neck.z},
                                     IkRow{side_point, kForward, beside.z}};
  solve_robust(spine.chain, rows, kRobust, spine.angles);
  write_spine(body, skeleton, spine, pose, world);
}

}  // namespace gaitpad
