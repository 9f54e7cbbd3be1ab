// Inverse kinematics of legs. A leg whose foot is planned as a whole has one degree of freedom
// left, the knee's swivel; a closed form gives the rest. If the closed form fails, the robust
// solver of gaitpad/ik.h runs, with the sizes of a leg known when compiling: seven single rotations
// (hip x z y, knee x, ankle x z y) and the six rows that hold a foot. Several legs are solved side
// by side, one a lane: the two of a character, or those of a crowd. Every lane gets the bits that
// solve_robust() gives with max_tries = 1, whatever the others do.
#pragma once
#include "base/lanes.h"
#include "gaitpad/ik.h"
#include "gaitpad/limbs.h"

namespace gaitpad {

inline constexpr RobustOptions kRobust = {.tolerance_m = 1e-6, .max_tries = 1};

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

// A leg whose foot is planned as a whole: the goal of its ankle, in the pelvis' frame from the hip
// joint, and the foot's axes.
template <class V>
struct PlannedLeg {
  V thigh_m, shank_m;
  std::array<V, kLegDofs> min_rad, max_rad;
  Vec3Of<V> ankle_m, foot_x, foot_y, foot_z;
};

template <class V>
struct LegSolution {
  V squares;                // of the error, square metres, summed over the rows
  V iterations;             // a whole number
  Vec3Of<V> heel_m, toe_m;  // the first two points, in the pelvis' frame from the hip joint
};

// The weights of equation (5): they decide how a leg uses the freedom that the planted point of its
// sole leaves. In LegGoals, the weights are then W; the first point is met exactly; the second and
// third, `lever_m` from it along the foot and across it, give way.
template <class V>
struct LegShares {
  V uneven;                               // 1, or 0: this leg is left as it is
  std::array<V, kLegDofs> reference_rad;  // the pose that it pulls to
  V on_heel;                              // where the first point is: 0 toe .. 1 heel
  V lever_m;
  std::array<V, 3> give_m2;      // how far yaw, pitch and roll of the foot give way
  V room_down_rad, room_up_rad;  // how far the foot may pitch away from its goal
  V knee_rad, knee_soft_rad;     // a knee that is straighter than this is bent
};

// One leg: its goals and the solver's start, then the best pose and its error. Angles and weights
// have to be finite.
struct LegToSolve {
  LegGoals<double> goals;
  LegShares<double> shares;  // where weights differ
  LegAngles angles_rad;
  LegSolution<double> solution;
};

// One leg, and whether its goal was reached: 1 or 0. If not, the angles are unchanged.
struct LegToClose {
  PlannedLeg<double> planned;
  LegAngles angles_rad;
  double reached = 0.0;
};
template <int kRegister>
void close_legs(std::array<LegToClose, 2>& legs) noexcept;

// kWidth: 2, 4 or 8. kWeighted: the legs' `shares` are looked at. kRegister: the width of the
// registers that it is compiled for; wider ones bring instructions with three operands, by which
// two legs take a seventh less time.
template <int kWidth, bool kWeighted, int kRegister = kWidth>
void solve_legs(const std::array<LegToSolve*, kWidth>& legs) noexcept;

// The two of one character, for the widest registers in use.
inline void close_two_legs(std::array<LegToClose, 2>& legs) noexcept {
  const int lanes = lanes_in_use();
  const auto close = lanes >= 8 ? close_legs<8> : lanes >= 4 ? close_legs<4> : close_legs<2>;
  close(legs);
}
template <bool kWeighted>
inline void solve_two_legs(std::array<LegToSolve, 2>& legs) noexcept {
  const int lanes = lanes_in_use();
  const auto solve = lanes >= 8   ? solve_legs<2, kWeighted, 8>
                     : lanes >= 4 ? solve_legs<2, kWeighted, 4>
                                  : solve_legs<2, kWeighted>;
  solve({&legs[0], &legs[1]});
}

}  // namespace gaitpad
