// Fifth: the legs. One step of the paper's weighted half Jacobian (three rows of the ankle, four
// rotations) chooses what the foot leaves free, the knee's swivel; the knee then follows from the
// distance, and the least turn of the hip and the ankle close the rest exactly.
#pragma once
#include "walk/feet.h"

namespace gaitpad::anew {
namespace {

template <class V>
struct Leg {
  Turn<V> hip, knee, ankle;
  Mask<V> short_of{};  // the ankle is out of the leg's reach
};

inline constexpr float kLeastKnee_rad = 0.017453293f, kLeak_per_s = 4.0f, kMostStep_rad = 0.3f;
inline constexpr float kStraightCosine = 0.99984770f, kFoldedCosine = -0.9f;  // 1 and 154 degrees
inline constexpr float kDamping_m2 = 1e-8f;

// `ankle_m`, `foot`: seen from the hip joint in the pelvis' frame. `table_rad`: where it starts.
template <class V>
Leg<V> solve_leg(const V& thigh_m, const V& shank_m, const Vec<V>& ankle_m, const Turn<V>& foot,
                 const V (&table_rad)[4], V (&off_rad)[4]) noexcept {
  V half_sine[4], half_cosine[4], s[4], c[4];
  for (int j = 0; j < 4; ++j) {
    sin_cos_small(V(0.5f * (table_rad[j] + off_rad[j])), half_sine[j], half_cosine[j]);
    s[j] = 2.0f * half_sine[j] * half_cosine[j];
    c[j] = 1.0f - 2.0f * half_sine[j] * half_sine[j];
  }
  // Axes of the hip's second and third turn, of the knee, and along the shank.
  const Vec<V> hip_z{V{}, -s[0], c[0]}, thigh{-s[1], c[1] * c[0], c[1] * s[0]},
      x{c[1], s[1] * c[0], s[1] * s[0]};
  const Vec<V> hinge = x * c[2] - hip_z * s[2], ahead = hip_z * c[2] + x * s[2];
  const Vec<V> shank = (thigh * c[3] + ahead * s[3]) * (-shank_m), p = thigh * (-thigh_m) + shank;
  const Vec<V> error = ankle_m - p;
  const Vec<V> column[4] = {
      {V{}, -p.z, p.y}, cross(hip_z, p), cross(thigh, p), cross(hinge, shank)};
  // J J^T + l^2 I, its Cholesky factors, and J^T of what they give.
  V m00 = all<V>(kDamping_m2), m11 = m00, m22 = m00, m01{}, m02{}, m12{};
  for (const Vec<V>& a : column) {
    m00 = m00 + a.x * a.x, m01 = m01 + a.x * a.y, m02 = m02 + a.x * a.z;
    m11 = m11 + a.y * a.y, m12 = m12 + a.y * a.z, m22 = m22 + a.z * a.z;
  }
  const V r0 = 1.0f / m00, l1 = m01 * r0, l2 = m02 * r0, d1 = m11 - l1 * m01, t = m12 - l1 * m02,
          r1 = 1.0f / d1, l3 = t * r1, r2 = 1.0f / ((m22 - l2 * m02) - l3 * t);
  const V b1 = error.y - l1 * error.x, b2 = (error.z - l2 * error.x) - l3 * b1, z2 = b2 * r2,
          z1 = b1 * r1 - l3 * z2, z0 = (error.x * r0 - l1 * z1) - l2 * z2;
  V step[4];
  for (int j = 0; j < 4; ++j) {
    step[j] = within(V(column[j].x * z0 + column[j].y * z1 + column[j].z * z2), -kMostStep_rad,
                     kMostStep_rad);
    off_rad[j] = off_rad[j] + step[j];
  }
  // The hip after the step: its half angles turned on by the step, Rx Rz Ry.
  V hs[3], hc[3];
  for (int j = 0; j < 3; ++j) {
    V ds, dc;
    sin_cos_small(V(0.5f * step[j]), ds, dc);
    hs[j] = half_sine[j] * dc + half_cosine[j] * ds;
    hc[j] = half_cosine[j] * dc - half_sine[j] * ds;
  }
  const V w = hc[0] * hc[1], i = hs[0] * hc[1], j = -hs[0] * hs[1], k = hc[0] * hs[1];
  const Turn<V> hip{w * hc[2] - j * hs[2], i * hc[2] - k * hs[2], w * hs[2] + j * hc[2],
                    k * hc[2] + i * hs[2]};
  const V square = dot(ankle_m, ankle_m),
          bends = (square - (thigh_m * thigh_m + shank_m * shank_m)) / (2.0f * thigh_m * shank_m);
  Leg<V> leg;
  leg.short_of = either(bends > all<V>(kStraightCosine), bends < all<V>(kFoldedCosine));
  const V knee_c = within(bends, kFoldedCosine, kStraightCosine),
          knee_hc = root(V(0.5f + 0.5f * knee_c)), knee_hs = root(V(0.5f - 0.5f * knee_c));
  const Vec<V> from = hip * Vec<V>{V{}, -(thigh_m + shank_m * knee_c),
                                   -(shank_m * 2.0f * knee_hc * knee_hs)},
               axis = cross(from, ankle_m);
  const Turn<V> least_turn =
      unit(Turn<V>{root(V(dot(from, from) * square)) + dot(from, ankle_m), axis.x, axis.y, axis.z});
  leg.hip = unit(least_turn * hip);
  leg.knee = {knee_hc, knee_hs, V{}, V{}};
  leg.ankle = back(leg.hip * leg.knee) * foot;
  return leg;
}

// Swing and stand.
template <class V>
void solve_legs(const Tables& tables, const Time<V>& time, const Stride<V>& stride,
                const Feet<V>& feet, const Pelvis<V>& pelvis, State<V>& state,
                Leg<V> (&legs)[2]) noexcept {
  // What is added to the tables' angles leaks away, and most of what it had changed by goes on: the
  // most with which the swivel still returns without swinging, a double root.
  const float keep = 1.0f - std::min(1.0f, kLeak_per_s * tables.tick_s),
              square_root = 1.0f - std::sqrt(1.0f - keep), ahead = square_root * square_root;
  const Turn<V> to_pelvis = back(pelvis.turn);
  for (int k : {0, 1}) {
    const auto right = k == 0 ? time.right : no(time.right);
    const LegBones &l = tables.leg[0], &r = tables.leg[1];
    V table_rad[4];
    for (int j = 0; j < 4; ++j) {
      table_rad[j] = stride.leg_rad[k][j] + chosen<V>(right, r.stand_rad[j], l.stand_rad[j]);
      const V off = state.leg_rad[k][j];
      state.leg_rad[k][j] = keep * off + ahead * (off - state.last_leg_rad[k][j]);
      state.last_leg_rad[k][j] = off;
    }
    table_rad[3] = most(table_rad[3], all<V>(kLeastKnee_rad));
    const Vec<V> ankle_m =
        to_pelvis * (ankle_of(feet.foot[k], feet.sole[k]) - pelvis.place_m - pelvis.hip_m[k]);
    legs[k] =
        solve_leg<V>(chosen<V>(right, r.thigh_m, l.thigh_m), chosen<V>(right, r.shank_m, l.shank_m),
                     ankle_m, to_pelvis * feet.foot[k].turn, table_rad, state.leg_rad[k]);
  }
}

}  // namespace
}  // namespace gaitpad::anew
