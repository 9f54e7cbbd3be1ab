#include "gaitpad/math.h"

#include <cstdint>

#include "base/trigonometry.h"

namespace gaitpad {
SinCos sin_cos(double angle_rad) noexcept {
  // Below pi/4 no reduction is needed; skipping it gives the same bits.
  if (std::abs(angle_rad) < 0.785) return {sin_kernel(angle_rad), cos_kernel(angle_rad)};
  if (!(std::abs(angle_rad) < 1e6)) return {0.0, 1.0};  // keeps NaN and huge angles bounded
  const double scaled = angle_rad * kTwoOverPi;
  const auto n = static_cast<std::int64_t>(scaled + (scaled < 0.0 ? -0.5 : 0.5));
  const double k = static_cast<double>(n);
  const double x = ((angle_rad - k * kHalfPi1) - k * kHalfPi2) - k * kHalfPi3;
  const double s = sin_kernel(x), c = cos_kernel(x);
  switch (n & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

double atan2(double y, double x) noexcept {
  const double ax = std::abs(x), ay = std::abs(y);
  if (ay == 0.0) return x < 0.0 ? kPi : 0.0;
  // atan of r = |y / x|, reduced by atan r = atan c + atan((r - c) / (1 + c r)).
  const double r = ay / ax;
  double whole = 0.0, rest = r;
  if (!(r < 2.4375)) {
    whole = 1.57079632679489655800e+00, rest = -1.0 / r;
  } else if (r >= 1.1875) {
    whole = 9.82793723247329054082e-01, rest = (r - 1.5) / (1.0 + 1.5 * r);
  } else if (r >= 0.6875) {
    whole = 7.85398163397448278999e-01, rest = (r - 1.0) / (r + 1.0);
  } else if (r >= 0.4375) {
    whole = 4.63647609000806093515e-01, rest = (2.0 * r - 1.0) / (2.0 + r);
  }
  double a = whole + atan_kernel(rest);
  a = ax > 0.0 ? a : kPi / 2.0;
  a = x < 0.0 ? kPi - a : a;
  return y < 0.0 ? -a : a;
}

double acos(double x) noexcept {
  const double c = std::clamp(x, -1.0, 1.0);
  return gaitpad::atan2(std::sqrt((1.0 - c) * (1.0 + c)), c);
}

double wrapped(double angle_rad) noexcept {
  if (std::abs(angle_rad) < 3.0) return angle_rad;  // a shortcut that gives the same bits
  const double turns = std::floor((angle_rad + kPi) / (2.0 * kPi));
  return angle_rad - turns * 2.0 * kPi;
}

quat rotation_about(const vec3& unit_axis, double angle_rad) noexcept {
  const SinCos h = sin_cos(0.5 * angle_rad);
  return quat(h.cos, unit_axis.x * h.sin, unit_axis.y * h.sin, unit_axis.z * h.sin);
}
quat rotation_x(double angle_rad) noexcept {
  const SinCos h = sin_cos(0.5 * angle_rad);
  return quat(h.cos, h.sin, 0.0, 0.0);
}
quat rotation_y(double angle_rad) noexcept {
  const SinCos h = sin_cos(0.5 * angle_rad);
  return quat(h.cos, 0.0, h.sin, 0.0);
}
quat rotation_z(double angle_rad) noexcept {
  const SinCos h = sin_cos(0.5 * angle_rad);
  return quat(h.cos, 0.0, 0.0, h.sin);
}

quat rotation_between(const vec3& from, const vec3& to) noexcept {
  const double c = glm::dot(from, to);
  if (c < -0.999999) {  // opposite: half a turn about any axis across `from`
    const vec3 side = std::abs(from.x) < 0.9 ? kLeft : kUp;
    const vec3 axis = glm::normalize(glm::cross(from, side));
    return quat(0.0, axis.x, axis.y, axis.z);
  }
  const vec3 n = glm::cross(from, to);
  return glm::normalize(quat(1.0 + c, n.x, n.y, n.z));
}

vec3 rotation_vector(const quat& q) noexcept {
  const quat p = q.w < 0.0 ? -q : q;
  const vec3 v(p.x, p.y, p.z);
  const double s = glm::length(v);
  if (s < 1e-12) return 2.0 * v;
  return v * (2.0 * gaitpad::atan2(s, p.w) / s);
}

quat from_rotation_vector(const vec3& v) noexcept {
  const double angle = glm::length(v);
  if (angle < 1e-12) return glm::normalize(quat(1.0, 0.5 * v.x, 0.5 * v.y, 0.5 * v.z));
  return rotation_about(v / angle, angle);
}

quat nlerp(const quat& from, const quat& to, double share) noexcept {
  const double sign = glm::dot(from, to) < 0.0 ? -1.0 : 1.0;
  return glm::normalize(from * (1.0 - share) + to * (sign * share));
}

quat from_axes(const vec3& x, const vec3& y, const vec3& z) noexcept {
  // Shepperd's method: divide by the largest component. glm::quat_cast does the same; this is
  // written out so that the order of operations does not change with glm's version.
  const double t = x.x + y.y + z.z;
  quat q;
  if (t > 0.0) {
    q = quat(1.0 + t, y.z - z.y, z.x - x.z, x.y - y.x);
  } else if (x.x > y.y && x.x > z.z) {
    q = quat(y.z - z.y, 1.0 + x.x - y.y - z.z, x.y + y.x, z.x + x.z);
  } else if (y.y > z.z) {
    q = quat(z.x - x.z, x.y + y.x, 1.0 - x.x + y.y - z.z, y.z + z.y);
  } else {
    q = quat(x.y - y.x, z.x + x.z, y.z + z.y, 1.0 - x.x - y.y + z.z);
  }
  return glm::normalize(q);
}

}  // namespace gaitpad
