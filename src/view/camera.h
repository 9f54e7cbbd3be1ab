// Where the picture is seen from: on a sphere round a target that may follow somebody.
// Plain functions on plain data; what is not a finite number changes nothing.
#pragma once
#include "gaitpad/math.h"

namespace gaitpad {

using mat4 = glm::dmat4;

struct Camera {
  vec3 target_m{0.0, 0.8, 0.0};
  double distance_m = 6.0;
  double yaw_rad = 0.16;            // 0: looks along -z, at the front of who walks along +z
  double pitch_rad = 0.2;           // above the horizon
  double field_of_view_rad = 0.66;  // from the lower edge to the upper one
  // The ground's height below target and eye: bounds count from there.
  double floor_m = 0.0, eye_floor_m = 0.0;
  bool is_following = true;
  vec3 followed_m{0.0, 0.8, 0.0};  // the place that follow() was told last

  vec3 eye_m() const noexcept;
  mat4 view() const noexcept;  // world to eye: x right, y up, looking along -z
  mat4 projection(double aspect) const noexcept;
};

// All bounded: never below the floor, never nearer than 1 m or farther than 40 m.
// Yaw moves the eye counter-clockwise seen from above, pitch upwards.
void orbit(Camera& camera, double yaw_rad, double pitch_rad) noexcept;
void dolly(Camera& camera, double factor) noexcept;  // times the distance
// What is at the target's distance moves by so many pixels, y downwards. Ends following.
void pan(Camera& camera, const vec2& pixels, double viewport_height_px) noexcept;
// On uneven ground, whenever target or eye have moved.
void stand_on(Camera& camera, double floor_m, double eye_floor_m) noexcept;
// Towards a place, smoothly and independent of the frame rate; not where is_following is false.
void follow(Camera& camera, const vec3& place_m, double dt_s) noexcept;

// Pixels from the viewport's upper left corner, y downwards; z: depth in metres along the view,
// <= 0 behind the eye or at it, where x and y are 0.
vec3 projected(const Camera& camera, const vec3& world_m, int width_px, int height_px) noexcept;

}  // namespace gaitpad
