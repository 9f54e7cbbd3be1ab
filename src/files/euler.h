// Three rotations about coordinate axes, as BVH writes them: R = R_first R_second R_third.
#pragma once
#include <array>

#include "gaitpad/math.h"

namespace gaitpad {

// Axes 0 x, 1 y, 2 z, each once.
using EulerOrder = std::array<int, 3>;
// Numbers of axes.
inline constexpr EulerOrder kEulerZyx = {2, 1, 0};
inline constexpr EulerOrder kEulerYxz = {1, 0, 2};
inline constexpr std::array<EulerOrder, 6> kEulerOrders = {
    {{2, 1, 0}, {2, 0, 1}, {1, 0, 2}, {1, 2, 0}, {0, 1, 2}, {0, 2, 1}}};

using EulerAngles = std::array<double, 3>;  // radians; angle i is about axis i of the order

quat rotation_about_axis(int axis, double angle_rad) noexcept;

// The triple nearest to `previous_rad` that gives this rotation; angles may differ by whole turns.
// At the pole (second angle +-90 degrees) only the sum or the difference of the outer angles is
// defined; both then stay as close to `previous_rad` as possible.
EulerAngles nearest_euler(const EulerOrder& order, const quat& rotation,
                          const EulerAngles& previous_rad) noexcept;

// |sine| of the second angle; 1 is the pole, where the outer angles are not unique.
double pole_closeness(const EulerOrder& order, const quat& rotation) noexcept;

}  // namespace gaitpad
