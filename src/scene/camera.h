// The camera: on a sphere around a target that may follow a character. Arguments that are not
// finite change nothing.
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
  double pitch_rad = 0.2;  // above the horizon
  double field_of_view_rad = 0.66;  // from the lower edge to the upper one
  // Height of the ground below target and eye; bounds are counted from there.
  double floor_m = 0.0, eye_floor_m = 0.0;
  bool is_following = true;
  vec3 followed_m{0.0, 0.8, 0.0};  // the last place of follow()
  vec3 pace_m_s{0.0};              // of the target, as it follows
  vec3 aside_m{0.0};               // from the followed place to the target
  double framed_m = 6.0;           // the distance that shows everybody; distance_m over it is zoom

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
// Moves along with a place, smoothly and independent of the frame rate, if is_following is set: it
// lags while the place gains speed, and not behind one that moves evenly.
void follow(Camera& camera, const vec3& place_m, double dt_s) noexcept;

// Where a camera has to be to see what it should.
struct Framing {
  vec3 target_m{0.0};
  double distance_m = 6.0;
};
// The nearest place from which a camera, turned as this one is, sees all points in the middle 92 %
// of a picture, and beside and above each of them a label of so many pixels (half its width, its
// height). At least `least_m` away; without points as the camera is.
Framing framing(const Camera& camera, std::span<const vec3> points_m, int width_px, int height_px,
                const vec2& label_px, double least_m) noexcept;
// Goes there at once, following `place_m` from then on.
void show(Camera& camera, const Framing& framing, const vec3& place_m) noexcept;
// Goes there smoothly, outwards faster than inwards, if is_following is set; what the person has
// zoomed stays zoomed. Differences of 3 % are let pass inwards, so that it does not breathe with
// every step.
void approach(Camera& camera, const Framing& framing, double dt_s) noexcept;

// Pixels from the viewport's upper left corner, y downwards; z is the depth in metres along the
// view. At the eye or behind it z <= 0 and x = y = 0.
vec3 projected(const Camera& camera, const vec3& world_m, int width_px, int height_px) noexcept;

}  // namespace gaitpad
