// Choices among numbers side by side: V is a register of floats, or one float or double. Every
// number gets the bits that it would get alone, because masks replace branches.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <type_traits>

namespace gaitpad {

template <class V>
inline constexpr int kLanes = sizeof(V) / sizeof(float);
template <class V>
using Scalar = std::conditional_t<std::is_same_v<V, double>, double, float>;
template <class V>
using Mask = decltype(V{} < V{});  // bool of one walk

// Without a name: units with different instruction sets have a copy each.
namespace {

template <class V>
inline V all(Scalar<V> x) noexcept {
  return x - V{};  // x itself, which V{} + x is not: a zero may have a sign
}
inline bool both(bool a, bool b) noexcept { return a && b; }
inline bool either(bool a, bool b) noexcept { return a || b; }
inline bool no(bool a) noexcept { return !a; }
inline bool any(bool a) noexcept { return a; }
template <class M>
inline M both(const M& a, const M& b) noexcept {
  return a & b;
}
template <class M>
inline M either(const M& a, const M& b) noexcept {
  return a | b;
}
template <class M>
inline M no(const M& a) noexcept {
  return ~a;
}
template <class M>
inline bool any(const M& mask) noexcept {
  static_assert(sizeof(M) >= 16, "a mask, not a number");
  std::array<long long, sizeof(M) / 8> parts;
  std::memcpy(parts.data(), &mask, sizeof mask);
  long long sum = 0;
  for (const long long part : parts) sum |= part;
  return sum != 0;
}
template <class V>
inline V chosen(const Mask<V>& mask, const V& a, const V& b) noexcept {
  return mask ? a : b;
}
template <class V>
inline V chosen(const Mask<V>& mask, Scalar<V> a, Scalar<V> b) noexcept {
  return mask ? all<V>(a) : all<V>(b);
}

template <class V>
inline V least(const V& a, const V& b) noexcept {
  return b < a ? b : a;
}
template <class V>
inline V most(const V& a, const V& b) noexcept {
  return a < b ? b : a;
}
template <class V>
inline V size(const V& x) noexcept {
  return most(x, -x);
}
template <class V>
inline V root(const V& x) noexcept {
  if constexpr (std::is_floating_point_v<V>) {
    return std::sqrt(x);
  } else {
    V r{};
    for (int i = 0; i < kLanes<V>; ++i) r[i] = std::sqrt(x[i]);
    return r;
  }
}

// Sets the numbers V of which T consists to those of another T.
template <class V, class T>
inline void put_where(const Mask<V>& where, const T& from, T& to) noexcept {
  constexpr std::size_t kBytes = sizeof(V);
  static_assert(sizeof(T) % kBytes == 0);
#pragma GCC unroll 8
  for (std::size_t n = 0; n < sizeof(T) / kBytes; ++n) {
    V& number = reinterpret_cast<V*>(&to)[n];
    number = where ? reinterpret_cast<const V*>(&from)[n] : number;
  }
}

}  // namespace
}  // namespace gaitpad
