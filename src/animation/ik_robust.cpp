// theta += W J^T (J W J^T + l^2 I)^-1 dX inside joint limits.
#include <cassert>
#include <limits>

#include "animation/ik.h"
#include "animation/ik_step.h"

namespace gaitpad {
namespace {

// l^2 = damping^2 + growth |dX|^2 (after Sugihara 2011, "Solvability-unconcerned inverse kinematics
// by the Levenberg-Marquardt method"); growth rises where a step makes the error greater.
constexpr double kLeastDampingSquared = 1e-20;
constexpr double kGrowth = 0.1;
constexpr double kGrowthUp = 8.0, kGrowthDown = 0.25;
constexpr double kFarthest = 0.5;     // metres of dX that one step asks for at most
constexpr int kPatience = 6;          // iterations that must gain, together,
constexpr double kLeastGain = 0.001;  // this share of the error
constexpr double kGainFrom = 0.1;     // or, if it is greater, of this many metres
constexpr int kCandidates = 16;       // starts looked at before each further try
constexpr double kWorthAJump = 0.99;  // a later try replaces an earlier one only below this share

// All that stays the same during a solve.
struct Problem {
  const IkChain& chain;
  std::span<const IkRow> rows;
  const RobustOptions& options;
  IkDofValues weight;  // divided by the greatest
};

IkDofValues relative_weights(const IkChain& chain) noexcept {
  IkDofValues w{};
  double greatest = 0.0;
  for (int j = 0; j < chain.dofs; ++j) greatest = std::max(greatest, chain.dof[j].weight);
  if (greatest <= 0.0) return w;
  for (int j = 0; j < chain.dofs; ++j) w[j] = std::max(chain.dof[j].weight, 0.0) / greatest;
  return w;
}

double inside(const IkDof& dof, double angle_rad) noexcept {
  return std::min(std::max(angle_rad, dof.min_rad), dof.max_rad);
}

// The step within the limits. A DOF that the step would carry past a limit moves exactly to it, its
// column leaves the system, and the others make up for what it cannot do. All of this depends
// continuously on goal and pose.
template <int kRows>
void limited_step(const Problem& p, IkStep<kRows>& step, double damping_squared,
                  typename IkStep<kRows>::Rows& dx, const IkAngles& angles_rad,
                  IkDofValues& delta) noexcept {
  const int dofs = p.chain.dofs;
  IkDofValues weight = p.weight;
  typename IkStep<kRows>::Rows y;
  for (int j = 0; j < dofs; ++j) delta[j] = 0.0;
  for (int round = 0; round <= dofs; ++round) {
    step.factor(weight, dofs, damping_squared);
    step.solve(dx, y);
    bool frozen = false;
    for (int j = 0; j < dofs; ++j) {
      if (weight[j] == 0.0) continue;
      delta[j] = weight[j] * step.product(j, y);
      const double wanted = angles_rad[j] + delta[j], allowed = inside(p.chain.dof[j], wanted);
      if (allowed == wanted) continue;
      delta[j] = allowed - angles_rad[j];
      weight[j] = 0.0;
      frozen = true;
      step.subtract(j, delta[j], dx);
    }
    if (!frozen) return;
  }
}

double cap_share(const IkDofValues& delta, int dofs, double cap_rad) noexcept {
  double greatest = 0.0;
  for (int j = 0; j < dofs; ++j) greatest = std::max(greatest, std::abs(delta[j]));
  return greatest > cap_rad ? cap_rad / greatest : 1.0;
}

template <int kRows>
void advance(const Problem& p, const IkPose& pose, const IkErrors& errors, double growth,
             IkAngles& angles_rad) noexcept {
  IkStep<kRows> step;
  step.set_columns(pose, p.rows, errors, p.chain.dofs);
  const double most = kFarthest * kFarthest;
  const double share = errors.squares > most ? kFarthest / std::sqrt(errors.squares) : 1.0;
  typename IkStep<kRows>::Rows dx{};
  for (std::size_t r = 0; r < p.rows.size(); ++r) dx[r] = share * errors.dx[r];
  const double damping_squared =
      std::max(p.options.damping * p.options.damping, kLeastDampingSquared) +
      growth * std::min(errors.squares, most);
  IkDofValues delta;
  limited_step(p, step, damping_squared, dx, angles_rad, delta);
  const double cap = cap_share(delta, p.chain.dofs, p.options.max_step_rad);
  for (int j = 0; j < p.chain.dofs; ++j) {
    angles_rad[j] = inside(p.chain.dof[j], angles_rad[j] + cap * delta[j]);
  }
}

struct Try {
  IkAngles angles_rad;  // the best met
  double squares = std::numeric_limits<double>::infinity();
  int iterations = 0;
};

// True when `squares` is a stand-still: too little gained in the last iterations.
struct Progress {
  double error_m = std::numeric_limits<double>::infinity();
  int iteration = 0;

  bool stands_still(double squares, int k) noexcept {
    const double now = std::sqrt(squares);
    if (now < error_m - kLeastGain * std::min(now, kGainFrom)) error_m = now, iteration = k;
    return k - iteration >= kPatience;
  }
};

// From `start` until the tolerance, a stand-still or the last iteration allowed.
template <int kRows>
Try one_try(const Problem& p, const IkAngles& start, int max_iterations, IkTrace* trace) noexcept {
  Try best;
  IkAngles angles_rad = best.angles_rad = start;
  std::array<IkPose, 2> pose;
  std::array<IkErrors, 2> errors;
  int best_at = 0;
  Progress progress;
  double growth = kGrowth;
  const double enough = p.options.tolerance_m * p.options.tolerance_m;
  for (int k = 0;; ++k) {
    const int at = 1 - best_at;
    pose_chain(p.chain, angles_rad, pose[at]);
    measure(pose[at], p.rows, errors[at]);
    if (errors[at].squares < best.squares) {
      best.squares = errors[at].squares, best.angles_rad = angles_rad, best_at = at;
      growth = std::max(growth * kGrowthDown, kGrowth);
    } else {
      growth *= kGrowthUp;
    }
    best.iterations = k;
    if (trace != nullptr) note(trace, best.angles_rad, std::sqrt(best.squares));
    if (best.squares <= enough || k >= max_iterations) break;
    if (!std::isfinite(best.squares) || progress.stands_still(best.squares, k)) break;
    angles_rad = best.angles_rad;
    advance<kRows>(p, pose[best_at], errors[best_at], growth, angles_rad);
  }
  return best;
}

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
  for (int j = 0; j < p.chain.dofs; ++j) {
    if (p.weight[j] == 0.0) continue;
    const double low = std::max(p.chain.dof[j].min_rad, given[j] - kPi);
    const double high = std::min(p.chain.dof[j].max_rad, given[j] + kPi);
    const double x = 0.5 + k * kIrrational[j];
    start[j] = low + (high - low) * (x - static_cast<int>(x));
  }
  return start;
}

// Of the kCandidates starts from number `first` on the one that is nearest to the goal.
IkAngles nearest_start(const Problem& p, const IkAngles& given, int first) noexcept {
  IkAngles nearest = given;
  double least = std::numeric_limits<double>::infinity();
  for (int k = first; k < first + kCandidates; ++k) {
    const IkAngles candidate = spread_start(p, given, k);
    IkPose pose;
    IkErrors errors;
    pose_chain(p.chain, candidate, pose);
    measure(pose, p.rows, errors);
    if (errors.squares < least) least = errors.squares, nearest = candidate;
  }
  return nearest;
}

// True for a goal farther from the base than the stretched chain: no other start can help. Looks at
// the leading rows of one point along directions at right angles.
bool beyond_reach(const Problem& p) noexcept {
  if (p.rows.empty()) return false;
  double reach = glm::length(p.rows[0].point_m), squares = 0.0;
  for (int j = 0; j < p.chain.dofs; ++j) reach += glm::length(p.chain.dof[j].link_m);
  for (std::size_t r = 0; r < p.rows.size() && p.rows[r].point_m == p.rows[0].point_m; ++r) {
    for (std::size_t s = 0; s < r; ++s) {
      if (std::abs(glm::dot(p.rows[r].direction, p.rows[s].direction)) > 1e-9) return false;
    }
    squares += p.rows[r].goal_m * p.rows[r].goal_m;
    if (squares > reach * reach) return true;
  }
  return false;
}

template <int kRows>
IkResult best_of_tries(const Problem& p, const IkAngles& start, IkAngles& angles_rad,
                       IkTrace* trace) noexcept {
  const double enough = p.options.tolerance_m * p.options.tolerance_m;
  Try best = one_try<kRows>(p, start, p.options.max_iterations, trace);
  IkResult result;
  result.iterations = best.iterations;
  const int tries = best.squares <= enough || beyond_reach(p) ? 1 : p.options.max_tries;
  while (!(best.squares <= enough) && result.tries < tries &&
         result.iterations < p.options.max_iterations) {
    const IkAngles other = nearest_start(p, start, (result.tries - 1) * kCandidates);
    const int left = p.options.max_iterations - result.iterations - 1;
    const Try next = one_try<kRows>(p, other, left, trace);
    ++result.tries;
    result.iterations += 1 + next.iterations;  // the jump counts
    if (next.squares <= enough || next.squares < kWorthAJump * best.squares) best = next;
  }
  angles_rad = best.angles_rad;
  result.error_m = std::sqrt(best.squares);
  result.status = best.squares <= enough ? IkStatus::converged : IkStatus::unreachable;
  note_answer(trace, angles_rad, result.error_m);
  return result;
}

IkResult refused() noexcept {
  IkResult result;
  result.status = IkStatus::not_finite;
  result.error_m = std::numeric_limits<double>::infinity();
  return result;
}

}  // namespace

IkResult solve_robust(const IkChain& chain, std::span<const IkRow> rows,
                      const RobustOptions& options, IkAngles& angles_rad, IkTrace* trace) noexcept {
  assert(rows.size() <= kMaxIkRows);
  if (!finite_inputs(chain, angles_rad)) return refused();
  const Problem p{chain, rows, options, relative_weights(chain)};
  IkAngles start = angles_rad;
  for (int j = 0; j < chain.dofs; ++j) start[j] = inside(chain.dof[j], start[j]);
  IkAngles answer = start;
  const IkResult result = rows.size() <= 4 ? best_of_tries<4>(p, start, answer, trace)
                                           : best_of_tries<6>(p, start, answer, trace);
  if (!std::isfinite(result.error_m)) return refused();
  angles_rad = answer;
  return result;
}

}  // namespace gaitpad
