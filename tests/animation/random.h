// Random numbers that are the same with every standard library.
#pragma once
#include <cstdint>
#include <random>

#include "gaitpad/math.h"

namespace gaitpad::test {

class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}
  double between(double a, double b) {
    return a + (b - a) * (static_cast<double>(bits_() >> 11) * 0x1p-53);
  }
  vec3 inside(double most) {
    vec3 v;  // one by one: compilers differ in the order in which they evaluate arguments
    for (int i = 0; i < 3; ++i) v[i] = between(-most, most);
    return v;
  }
  vec3 direction() {
    for (;;) {
      const vec3 v = inside(1.0);
      const double length = glm::length(v);
      if (length > 0.1 && length < 1.0) return v / length;
    }
  }

 private:
  std::mt19937_64 bits_;
};

}  // namespace gaitpad::test
