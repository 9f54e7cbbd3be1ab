// Weighted half-Jacobian inverse kinematics: moves points of a chain to goals, positions only.
// Meredith & Maddock 2005, section 3.3.2, steps 1-7 and equations (1)-(5).
//
// A chain is a list of single rotations; each is followed by a fixed link. Its base is at the
// origin of the caller's frame, unturned. A *row* is one line of the position Jacobian: the
// distance of a point of the last frame along one direction. Three rows x, y, z of one point are
// the paper's half Jacobian (3 x n); a second point (toe beside heel) adds rows, never
// orientations.
#pragma once
#include <array>
#include <span>

#include "gaitpad/math.h"

namespace gaitpad {

inline constexpr int kMaxIkDofs = 16;
inline constexpr int kMaxIkRows = 6;

struct IkDof {
  vec3 axis{1.0, 0.0, 0.0};  // unit, in the frame that the DOFs before it leave
  vec3 link_m{0.0};          // translation that follows this rotation, in the turned frame
  double min_rad = -1e9, max_rad = 1e9;  // robust mode only
  double weight = 1.0;                   // W of eq. (5): 0 locked .. 1 free
};
struct IkChain {
  std::array<IkDof, kMaxIkDofs> dof;
  int dofs = 0;
};
struct IkRow {
  vec3 point_m{0.0};              // in the last frame, from the chain's end
  vec3 direction{1.0, 0.0, 0.0};  // unit, base frame
  double goal_m = 0.0;            // wanted value of dot(direction, point in the base frame)
};
using IkAngles = std::array<double, kMaxIkDofs>;

enum class IkStatus : unsigned char {
  converged,
  unreachable,  // not within the tolerance: error_m says how far off the returned pose is
  singular,     // paper mode: J J^T had no inverse; the last pose before it is returned
  not_finite,   // a NaN, an infinity, a goal too far to square or crossed limits came in: the
                // angles are untouched
};
struct IkResult {
  IkStatus status = IkStatus::converged;
  int iterations = 0;
  double error_m = 0.0;  // root of the summed squares over all rows; infinite for not_finite
  int halvings = 0;      // paper mode: of step 5, over all iterations
  int tries = 1;         // robust mode: starts used, the given one included
};

// The poses that a solve went through: row k is the pose after k iterations, row 0 the start and
// the last row the answer. Rows beyond the spans' length are dropped.
struct IkTrace {
  std::span<IkAngles> angles_rad;
  std::span<double> error_m;
  int rows = 0;
};

// Steps 1-7 to the letter with raw weights: theta += W J^T (J J^T)^-1 dX; halving of dX in step 5;
// no limits, no damping. Hard caps only against hanging.
struct PaperOptions {
  double tolerance_m = 1e-4;
  double epsilon_m = 1e-6;  // step 5
  int max_iterations = 200;
  int max_halvings = 60;
};
IkResult solve_paper(const IkChain& chain, std::span<const IkRow> rows, const PaperOptions& options,
                     IkAngles& angles_rad, IkTrace* trace = nullptr) noexcept;
// One pass of steps 1-6 (for traces and tests): the error before it.
double paper_iteration(const IkChain& chain, std::span<const IkRow> rows,
                       const PaperOptions& options, IkAngles& angles_rad) noexcept;

// theta += W J^T (J W J^T + l^2 I)^-1 dX: the same family of poses, quadratic convergence and no
// dependence on the weights' scale. l grows with the error, so steps stay small near singular poses
// and far from the goal, and die out in neither. Angles out are always inside their limits, also
// when the ones given were not; a DOF at its limit is frozen (its column leaves the step, which is
// solved again) until a step points inwards. The best pose is kept.
struct RobustOptions {
  double tolerance_m = 1e-6;
  double damping = 1e-5;      // the least l, metres
  double max_step_rad = 0.3;  // per DOF and iteration
  int max_iterations = 150;   // of all tries together; a further start counts as one
  // Starts: the given one and, only if it fails, others spread through the limits by a fixed table.
  // 1: never jumps to another branch and costs least when a goal is out of reach.
  int max_tries = 9;
};
IkResult solve_robust(const IkChain& chain, std::span<const IkRow> rows,
                      const RobustOptions& options, IkAngles& angles_rad,
                      IkTrace* trace = nullptr) noexcept;

// Eq. (1): origin and rotation of the last frame.
struct IkFrame {
  vec3 position_m{0.0};
  quat rotation = quat(1.0, 0.0, 0.0, 0.0);
};
IkFrame end_frame(const IkChain& chain, const IkAngles& angles_rad) noexcept;
// Rows of eq. (3): jacobian[r][j] = d(row r) / d(theta j), analytic. Returns the errors dX too.
using IkJacobian = std::array<std::array<double, kMaxIkDofs>, kMaxIkRows>;
void position_jacobian(const IkChain& chain, std::span<const IkRow> rows,
                       const IkAngles& angles_rad, IkJacobian& jacobian,
                       std::array<double, kMaxIkRows>& error_m) noexcept;

// The three rows that carry `point_m` of the last frame to `goal_m`.
std::array<IkRow, 3> point_goal(const vec3& point_m, const vec3& goal_m) noexcept;

}  // namespace gaitpad
