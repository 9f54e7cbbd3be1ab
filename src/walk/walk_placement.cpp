// Places a walk in the world, and lets it follow a body that an engine moves.
#include <cmath>
#include <limits>

#include "gaitpad/control.h"
#include "gaitpad/walk.h"
#include "walk/steer.h"

namespace gaitpad {

namespace {

// True if each number is finite and at most kFarthest_m; counts those that are not.
bool is_sound_move(const vec3& place_m, double heading_rad, WalkState& state) noexcept {
  int bad = 0;
  for (const double number : {place_m.x, place_m.y, place_m.z, heading_rad})
    bad += !(std::abs(number) <= kFarthest_m);
  state.bad_inputs += bad;
  return bad == 0;
}

void place_walk(const Placement& by, WalkState& state, Pose& pose) noexcept {
  if (by == Placement{}) return;
  state.placed = moved(by, state.placed);
  place(state.placed, 0, state.walk);
  pose.root_m = to_world(by, pose.root_m);
  pose.local[0] = rotation_y(by.heading_rad) * pose.local[0];
}

bool is_finite(const CapsuleMotion& c) noexcept {
  const vec3 sum = c.place_m + c.velocity_m_s;
  return std::isfinite(sum.x + sum.y + sum.z + c.heading_rad + c.turn_rate_rad_s);
}

}  // namespace

void move_walk(const Placement& by, WalkState& state, Pose& pose) noexcept {
  if (is_sound_move(by.place_m, by.heading_rad, state)) place_walk(by, state, pose);
}

void put_walk(const vec3& place_m, double heading_rad, WalkState& state, Pose& pose) noexcept {
  if (!is_sound_move(place_m, heading_rad, state)) return;
  Placement by;
  by.heading_rad = heading_rad - (state.placed.heading_rad + state.root.heading_rad);
  by.place_m = place_m - to_world(by, to_world(state.placed, state.root.place_m));
  place_walk(by, state, pose);
}

GaitParams following(const CapsuleMotion& capsule, const WalkState& state, const StyleValues& style,
                     const GaitLimits& limits) noexcept {
  // Time constants: of the distance to the body, and of the turn towards it.
  constexpr double kCatchUp_s = 0.6, kTurns_s = 0.35;
  constexpr double kStill_m_s = 0.1, kBeside_m = 0.8;  // a slower and nearer body has arrived
  constexpr double kNear_m = 0.12, kFaces_rad = 3.0 * kDegree;  // a walk that is nearer stands
  const Placement root = moved(state.placed, state.root);
  Stick stick;
  if (!is_finite(capsule)) {
    stick.left = vec2(std::numeric_limits<double>::quiet_NaN());
    return gait_params(stick, style, limits);
  }
  vec3 off_m = capsule.place_m - root.place_m;
  off_m.y = 0.0;
  const vec3 goes = capsule.velocity_m_s + off_m / kCatchUp_s;
  const bool arrives =
      horizontal_length(capsule.velocity_m_s) < kStill_m_s && horizontal_length(off_m) < kBeside_m;
  const double aim_rad = arrives ? capsule.heading_rad : heading_of(goes);
  const double off_rad = aim_rad - root.heading_rad,
               left_rad = off_rad - 2.0 * kPi * std::floor(off_rad / (2.0 * kPi) + 0.5);
  // The walk steps back only to a body that has arrived; otherwise it turns round.
  const double along = glm::dot(goes, heading_direction(root.heading_rad)),
               ahead = arrives ? along : std::max(0.0, along);
  GaitOverrides overrides;
  const auto ask = [&overrides](GaitKey key, double value) {
    overrides.value[static_cast<std::size_t>(key)] = value;
    overrides.is_set[static_cast<std::size_t>(key)] = true;
  };
  if (std::abs(ahead) > kNear_m / kCatchUp_s) {
    stick.left.y = 1.0;
    ask(GaitKey::speed_m_s, ahead);
  } else if (std::abs(left_rad) < kFaces_rad) {
    return gait_params(stick, style, limits);
  }
  ask(GaitKey::turn_rate_rad_s, capsule.turn_rate_rad_s + left_rad / kTurns_s);
  return gait_params(stick, style, overrides, limits);
}

}  // namespace gaitpad
