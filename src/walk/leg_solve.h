// Fifth: the legs. The knee's angle follows from the distance between hip and ankle. The poses that
// are left differ by the knee's swivel about the line from hip to ankle; a leg takes the one with
// the least sum of squares of its seven angles' changes. To first order this is the answer of the
// pseudoinverse in the paper's equation (4). The foot is exactly where it is planned.
#pragma once
#include "walk/feet.h"

namespace gaitpad {
namespace {

template <class V>
struct Leg {
  Turn<V> hip, knee, ankle;
  V short_m{};         // how far the ankle's goal is out of the leg's reach
  V iterations{};      // of the paper's solver
  Mask<V> failed{};    // the paper's solver did not converge
  V more_pitch_rad{};  // the foot's pitch beyond its plan, which weights or the paper's solver add
};

inline constexpr float kLeastKnee_rad = kDegree_rad;  // a straight knee has no side to bend to
inline constexpr float kLeak_per_s = 4.0f;  // what is added to the tables' angles fades so fast
inline constexpr float kStraightCosine = 0.99984770f, kFoldedCosine = -0.9f;  // 1 and 154 degrees
inline constexpr float kLeast_m2 = 1e-8f;       // squares of lengths below are no direction
inline constexpr float kMostOff_rad = 2.5f;     // no joint of a leg turns so far off the tables
inline constexpr float kMostSwivel_rad = 0.3f;  // in a tick: beyond, the first order is not enough

// The axes of a frame.
template <class V>
struct Axes {
  Vec<V> x, y, z;
  Vec<V> operator*(const Vec<V>& p) const noexcept { return x * p.x + y * p.y + z * p.z; }
};
// Those after Rx Rz, from the sines and cosines of both angles.
template <class V>
[[gnu::always_inline]] inline Axes<V> axes_xz(const V* sine, const V* cosine) noexcept {
  return {{cosine[1], sine[1] * cosine[0], sine[1] * sine[0]},
          {-sine[1], cosine[1] * cosine[0], cosine[1] * sine[0]},
          {V{}, -sine[0], cosine[0]}};
}
// Turns two axes of a frame about the third; (a, b) in cyclic order.
template <class V>
[[gnu::always_inline]] inline void turn_axes(Vec<V>& a, Vec<V>& b, const V& sine,
                                             const V& cosine) noexcept {
  const Vec<V> old = a;
  a = old * cosine + b * sine;
  b = b * cosine - old * sine;
}

// The changes of a joint's angles x, z and y, of Rx Rz Ry, that turn it by a small rotation vector.
// `x` and `y` are the axes before the last turn, `z` is the axis of the second one.
template <class V>
void turns_xzy(const Vec<V>& vector, const Vec<V>& x, const Vec<V>& y, const Vec<V>& z,
               const V& sine_z, const V& cosine_z, V (&turns)[3]) noexcept {
  turns[0] = dot(vector, x) / cosine_z;
  turns[1] = dot(vector, z);
  turns[2] = dot(vector, y) + sine_z * turns[0];
}

// Rx(x) Rz(z) Ry(y) from the sines and cosines of half the angles x, z, y.
template <class V>
Turn<V> turn_of_halves(const V* sine, const V* cosine) noexcept {
  const V w = cosine[0] * cosine[1], i = sine[0] * cosine[1], j = -sine[0] * sine[1],
          k = cosine[0] * sine[1];
  return {w * cosine[2] - j * sine[2], i * cosine[2] - k * sine[2], w * sine[2] + j * cosine[2],
          k * cosine[2] + i * sine[2]};
}

// A leg in a pose: the turns of its joints.
template <class V>
Leg<V> leg_at(const V (&angle_rad)[kLegAngles]) noexcept {
  V sine[kLegAngles], cosine[kLegAngles];
  for (int j = 0; j < kLegAngles; ++j) sin_cos_small(V(0.5f * angle_rad[j]), sine[j], cosine[j]);
  Leg<V> leg;
  leg.hip = turn_of_halves(sine, cosine);
  leg.knee = {cosine[3], sine[3], V{}, V{}};
  leg.ankle = turn_of_halves(sine + 4, cosine + 4);
  return leg;
}

// Takes the joints of another leg.
template <class V>
void pose_leg(const Mask<V>& where, const Leg<V>& other, Leg<V>& leg) noexcept {
  leg.hip = chosen(where, other.hip, leg.hip);
  leg.knee = chosen(where, other.knee, leg.knee);
  leg.ankle = chosen(where, other.ankle, leg.ankle);
}

// The input of a solve, seen from the hip joint in the pelvis' frame. All of its members are
// numbers V, of legs side by side.
template <class V>
struct LegGoal {
  V thigh_m, shank_m;
  Vec<V> ankle_m;
  Turn<V> foot;
  V table_rad[kLegAngles], off_rad[kLegAngles];
};
// The leg starts at table_rad + off_rad; the changes of its angles are added to `off_rad`.
template <class V>
Leg<V> solve_leg(LegGoal<V>& goal) noexcept {
  auto& [thigh_m, shank_m, ankle_m, foot, table_rad, off_rad] = goal;
  V hs[kLegAngles], hc[kLegAngles], s[kLegAngles], c[kLegAngles];
  for (int j = 0; j < kLegAngles; ++j) {
    sin_cos_small(V(0.5f * (table_rad[j] + off_rad[j])), hs[j], hc[j]);
    s[j] = 2.0f * hs[j] * hc[j];
    c[j] = 1.0f - 2.0f * hs[j] * hs[j];
  }
  // Axes at the start: after the hip's first two turns, and on to the foot.
  const Axes<V> start = axes_xz(s, c);
  Vec<V> x = start.x, z = start.z;
  turn_axes(z, x, s[2], c[2]);
  Vec<V> foot_x = x, foot_y = start.y, ankle_z = z;
  turn_axes(foot_y, ankle_z, s[3], c[3]);
  turn_axes(foot_y, ankle_z, s[4], c[4]);
  turn_axes(foot_x, foot_y, s[5], c[5]);
  const Vec<V> ankle_x = foot_x;
  Vec<V> foot_z = ankle_z;
  turn_axes(foot_z, foot_x, s[6], c[6]);

  const V square = most(dot(ankle_m, ankle_m), all<V>(kLeast_m2)),
          bends = (square - (thigh_m * thigh_m + shank_m * shank_m)) / (2.0f * thigh_m * shank_m);
  Leg<V> leg;
  const V knee_c = within(bends, kFoldedCosine, kStraightCosine);
  if (any(knee_c != bends)) {
    const V reach = root(V(thigh_m * (thigh_m + 2.0f * shank_m * knee_c) + shank_m * shank_m)),
            off_m = size(V(root(square) - reach));
    leg.short_m = knee_c != bends ? off_m : V{};
  }
  const V knee_hc = root(V(0.5f + 0.5f * knee_c)), knee_hs = root(V(0.5f - 0.5f * knee_c)),
          knee_s = 2.0f * knee_hc * knee_hs, knee_turns = knee_s * c[3] - knee_c * s[3];
  // The hip's least turn brings the ankle to its place; the ankle makes the rest of the foot's
  // turn.
  const Vec<V> from = start.y * -(thigh_m + shank_m * knee_c) - z * (shank_m * knee_s),
               axis = cross(from, ankle_m);
  const V w = most(V(root(V(dot(from, from) * square)) + dot(from, ankle_m)), all<V>(kLeast_m2));
  const Vec<V> goal_x{1.0f - 2.0f * (foot.y * foot.y + foot.z * foot.z),
                      2.0f * (foot.x * foot.y + foot.w * foot.z),
                      2.0f * (foot.x * foot.z - foot.w * foot.y)},
      goal_y{2.0f * (foot.x * foot.y - foot.w * foot.z),
             1.0f - 2.0f * (foot.x * foot.x + foot.z * foot.z),
             2.0f * (foot.y * foot.z + foot.w * foot.x)},
      goal_z = cross(goal_x, goal_y);
  const Vec<V> of_hip = axis * V(2.0f / w),
               of_foot =
                   (cross(foot_x, goal_x) + cross(foot_y, goal_y) + cross(foot_z, goal_z)) * 0.5f,
               of_ankle = of_foot - of_hip - x * knee_turns,
               line = ankle_m * V(1.0f / root(square));
  V hip[3], ankle[3], hip_swivels[3], ankle_swivels[3];
  turns_xzy(of_hip, start.x, start.y, start.z, s[1], c[1], hip);
  turns_xzy(of_ankle, ankle_x, foot_y, ankle_z, s[5], c[5], ankle);
  turns_xzy(line, start.x, start.y, start.z, s[1], c[1], hip_swivels);
  turns_xzy(line, ankle_x, foot_y, ankle_z, s[5], c[5], ankle_swivels);
  V along{}, squares{};
  for (int i = 0; i < 3; ++i) {
    along = along + (ankle_swivels[i] * ankle[i] - hip_swivels[i] * hip[i]);
    squares = squares + (hip_swivels[i] * hip_swivels[i] + ankle_swivels[i] * ankle_swivels[i]);
  }
  const V swivel_rad = within(V(along / squares), -kMostSwivel_rad, kMostSwivel_rad);
  for (int i = 0; i < 3; ++i) {
    off_rad[i] = off_rad[i] + (hip[i] + swivel_rad * hip_swivels[i]);
    off_rad[4 + i] = off_rad[4 + i] + (ankle[i] - swivel_rad * ankle_swivels[i]);
  }
  off_rad[3] = off_rad[3] + knee_turns;
  // Over a cliff a foot may pass its hip; there the first order is far off and would add up.
  for (int j = 0; j < kLegAngles; ++j) off_rad[j] = within(off_rad[j], -kMostOff_rad, kMostOff_rad);

  const Vec<V> half = line * V(0.5f * swivel_rad), vector = axis + half * w + cross(half, axis);
  leg.hip =
      unit(Turn<V>{V(w - dot(half, axis)), vector.x, vector.y, vector.z} * turn_of_halves(hs, hc));
  leg.knee = {knee_hc, knee_hs, V{}, V{}};
  leg.ankle = back(leg.hip * leg.knee) * foot;
  return leg;
}

// The angles in the tables of leg k, 0 for swing and 1 for stand.
template <class V>
void set_table_angles(const Tables& tables, const Mask<V>& right, const Stride<V>& stride, int k,
                      V (&table_rad)[kLegAngles]) noexcept {
  for (int j = 0; j < kLegAngles; ++j)
    table_rad[j] = stride.leg_rad[k][j] + stand_rad<V>(tables, right, j);
  table_rad[3] = most(table_rad[3], all<V>(kLeastKnee_rad));
}

// Sets the goal of leg k for a foot that is planned; the leg starts `begun_rad` off the tables.
template <class V>
[[gnu::always_inline]] inline void set_goal(const Tables& tables, const Time<V>& time,
                                            const Stride<V>& stride, int k, const Pelvis<V>& pelvis,
                                            const Vec<V>& ankle_m, const Turn<V>& foot,
                                            const V (&begun_rad)[kLegAngles],
                                            LegGoal<V>& goal) noexcept {
  const auto right = is_right(time, k);
  const Turn<V> to_pelvis = back(pelvis.turn);
  goal.thigh_m = of_leg<V>(tables, right, &LegBones::thigh_m);
  goal.shank_m = of_leg<V>(tables, right, &LegBones::shank_m);
  goal.ankle_m = to_pelvis * (ankle_m - pelvis.place_m - pelvis.hip_m[k]);
  goal.foot = to_pelvis * foot;
  set_table_angles(tables, right, stride, k, goal.table_rad);
  std::copy_n(begun_rad, kLegAngles, goal.off_rad);
}
#ifdef GAITPAD_NO_VECTORS
inline void solve_both(LegGoal<float> (&goals)[2], Leg<float> (&legs)[2]) noexcept {
  for (int k : {0, 1}) legs[k] = solve_leg(goals[k]);
}
#else
// Solves both legs of one walk side by side. The register's other half holds them again.
inline void solve_both(LegGoal<float> (&goals)[2], Leg<float> (&legs)[2]) noexcept {
  constexpr int kNumbers = sizeof(LegGoal<float>) / sizeof(float);
  LegGoal<Four> both;
  const float *const a = &goals[0].thigh_m, *const b = &goals[1].thigh_m;
#pragma GCC unroll 32
  for (int n = 0; n < kNumbers; ++n)
    reinterpret_cast<Four*>(&both)[n] = Four{a[n], b[n], a[n], b[n]};
  const Leg<Four> solved = solve_leg(both);
  for (int k : {0, 1}) {
    const auto turn = [&](const Turn<Four>& q) {
      return Turn<float>{q.w[k], q.x[k], q.y[k], q.z[k]};
    };
    legs[k].hip = turn(solved.hip), legs[k].ankle = turn(solved.ankle);
    legs[k].knee = {solved.knee.w[k], solved.knee.x[k], 0.0f, 0.0f};
    legs[k].short_m = solved.short_m[k];
    for (int j = 0; j < kLegAngles; ++j) goals[k].off_rad[j] = both.off_rad[j][k];
  }
}
#endif

// Solves swing and stand. `begun_rad`, unless null: what was added to the tables' angles at the
// start.
template <class V>
void solve_legs(const Tables& tables, const Time<V>& time, const Stride<V>& stride,
                const Feet<V>& feet, const Pelvis<V>& pelvis, State<V>& state, Leg<V> (&legs)[2],
                V (*begun_rad)[kLegAngles]) noexcept {
  // The part added to the tables' angles fades, and a share of its last change goes on. `ahead` is
  // the largest share with which the swivel returns without swinging: a double root.
  const float keep = 1.0f - std::min(1.0f, kLeak_per_s * tables.tick_s),
              square_root = 1.0f - std::sqrt(1.0f - keep), ahead = square_root * square_root;
  LegGoal<V> goals[2];
  for (int k : {0, 1}) {
    for (int j = 0; j < kLegAngles; ++j) {
      const V off = state.leg_rad[k][j];
      state.leg_rad[k][j] = keep * off + ahead * (off - state.last_leg_rad[k][j]);
      state.last_leg_rad[k][j] = off;
    }
    if (begun_rad != nullptr) std::copy_n(state.leg_rad[k], kLegAngles, begun_rad[k]);
    set_goal(tables, time, stride, k, pelvis, feet.ankle_m[k], feet.foot[k].turn, state.leg_rad[k],
             goals[k]);
  }
  if constexpr (kLanes<V> == 1) {
    solve_both(goals, legs);
  } else {
    for (int k : {0, 1}) legs[k] = solve_leg(goals[k]);
  }
  for (int k : {0, 1}) std::copy_n(goals[k].off_rad, kLegAngles, state.leg_rad[k]);
}

}  // namespace
}  // namespace gaitpad
