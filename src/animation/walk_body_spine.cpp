// The spine by weighted half-Jacobian IK: its joints share the way to where the data carry the neck
// and turn the shoulders. Four rows, all of positions: the neck's sideways and fore-aft place, the
// same of a point beside it.
#include "animation/walk_body_parts.h"
#include "motion/cycle_leg.h"

namespace gaitpad {
namespace {

constexpr RobustOptions kRobust = {.tolerance_m = 1e-6, .max_iterations = 40, .max_tries = 1};
constexpr double kSideLever_m = 0.2;
constexpr double kMostBend = 60.0 * kDegree;  // of one joint
constexpr int kAxes = 3;
static_assert(kAxes * kMaxSpineIk <= kMaxIkDofs);

}  // namespace

bool is_spine_even(const BodyParams& now) noexcept {
  return std::abs(now.spine_weight[kLowerSpine] - now.spine_weight[kUpperSpine]) < kEvenBodySpread;
}

void pose_spine(const BodyModel& body, const Skeleton& skeleton, const SpineWeights& weight,
                Pose& pose, JointFrames& world) noexcept {
  carry_path(skeleton, body.spine_path, pose, world);
  const int count = static_cast<int>(body.spine.size());
  const quat base = world.rotation[skeleton.joints[body.spine.front().joint].parent] *
                    glm::conjugate(body.spine_base);
  const quat to_base = glm::conjugate(base);
  // Segments: how far each joint has turned from its standing pose, in the walker's axes.
  std::array<quat, kMaxSpineIk> own;
  IkChain chain;
  IkAngles angles{};
  chain.dofs = kAxes * count;
  const double largest = std::max({1e-6, weight[kLowerSpine], weight[kUpperSpine]});
  quat below = kIdentity;
  for (int i = 0; i < count; ++i) {
    const SpineJoint& at = body.spine[i];
    own[i] = to_base * world.rotation[at.joint] * glm::conjugate(at.standing);
    const AnglesXzy turn = angles_xzy(glm::conjugate(below) * own[i]);
    below = own[i];
    const double w =
        std::clamp(mix(weight[kLowerSpine], weight[kUpperSpine], at.upper) / largest, 0.0, 1.0);
    const std::array<double, kAxes> own_rad = {turn.x, turn.z, turn.y};
    constexpr std::array<vec3, kAxes> kAxis = {vec3(1, 0, 0), vec3(0, 0, 1), vec3(0, 1, 0)};
    for (int a = 0; a < kAxes; ++a) {
      angles[kAxes * i + a] = own_rad[a] * (1.0 - held_back(w));
      chain.dof[kAxes * i + a] = {
          .axis = kAxis[a], .min_rad = -kMostBend, .max_rad = kMostBend, .weight = w};
    }
    if (i + 1 < count) {
      const vec3 link = world.position_m[body.spine[i + 1].joint] - world.position_m[at.joint];
      chain.dof[kAxes * i + 2].link_m = glm::conjugate(own[i]) * (to_base * link);
    }
  }
  // The neck is as far above the last joint as the shoulders' lever is wide.
  const vec3 origin = world.position_m[body.spine.front().joint];
  const vec3 last = to_base * (world.position_m[body.spine.back().joint] - origin);
  const vec3 neck_point = body.neck_m, side_point = body.neck_m + vec3(kSideLever_m, 0.0, 0.0);
  const vec3 neck = last + own[count - 1] * neck_point, beside = last + own[count - 1] * side_point;
  const std::array<IkRow, 4> rows = {
      IkRow{neck_point, vec3(1, 0, 0), neck.x}, IkRow{neck_point, vec3(0, 0, 1), neck.z},
      IkRow{side_point, vec3(0, 1, 0), beside.y}, IkRow{side_point, vec3(0, 0, 1), beside.z}};
  solve_robust(chain, rows, kRobust, angles);
  quat segment = kIdentity;
  for (int i = 0, k = 0; i < count; ++i) {
    const SpineJoint& at = body.spine[i];
    segment = segment * (rotation_x(angles[kAxes * i]) * rotation_z(angles[kAxes * i + 1]) *
                         rotation_y(angles[kAxes * i + 2]));
    for (; k < static_cast<int>(body.spine_path.size()) && body.spine_path[k] != at.joint; ++k) {
      const int j = body.spine_path[k], parent = skeleton.joints[j].parent;
      if (parent >= 0) world.rotation[j] = world.rotation[parent] * pose.local[j];
    }
    const quat& above = world.rotation[skeleton.joints[at.joint].parent];
    world.rotation[at.joint] = base * segment * at.standing;
    pose.local[at.joint] = glm::normalize(glm::conjugate(above) * world.rotation[at.joint]);
    ++k;
  }
}

}  // namespace gaitpad
