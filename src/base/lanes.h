// Several numbers side by side, one a lane, as a processor's vector register holds them. Every lane
// is computed as a double alone is: the same bits for any width. What happens in some lanes only is
// chosen by masks.
#pragma once
#include <cmath>
#include <cstring>

#include "base/trigonometry.h"
#include "gaitpad/math.h"

namespace gaitpad {

template <int kWidth>
struct LanesOf {
  typedef double Type __attribute__((vector_size(8 * kWidth)));
  typedef long long Mask __attribute__((vector_size(8 * kWidth)));
};
template <int kWidth>
using Lanes = typename LanesOf<kWidth>::Type;
template <class V>
using MaskOf = decltype(V{} < V{});
template <class V>
inline constexpr int kWidthOf = sizeof(V) / sizeof(double);

// How many numbers this processor's registers hold: 8 with AVX-512, 4 with AVX2, else 2. What is
// compiled for wider ones may not be called.
int widest_lanes() noexcept;
// How many are used: as many as there are, or as use_lanes() says (2, 4, 8), for tests and
// measurements. The results are the same.
int lanes_in_use() noexcept;
void use_lanes(int lanes) noexcept;

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
  V root;
  for (int i = 0; i < kWidthOf<V>; ++i) root[i] = std::sqrt(a[i]);
  return root;
}
template <class M>
inline bool any(const M& mask) noexcept {
  if constexpr (kWidthOf < M >> 2) {  // half of it and half of it
    typename LanesOf<kWidthOf<M> / 2>::Mask low, high;
    std::memcpy(&low, &mask, sizeof low);
    std::memcpy(&high, reinterpret_cast<const char*>(&mask) + sizeof low, sizeof high);
    return any(low | high);
  } else {
    return (mask[0] | mask[1]) != 0;
  }
}

// sin_cos() of gaitpad/math.h in each lane, for angles below 2^20.
template <class V>
inline void sin_cos_of(const V& angle_rad, V& sine, V& cosine) noexcept {
  V x = angle_rad;
  const bool turned = any(abs_of(angle_rad) >= all_of<V>(0.785));
  V quarters{};
  if (turned) {
    constexpr double kRound = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to a whole number
    quarters = (angle_rad * kTwoOverPi + kRound) - kRound;
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

// A rotation in each lane.
template <class V>
struct QuatOf {
  V w, x, y, z;
};
template <class V>
inline QuatOf<V> operator*(const QuatOf<V>& q, const V& k) noexcept {
  return {q.w * k, q.x * k, q.y * k, q.z * k};
}
template <class V>
inline QuatOf<V> operator+(const QuatOf<V>& a, const QuatOf<V>& b) noexcept {
  return {a.w + b.w, a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class V>
inline V dot_of(const QuatOf<V>& a, const QuatOf<V>& b) noexcept {
  return (a.w * b.w + a.x * b.x) + (a.y * b.y + a.z * b.z);
}
template <class V>
inline QuatOf<V> normalized(const QuatOf<V>& q) noexcept {
  return q * (1.0 / sqrt_of(dot_of(q, q)));
}

// A vector in space in each lane. The operations are those of glm, in its order.
template <class V>
struct Vec3Of {
  V x, y, z;
};
template <class V>
inline Vec3Of<V> operator+(const Vec3Of<V>& a, const Vec3Of<V>& b) noexcept {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class V>
inline Vec3Of<V> operator-(const Vec3Of<V>& a, const Vec3Of<V>& b) noexcept {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class V>
inline Vec3Of<V> operator*(const V& k, const Vec3Of<V>& a) noexcept {
  return {k * a.x, k * a.y, k * a.z};
}
template <class V>
inline V dot_of(const Vec3Of<V>& a, const Vec3Of<V>& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class V>
inline Vec3Of<V> cross_of(const Vec3Of<V>& a, const Vec3Of<V>& b) noexcept {
  return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
}
template <class V, class M>
inline Vec3Of<V> chosen(const M& mask, const Vec3Of<V>& a, const Vec3Of<V>& b) noexcept {
  return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}

}  // namespace gaitpad
