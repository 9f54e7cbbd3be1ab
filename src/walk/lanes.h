// Arithmetic on the numbers V of walks: a register with one walk in each lane, or a float of one
// walk. Every lane gets the bits that its walk gets alone, because + - * / and square roots are in
// one order, masks replace branches, and nothing is contracted (see the flags of the build).
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/lanes.h"
#include "base/masks.h"
#include "gaitpad/walk_state.h"

namespace gaitpad {

#ifdef GAITPAD_NO_VECTORS
// Stands for a register of four numbers of a table's row. Walks are computed alone, in floats.
template <int kWidth>
struct Numbers {
  float number[kWidth];
  float& operator[](int i) noexcept { return number[i]; }
  float operator[](int i) const noexcept { return number[i]; }
};
template <int kWidth>
struct FloatsOf {
  using Type = Numbers<kWidth>;
};
#else
template <int kWidth>
struct FloatsOf {
  using Type __attribute__((vector_size(4 * kWidth))) = float;
};
#endif
template <class V>
struct Turn {  // a unit quaternion
  V w{}, x{}, y{}, z{};
};

// A whole turn, a quarter of it, and a degree.
inline constexpr float kTurn_rad = 6.2831853f, kRightAngle_rad = 1.5707963f,
                       kDegree_rad = 0.017453293f;

namespace {

template <class V>
inline float lane(const V& v, int i) noexcept {
  return reinterpret_cast<const float*>(&v)[i];
}
template <class V>
inline void set_lane(float x, int i, V& v) noexcept {
  reinterpret_cast<float*>(&v)[i] = x;
}

template <class V>
inline V within(const V& x, float low, float high) noexcept {
  return least(most(x, all<V>(low)), all<V>(high));
}
// Rounds to the nearest multiple of `unit`, a power of 2, for |x| below 2^22 units.
template <class V>
inline V rounded_to(float unit, const V& x) noexcept {
  const float round = 12582912.0f * unit;  // 1.5 * 2^23: adding it leaves no room for fractions
  return (x + round) - round;
}
template <class V>
inline V rounded(const V& x) noexcept {
  return rounded_to(1.0f, x);
}
template <class V>
inline V floored(const V& x) noexcept {
#ifndef GAITPAD_NO_VECTORS
  // In a register a choice takes no branch, which a processor would guess wrong half of the time.
  if constexpr (kLanes<V> == 1) return floored(Floats<4>{x})[0];
#endif
  const V near = rounded(x);
  return near > x ? near - 1.0f : near;
}

// Exchanges two numbers where the mask says so.
template <class V>
inline void exchange(const Mask<V>& where, V& a, V& b) noexcept {
  const V was = a;
  a = where ? b : was;
  b = where ? was : b;
}

// --- Four numbers of a row, or of a rotation (x, y, z, w) ----------------------------------------

using Four = Floats<4>;
#ifdef GAITPAD_NO_VECTORS
template <class Work>
inline Four each(const Work& work) noexcept {
  return {{work(0), work(1), work(2), work(3)}};
}
inline Four operator+(const Four& a, const Four& b) noexcept {
  return each([&](int i) { return a[i] + b[i]; });
}
inline Four operator-(const Four& a, const Four& b) noexcept {
  return each([&](int i) { return a[i] - b[i]; });
}
inline Four operator*(const Four& a, float k) noexcept {
  return each([&](int i) { return a[i] * k; });
}
inline Four& operator+=(Four& a, const Four& b) noexcept { return a = a + b; }
inline Four unit(const Four& q) noexcept {
  const float length = std::sqrt((q[0] * q[0] + q[1] * q[1]) + (q[2] * q[2] + q[3] * q[3]));
  return each([&](int i) { return q[i] / length; });
}
inline void store(const Four& q, quat& to) noexcept {
  to.x = q[0], to.y = q[1], to.z = q[2], to.w = q[3];
}
inline Four load(const quat& q) noexcept {
  return {{static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z),
           static_cast<float>(q.w)}};
}
// Rows to columns.
inline void transpose(Four (&row)[4]) noexcept {
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < i; ++j) std::swap(row[i][j], row[j][i]);
}
#else
inline Four unit(const Four& q) noexcept {
  const Four square = q * q, pairs = square + __builtin_shufflevector(square, square, 1, 0, 3, 2),
             sum = pairs + __builtin_shufflevector(pairs, pairs, 2, 3, 0, 1);
  return q / root(sum);
}
inline void store(const Four& q, quat& to) noexcept {
  using Doubles __attribute__((vector_size(32))) = double;
  const Doubles wide = __builtin_convertvector(q, Doubles);
  std::memcpy(&to, &wide, sizeof wide);
}
inline Four load(const quat& q) noexcept {
  using Doubles __attribute__((vector_size(32))) = double;
  Doubles wide;
  std::memcpy(&wide, &q, sizeof wide);
  return __builtin_convertvector(wide, Four);
}
inline void transpose(Four (&row)[4]) noexcept {
  const Four ab = __builtin_shufflevector(row[0], row[1], 0, 4, 1, 5),
             ab2 = __builtin_shufflevector(row[0], row[1], 2, 6, 3, 7),
             cd = __builtin_shufflevector(row[2], row[3], 0, 4, 1, 5),
             cd2 = __builtin_shufflevector(row[2], row[3], 2, 6, 3, 7);
  row[0] = __builtin_shufflevector(ab, cd, 0, 1, 4, 5);
  row[1] = __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
  row[2] = __builtin_shufflevector(ab2, cd2, 0, 1, 4, 5);
  row[3] = __builtin_shufflevector(ab2, cd2, 2, 3, 6, 7);
}
#endif

// --- Curves --------------------------------------------------------------------------------------

// From 0 at x <= 0 to 1 at x >= 1. smooth() has no slope at both ends; smoother() has no curvature
// there either. With bounds: from 0 at `from` to 1 at `to`.
template <class V>
inline V smooth(const V& x) noexcept {
  const V u = within(x, 0.0f, 1.0f);
  return u * u * (3.0f - 2.0f * u);
}
template <class V>
inline V smoother(const V& x) noexcept {
  const V u = within(x, 0.0f, 1.0f);
  return u * u * u * (10.0f + u * (6.0f * u - 15.0f));
}
template <class V>
inline V smooth(float from, float to, const V& x) noexcept {
  return smooth(V((x - from) * (1.0f / (to - from))));
}
template <class V>
inline V smoother(float from, float to, const V& x) noexcept {
  return smoother(V((x - from) * (1.0f / (to - from))));
}
template <class V>
inline V mix(const V& a, const V& b, const V& share) noexcept {
  return a + (b - a) * share;
}
// max(x, 0), and min(a, b) with x = a - b; a parabola rounds their corner over |x| < width.
template <class V>
inline V soft_positive(const V& x, const V& width) noexcept {
  const V rounded = (x + width) * (x + width) / (4.0f * width), above = x >= width ? x : rounded;
  return x <= -width ? V{} : above;
}
template <class V>
inline V soft_least(const V& a, const V& b, const V& width) noexcept {
  return a - soft_positive(V(a - b), width);
}
// Cubics over s from 0 to 1 that end with value 0 and slope 0. They begin with value 1, and with
// slope 1.
template <class V>
inline V value_left(const V& s) noexcept {
  return 1.0f + s * s * (2.0f * s - 3.0f);
}
template <class V>
inline V slope_left(const V& s) noexcept {
  return s * (1.0f - s) * (1.0f - s);
}

// --- Angles --------------------------------------------------------------------------------------

// Sine and cosine of an angle below pi / 4, to 1e-7: minimax polynomials (Cephes, sinf and cosf).
template <class V>
inline void sin_cos_small(const V& x, V& sine, V& cosine) noexcept {
  const V z = x * x;
  sine = x + x * z * (-1.6666654611e-1f + z * (8.3321608736e-3f + z * -1.9515295891e-4f));
  cosine =
      1.0f - 0.5f * z +
      z * z * (4.166664568298827e-2f + z * (-1.388731625493765e-3f + z * 2.443315711809948e-5f));
}
// Sine and cosine of any angle below 1e4, which is nearest to so many quarter turns.
template <class V>
[[gnu::noinline]] void sin_cos_far(const V& angle_rad, const V& quarters, V& sine,
                                   V& cosine) noexcept {
  // pi / 2 in three parts, of which the first two have few digits.
  const V x = ((angle_rad - quarters * 1.5703125f) - quarters * 4.837512969970703125e-4f) -
              quarters * 7.54978995489188216e-8f;
  V s, c;
  sin_cos_small(x, s, c);
  const auto is_odd = [](const V& n) {
    const V half = 0.5f * n;
    return half != rounded(half);
  };
  const auto odd = is_odd(quarters), back = is_odd(rounded(V(0.5f * quarters - 0.25f)));
  const V sine_of = odd ? c : s, cosine_of = odd ? s : c;
  sine = back ? -sine_of : sine_of;
  cosine = (odd != back) ? -cosine_of : cosine_of;
}
template <class V>
inline void sin_cos(const V& angle_rad, V& sine, V& cosine) noexcept {
  const V quarters = rounded(V(angle_rad * 0.63661977f));
  if (any(quarters != V{})) return sin_cos_far(angle_rad, quarters, sine, cosine);
  sin_cos_small(angle_rad, sine, cosine);
}
// Arc sine to 1e-7 (Cephes, asinf). Above 0.5 it is a right angle less the other acute angle.
template <class V>
inline V arc_sine(const V& x) noexcept {
  const V a = size(x);
  const auto wide = a > all<V>(0.5f);
  const V z = wide ? V(0.5f * (1.0f - a)) : V(a * a), s = wide ? root(z) : a,
          arc = s +
                s * z *
                    (1.6666752422e-1f +
                     z * (7.4953002686e-2f +
                          z * (4.5470025998e-2f + z * (2.4181311049e-2f + z * 4.2163199048e-2f)))),
          angle_rad = wide ? V(kRightAngle_rad - 2.0f * arc) : arc;
  return x < V{} ? -angle_rad : angle_rad;
}
// The angle with a tangent of at most tan(pi / 8), exact to 1e-7 (Cephes, atanf).
template <class V>
inline V arc_tangent_small(const V& x) noexcept {
  const V z = x * x;
  return x + x * z *
                 (-3.33329491539e-1f +
                  z * (1.99777106478e-1f + z * (-1.38776856032e-1f + z * 8.05374449538e-2f)));
}

// --- Vectors and rotations -----------------------------------------------------------------------

template <class V>
inline Vec<V> operator+(const Vec<V>& a, const Vec<V>& b) noexcept {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class V>
inline Vec<V> operator-(const Vec<V>& a, const Vec<V>& b) noexcept {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class V, class K>
inline Vec<V> operator*(const Vec<V>& a, const K& k) noexcept {
  return {a.x * k, a.y * k, a.z * k};
}
template <class V>
inline V dot(const Vec<V>& a, const Vec<V>& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class V>
inline Vec<V> cross(const Vec<V>& a, const Vec<V>& b) noexcept {
  return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
}
template <class V>
inline Vec<V> chosen(const Mask<V>& mask, const Vec<V>& a, const Vec<V>& b) noexcept {
  if constexpr (kLanes<V> == 1) return mask ? a : b;
  return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}
template <class V>
inline Turn<V> no_turn() noexcept {
  return {all<V>(1.0f), V{}, V{}, V{}};
}
template <class V>
inline Turn<V> operator*(const Turn<V>& p, const Turn<V>& q) noexcept {
  return {
      p.w * q.w - p.x * q.x - p.y * q.y - p.z * q.z, p.w * q.x + p.x * q.w + p.y * q.z - p.z * q.y,
      p.w * q.y + p.y * q.w + p.z * q.x - p.x * q.z, p.w * q.z + p.z * q.w + p.x * q.y - p.y * q.x};
}
template <class V>
inline Vec<V> operator*(const Turn<V>& q, const Vec<V>& v) noexcept {
  const Vec<V> axis{q.x, q.y, q.z}, once = cross(axis, v), twice = cross(axis, once);
  return v + ((once * q.w) + twice) * 2.0f;
}
template <class V>
inline Turn<V> back(const Turn<V>& q) noexcept {
  return {q.w, -q.x, -q.y, -q.z};
}
template <class V>
inline Turn<V> unit(const Turn<V>& q) noexcept {
  const V k = 1.0f / root(V((q.w * q.w + q.x * q.x) + (q.y * q.y + q.z * q.z)));
  return {q.w * k, q.x * k, q.y * k, q.z * k};
}
template <class V>
inline Turn<V> chosen(const Mask<V>& mask, const Turn<V>& a, const Turn<V>& b) noexcept {
  if constexpr (kLanes<V> == 1) return mask ? a : b;
  return {mask ? a.w : b.w, mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}
inline vec3 wide(const Vec<float>& v) noexcept { return {v.x, v.y, v.z}; }
inline vec3 wide(const std::array<float, 3>& v) noexcept { return {v[0], v[1], v[2]}; }
// Rotation about a unit axis by less than a quarter turn.
template <class V>
inline Turn<V> turn_about(const Vec<V>& axis, const V& angle_rad) noexcept {
  V s, c;
  sin_cos_small(V(0.5f * angle_rad), s, c);
  return {c, axis.x * s, axis.y * s, axis.z * s};
}
// Rotation by a vector of up to 30 degrees, with a series of the tangent of half its length.
template <class V>
inline Turn<V> turn_by(const Vec<V>& v) noexcept {
  const V square = dot(v, v), k = 0.5f + square * (1.0f / 24.0f + square * (1.0f / 240.0f));
  return unit(Turn<V>{all<V>(1.0f), v.x * k, v.y * k, v.z * k});
}

// A direction on the ground as an angle from straight ahead, positive to the left.
template <class V>
struct Way {
  V half_sine{}, half_cosine = all<V>(1.0f), sine{}, cosine = all<V>(1.0f);
  // A place in the frame that points this way, seen from outside of that frame.
  Vec<V> operator*(const Vec<V>& p) const noexcept {
    return {cosine * p.x + sine * p.z, p.y, cosine * p.z - sine * p.x};
  }
  // Components of a place along this way and to the left of it.
  V ahead(const V& x_m, const V& z_m) const noexcept { return x_m * sine + z_m * cosine; }
  V left(const V& x_m, const V& z_m) const noexcept { return x_m * cosine - z_m * sine; }
  Turn<V> turn() const noexcept { return {half_cosine, V{}, half_sine, V{}}; }
};
template <class V>
[[gnu::always_inline]] inline Way<V> way_of_half(const V& sine, const V& cosine) noexcept {
  return {sine, cosine, 2.0f * sine * cosine, cosine * cosine - sine * sine};
}
template <class V>
[[gnu::always_inline]] inline Way<V> way_of(const V& heading_rad) noexcept {
  V sine, cosine;
  sin_cos(V(0.5f * heading_rad), sine, cosine);
  return way_of_half(sine, cosine);
}
template <class V>
inline Off<V> chosen(const Mask<V>& mask, const Off<V>& a, const Off<V>& b) noexcept {
  return {mask ? a.x : b.x, mask ? a.v : b.v, mask ? a.a : b.a};
}
template <class V>
inline Way<V> chosen(const Mask<V>& mask, const Way<V>& a, const Way<V>& b) noexcept {
  return {mask ? a.half_sine : b.half_sine, mask ? a.half_cosine : b.half_cosine,
          mask ? a.sine : b.sine, mask ? a.cosine : b.cosine};
}
// The opposite angle.
template <class V>
inline Way<V> back(const Way<V>& way) noexcept {
  return {-way.half_sine, way.half_cosine, -way.sine, way.cosine};
}

// --- Limbs packed into full registers ------------------------------------------------------------

// Calls `work` with the legs or arms of a block `where` they ask for it, put side by side in full
// registers. Limb<V> holds nothing but numbers V: the first kTakes of them go to `work`, those
// from number kGives on come back.
template <int kTakes, int kGives, template <class> class Limb, class V, class Work>
void work_packed(const Mask<V> (&where)[2], Limb<V> (&limbs)[2], const Work& work) noexcept {
  constexpr int kWidth = kLanes<V>, kTogether = std::max(kWidth, kLeastLanes),
                kNumbers = sizeof(Limb<float>) / sizeof(float);
  const V is[2] = {chosen<V>(where[0], 1.0f, 0.0f), chosen<V>(where[1], 1.0f, 0.0f)};
  float* places[2 * kWidth];
  int count = 0;
  for (int w = 0; w < kWidth; ++w)
    for (int k : {0, 1})
      if (lane(is[k], w) != 0.0f) places[count++] = reinterpret_cast<float*>(&limbs[k]) + w;
  for (int begin = 0; begin < count; begin += kTogether) {
    Limb<Floats<kTogether>> together;
    float* to = reinterpret_cast<float*>(&together);
    const int here = std::min(kTogether, count - begin);
    // Written out, a number takes two instructions; the loop would take eight.
    for (int i = 0; i < here; ++i) {
      const float* const from = places[begin + i];
#pragma GCC unroll 64
      for (int n = 0; n < kTakes; ++n) to[n * kTogether + i] = from[n * kWidth];
    }
    work(together);
    for (int i = 0; i < here; ++i) {
      float* const back = places[begin + i];
#pragma GCC unroll 64
      for (int n = kGives; n < kNumbers; ++n) back[n * kWidth] = to[n * kTogether + i];
    }
  }
}

}  // namespace
}  // namespace gaitpad
