#include "files/euler.h"

namespace gaitpad {
namespace {

// +1 for cyclic orders (xyz, yzx, zxy), otherwise -1.
constexpr double handedness(const EulerOrder& order) noexcept {
  return (order[1] - order[0] + 3) % 3 == 1 ? 1.0 : -1.0;
}

double nearest_turn(double angle_rad, double previous_rad) noexcept {
  return previous_rad + wrapped(angle_rad - previous_rad);
}

double distance(const EulerAngles& a, const EulerAngles& b) noexcept {
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

struct PoleParts {
  double sine, cosine;  // sine and cosine of the second angle
};
// sin(second) = handedness * R[first axis][third axis], where R[row][column] is the matrix of the
// rotation.
inline PoleParts second_angle(const EulerOrder& order, const mat3& r) noexcept {
  const double sine = std::clamp(handedness(order) * r[order[2]][order[0]], -1.0, 1.0);
  const double a = r[order[2]][order[1]], b = r[order[2]][order[2]];
  return {sine, std::sqrt(a * a + b * b)};
}

}  // namespace

quat rotation_about_axis(int axis, double angle_rad) noexcept {
  return axis == 0   ? rotation_x(angle_rad)
         : axis == 1 ? rotation_y(angle_rad)
                     : rotation_z(angle_rad);
}

double pole_closeness(const EulerOrder& order, const quat& rotation) noexcept {
  return std::abs(second_angle(order, glm::mat3_cast(rotation)).sine);
}

namespace {

// nearest_euler() for the order i, j, k, of which only the needed parts of the matrix are computed.
template <int i, int j, int k>
EulerAngles nearest_in_order(const quat& rotation, const EulerAngles& previous_rad) noexcept {
  constexpr EulerOrder order = {i, j, k};
  constexpr double h = handedness(order);
  const mat3 r = glm::mat3_cast(rotation);  // r[column][row]
  const PoleParts second = second_angle(order, r);
  // Within 1e-7 of the pole the outer angles' sum (or difference) alone is defined.
  if (second.cosine < 1e-7) {
    const double pole = second.sine > 0.0 ? 1.0 : -1.0;
    EulerAngles angles = {previous_rad[0], nearest_turn(pole * 0.5 * kPi, previous_rad[1]), 0.0};
    // Each outer angle takes half of the remaining turn: the closest solution.
    const double sign = h * pole;
    // The angle of third + sign * first.
    const double sum = gaitpad::atan2(pole * r[j][k], r[j][j]);
    const double before = previous_rad[2] + sign * previous_rad[0];
    const double rest = wrapped(sum - before);
    angles[0] = previous_rad[0] + sign * 0.5 * rest;
    angles[2] = previous_rad[2] + 0.5 * rest;
    return angles;
  }
  const double first = gaitpad::atan2(-h * r[k][j], r[k][k]);
  const double middle = gaitpad::atan2(second.sine, second.cosine);
  const double third = gaitpad::atan2(-h * r[j][i], r[i][i]);
  const EulerAngles one = {nearest_turn(first, previous_rad[0]),
                           nearest_turn(middle, previous_rad[1]),
                           nearest_turn(third, previous_rad[2])};
  // The outer angles of the other triple are half a turn away from these.
  if (distance(one, previous_rad) < 1.0) return one;
  const EulerAngles two = {nearest_turn(first + kPi, previous_rad[0]),
                           nearest_turn(kPi - middle, previous_rad[1]),
                           nearest_turn(third + kPi, previous_rad[2])};
  return distance(one, previous_rad) <= distance(two, previous_rad) ? one : two;
}

}  // namespace

EulerAngles nearest_euler(const EulerOrder& order, const quat& rotation,
                          const EulerAngles& previous_rad) noexcept {
  const bool is_cyclic = handedness(order) > 0.0;
  switch (order[0]) {
    case 0:
      return is_cyclic ? nearest_in_order<0, 1, 2>(rotation, previous_rad)
                       : nearest_in_order<0, 2, 1>(rotation, previous_rad);
    case 1:
      return is_cyclic ? nearest_in_order<1, 2, 0>(rotation, previous_rad)
                       : nearest_in_order<1, 0, 2>(rotation, previous_rad);
    default:
      return is_cyclic ? nearest_in_order<2, 0, 1>(rotation, previous_rad)
                       : nearest_in_order<2, 1, 0>(rotation, previous_rad);
  }
}

}  // namespace gaitpad
