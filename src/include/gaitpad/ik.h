// Weighted half-Jacobian inverse kinematics: moves points of a chain to goals, positions only.
// Meredith & Maddock 2005, section 3.3.2, steps 1-7 and equations (1)-(5).
//
// A chain is a list of single rotations; each is followed by a fixed link. Its base is at the
// origin of the caller's frame, unturned. A *row* is one line of the position Jacobian: the place
// of a point of the last frame along one direction. Three rows x, y, z of one point are the paper's
// half Jacobian (3 x n). A second point (the toe beside the heel) adds rows; there are no rows for
// orientations.
//
// Everything here but check() is noexcept, uses no heap and no libm trigonometry, and may be called
// in a tick.
#pragma once
#include <array>
#include <optional>
#include <span>

#include "gaitpad/math.h"
#include "gaitpad/result.h"

namespace gaitpad {

inline constexpr int kMaxIkDofs = 16;
inline constexpr int kMaxIkRows = 6;
// Greatest number of iterations that options may set.
inline constexpr int kMostIkIterations = 1'000'000;

// A degree of freedom. The caller fills a chain and its rows. Coordinates are at most 1e6 m.
struct IkDof {
  vec3 axis{1.0, 0.0, 0.0};  // unit axis, in the frame after the DOFs before it
  vec3 link_m{0.0};          // translation that follows this rotation, in the turned frame
  double min_rad = -1e9, max_rad = 1e9;  // limits, min <= max; paper mode ignores them
  double weight = 1.0;                   // W of eq. (5): 0 locked .. 1 free
};
struct IkChain {
  std::array<IkDof, kMaxIkDofs> dof;  // degrees of freedom from the base outwards
  int dofs = 0;                       // number of those that count: 1 .. kMaxIkDofs
};
struct IkRow {
  vec3 point_m{0.0};              // point in the last frame, from its origin
  vec3 direction{1.0, 0.0, 0.0};  // unit direction in the base frame
  double goal_m = 0.0;            // wanted value of dot(direction, point in the base frame)
};
// Errors read `IkChain: dof[2].weight is nan, outside [0, 1]`. For set-up code: both allocate their
// sentence.
std::optional<Error> check(const IkChain& chain);
std::optional<Error> check(std::span<const IkRow> rows);

using IkAngles = std::array<double, kMaxIkDofs>;  // radians, indexed by DOF

enum class IkStatus : unsigned char {
  converged,
  unreachable,  // not within the tolerance; error_m is the error of the returned pose
  singular,     // paper mode: J J^T had no inverse; the last pose before that is returned
  not_finite,   // the angles are unchanged: the input has a NaN, an infinity, a goal too far to
                // square or crossed limits, `dofs` or the rows exceed the arrays, or check()
                // refuses the options
};
struct IkResult {
  IkStatus status = IkStatus::converged;
  int iterations = 0;
  double error_m = 0.0;  // root of the summed squares over all rows; infinite for not_finite
  int halvings = 0;      // paper mode: number of halvings in step 5, summed over all iterations
  int tries = 1;         // robust mode: number of starts that were tried, including the given one
};

// The poses that a solve went through: row k is the pose after k iterations, row 0 the start and
// the last row the answer. Rows beyond the spans' length are dropped.
struct IkTrace {
  std::span<IkAngles> angles_rad;
  std::span<double> error_m;
  int rows = 0;
};

// The paper's steps 1-7, followed literally, with raw weights: theta += W J^T (J J^T)^-1 dX (eq.
// (5)), dX halved in step 5, no limits, no damping. The caps only bound its time. With equal
// weights w an iteration leaves 1 - w of the error, so small weights need many. The caller fills
// the options.
struct PaperOptions {
  double tolerance_m = 1e-4;  // an error of at most this counts as converged, 0 .. 1e6
  double epsilon_m = 1e-6;    // step 5: greatest allowed ||(I - J J^+) dX||, 0 .. 1e6
  int max_iterations = 200;   // greatest number of iterations, 0 .. kMostIkIterations
  // Greatest number of halvings in one iteration's step 5, 0 .. kMostIkIterations.
  int max_halvings = 60;
};
// Errors read `PaperOptions: max_iterations is -1, outside [0, 1e+06]`. For set-up code, as above.
std::optional<Error> check(const PaperOptions& options);
IkResult solve_paper(const IkChain& chain, std::span<const IkRow> rows, const PaperOptions& options,
                     IkAngles& angles_rad, IkTrace* trace = nullptr) noexcept;
// One pass of steps 1-6, for traces and tests. Returns the error before it; if `dofs` or the rows
// exceed the arrays, returns infinity and does nothing.
double paper_iteration(const IkChain& chain, std::span<const IkRow> rows,
                       const PaperOptions& options, IkAngles& angles_rad) noexcept;

// The robust solver: theta += W J^T (J W J^T + l^2 I)^-1 dX. It reaches the same family of poses,
// converges quadratically and does not depend on the weights' scale. l grows with the error (after
// Sugihara 2011), so steps stay small near singular poses and far from the goal. The angles
// returned are always inside their limits, also when the ones given were not: a DOF at its limit is
// frozen (its column leaves the step, which is solved again) until a step points inwards. The best
// pose is kept.
// The caller fills the options.
struct RobustOptions {
  double tolerance_m = 1e-6;  // an error of at most this counts as converged, 0 .. 1e6
  double damping = 1e-5;      // the least l, metres, 0 .. 1e6
  double max_step_rad = 0.3;  // greatest change of a DOF in one iteration, 1e-6 .. pi
  // Greatest number of iterations of all tries together, 0 .. kMostIkIterations; each further start
  // counts as one.
  int max_iterations = 150;
  // Greatest number of starts, 1 .. kMostIkIterations: the given one and, only if it fails, others
  // spread through the limits by a fixed table. With 1 the pose never jumps to another branch, and
  // a goal out of reach takes least time.
  int max_tries = 9;
};
std::optional<Error> check(const RobustOptions& options);
IkResult solve_robust(const IkChain& chain, std::span<const IkRow> rows,
                      const RobustOptions& options, IkAngles& angles_rad,
                      IkTrace* trace = nullptr) noexcept;

// Forward kinematics, eq. (1): origin and rotation of the last frame, in the base frame.
struct IkFrame {
  vec3 position_m{0.0};
  quat rotation = quat(1.0, 0.0, 0.0, 0.0);
};
IkFrame end_frame(const IkChain& chain, const IkAngles& angles_rad) noexcept;
// Rows of eq. (3), analytic: jacobian[r][j] = d(row r) / d(theta j), metres per radian. error_m is
// dX, goal minus place.
using IkJacobian = std::array<std::array<double, kMaxIkDofs>, kMaxIkRows>;
void position_jacobian(const IkChain& chain, std::span<const IkRow> rows,
                       const IkAngles& angles_rad, IkJacobian& jacobian,
                       std::array<double, kMaxIkRows>& error_m) noexcept;

// The three rows that bring `point_m` of the last frame to `goal_m` of the base frame.
std::array<IkRow, 3> point_goal(const vec3& point_m, const vec3& goal_m) noexcept;

}  // namespace gaitpad
