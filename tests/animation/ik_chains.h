// Chains, targets and random numbers for the tests of the IK solvers.
#pragma once
#include <cstdint>
#include <random>
#include <vector>

#include "gaitpad/ik.h"

namespace gaitpad::test {

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif
#else
inline constexpr bool kSanitized = false;
#endif
// The specification's 10^6; an unoptimised or sanitized build takes a sample.
#ifdef __OPTIMIZE__
inline constexpr int kMillion = kSanitized ? 20'000 : 1'000'000;
#else
inline constexpr int kMillion = 20'000;
#endif

class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}
  double between(double a, double b) {
    return a + (b - a) * (static_cast<double>(bits_() >> 11) * 0x1p-53);
  }
  vec3 direction() {
    for (;;) {
      vec3 v;  // one by one: compilers differ in the order in which they evaluate arguments
      for (int i = 0; i < 3; ++i) v[i] = between(-1.0, 1.0);
      const double length = glm::length(v);
      if (length > 0.1 && length < 1.0) return v / length;
    }
  }

 private:
  std::mt19937_64 bits_;
};

inline const vec3 kHeel(0.0, -0.08, -0.05), kToe(0.0, -0.06, 0.13);  // from the ankle
inline const vec3 kX(1.0, 0.0, 0.0), kY(0.0, 1.0, 0.0), kZ(0.0, 0.0, 1.0);

// A leg of thigh 0.42 and shank 0.42 m with a human's limits.
inline IkChain human_leg() {
  const vec3 shaft(0.0, -0.42, 0.0);
  IkChain c;
  const auto add = [&](const vec3& axis, double min_deg, double max_deg, const vec3& link) {
    c.dof[c.dofs++] = {axis, link, min_deg * kDegree, max_deg * kDegree, 1.0};
  };
  add(kX, -120, 30, vec3(0.0)), add(kZ, -45, 45, vec3(0.0)), add(kY, -45, 45, shaft);
  add(kX, 1, 150, shaft);
  add(kX, -38, 50, vec3(0.0)), add(kZ, -30, 30, vec3(0.0)), add(kY, -30, 30, vec3(0.0));
  return c;
}

inline IkAngles standing() {
  IkAngles q{};
  q[0] = -4.0 * kDegree, q[3] = 8.0 * kDegree, q[4] = -4.0 * kDegree;
  return q;
}

inline IkAngles random_pose(const IkChain& c, Random& random) {
  IkAngles q{};
  for (int j = 0; j < c.dofs; ++j) q[j] = random.between(c.dof[j].min_rad, c.dof[j].max_rad);
  return q;
}

// Oblique axes, links of 0.2 to 0.6 m, weights 0.2 to 1, no limits.
inline IkChain random_chain(int dofs, Random& random) {
  IkChain c;
  c.dofs = dofs;
  for (int j = 0; j < dofs; ++j) {
    c.dof[j].axis = random.direction();
    c.dof[j].link_m = random.direction();
    c.dof[j].link_m *= random.between(0.2, 0.6);
    c.dof[j].weight = random.between(0.2, 1.0);
  }
  return c;
}

inline IkAngles random_angles(const IkChain& c, Random& random) {
  IkAngles q{};
  for (int j = 0; j < c.dofs; ++j) q[j] = random.between(-1.5, 1.5);
  return q;
}

inline vec3 point_at(const IkChain& c, const IkAngles& q, const vec3& point_m) {
  const IkFrame f = end_frame(c, q);
  return f.position_m + f.rotation * point_m;
}

inline double error_of(const IkChain& c, std::span<const IkRow> rows, const IkAngles& q) {
  double squares = 0.0;
  for (const IkRow& row : rows) {
    const double e = row.goal_m - glm::dot(row.direction, point_at(c, q, row.point_m));
    squares += e * e;
  }
  return std::sqrt(squares);
}

inline bool within_limits(const IkChain& c, const IkAngles& q) {
  for (int j = 0; j < c.dofs; ++j) {
    if (!(q[j] >= c.dof[j].min_rad && q[j] <= c.dof[j].max_rad)) return false;
  }
  return true;
}

}  // namespace gaitpad::test
