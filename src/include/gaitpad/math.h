// Vectors, quaternions and the few transcendental functions of the program.
// Everything is double: a character that has walked 200 m still has its feet nailed to 0.1 mm.
// sin, cos and atan2 are our own, because libm's last bits differ between compilers, versions and
// CPUs, and a replay must give the same bits everywhere (only + - * / and sqrt are exact in IEEE
// 754). GLM_FORCE_CTOR_INIT stays undefined: with it GLM types are not trivially copyable.
#pragma once
#ifdef GLM_FORCE_QUAT_DATA_WXYZ
#error "gaitpad's rotations lie in memory as x, y, z, w: build without GLM_FORCE_QUAT_DATA_WXYZ"
#endif
#define GLM_FORCE_EXPLICIT_CTOR
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <type_traits>

namespace gaitpad {

using vec2 = glm::dvec2;
using vec3 = glm::dvec3;
using mat3 = glm::dmat3;
using quat = glm::dquat;

// With another GLM configuration a program would misread the numbers that the library has written.
static_assert(std::is_trivially_copyable_v<quat>, "build without GLM_FORCE_CTOR_INIT");
static_assert(sizeof(vec3) == 3 * sizeof(double) && sizeof(quat) == 4 * sizeof(double),
              "build without GLM_FORCE_DEFAULT_ALIGNED_GENTYPES");

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kDegree = kPi / 180.0;           // a degree in radians
inline const quat kIdentity = quat(1.0, 0.0, 0.0, 0.0);  // no rotation; w, x, y, z
// X axis of the world, to the walker's left at heading 0.
inline const vec3 kLeft = vec3(1.0, 0.0, 0.0);
inline const vec3 kUp = vec3(0.0, 1.0, 0.0);       // y axis of the world
inline const vec3 kForward = vec3(0.0, 0.0, 1.0);  // z axis of the world, forward

struct SinCos {
  double sin, cos;
};
// Errors are about 1 ulp at most for |angle| < 1e5 rad.
SinCos sin_cos(double angle_rad) noexcept;
double atan2(double y, double x) noexcept;
double acos(double x) noexcept;  // The argument is clamped to [-1, 1].

// The equal angle within [-pi, pi).
double wrapped(double angle_rad) noexcept;

quat rotation_about(const vec3& unit_axis, double angle_rad) noexcept;
quat rotation_x(double angle_rad) noexcept;
quat rotation_y(double angle_rad) noexcept;
quat rotation_z(double angle_rad) noexcept;
// The smallest rotation from unit vector `from` to unit vector `to`.
quat rotation_between(const vec3& from, const vec3& to) noexcept;
// A rotation as its unit axis times its angle in [0, pi]; and the rotation of such a vector.
vec3 rotation_vector(const quat& q) noexcept;
quat from_rotation_vector(const vec3& v) noexcept;
// `share` of the way from one rotation to another, along the shorter arc: linear, then normalized.
// The ends are normalized as well.
quat nlerp(const quat& from, const quat& to, double share) noexcept;
// The rotation whose columns are the images of x, y, z (orthonormal, right-handed).
quat from_axes(const vec3& x, const vec3& y, const vec3& z) noexcept;

// The unit direction on the ground of a heading: 0 along +z, positive to the left (+x).
inline vec3 heading_direction(double heading_rad) noexcept {
  const SinCos s = sin_cos(heading_rad);
  return vec3(s.sin, 0.0, s.cos);
}
// The length of a vector's horizontal part.
inline double horizontal_length(const vec3& v) noexcept { return std::sqrt(v.x * v.x + v.z * v.z); }
// The heading of a direction's horizontal part.
inline double heading_of(const vec3& direction) noexcept { return atan2(direction.x, direction.z); }

// The functions below take a number, or several numbers side by side.
template <class V>
V within(const V& x, double low, double high) noexcept {
  const V above = x < low ? V{} + low : x;
  return high < above ? V{} + high : above;
}
// A cubic that is 0 at x <= a and 1 at x >= b, with zero slope at both ends.
template <class V>
auto smoothstep(double a, double b, const V& x) noexcept {
  const auto u = within((x - a) / (b - a), 0.0, 1.0);
  return u * u * (3.0 - 2.0 * u);
}
template <class A, class B, class V>
auto mix(const A& a, const B& b, const V& t) noexcept {
  return a + (b - a) * t;
}
// The fractional part of a number of turns, 0 .. 1.
inline double fraction(double turns) noexcept { return turns - std::floor(turns); }

}  // namespace gaitpad
