#include "scene/camera.h"

namespace gaitpad {
namespace {

constexpr double kNearest_m = 1.0, kFarthest_m = 40.0;
constexpr double kLowestEye_m = 0.1, kHighestTarget_m = 4.0;
// Greatest pitch, almost straight down, where "up" would be undefined.
constexpr double kSteepest_rad = 1.5;
constexpr double kNearPlane_m = 0.1, kFarPlane_m = 200.0;
// Rate at which the camera approaches the place that it follows.
constexpr double kFollow_1_s = 4.0;
// A followed place that moves faster has jumped: a reset or another character.
constexpr double kFastest_m_s = 20.0;
// Share of the picture's width and height in which the characters are framed.
constexpr double kUsed = 0.92;
constexpr double kLeastUsed = 0.3;       // the least such share; labels may take the rest
constexpr double kNearestPoint_m = 0.5;  // least distance from the eye to the nearest point
// Times after which approach() has gone 63 % of the way outwards and inwards; and the share of the
// distance above which it does not move inwards.
constexpr double kOutTime_s = 0.25, kInTime_s = 0.6, kLetPass = 0.97;

// The picture's axes as unit vectors of the world.
struct Axes {
  vec3 right, up, back;
};
Axes axes_of(const Camera& camera) noexcept {
  const double sy = std::sin(camera.yaw_rad), cy = std::cos(camera.yaw_rad);
  const double sp = std::sin(camera.pitch_rad), cp = std::cos(camera.pitch_rad);
  return {{cy, 0.0, -sy}, {-sy * sp, cp, -cy * sp}, {sy * cp, sp, cy * cp}};
}

void keep_bounds(Camera& camera) noexcept {
  camera.target_m.y =
      std::clamp(camera.target_m.y, camera.floor_m, camera.floor_m + kHighestTarget_m);
  camera.distance_m = std::clamp(camera.distance_m, kNearest_m, kFarthest_m);
  const double floor = (camera.eye_floor_m + kLowestEye_m - camera.target_m.y) / camera.distance_m;
  const double lowest_rad = std::asin(std::clamp(floor, -1.0, 1.0));
  camera.pitch_rad =
      std::clamp(camera.pitch_rad, std::max(lowest_rad, -kSteepest_rad), kSteepest_rad);
}

}  // namespace

vec3 Camera::eye_m() const noexcept { return target_m + axes_of(*this).back * distance_m; }

mat4 Camera::view() const noexcept {
  const Axes axes = axes_of(*this);
  const vec3 eye = eye_m();
  mat4 m(1.0);
  const vec3* rows[] = {&axes.right, &axes.up, &axes.back};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) m[c][r] = (*rows[r])[c];
    m[3][r] = -glm::dot(*rows[r], eye);
  }
  return m;
}

mat4 Camera::projection(double aspect) const noexcept {
  const double scale = 1.0 / std::tan(0.5 * field_of_view_rad);
  const double depth = kNearPlane_m - kFarPlane_m;
  mat4 m(0.0);
  m[0][0] = scale / std::max(aspect, 1e-3);
  m[1][1] = scale;
  m[2][2] = (kFarPlane_m + kNearPlane_m) / depth;
  m[2][3] = -1.0;
  m[3][2] = 2.0 * kFarPlane_m * kNearPlane_m / depth;
  return m;
}

void orbit(Camera& camera, double yaw_rad, double pitch_rad) noexcept {
  if (!std::isfinite(yaw_rad) || !std::isfinite(pitch_rad)) return;
  camera.yaw_rad = std::remainder(camera.yaw_rad + yaw_rad, 2.0 * kPi);
  camera.pitch_rad += pitch_rad;
  keep_bounds(camera);
}

void dolly(Camera& camera, double factor) noexcept {
  if (!std::isfinite(factor) || factor <= 0.0) return;
  camera.distance_m *= factor;
  keep_bounds(camera);
}

void stand_on(Camera& camera, double floor_m, double eye_floor_m) noexcept {
  if (!std::isfinite(floor_m) || !std::isfinite(eye_floor_m)) return;
  camera.floor_m = floor_m;
  camera.eye_floor_m = eye_floor_m;
  keep_bounds(camera);
}

void pan(Camera& camera, const vec2& pixels, double viewport_height_px) noexcept {
  if (!std::isfinite(pixels.x) || !std::isfinite(pixels.y) || !(viewport_height_px >= 1.0)) return;
  const Axes axes = axes_of(camera);
  const double metres =
      2.0 * camera.distance_m * std::tan(0.5 * camera.field_of_view_rad) / viewport_height_px;
  camera.target_m += (axes.up * pixels.y - axes.right * pixels.x) * metres;
  camera.is_following = false;
  keep_bounds(camera);
}

// The exact response of a critically damped spring to a place that moves at constant speed between
// two calls, so that two short frames end where one long frame does.
void follow(Camera& camera, const vec3& place_m, double dt_s) noexcept {
  if (!is_finite(place_m) || !(dt_s > 0.0) || !std::isfinite(dt_s)) return;
  vec3 from_m = camera.followed_m;
  if (glm::distance(place_m, from_m) > kFastest_m_s * dt_s) from_m = place_m;
  camera.followed_m = place_m;
  if (!camera.is_following) return;
  const vec3 place_m_s = (place_m - from_m) / dt_s;
  const vec3 behind_m = camera.target_m - camera.aside_m - from_m;
  const vec3 gain_m_s = camera.pace_m_s - place_m_s + behind_m * kFollow_1_s;
  const double kept = std::exp(-kFollow_1_s * dt_s);
  const vec3 left_m = (behind_m + gain_m_s * dt_s) * kept;
  camera.target_m = place_m + camera.aside_m + left_m;
  camera.pace_m_s = place_m_s + gain_m_s * kept - left_m * kFollow_1_s;
  keep_bounds(camera);
}

Framing framing(const Camera& camera, std::span<const vec3> points_m, int width_px, int height_px,
                const vec2& label_px, double least_m) noexcept {
  const Axes axes = axes_of(camera);
  const double width = std::max(width_px, 1), height = std::max(height_px, 1);
  const double half = std::tan(0.5 * camera.field_of_view_rad);
  const double below = half * kUsed;
  const double above = half * std::max(kUsed - 2.0 * label_px.y / height, kLeastUsed);
  const double aside =
      half * width / height * std::max(kUsed - 2.0 * label_px.x / width, kLeastUsed);
  constexpr double kNothing_m = -1e9;
  double right = kNothing_m, left = kNothing_m, top = kNothing_m, bottom = kNothing_m;
  double nearest = kNothing_m, farthest = kNothing_m;
  for (const vec3& point : points_m) {
    if (!is_finite(point)) continue;
    const double x = glm::dot(axes.right, point), y = glm::dot(axes.up, point),
                 z = glm::dot(axes.back, point);
    right = std::max(right, x + aside * z);
    left = std::max(left, -x + aside * z);
    top = std::max(top, y + above * z);
    bottom = std::max(bottom, -y + below * z);
    nearest = std::max(nearest, z);
    farthest = std::max(farthest, -z);
  }
  if (nearest == kNothing_m) return {camera.target_m, camera.distance_m};
  const double middle = 0.5 * (nearest - farthest);
  const double eye_z = std::max({(right + left) / (2.0 * aside), (top + bottom) / (above + below),
                                 nearest + kNearestPoint_m, middle + least_m});
  const double eye_x = 0.5 * (right - left);
  const double eye_y = 0.5 * (top - above * eye_z + below * eye_z - bottom);
  return {axes.right * eye_x + axes.up * eye_y + axes.back * middle, eye_z - middle};
}

void show(Camera& camera, const Framing& framing, const vec3& place_m) noexcept {
  if (!is_finite(framing.target_m) || !is_finite(place_m)) return;
  camera.target_m = framing.target_m;
  camera.followed_m = place_m;
  camera.pace_m_s = vec3(0.0);
  camera.aside_m = framing.target_m - place_m;
  camera.distance_m = camera.framed_m = framing.distance_m;
  keep_bounds(camera);
}

void approach(Camera& camera, const Framing& framing, double dt_s) noexcept {
  if (!camera.is_following || !is_finite(framing.target_m) || !(dt_s > 0.0)) return;
  const bool is_outwards = framing.distance_m > camera.framed_m;
  const double share = 1.0 - std::exp(-dt_s / (is_outwards ? kOutTime_s : kInTime_s));
  const vec3 aside_m = framing.target_m - camera.followed_m;
  const vec3 step_m = (aside_m - camera.aside_m) * share;
  camera.aside_m += step_m;
  camera.target_m += step_m;
  if (is_outwards || framing.distance_m < kLetPass * camera.framed_m) {
    const double factor = std::pow(framing.distance_m / camera.framed_m, share);
    camera.framed_m *= factor;
    camera.distance_m *= factor;
  }
  keep_bounds(camera);
}

vec3 projected(const Camera& camera, const vec3& world_m, int width_px, int height_px) noexcept {
  const double width = std::max(width_px, 1), height = std::max(height_px, 1);
  const glm::dvec4 at =
      camera.projection(width / height) * camera.view() * glm::dvec4(world_m, 1.0);
  if (!(at.w >= kNearPlane_m)) return {0.0, 0.0, std::min(at.w, 0.0)};
  return {(0.5 + 0.5 * at.x / at.w) * width, (0.5 - 0.5 * at.y / at.w) * height, at.w};
}

}  // namespace gaitpad
