// The camera: on a sphere around a target that may follow a character. Arguments that are not
// finite are ignored.
#pragma once
#include <cmath>
#include <span>

#include "gaitpad/math.h"

namespace gaitpad {

using mat4 = glm::dmat4;

inline bool is_finite(const vec3& v) noexcept {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

struct Camera {
  vec3 target_m{0.0, 0.8, 0.0};
  double distance_m = 6.0;
  double yaw_rad = 0.16;   // 0: looks along -z, at the front of a character that walks along +z
  double pitch_rad = 0.2;  // angle of the eye above the horizon
  double field_of_view_rad = 0.66;  // angle between the picture's lower and upper edge
  // Ground heights below target and eye; the limits are relative to them.
  double floor_m = 0.0, eye_floor_m = 0.0;
  bool is_following = true;
  vec3 followed_m{0.0, 0.8, 0.0};  // the place that follow() was last called with
  vec3 pace_m_s{0.0};              // the target's velocity while the camera follows
  vec3 aside_m{0.0};               // from the followed place to the target, as moved by the user
  // Distance that shows all characters; the user's zoom is distance_m / framed_m.
  double framed_m = 6.0;

  vec3 eye_m() const noexcept;
  // Transforms the world to the eye's frame: x right, y up, looking along -z.
  mat4 view() const noexcept;
  mat4 projection(double aspect) const noexcept;
};

// All functions below keep the camera above the floor and 1 to 40 m from the target. Positive yaw
// moves the eye counter-clockwise as seen from above, positive pitch upwards.
void orbit(Camera& camera, double yaw_rad, double pitch_rad) noexcept;
void dolly(Camera& camera, double factor) noexcept;  // Multiplies the distance by `factor`.
// Moves the picture at the target's distance by this number of pixels, y downwards. Ends following.
void pan(Camera& camera, const vec2& pixels, double viewport_height_px) noexcept;
// Call it on uneven ground after the target or the eye has moved.
void stand_on(Camera& camera, double floor_m, double eye_floor_m) noexcept;
// If is_following is set, follows a place smoothly, at any frame rate: lags behind an accelerating
// place, but not behind one at constant velocity.
void follow(Camera& camera, const vec3& place_m, double dt_s) noexcept;

// A camera position that shows all points.
struct Framing {
  vec3 target_m{0.0};
  double distance_m = 6.0;
};
// The nearest position from which the camera, at its present angles, shows all points within the
// middle 92 % of the picture, with space around each for a label (half its width, its height, in
// pixels). At least `least_m` away; without points the present position.
Framing framing(const Camera& camera, std::span<const vec3> points_m, int width_px, int height_px,
                const vec2& label_px, double least_m) noexcept;
// Moves to this framing at once and follows `place_m` from then on.
void show(Camera& camera, const Framing& framing, const vec3& place_m) noexcept;
// If is_following is set, moves to this framing smoothly, outwards faster than inwards, and keeps
// the user's zoom. Differences of up to 3 % inwards are ignored, so that the picture does not
// pulsate with each step.
void approach(Camera& camera, const Framing& framing, double dt_s) noexcept;

// Pixels from the viewport's upper left corner, y downwards; z is the depth in metres along the
// view. At or behind the eye z <= 0 and x = y = 0.
vec3 projected(const Camera& camera, const vec3& world_m, int width_px, int height_px) noexcept;

}  // namespace gaitpad
