// Meredith & Maddock 2005, section 3.3.2, steps 1-7, literally.
#include <cassert>
#include <limits>

#include "animation/ik.h"
#include "animation/ik_pose.h"

namespace gaitpad {
namespace {

using Rows = std::array<double, kMaxIkRows>;
using Square = std::array<Rows, kMaxIkRows>;

// Explicit inverse by Gauss-Jordan elimination with row exchange; false if there is none.
bool invert(Square& a, int n) noexcept {
  Square inverse{};
  for (int i = 0; i < n; ++i) inverse[i][i] = 1.0;
  for (int i = 0; i < n; ++i) {
    int pivot = i;
    for (int k = i + 1; k < n; ++k) {
      if (std::abs(a[k][i]) > std::abs(a[pivot][i])) pivot = k;
    }
    if (!(std::abs(a[pivot][i]) > 0.0)) return false;  // also for NaN
    std::swap(a[i], a[pivot]);
    std::swap(inverse[i], inverse[pivot]);
    const double reciprocal = 1.0 / a[i][i];
    for (int k = 0; k < n; ++k) a[i][k] *= reciprocal, inverse[i][k] *= reciprocal;
    for (int row = 0; row < n; ++row) {
      if (row == i) continue;
      const double factor = a[row][i];
      for (int k = 0; k < n; ++k) {
        a[row][k] -= factor * a[i][k];
        inverse[row][k] -= factor * inverse[i][k];
      }
    }
  }
  a = inverse;
  return true;
}

struct Equations {
  int rows, dofs;
  IkJacobian j;                                              // J
  std::array<std::array<double, kMaxIkRows>, kMaxIkDofs> p;  // J^+
  Square left_over;                                          // I - J J^+
  Rows dx;
};

// Steps 1-3: dX, J and its pseudo-inverse J^+ = J^T (J J^T)^-1. False if J J^T has no inverse.
bool form_equations(const IkChain& chain, std::span<const IkRow> rows, const IkAngles& angles_rad,
                    Equations& e) noexcept {
  e.rows = static_cast<int>(rows.size()), e.dofs = chain.dofs;
  position_jacobian(chain, rows, angles_rad, e.j, e.dx);
  Square gram{};
  for (int r = 0; r < e.rows; ++r) {
    for (int s = 0; s < e.rows; ++s) {
      for (int k = 0; k < e.dofs; ++k) gram[r][s] += e.j[r][k] * e.j[s][k];
    }
  }
  if (!invert(gram, e.rows)) return false;
  for (int k = 0; k < e.dofs; ++k) {
    for (int s = 0; s < e.rows; ++s) {
      e.p[k][s] = 0.0;
      for (int r = 0; r < e.rows; ++r) e.p[k][s] += e.j[r][k] * gram[r][s];
    }
  }
  for (int r = 0; r < e.rows; ++r) {
    for (int s = 0; s < e.rows; ++s) {
      double product = 0.0;
      for (int k = 0; k < e.dofs; ++k) product += e.j[r][k] * e.p[k][s];
      e.left_over[r][s] = (r == s ? 1.0 : 0.0) - product;
    }
  }
  return true;
}

double norm(const Rows& v, int n) noexcept {
  double squares = 0.0;
  for (int r = 0; r < n; ++r) squares += v[r] * v[r];
  return std::sqrt(squares);
}

// Step 4: ||(I - J J^+) dX||.
double inverse_error(const Equations& e) noexcept {
  Rows v{};
  for (int r = 0; r < e.rows; ++r) {
    for (int s = 0; s < e.rows; ++s) v[r] += e.left_over[r][s] * e.dx[s];
  }
  return norm(v, e.rows);
}

struct Pass {
  bool done = false;  // false: no inverse or no finite step; the angles are as before
  double error_m = 0.0;
  int halvings = 0;
};

// Steps 1-6, with eq. (5) in step 6.
Pass one_pass(const IkChain& chain, std::span<const IkRow> rows, const PaperOptions& options,
              IkAngles& angles_rad) noexcept {
  Equations e;
  Pass pass;
  const bool inverted = form_equations(chain, rows, angles_rad, e);
  pass.error_m = norm(e.dx, e.rows);
  if (!inverted) return pass;
  while (inverse_error(e) > options.epsilon_m && pass.halvings < options.max_halvings) {
    for (int r = 0; r < e.rows; ++r) e.dx[r] /= 2.0;
    ++pass.halvings;
  }
  IkAngles next = angles_rad;
  double zero = 0.0;
  for (int k = 0; k < e.dofs; ++k) {
    double step = 0.0;
    for (int r = 0; r < e.rows; ++r) step += e.p[k][r] * e.dx[r];
    next[k] += chain.dof[k].weight * step;
    zero += next[k] - next[k];
  }
  if (zero != 0.0) return pass;
  angles_rad = next;
  pass.done = true;
  return pass;
}

double pose_error(const IkChain& chain, std::span<const IkRow> rows,
                  const IkAngles& angles_rad) noexcept {
  IkPose pose;
  IkErrors errors;
  pose_chain(chain, angles_rad, pose);
  measure(pose, rows, errors);
  return std::sqrt(errors.squares);
}

}  // namespace

double paper_iteration(const IkChain& chain, std::span<const IkRow> rows,
                       const PaperOptions& options, IkAngles& angles_rad) noexcept {
  return one_pass(chain, rows, options, angles_rad).error_m;
}

IkResult solve_paper(const IkChain& chain, std::span<const IkRow> rows, const PaperOptions& options,
                     IkAngles& angles_rad, IkTrace* trace) noexcept {
  IkResult result;
  result.error_m = pose_error(chain, rows, angles_rad);
  if (!finite_inputs(chain, angles_rad) || !std::isfinite(result.error_m)) {
    result.status = IkStatus::not_finite;
    result.error_m = std::numeric_limits<double>::infinity();
    return result;
  }
  note(trace, angles_rad, result.error_m);
  while (result.error_m > options.tolerance_m) {  // step 7
    if (result.iterations >= options.max_iterations) {
      result.status = IkStatus::unreachable;
      break;
    }
    const Pass pass = one_pass(chain, rows, options, angles_rad);
    result.halvings += pass.halvings;
    if (!pass.done) {
      result.status = IkStatus::singular;
      break;
    }
    ++result.iterations;
    result.error_m = pose_error(chain, rows, angles_rad);
    note(trace, angles_rad, result.error_m);
  }
  return result;
}

}  // namespace gaitpad
