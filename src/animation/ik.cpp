#include "gaitpad/ik.h"

#include <cassert>
#include <string>

#include "animation/robust_solver.h"
#include "base/ranges.h"

namespace gaitpad {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Turns a frame about its own first axis: (y, z) are the other two, in cyclic order.
void turn(vec3& y, vec3& z, double sine, double cosine) noexcept {
  const vec3 old = y;
  y = cosine * old + sine * z;
  z = cosine * z - sine * old;
}

// --- The chain in one pose -----------------------------------------------------------------------

// Axes of a frame of the chain, in the base frame.
struct Axes {
  vec3 x{1.0, 0.0, 0.0}, y{0.0, 1.0, 0.0}, z{0.0, 0.0, 1.0};
};

// A pose of the chain, with every DOF as an axis in space, and the distance of each row from its
// goal: dX of step 1 of section 3.3.2. A column of the Jacobian is then one cross product per
// point. All in the base frame.
struct IkPose {
  std::array<vec3, kMaxIkDofs> axis;     // axis of each DOF
  std::array<vec3, kMaxIkDofs> pivot_m;  // a point on the axis of each DOF
  Axes last;                             // axes of the last frame
  vec3 end_m;                            // its origin
  std::array<vec3, kMaxIkRows> point_m;  // points of the rows
  std::array<double, kMaxIkRows> error_m;
};

// Turns the frame about a unit axis that is given in the frame itself, by Rodrigues' formula;
// returns the axis in the base frame. For an axis along x, y or z this takes a third of the time.
vec3 turn_about(const vec3& a, const SinCos& s, Axes& f) noexcept {
  vec3 axis;
  if (a.x == 1.0) return axis = f.x, turn(f.y, f.z, s.sin, s.cos), axis;
  if (a.y == 1.0) return axis = f.y, turn(f.z, f.x, s.sin, s.cos), axis;
  if (a.z == 1.0) return axis = f.z, turn(f.x, f.y, s.sin, s.cos), axis;
  axis = a.x * f.x + a.y * f.y + a.z * f.z;
  const double versine = 1.0 - s.cos;
  f.x = s.cos * f.x + s.sin * glm::cross(axis, f.x) + (versine * a.x) * axis;
  f.y = s.cos * f.y + s.sin * glm::cross(axis, f.y) + (versine * a.y) * axis;
  f.z = s.cos * f.z + s.sin * glm::cross(axis, f.z) + (versine * a.z) * axis;
  return axis;
}

void pose_chain(const IkChain& chain, const IkAngles& angles_rad, IkPose& pose) noexcept {
  assert(chain.dofs >= 0 && chain.dofs <= kMaxIkDofs);
  // Compute all sines and cosines first: the axes then stay in registers.
  std::array<SinCos, kMaxIkDofs> angle;
  for (int j = 0; j < chain.dofs; ++j) angle[j] = sin_cos(angles_rad[j]);
  Axes f;
  vec3 end(0.0);
  for (int j = 0; j < chain.dofs; ++j) {
    const IkDof& dof = chain.dof[j];
    pose.pivot_m[j] = end;
    pose.axis[j] = turn_about(dof.axis, angle[j], f);
    const vec3& l = dof.link_m;
    if (l.x != 0.0 || l.y != 0.0 || l.z != 0.0) end += l.x * f.x + l.y * f.y + l.z * f.z;
  }
  pose.last = f;
  pose.end_m = end;
}

void pose_chain(const IkChain& chain, std::span<const IkRow> rows, const IkAngles& angles_rad,
                IkPose& pose) noexcept {
  assert(rows.size() <= kMaxIkRows);
  pose_chain(chain, angles_rad, pose);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const vec3& p = rows[r].point_m;
    pose.point_m[r] = pose.end_m + p.x * pose.last.x + p.y * pose.last.y + p.z * pose.last.z;
    pose.error_m[r] = rows[r].goal_m - glm::dot(rows[r].direction, pose.point_m[r]);
  }
}

// |dX|^2 in one pose.
double squares_of(const IkChain& chain, std::span<const IkRow> rows,
                  const IkAngles& angles_rad) noexcept {
  IkPose pose;
  pose_chain(chain, rows, angles_rad, pose);
  double squares = 0.0;
  for (std::size_t r = 0; r < rows.size(); ++r) squares += pose.error_m[r] * pose.error_m[r];
  return squares;
}

// An entry of the Jacobian: how far DOF j moves the point of row r along the row's direction.
double jacobian_entry(const IkPose& pose, const IkRow& row, std::size_t r, int j) noexcept {
  return glm::dot(row.direction, glm::cross(pose.axis[j], pose.point_m[r] - pose.pivot_m[j]));
}

// True if the arrays have room for the chain and the rows.
bool do_fit(const IkChain& chain, std::span<const IkRow> rows) noexcept {
  return chain.dofs >= 0 && chain.dofs <= kMaxIkDofs && rows.size() <= kMaxIkRows;
}

// A number of the options, and the range in which it has to be.
struct Bounded {
  const char* name;
  double value, least, most;
};
constexpr double kLongest_m = 1e6;  // beyond any skeleton: squares of it are far from infinite
std::array<Bounded, 4> bounded(const PaperOptions& o) noexcept {
  return {{{"PaperOptions: tolerance_m", o.tolerance_m, 0.0, kLongest_m},
           {"PaperOptions: epsilon_m", o.epsilon_m, 0.0, kLongest_m},
           {"PaperOptions: max_iterations", double(o.max_iterations), 0.0, kMostIkIterations},
           {"PaperOptions: max_halvings", double(o.max_halvings), 0.0, kMostIkIterations}}};
}
std::array<Bounded, 5> bounded(const RobustOptions& o) noexcept {
  return {{{"RobustOptions: tolerance_m", o.tolerance_m, 0.0, kLongest_m},
           {"RobustOptions: damping", o.damping, 0.0, kLongest_m},
           {"RobustOptions: max_step_rad", o.max_step_rad, 1e-6, kPi},
           {"RobustOptions: max_iterations", double(o.max_iterations), 0.0, kMostIkIterations},
           {"RobustOptions: max_tries", double(o.max_tries), 1.0, kMostIkIterations}}};
}
// True for options that check() accepts; makes no sentence.
template <class Options>
bool are_sound(const Options& options) noexcept {
  for (const Bounded& b : bounded(options)) {
    if (!(b.value >= b.least && b.value <= b.most)) return false;
  }
  return true;
}

// Checks that angles and weights are finite, and limits in order (they may be infinite). A bad
// link, axis, point or goal shows in the error.
bool are_inputs_finite(const IkChain& chain, const IkAngles& angles_rad) noexcept {
  double zero = 0.0;  // stays 0 unless a number is NaN or infinite, because x - x is NaN then
  bool ordered = true;
  for (int j = 0; j < chain.dofs; ++j) {
    const IkDof& dof = chain.dof[j];
    zero += (angles_rad[j] - angles_rad[j]) + (dof.weight - dof.weight);
    ordered = ordered && dof.min_rad <= dof.max_rad;
  }
  return zero == 0.0 && ordered;
}

// Adds a row to the trace.
void add_trace_row(IkTrace* trace, const IkAngles& angles_rad, double error_m) noexcept {
  if (trace == nullptr) return;
  const auto row = static_cast<std::size_t>(trace->rows);
  if (row >= trace->angles_rad.size() || row >= trace->error_m.size()) return;
  trace->angles_rad[row] = angles_rad;
  trace->error_m[row] = error_m;
  ++trace->rows;
}

// Adds the answer as the trace's last row, unless it is there already.
void end_trace(IkTrace* trace, const IkAngles& angles_rad, double error_m) noexcept {
  if (trace == nullptr || trace->rows == 0) return;
  if (trace->angles_rad[static_cast<std::size_t>(trace->rows - 1)] == angles_rad) return;
  const std::size_t room = std::min(trace->angles_rad.size(), trace->error_m.size());
  if (static_cast<std::size_t>(trace->rows) == room) --trace->rows;
  add_trace_row(trace, angles_rad, error_m);
}

IkResult refused() noexcept { return {.status = IkStatus::not_finite, .error_m = kInfinity}; }

}  // namespace

IkFrame end_frame(const IkChain& chain, const IkAngles& angles_rad) noexcept {
  IkPose pose;
  pose_chain(chain, angles_rad, pose);
  return {pose.end_m, from_axes(pose.last.x, pose.last.y, pose.last.z)};
}

void position_jacobian(const IkChain& chain, std::span<const IkRow> rows,
                       const IkAngles& angles_rad, IkJacobian& jacobian,
                       std::array<double, kMaxIkRows>& error_m) noexcept {
  IkPose pose;
  pose_chain(chain, rows, angles_rad, pose);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    error_m[r] = pose.error_m[r];
    for (int j = 0; j < chain.dofs; ++j) jacobian[r][j] = jacobian_entry(pose, rows[r], r, j);
  }
}

std::array<IkRow, 3> point_goal(const vec3& point_m, const vec3& goal_m) noexcept {
  return {{{point_m, vec3(1.0, 0.0, 0.0), goal_m.x},
           {point_m, vec3(0.0, 1.0, 0.0), goal_m.y},
           {point_m, vec3(0.0, 0.0, 1.0), goal_m.z}}};
}

namespace {

// --- The paper, section 3.3.2, steps 1-7 to the letter -------------------------------------------

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
    if (!(std::abs(a[pivot][i]) > 0.0)) return false;  // written so that NaN counts as no pivot
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
  bool done = false;  // false: there is no inverse or no finite step, and the angles are unchanged
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

}  // namespace

double paper_iteration(const IkChain& chain, std::span<const IkRow> rows,
                       const PaperOptions& options, IkAngles& angles_rad) noexcept {
  if (!do_fit(chain, rows) || !are_sound(options)) return refused().error_m;
  return one_pass(chain, rows, options, angles_rad).error_m;
}

IkResult solve_paper(const IkChain& chain, std::span<const IkRow> rows, const PaperOptions& options,
                     IkAngles& angles_rad, IkTrace* trace) noexcept {
  if (!do_fit(chain, rows) || !are_sound(options) || !are_inputs_finite(chain, angles_rad))
    return refused();
  IkResult result;
  result.error_m = std::sqrt(squares_of(chain, rows, angles_rad));
  if (!std::isfinite(result.error_m)) return refused();
  add_trace_row(trace, angles_rad, result.error_m);
  while (result.error_m > options.tolerance_m) {  // step 7: repeat until the error is small enough
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
    result.error_m = std::sqrt(squares_of(chain, rows, angles_rad));
    add_trace_row(trace, angles_rad, result.error_m);
  }
  return result;
}

namespace {

// --- The robust solver ---------------------------------------------------------------------------

constexpr int kCandidates = 16;  // number of starts that are compared before each further try
constexpr double kLeastDamping_m = 1e-10;  // its square is above the rounding of doubles
// A later try replaces an earlier one only if its error is below this share of the earlier error.
constexpr double kWorthAJump = 0.99;

// The chain and its rows as robust_solver.h reads them.
struct Problem {
  using V = double;
  using Place = IkPose;
  static constexpr int kRows = kMaxIkRows;

  const IkChain& chain;
  std::span<const IkRow> rows;
  int dofs = chain.dofs;
  IkAngles weight{}, min_rad{}, max_rad{};

  Problem(const IkChain& of, std::span<const IkRow> of_rows) noexcept : chain(of), rows(of_rows) {
    for (int j = 0; j < dofs; ++j) {
      const IkDof& dof = chain.dof[j];
      weight[j] = dof.weight, min_rad[j] = dof.min_rad, max_rad[j] = dof.max_rad;
    }
    make_relative(dofs, weight);
  }
  void place(const IkAngles& angles_rad, IkPose& pose) const noexcept {
    pose_chain(chain, rows, angles_rad, pose);
  }
  void set_columns(const IkPose& pose, double (&column)[kMaxIkDofs][kRows]) const noexcept {
    for (int j = 0; j < dofs; ++j) {
      for (std::size_t r = 0; r < kRows; ++r)
        column[j][r] = r < rows.size() ? jacobian_entry(pose, rows[r], r, j) : 0.0;
    }
  }
};

// Start number k: a sequence that fills the box of the limits evenly (Weyl: multiples of an
// irrational number per DOF, here square roots of primes). Without limits: half a turn to both
// sides.
IkAngles spread_start(const Problem& p, const IkAngles& given, int k) noexcept {
  static constexpr std::array<double, kMaxIkDofs> kIrrational = {
      0.41421356237309515, 0.73205080756887719, 0.23606797749978969, 0.64575131106459072,
      0.31662479035539981, 0.60555127546398912, 0.12310562561766059, 0.35889894354067398,
      0.79583152331271907, 0.38516480713450374, 0.56776436283002192, 0.082762530298219357,
      0.40312423743284853, 0.55743852430200066, 0.85565460040104412, 0.28010988928051805};
  IkAngles start = given;
  for (int j = 0; j < p.dofs; ++j) {
    if (p.weight[j] == 0.0) continue;
    const double low = std::max(p.min_rad[j], given[j] - kPi);
    const double high = std::min(p.max_rad[j], given[j] + kPi);
    const double x = 0.5 + k * kIrrational[j];
    start[j] = low + (high - low) * (x - static_cast<int>(x));
  }
  return start;
}

// The start that is nearest to the goal, of kCandidates starts from number `first` on.
IkAngles nearest_start(const Problem& p, const IkAngles& given, int first) noexcept {
  IkAngles nearest = given;
  double least = kInfinity;
  for (int k = first; k < first + kCandidates; ++k) {
    const IkAngles candidate = spread_start(p, given, k);
    const double squares = squares_of(p.chain, p.rows, candidate);
    if (squares < least) least = squares, nearest = candidate;
  }
  return nearest;
}

// True for a goal farther from the base than the stretched chain, where no other start can help.
// Only the leading rows of one point, along directions at right angles, are checked.
bool beyond_reach(const Problem& p) noexcept {
  if (p.rows.empty()) return false;
  double reach = glm::length(p.rows[0].point_m), squares = 0.0;
  for (int j = 0; j < p.dofs; ++j) reach += glm::length(p.chain.dof[j].link_m);
  for (std::size_t r = 0; r < p.rows.size() && p.rows[r].point_m == p.rows[0].point_m; ++r) {
    for (std::size_t s = 0; s < r; ++s) {
      if (std::abs(glm::dot(p.rows[r].direction, p.rows[s].direction)) > 1e-9) return false;
    }
    squares += p.rows[r].goal_m * p.rows[r].goal_m;
    if (squares > reach * reach) return true;
  }
  return false;
}

}  // namespace

IkResult solve_robust(const IkChain& chain, std::span<const IkRow> rows,
                      const RobustOptions& options, IkAngles& angles_rad, IkTrace* trace) noexcept {
  if (!do_fit(chain, rows) || !are_sound(options) || !are_inputs_finite(chain, angles_rad))
    return refused();
  const Problem p(chain, rows);
  RobustOptions left = options;  // what is left of them
  left.damping = std::max(options.damping, kLeastDamping_m);
  const double enough = options.tolerance_m * options.tolerance_m;
  const auto solve = [&](IkAngles& at_rad) {
    return solve_chains(p, left, true, at_rad, [&](const IkAngles& best_rad, double squares) {
      if (trace != nullptr) add_trace_row(trace, best_rad, std::sqrt(squares));
    });
  };
  IkAngles start = angles_rad;
  for (int j = 0; j < p.dofs; ++j) start[j] = std::clamp(start[j], p.min_rad[j], p.max_rad[j]);
  IkAngles answer = start;
  Solved<double> best = solve(answer);
  IkResult result;
  result.iterations = best.steps;
  const int tries = best.squares <= enough || beyond_reach(p) ? 1 : options.max_tries;
  while (!(best.squares <= enough) && result.tries < tries &&
         result.iterations < options.max_iterations) {
    IkAngles other = nearest_start(p, start, (result.tries - 1) * kCandidates);
    left.max_iterations = options.max_iterations - result.iterations - 1;
    const Solved<double> next = solve(other);
    ++result.tries;
    result.iterations += 1 + next.steps;  // the further start counts as one iteration
    if (next.squares <= enough || next.squares < kWorthAJump * best.squares)
      best = next, answer = other;
  }
  result.error_m = std::sqrt(best.squares);
  if (!std::isfinite(result.error_m)) return refused();
  result.status = best.squares <= enough ? IkStatus::converged : IkStatus::unreachable;
  end_trace(trace, answer, result.error_m);
  angles_rad = answer;
  return result;
}

namespace {

std::optional<Error> unit_problem(const std::string& what, const vec3& v) {
  return range_problem(what + ", its length,", std::sqrt(glm::dot(v, v)), 1.0 - 1e-6, 1.0 + 1e-6);
}

template <class Options>
std::optional<Error> options_problem(const Options& options) {
  for (const Bounded& b : bounded(options)) {
    if (auto problem = range_problem(b.name, b.value, b.least, b.most)) return problem;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Error> check(const IkChain& chain) {
  if (auto problem = range_problem("IkChain: dofs", chain.dofs, 1, kMaxIkDofs)) return problem;
  for (int i = 0; i < chain.dofs; ++i) {
    const IkDof& dof = chain.dof[i];
    const std::string what = "IkChain: dof[" + std::to_string(i) + "].";
    if (auto problem = unit_problem(what + "axis", dof.axis)) return problem;
    if (auto problem = vector_problem(what + "link_m", dof.link_m, kLongest_m)) return problem;
    if (auto problem = range_problem(what + "min_rad", dof.min_rad, -kInfinity, kInfinity))
      return problem;
    if (auto problem = range_problem(what + "max_rad", dof.max_rad, dof.min_rad, kInfinity))
      return problem;
    if (auto problem = range_problem(what + "weight", dof.weight, 0.0, 1.0)) return problem;
  }
  return std::nullopt;
}

std::optional<Error> check(std::span<const IkRow> rows) {
  if (auto problem = range_problem("the number of IkRow", double(rows.size()), 1, kMaxIkRows))
    return problem;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string what = "IkRow " + std::to_string(i) + ": ";
    if (auto problem = vector_problem(what + "point_m", rows[i].point_m, kLongest_m))
      return problem;
    if (auto problem = unit_problem(what + "direction", rows[i].direction)) return problem;
    if (auto problem = range_problem(what + "goal_m", rows[i].goal_m, -kLongest_m, kLongest_m))
      return problem;
  }
  return std::nullopt;
}

std::optional<Error> check(const PaperOptions& options) { return options_problem(options); }
std::optional<Error> check(const RobustOptions& options) { return options_problem(options); }

}  // namespace gaitpad
