// Vector registers of doubles, one number per lane. Every lane gives the same bits as a single
// double, for any width. Masks select lanes instead of branches.
//
// Registers are the vector types of GCC and Clang. For other compilers, and where
// GAITPAD_NO_VECTORS is defined, there is one lane alone, a double: the two legs of a walk and the
// walks of a crowd are computed one after the other.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <type_traits>
#include <utility>

#include "base/trigonometry.h"
#include "gaitpad/math.h"

namespace gaitpad {

#if !defined(GAITPAD_NO_VECTORS) && !defined(__GNUC__) && !defined(__clang__)
#define GAITPAD_NO_VECTORS
#endif

template <int kWidth>
struct LanesOf;
template <>
struct LanesOf<1> {
  using Type = double;
  using Mask = bool;
};
#ifdef GAITPAD_NO_VECTORS
inline constexpr int kLeastLanes = 1;
#else
template <int kWidth>
struct LanesOf {
  using Type __attribute__((vector_size(8 * kWidth))) = double;
  using Mask __attribute__((vector_size(8 * kWidth))) = long long;
};
inline constexpr int kLeastLanes = 2;  // lanes of the narrowest registers
#endif
template <int kWidth>
using Lanes = typename LanesOf<kWidth>::Type;
// The type of a comparison; bool for double.
template <class V>
using MaskOf = decltype(V{} < V{});
template <class V>
inline constexpr int kWidthOf = sizeof(V) / sizeof(double);

// Lanes of this processor's registers: 8 with AVX-512, 4 with AVX2, otherwise kLeastLanes. Code
// that is compiled for wider ones must not be called.
int widest_lanes() noexcept;
// Lanes in use: widest_lanes(), unless tests and measurements set fewer by use_lanes() (1, 2, 4,
// 8). Results have the same bits. With 1, the walks of a crowd are computed one by one.
int lanes_in_use() noexcept;
void use_lanes(int lanes) noexcept;
// Calls `work` with the greatest of these widths, a constant, that is not above `lanes`: 8, 4, and
// kLeastLanes, which is the least.
template <class Work>
inline void with_width([[maybe_unused]] int lanes, const Work& work) noexcept {
#ifndef GAITPAD_NO_VECTORS
  if (lanes >= 8) return work(std::integral_constant<int, 8>());
  if (lanes >= 4) return work(std::integral_constant<int, 4>());
#endif
  work(std::integral_constant<int, kLeastLanes>());
}

template <class V>
inline V all_of(double x) noexcept {
  return V{} + x;
}
template <class V>
inline V min_of(const V& a, const V& b) noexcept {
  return b < a ? b : a;
}
template <class V>
inline V max_of(const V& a, const V& b) noexcept {
  return a < b ? b : a;
}
template <class V>
inline V abs_of(const V& a) noexcept {
  return max_of(a, -a);
}
template <class V>
inline V sqrt_of(const V& a) noexcept {
  if constexpr (kWidthOf<V> == 1) {
    return std::sqrt(a);
  } else {
    V root;
    for (int i = 0; i < kWidthOf<V>; ++i) root[i] = std::sqrt(a[i]);
    return root;
  }
}
inline double lane_of(double a, int) noexcept { return a; }
template <class V>
inline double lane_of(const V& a, int lane) noexcept {
  return a[lane];
}
inline void set_lane(double to, int, double& a) noexcept { a = to; }
template <class V>
inline void set_lane(double to, int lane, V& a) noexcept {
  a[lane] = to;
}
inline void set_lane(bool to, int, bool& mask) noexcept { mask = to; }
template <class M>
inline void set_lane(bool to, int lane, M& mask) noexcept {
  mask[lane] = to ? -1 : 0;
}
inline bool is_set(bool mask, int) noexcept { return mask; }
template <class M>
inline bool is_set(const M& mask, int lane) noexcept {
  return mask[lane] != 0;
}
// The inverse of a mask. Masks of bools are combined by & and |, which return int.
inline bool not_of(bool mask) noexcept { return !mask; }
inline bool not_of(int mask) noexcept { return mask == 0; }
template <class M>
inline M not_of(const M& mask) noexcept {
  return ~mask;
}
inline bool any(bool mask) noexcept { return mask; }
inline bool any(int mask) noexcept { return mask != 0; }
template <class M>
inline bool any(const M& mask) noexcept {
  if constexpr (kWidthOf < M >> 2) {  // combines both halves of the register
    typename LanesOf<kWidthOf<M> / 2>::Mask low, high;
    std::memcpy(&low, &mask, sizeof low);
    std::memcpy(&high, reinterpret_cast<const char*>(&mask) + sizeof low, sizeof high);
    return any(low | high);
  } else {
    return (mask[0] | mask[1]) != 0;
  }
}

// --- Numbers of several walks from memory, and back ----------------------------------------------

// Swaps rows and lanes of a square: number j of v[i] becomes number i of v[j].
template <int kStep, bool kSecond, class V, std::size_t... kLane>
inline V swapped_half(const V& a, const V& b, std::index_sequence<kLane...>) noexcept {
  constexpr int n = kWidthOf<V>;
  if constexpr (kSecond) {
    return __builtin_shufflevector(a, b,
                                   static_cast<int>(kLane & kStep ? kLane + n : kLane + kStep)...);
  } else {
    return __builtin_shufflevector(a, b,
                                   static_cast<int>(kLane & kStep ? kLane - kStep + n : kLane)...);
  }
}
// With eight lanes and four rows, each half is transposed on its own.
template <int kStep = 1, class V, std::size_t kRows>
inline void transpose(std::array<V, kRows>& v) noexcept {
  if constexpr (kStep < kRows) {
    for (std::size_t i = 0; i < kRows; ++i) {
      if (i & kStep) continue;
      const V a = v[i], b = v[i + kStep];
      v[i] = swapped_half<kStep, false>(a, b, std::make_index_sequence<kWidthOf<V>>());
      v[i + kStep] = swapped_half<kStep, true>(a, b, std::make_index_sequence<kWidthOf<V>>());
    }
    transpose<2 * kStep>(v);
  }
}

// Loads `count` numbers of each lane from its own array: number j of all lanes goes to to[j].
template <class V>
inline void load_lanes(const std::array<const double*, kWidthOf<V>>& from, int count,
                       V* to) noexcept {
  constexpr int n = kWidthOf<V>;
  if constexpr (n == 1) {
    std::copy_n(from[0], count, to);
    return;
  } else {
    for (int k = 0; k < count; k += n) {
      if (count < n) {
        for (int j = 0; j < count; ++j)
          for (int lane = 0; lane < n; ++lane) to[j][lane] = from[lane][j];
        return;
      }
      // The last square overlaps the one before.
      const int at = k + n <= count ? k : count - n;
      std::array<V, n> square;
      for (int lane = 0; lane < n; ++lane) std::memcpy(&square[lane], from[lane] + at, sizeof(V));
      transpose(square);
      for (int j = 0; j < n; ++j) to[at + j] = square[j];
    }
  }
}
// The inverse, for the first `lanes` lanes.
template <class V>
inline void store_lanes(const V* from, int count, int lanes,
                        const std::array<double*, kWidthOf<V>>& to) noexcept {
  constexpr int n = kWidthOf<V>;
  for (int k = 0; k < count; k += n) {
    if (count < n) {
      for (int j = 0; j < count; ++j)
        for (int lane = 0; lane < lanes; ++lane) to[lane][j] = from[j][lane];
      return;
    }
    const int at = k + n <= count ? k : count - n;
    std::array<V, n> square;
    for (int j = 0; j < n; ++j) square[j] = from[at + j];
    transpose(square);
    for (int lane = 0; lane < lanes; ++lane) std::memcpy(to[lane] + at, &square[lane], sizeof(V));
  }
}

// --- Mathematics ---------------------------------------------------------------------------------

// sin_cos() of gaitpad/math.h in each lane, for angles below 2^20.
inline void sin_cos_of(double angle_rad, double& sine, double& cosine) noexcept {
  const SinCos both = sin_cos(angle_rad);
  sine = both.sin, cosine = both.cos;
}
template <class V>
inline void sin_cos_of(const V& angle_rad, V& sine, V& cosine) noexcept {
  V x = angle_rad;
  const bool turned = any(abs_of(angle_rad) >= all_of<V>(0.785));
  V quarters{};
  if (turned) {
    constexpr double kRound = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to a whole number
    // Round to nearest, halves away from 0, like sin_cos().
    const V scaled = angle_rad * kTwoOverPi, above = abs_of(scaled) + 0.5;
    const V near = (above + kRound) - kRound, whole = near > above ? near - 1.0 : near;
    quarters = scaled < V{} ? -whole : whole;
    x = ((angle_rad - quarters * kHalfPi1) - quarters * kHalfPi2) - quarters * kHalfPi3;
    const V s = sin_kernel(x), c = cos_kernel(x);
    const auto is_odd = [](const V& n) {
      const V half = 0.5 * n;
      return half != (half + kRound) - kRound;
    };
    const auto swapped = is_odd(quarters), back = is_odd((0.5 * quarters - 0.25 + kRound) - kRound);
    sine = swapped ? c : s;
    cosine = swapped ? s : c;
    sine = back ? -sine : sine;
    cosine = (swapped ^ back) != 0 ? -cosine : cosine;
    return;
  }
  sine = sin_kernel(x);
  cosine = cos_kernel(x);
}

// std::floor() for numbers below 2^51.
inline double floor_of(double x) noexcept { return std::floor(x); }
template <class V>
inline V floor_of(const V& x) noexcept {
  constexpr double kRound = 6755399441055744.0;  // rounds as in sin_cos_of()
  const V near = (x + kRound) - kRound;
  return near > x ? near - 1.0 : near;
}

// atan2() and acos() of gaitpad/math.h.
template <class V>
inline V atan2_of(const V& y, const V& x) noexcept {
  const V ax = abs_of(x), ay = abs_of(y);
  // atan of r = |y / x|, reduced by atan r = atan c + atan((r - c) / (1 + c r)).
  const V r = ay / ax, one = all_of<V>(1.0);
  V whole{}, above = r, below = one;
  const auto from = [&](double least, double atan_c, const V& over, const V& under) {
    const auto here = not_of(r < all_of<V>(least));
    whole = here ? all_of<V>(atan_c) : whole;
    above = here ? over : above;
    below = here ? under : below;
  };
  from(0.4375, 4.63647609000806093515e-01, 2.0 * r - 1.0, 2.0 + r);
  from(0.6875, 7.85398163397448278999e-01, r - 1.0, r + 1.0);
  from(1.1875, 9.82793723247329054082e-01, r - 1.5, 1.0 + 1.5 * r);
  from(2.4375, 1.57079632679489655800e+00, -one, r);
  V a = whole + atan_kernel(above / below);
  a = ax > V{} ? a : all_of<V>(kPi / 2.0);
  a = x < V{} ? kPi - a : a;
  a = y < V{} ? -a : a;
  return ((ax == V{}) & (ay == V{})) ? V{} : a;
}
template <class V>
inline V acos_of(const V& x) noexcept {
  const V c = within(x, -1.0, 1.0);
  return atan2_of(sqrt_of((1.0 - c) * (1.0 + c)), c);
}
template <class V>
inline V asin_of(const V& x) noexcept {
  return kPi / 2.0 - acos_of(x);
}

// Vectors and rotations, one per lane. Operations have glm's order, so the bits are equal; a single
// lane uses glm itself.
template <class V>
inline Vec3Of<V> operator+(const Vec3Of<V>& a, const Vec3Of<V>& b) noexcept {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class V>
inline Vec3Of<V> operator-(const Vec3Of<V>& a, const Vec3Of<V>& b) noexcept {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class V>
inline Vec3Of<V>& operator+=(Vec3Of<V>& a, const Vec3Of<V>& b) noexcept {
  return a = a + b;
}
template <class V>
inline Vec3Of<V>& operator-=(Vec3Of<V>& a, const Vec3Of<V>& b) noexcept {
  return a = a - b;
}
template <class V, class K>
inline Vec3Of<V> operator*(const K& k, const Vec3Of<V>& a) noexcept {
  return {k * a.x, k * a.y, k * a.z};
}
template <class V, class K>
inline Vec3Of<V> operator*(const Vec3Of<V>& a, const K& k) noexcept {
  return {a.x * k, a.y * k, a.z * k};
}
template <class V, class K>
inline Vec3Of<V> operator/(const Vec3Of<V>& a, const K& k) noexcept {
  return {a.x / k, a.y / k, a.z / k};
}
template <class V>
inline V dot_of(const Vec3Of<V>& a, const Vec3Of<V>& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline double dot_of(const vec3& a, const vec3& b) noexcept { return glm::dot(a, b); }
template <class V>
inline Vec3Of<V> cross_of(const Vec3Of<V>& a, const Vec3Of<V>& b) noexcept {
  return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
}
inline vec3 cross_of(const vec3& a, const vec3& b) noexcept { return glm::cross(a, b); }
template <class V>
inline auto length_of(const V& a) noexcept {
  return sqrt_of(dot_of(a, a));
}
template <class V, class M>
inline Vec3Of<V> chosen(const M& mask, const Vec3Of<V>& a, const Vec3Of<V>& b) noexcept {
  return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}
// Puts one vector or rotation into each lane.
template <class V>
inline Vec<V> all_of(const vec3& a) noexcept {
  if constexpr (kWidthOf<V> == 1) {
    return a;
  } else {
    return {all_of<V>(a.x), all_of<V>(a.y), all_of<V>(a.z)};
  }
}
template <class V>
inline Quat<V> all_of(const quat& q) noexcept {
  if constexpr (kWidthOf<V> == 1) {
    return q;
  } else {
    return {all_of<V>(q.w), all_of<V>(q.x), all_of<V>(q.y), all_of<V>(q.z)};
  }
}

template <class V>
inline QuatOf<V> operator*(const QuatOf<V>& q, const V& k) noexcept {
  return {q.w * k, q.x * k, q.y * k, q.z * k};
}
template <class V>
inline QuatOf<V> operator+(const QuatOf<V>& a, const QuatOf<V>& b) noexcept {
  return {a.w + b.w, a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class V>
inline QuatOf<V> operator*(const QuatOf<V>& p, const QuatOf<V>& q) noexcept {
  return {
      p.w * q.w - p.x * q.x - p.y * q.y - p.z * q.z, p.w * q.x + p.x * q.w + p.y * q.z - p.z * q.y,
      p.w * q.y + p.y * q.w + p.z * q.x - p.x * q.z, p.w * q.z + p.z * q.w + p.x * q.y - p.y * q.x};
}
template <class V>
inline Vec3Of<V> operator*(const QuatOf<V>& q, const Vec3Of<V>& v) noexcept {
  const Vec3Of<V> axis{q.x, q.y, q.z}, uv = cross_of(axis, v), uuv = cross_of(axis, uv);
  return v + ((uv * q.w) + uuv) * 2.0;
}
template <class V>
inline QuatOf<V> conjugate_of(const QuatOf<V>& q) noexcept {
  return {q.w, -q.x, -q.y, -q.z};
}
inline quat conjugate_of(const quat& q) noexcept { return glm::conjugate(q); }
template <class V>
inline V dot_of(const QuatOf<V>& a, const QuatOf<V>& b) noexcept {
  return (a.w * b.w + a.x * b.x) + (a.y * b.y + a.z * b.z);
}
inline double dot_of(const quat& a, const quat& b) noexcept { return glm::dot(a, b); }
template <class V>
inline QuatOf<V> normalized(const QuatOf<V>& q) noexcept {
  return q * (1.0 / sqrt_of(dot_of(q, q)));
}
inline quat normalized(const quat& q) noexcept { return glm::normalize(q); }
template <class V, class M>
inline QuatOf<V> chosen(const M& mask, const QuatOf<V>& a, const QuatOf<V>& b) noexcept {
  return {mask ? a.w : b.w, mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}
template <class V>
inline V chosen(const MaskOf<V>& mask, const V& a, const V& b) noexcept {
  return mask ? a : b;
}
inline vec3 chosen(bool mask, const vec3& a, const vec3& b) noexcept { return mask ? a : b; }
inline quat chosen(bool mask, const quat& a, const quat& b) noexcept { return mask ? a : b; }

// Stores each lane's rotation to its walk.
template <class V>
inline void store_quats(const QuatOf<V>& q, const std::array<quat*, kWidthOf<V>>& to) noexcept {
  constexpr int n = kWidthOf<V>;
  if constexpr (n == 1) {
    *to[0] = quat(q.w, q.x, q.y, q.z);
  } else if constexpr (n == 2) {
    std::array<V, 2> xy = {q.x, q.y}, zw = {q.z, q.w};
    transpose(xy);
    transpose(zw);
    for (int lane = 0; lane < 2; ++lane) {
      std::memcpy(to[lane], &xy[lane], sizeof(V));
      std::memcpy(reinterpret_cast<double*>(to[lane]) + 2, &zw[lane], sizeof(V));
    }
  } else {
    // Rows of four numbers: lanes 0 .. 3, and with eight lanes also 4 .. 7.
    std::array<V, 4> square = {q.x, q.y, q.z, q.w};
    transpose(square);
    for (int lane = 0; lane < n; ++lane) {
      std::memcpy(to[lane], reinterpret_cast<const double*>(&square[lane % 4]) + lane / 4 * 4,
                  sizeof(quat));
    }
  }
}

// The rotations of gaitpad/math.h.
template <class V>
inline Quat<V> rotation_about_x(const V& angle_rad) noexcept {
  V sine, cosine;
  sin_cos_of(V(0.5 * angle_rad), sine, cosine);
  return Quat<V>(cosine, sine, V{}, V{});
}
template <class V>
inline Quat<V> rotation_about_y(const V& angle_rad) noexcept {
  V sine, cosine;
  sin_cos_of(V(0.5 * angle_rad), sine, cosine);
  return Quat<V>(cosine, V{}, sine, V{});
}
template <class V>
inline Quat<V> rotation_about_z(const V& angle_rad) noexcept {
  V sine, cosine;
  sin_cos_of(V(0.5 * angle_rad), sine, cosine);
  return Quat<V>(cosine, V{}, V{}, sine);
}
template <class V>
inline Quat<V> rotation_about_axis(const Vec<V>& unit_axis, const V& angle_rad) noexcept {
  V sine, cosine;
  sin_cos_of(V(0.5 * angle_rad), sine, cosine);
  return Quat<V>(cosine, unit_axis.x * sine, unit_axis.y * sine, unit_axis.z * sine);
}
template <class V>
inline Quat<V> rotation_by_vector(const Vec<V>& v) noexcept {
  const V angle = length_of(v);
  const auto is_small = angle < all_of<V>(1e-12);
  if (!any(is_small)) return rotation_about_axis<V>(v / angle, angle);
  const V one = all_of<V>(1.0);
  return chosen(is_small, normalized(Quat<V>(one, 0.5 * v.x, 0.5 * v.y, 0.5 * v.z)),
                rotation_about_axis<V>(v / (is_small ? one : angle), angle));
}
template <class V>
inline Quat<V> nlerp_of(const Quat<V>& from, const Quat<V>& to, const V& share) noexcept {
  const V one = all_of<V>(1.0), sign = dot_of(from, to) < V{} ? -one : one;
  return normalized(from * (1.0 - share) + to * (sign * share));
}

}  // namespace gaitpad
