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
  // Three points in the foot's frame: the foot's end-effector, its other end and a point beside the
  // end-effector.
  std::array<Vec3Of<V>, 3> point_m;
  // Axes of the foot in the pelvis' frame: sideways, across, along. The rows are side, across and
  // along of the first point, side and across of the second, across of the third.
  Vec3Of<V> side, across, along;
  std::array<V, 6> goal_m;
};

// A leg whose foot is planned as a whole: the goal of its ankle, counted from the hip joint in the
// pelvis' frame, and the foot's axes.
template <class V>
struct PlannedLeg {
  V thigh_m, shank_m;
  std::array<V, kLegDofs> min_rad, max_rad;
  Vec3Of<V> ankle_m, foot_x, foot_y, foot_z;
};

template <class V>
struct LegSolution {
  V squares;                // squared error, summed over the rows, square metres
  V iterations;             // number of iterations, a whole number
  Vec3Of<V> heel_m, toe_m;  // the first two points, from the hip joint in the pelvis' frame
};

// The weights of equation (5) decide how a leg uses the freedom that the planted point of its sole
// leaves. With them, the weights in LegGoals are W; the first point is met exactly; the second and
// third, `lever_m` from it along the foot and across it, give way.
template <class V>
struct LegShares {
  V uneven;                               // 1: the weights differ; 0: this leg is not changed
  std::array<V, kLegDofs> reference_rad;  // pose towards which the joints are pulled
  V on_heel;                              // place of the first point on the sole: 0 toe .. 1 heel
  V lever_m;
  std::array<V, 3> give_m2;      // how far yaw, pitch and roll of the foot give way
  V room_down_rad, room_up_rad;  // angles by which the foot may pitch away from its goal
  V knee_rad, knee_soft_rad;     // a knee that is straighter than this angle is bent
};

// One leg: its goals and the solver's start, then the best pose and its error. Angles and weights
// have to be finite.
struct LegToSolve {
  LegGoals<double> goals;
  LegShares<double> shares;  // shares for legs whose weights differ
  LegAngles angles_rad;
  LegSolution<double> solution;
};

// One leg, and whether its goal was reached: 1 or 0. If it was not, the angles are unchanged.
struct LegToClose {
  PlannedLeg<double> planned;
  LegAngles angles_rad;
  double reached = 0.0;
};
template <int kRegister>
void close_legs(std::array<LegToClose, 2>& legs) noexcept;

// Solves legs side by side. kWidth: kLeastLanes, 2, 4 or 8. kWeighted: the legs' `shares` are used.
// kRegister: the width of the registers for which it is compiled; wider ones bring instructions
// with three operands, with which two legs take a seventh less time.
template <int kWidth, bool kWeighted, int kRegister = kWidth>
void solve_legs(const std::array<LegToSolve*, kWidth>& legs) noexcept;

// Closes the two legs of one character, for the widest registers in use.
inline void close_two_legs(std::array<LegToClose, 2>& legs) noexcept {
  with_width(lanes_in_use(), [&](auto width) { close_legs<width>(legs); });
}
template <bool kWeighted>
inline void solve_two_legs(std::array<LegToSolve, 2>& legs) noexcept {
  with_width(lanes_in_use(), [&](auto width) {
    if constexpr (width == 1) {
      for (LegToSolve& leg : legs) solve_legs<1, kWeighted>({&leg});
    } else {
      solve_legs<2, kWeighted, width>({&legs[0], &legs[1]});
    }
  });
}

}  // namespace gaitpad
