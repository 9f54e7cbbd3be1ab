// The camera: on a sphere around a target that may follow a character. Arguments that are not
// finite change nothing.
#pragma once
#include <cmath>

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
  double pitch_rad = 0.2;  // above the horizon
  double field_of_view_rad = 0.66;  // from the lower edge to the upper one
  // Height of the ground below target and eye; bounds are counted from there.
  double floor_m = 0.0, eye_floor_m = 0.0;
  bool is_following = true;
  vec3 followed_m{0.0, 0.8, 0.0};  // the last argument of follow()

  vec3 eye_m() const noexcept;
  mat4 view() const noexcept;  // world to eye: x right, y up, looking along -z
  mat4 projection(double aspect) const noexcept;
};

// All are bounded: never below the floor, never nearer than 1 m or farther than 40 m. Positive yaw
// moves the eye counter-clockwise seen from above, positive pitch upwards.
void orbit(Camera& camera, double yaw_rad, double pitch_rad) noexcept;
void dolly(Camera& camera, double factor) noexcept;  // multiplies the distance
// Moves what is at the target's distance by so many pixels, y downwards. Ends following.
void pan(Camera& camera, const vec2& pixels, double viewport_height_px) noexcept;
// Call it on uneven ground whenever the target or the eye has moved.
void stand_on(Camera& camera, double floor_m, double eye_floor_m) noexcept;
// Moves towards a place, smoothly and independent of the frame rate, if is_following is set.
void follow(Camera& camera, const vec3& place_m, double dt_s) noexcept;

// Pixels from the viewport's upper left corner, y downwards; z is the depth in metres along the
// view. At the eye or behind it z <= 0 and x = y = 0.
vec3 projected(const Camera& camera, const vec3& world_m, int width_px, int height_px) noexcept;

}  // namespace gaitpad
