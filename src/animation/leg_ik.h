// The robust solver of gaitpad/ik.h for legs, whose sizes are known when compiling: seven single
// rotations (hip x z y, knee x, ankle x z y) and the six rows that hold a foot. Several legs are
// solved side by side, one a lane: the two of a character, or those of a crowd. Every lane gets the
// bits that solve_robust() gives with max_tries = 1, whatever the others do.
#pragma once
#include "base/lanes.h"
#include "gaitpad/ik.h"
#include "gaitpad/limbs.h"

namespace gaitpad {

template <class V>
struct LegGoals {
  V thigh_m, shank_m;
  std::array<V, kLegDofs> weight, min_rad, max_rad;
  // The foot's end-effector, its other end and a point beside the end-effector, in the foot.
  std::array<Vec3Of<V>, 3> point_m;
  // The foot's axes in the pelvis' frame: sideways, across, along. Rows: side, across and along of
  // the first point, side and across of the second, across of the third.
  Vec3Of<V> side, across, along;
  std::array<V, 6> goal_m;
};

template <class V>
struct LegSolution {
  V squares;                // of the error, square metres, summed over the rows
  V iterations;             // a whole number
  Vec3Of<V> heel_m, toe_m;  // the first two points, in the pelvis' frame from the hip joint
};

// The weights of equation (5), as one step of a solve takes them: they share out what the planted
// point of the sole leaves free. `of` LegGoals, the first point is the one that is met exactly; the
// second and third are `lever_m` from it along the foot and across it, and give way.
template <class V>
struct LegShares {
  V uneven;                                       // 1, or 0: this leg is left as it is
  std::array<V, kLegDofs> weight, reference_rad;  // W of the leg, and the pose that it pulls to
  V on_heel;                                      // where the first point is: 0 toe .. 1 heel
  V lever_m;
  std::array<V, 3> give_m2;      // how far yaw, pitch and roll of the foot give way
  V room_down_rad, room_up_rad;  // how far the foot may pitch away from its goal
  V knee_rad, knee_soft_rad;     // a knee that is straighter than this is bent
};

// One number of each of several legs, in memory.
template <int kWidth>
struct alignas(8 * kWidth) Row {
  std::array<double, kWidth> lane;
  double& operator[](std::size_t i) noexcept { return lane[i]; }
  double operator[](std::size_t i) const noexcept { return lane[i]; }
};

template <int kWidth>
struct LegLanes {
  LegGoals<Row<kWidth>> goals;
  std::array<Row<kWidth>, kLegDofs> angles_rad;
  LegSolution<Row<kWidth>> solution;
};

// Starts at `angles_rad` and leaves the best pose there. Angles and weights have to be finite.
// kWidth: 2, 4 or 8. kRegister: the width of the registers that it is compiled for; wider ones
// bring instructions with three operands, by which two legs take a seventh less time.
template <int kWidth, int kRegister = kWidth>
void solve_legs(const RobustOptions& options, LegLanes<kWidth>& legs) noexcept;

// The pose that the weights make of solved legs. Starts at `angles_rad`; LegSolution has the first
// two points, and the error of the first one.
template <int kWidth>
struct SharedLegs : LegLanes<kWidth> {
  LegShares<Row<kWidth>> shares;
};
template <int kWidth, int kRegister = kWidth>
void share_legs(SharedLegs<kWidth>& legs) noexcept;

// The two of one character, for the widest registers in use.
inline void share_two_legs(SharedLegs<2>& legs) noexcept {
  const int lanes = lanes_in_use();
  const auto share = lanes >= 8 ? share_legs<2, 8> : lanes >= 4 ? share_legs<2, 4> : share_legs<2>;
  share(legs);
}
inline void solve_two_legs(const RobustOptions& options, LegLanes<2>& legs) noexcept {
  const int lanes = lanes_in_use();
  const auto solve = lanes >= 8 ? solve_legs<2, 8> : lanes >= 4 ? solve_legs<2, 4> : solve_legs<2>;
  solve(options, legs);
}

}  // namespace gaitpad
