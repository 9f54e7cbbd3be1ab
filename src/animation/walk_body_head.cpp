// The head turns to where it is to look, the neck takes its share.
#include "animation/walk_body_parts.h"

namespace gaitpad {
namespace {

constexpr double kMostYaw = 70.0 * kDegree, kMostPitch = 40.0 * kDegree;  // from the trunk
constexpr double kSoftYaw = 6.0 * kDegree, kSoftPitch = 4.0 * kDegree;
// What is behind is not looked at: there left and right are the same.
constexpr double kBesideYaw = 105.0 * kDegree, kBehindYaw = 150.0 * kDegree;
constexpr double kLevelFrom = 0.15, kLevelTo = 0.4;  // nor what is straight above or below
constexpr double kNeckShare = 0.45;
constexpr double kLead_s = 0.6;  // how far ahead of the walk a leading head looks

double within(double x, double most, double soft) noexcept {
  return soft_max(soft_min(x, most, soft), -most, soft);
}

// Where the head stands when it looks along `direction` (world, unit), upright, as far as the trunk
// lets it; and how much of that it wants.
struct Gaze {
  quat head = kIdentity;
  double share = 1.0;
};
Gaze gaze(const BodyModel& body, const quat& trunk, const vec3& direction) noexcept {
  const vec3 d = glm::conjugate(trunk) * direction;
  const double level = std::sqrt(d.x * d.x + d.z * d.z);
  const double yaw = heading_of(d), pitch = gaitpad::atan2(d.y, level);
  Gaze to;
  to.share = (1.0 - smoothstep(kBesideYaw, kBehindYaw, std::abs(yaw))) *
             smoothstep(kLevelFrom, kLevelTo, level);
  const SinCos y = sin_cos(within(yaw, kMostYaw, kSoftYaw));
  const SinCos p = sin_cos(within(pitch, kMostPitch, kSoftPitch));
  const vec3 ahead = trunk * vec3(p.cos * y.sin, p.sin, p.cos * y.cos);
  const vec3 left = glm::normalize(glm::cross(kUp, ahead));
  to.head = from_axes(left, glm::cross(ahead, left), ahead) * body.head_standing;
  return to;
}

// Turns neck and head by `turn` (world): the neck by its share, the head by all of it.
void turn_head(const BodyModel& body, const Skeleton& skeleton, const quat& turn, Pose& pose,
               JointFrames& world) noexcept {
  const int last = static_cast<int>(body.head_path.size()) - 1;
  std::array<quat, kMaxBodyPath> own;
  for (int i = body.neck_at; i <= last; ++i) own[i] = world.rotation[body.head_path[i]];
  for (int i = body.neck_at; i <= last; ++i) {
    const int j = body.head_path[i], parent = skeleton.joints[j].parent;
    const double share =
        i == last ? 1.0 : kNeckShare * (i - body.neck_at + 1) / (last - body.neck_at);
    const quat to = between(kIdentity, turn, share) * own[i];
    pose.local[j] = glm::normalize(glm::conjugate(world.rotation[parent]) * to);
    world.position_m[j] =
        world.position_m[parent] + world.rotation[parent] * skeleton.joints[j].offset_m;
    world.rotation[j] = world.rotation[parent] * pose.local[j];
  }
}

}  // namespace

bool is_head_free(const HeadParams& head) noexcept {
  return head.look <= 0.0 && head.look_at <= 0.0 && head.lead <= 0.0;
}

void pose_head(const WalkModel& model, const WalkState& state, Pose& pose,
               JointFrames& world) noexcept {
  const BodyModel& body = model.body;
  const Skeleton& skeleton = model.cycle.skeleton;
  const HeadParams& now = state.body.now.head;
  carry_path(skeleton, body.head_path, pose, world);
  const int head = body.head_path.back();
  const int chest = skeleton.joints[body.head_path[body.neck_at]].parent;
  const quat trunk = world.rotation[chest] * glm::conjugate(body.chest_standing);
  const auto look = [&](const vec3& direction, double share) {
    const Gaze to = gaze(body, trunk, direction);
    const quat& own = world.rotation[head];
    const quat wanted = between(own, to.head, std::clamp(share, 0.0, 1.0) * to.share);
    turn_head(body, skeleton, wanted * glm::conjugate(own), pose, world);
  };
  if (now.lead > 0.0) {
    const quat ahead = rotation_y(now.lead * kLead_s * state.turn_rate.x);
    turn_head(body, skeleton, ahead, pose, world);
  }
  if (now.look > 0.0) {
    const SinCos p = sin_cos(now.pitch_deg * kDegree);
    look(rotation_y(state.heading_rad + now.yaw_deg * kDegree) * vec3(0.0, p.sin, p.cos), now.look);
  }
  // The head moves as it turns, so a near place is aimed at twice.
  for (int pass = 0; now.look_at > 0.0 && pass < 2; ++pass) {
    const vec3 way = vec3(now.x_m, now.y_m, now.z_m) - world.position_m[head];
    const double far = glm::length(way);
    if (far > 1e-3) look(way / far, pass == 0 || now.look_at >= 1.0 ? now.look_at : 0.0);
  }
}

}  // namespace gaitpad
