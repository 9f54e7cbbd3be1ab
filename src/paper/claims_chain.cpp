// Assertions 9-12: the solver itself, and figure 4.
#include <fmt/format.h>

#include <algorithm>

#include "paper/chain4.h"
#include "paper/claims.h"

namespace gaitpad {
namespace {

constexpr int kTasks = 1000;  // random near goals
constexpr const char* kSection = "3.3.2";
using Weights = std::array<double, kChainLinks>;

constexpr Weights kEven = {1.0, 1.0, 1.0, 1.0}, kStiffRoot = {0.2, 1.0, 1.0, 1.0};

double change(const ChainSolve& s, int joint) {
  return std::fabs(s.answer()[joint] - s.angles_rad.front()[joint]);
}
double others_change(const ChainSolve& s) { return change(s, 1) + change(s, 2) + change(s, 3); }
ChainSolve figure_solve(const Weights& w, IkMode mode) {
  return solve_chain(plane_chain(w), figure_4_task(), mode);
}
double pose_difference_deg(const ChainSolve& a, const ChainSolve& b) {
  double most = 0.0;
  for (int j = 0; j < kChainLinks; ++j) {
    most = std::max(most, std::fabs(a.answer()[j] - b.answer()[j]) / kDegree);
  }
  return most;
}

// The leg's Jacobian against central differences, metres a radian.
double jacobian_error(const IkChain& chain, const vec3& heel_m) {
  Lcg random(9);
  constexpr double kStep = 1e-5;
  double worst = 0.0;
  for (int n = 0; n < 200; ++n) {
    IkAngles q{};
    for (int j = 0; j < chain.dofs; ++j) q[j] = random.between(-1.0, 1.0);
    const auto rows = point_goal(heel_m, vec3(0.0));
    IkJacobian jacobian;
    std::array<double, kMaxIkRows> error;
    position_jacobian(chain, rows, q, jacobian, error);
    for (int j = 0; j < chain.dofs; ++j) {
      const auto at = [&](double angle) {
        IkAngles moved = q;
        moved[j] += angle;
        const IkFrame end = end_frame(chain, moved);
        return end.position_m + end.rotation * heel_m;
      };
      const vec3 slope = (at(kStep) - at(-kStep)) / (2.0 * kStep);
      for (int r = 0; r < 3; ++r) worst = std::max(worst, std::fabs(slope[r] - jacobian[r][j]));
    }
  }
  return worst;
}

// Straight chains along directions that no axis has: J J^T loses a rank but for its last bits.
int halved_at_rank_loss() {
  Lcg random(4);
  int halved = 0;
  for (int n = 0; n < 100; ++n) {
    vec3 along(random.between(-1.0, 1.0), 0.0, 0.0);
    along.y = random.between(-1.0, 1.0);
    along.z = random.between(0.2, 1.0);
    along = glm::normalize(along);
    IkChain chain;
    for (const vec3& axis : {kLeft, kForward, kUp, kLeft, kForward}) {
      chain.dof[chain.dofs++].axis = axis;
    }
    for (const int j : {2, 4}) chain.dof[j].link_m = 0.42 * along;
    IkAngles q{};
    const auto rows = point_goal(vec3(0.0), 0.7 * along);
    const IkResult result = solve_paper(chain, rows, {.max_iterations = 1}, q);
    halved += result.halvings > 0;
  }
  return halved;
}

struct Shares {
  double root_less = 0.0, others_more = 0.0, one_more = 0.0;
  int halvings = 0, unsolved = 0;
};
Shares near_goals(const NearGoals& what, IkMode mode) {
  Lcg random(2005);
  Shares found;
  for (int n = 0; n < kTasks; ++n) {
    const ChainTask task = near_task(random, what);
    const ChainSolve even = solve_chain(plane_chain(kEven), task, mode),
                     stiff = solve_chain(plane_chain(kStiffRoot), task, mode);
    found.root_less += change(stiff, 0) < change(even, 0);
    found.others_more += others_change(stiff) > others_change(even);
    bool rises = false;
    for (int j = 1; j < kChainLinks; ++j) rises = rises || change(stiff, j) > change(even, j);
    found.one_more += rises;
    found.halvings += even.result.halvings + stiff.result.halvings;
    found.unsolved += even.result.status != IkStatus::converged;
    found.unsolved += stiff.result.status != IkStatus::converged;
  }
  for (double* share : {&found.root_less, &found.others_more, &found.one_more}) *share /= kTasks;
  return found;
}

constexpr double kGentle_rad = 1.2;  // a chain that is bent like an arm
constexpr double kTickReach = 0.1;   // of a link: as far as a walk's goal moves in a few ticks

void near_claims(IkMode mode, ClaimList& list) {
  const Shares any = near_goals({}, mode), tick = near_goals({kGentle_rad, kTickReach}, mode),
               far = near_goals({kGentle_rad, NearGoals{}.reach_links}, mode);
  const auto others = [](const Shares& s) {
    return fmt::format("one of the others moves more in {:.3f}, {} solves missed the tolerance",
                       s.one_more, s.unsolved);
  };
  list.add("10 near goals at which the root moves less", any.root_less, at_least(0.99),
           fmt::format("of {}, chains bent at random, goals within 0.6 link; prototype 0.999; ",
                       kTasks) +
               others(any));
  list.add("10 near goals at which the others' sum rises", any.others_more, at_least(0.80),
           "prototype 0.852");
  const std::string not_near = fmt::format(
      "chains bent by 69 deg at most, goals within 0.1 link; within 0.6 link, which for these is "
      "not near any more, {:.3f} and {:.3f}",
      far.root_less, far.others_more);
  list.add("10 goals a tick away at which the root moves less", tick.root_less, at_least(0.99),
           not_near + "; " + others(tick));
  list.add("10 goals a tick away at which the others' sum rises", tick.others_more, at_least(0.80),
           not_near);
}

// 10: the root moves less, the others more.
void figure_4_claims(IkMode mode, ClaimList& list) {
  std::string roots;
  int rises = 0;
  double before = 1e9, apart = 0.0;
  const ChainSolve even = figure_solve(kEven, mode), stiff = figure_solve(kStiffRoot, mode);
  for (const double w : kRootWeights) {
    const ChainSolve s = figure_solve({w, 1.0, 1.0, 1.0}, mode);
    const double now = change(s, 0);
    roots += fmt::format("{}{:.1f}", roots.empty() ? "" : " / ", now / kDegree);
    rises += !(now < before);
    before = now;
    const vec2 end = plane_end(plane_chain(kEven), s.answer());
    apart = std::max(apart, glm::distance(end, figure_4_task().goal_m));
  }
  list.add("10 root's change at weight 0.2 over even", change(stiff, 0) / change(even, 0),
           less_than(1.0), "planar prototype 0.045 / 0.117 rad = 0.38");
  list.add("10 second joint's change at root weight 0.2 over even",
           change(stiff, 1) / change(even, 1), more_than(1.0), "the figure graphs the first two");
  list.add("10 root weights at which the root's change does not fall", rises, equal_to(0),
           "weights 1 / .5 / .2 / .1 / .05: " + roots + " deg");
  list.add("10 ends of the chain off the goal, mm", 1e3 * apart, at_most(1e3 * kChainTolerance_m));
}

// 11: only the weights' ratios count.
void relative_claims(IkMode mode, ClaimList& list) {
  std::vector<double> iterations;
  std::string text;
  double spread = 0.0;
  const ChainSolve even = figure_solve(kEven, mode);
  for (const double c : {1.0, 0.5, 0.2, 0.1}) {
    const ChainSolve s = figure_solve({c, c, c, c}, mode);
    iterations.push_back(s.iterations());
    text += fmt::format("{}{}", text.empty() ? "" : " / ", s.iterations());
    spread = std::max(spread, glm::distance(plane_end(plane_chain(kEven), s.answer()),
                                            plane_end(plane_chain(kEven), even.answer())));
  }
  const bool is_paper = mode == IkMode::paper;
  list.add("11 iterations with all weights 0.1 over all weights 0.2", iterations[3] / iterations[2],
           is_paper ? within(1.8, 2.4) : equal_to(1.0),
           "all weights 1 / .5 / .2 / .1: " + text + " iterations" +
               (is_paper ? "; planar prototype 4 / 15 / 44 / 93" : ""));
  list.add("11 ends of the chain apart, mm", 1e3 * spread, at_most(2e3 * kChainTolerance_m));
  const Weights half = {0.1, 0.5, 0.5, 0.5};
  const double apart =
      pose_difference_deg(figure_solve(kStiffRoot, mode), figure_solve(half, mode));
  list.add("11 pose of halved weights off that of the weights, deg", apart,
           is_paper ? less_than(2.0) : equal_to(0.0),
           "the paper: weights are to be \"specified relative to each other\"");
}

double error_of_two_links(double weight, IkMode mode, IkAngles& answer) {
  IkChain chain;
  chain.dofs = 2;
  for (int j = 0; j < 2; ++j) {
    chain.dof[j] = plane_chain(kEven).dof[j];
    chain.dof[j].weight = j == 0 ? weight : 1.0;
  }
  ChainTask task;
  task.start_rad = {0.9, -1.1};
  task.goal_m = vec2(0.42, 0.08);
  const ChainSolve s = solve_chain(chain, task, mode);
  answer = s.answer();
  return s.error_m.back();
}

// sqrt(e^T (J J^T)^-1 e): the norm in which eq. (5) contracts.
double contraction_norm(const IkChain& chain, const IkAngles& q, const vec2& goal_m) {
  const std::array<IkRow, 2> rows = {IkRow{vec3(0.0), kLeft, goal_m.x},
                                     IkRow{vec3(0.0), kUp, goal_m.y}};
  IkJacobian j;
  std::array<double, kMaxIkRows> e;
  position_jacobian(chain, rows, q, j, e);
  double a = 0.0, b = 0.0, d = 0.0;
  for (int k = 0; k < chain.dofs; ++k) {
    a += j[0][k] * j[0][k];
    b += j[0][k] * j[1][k];
    d += j[1][k] * j[1][k];
  }
  const double square =
      (d * e[0] * e[0] - 2.0 * b * e[0] * e[1] + a * e[1] * e[1]) / (a * d - b * b);
  return std::sqrt(std::max(square, 0.0));
}

// 12: no redundancy, no effect; and how fast eq. (5) converges.
void limit_claims(IkMode mode, ClaimList& list) {
  IkAngles even{}, stiff{};
  error_of_two_links(1.0, mode, even);
  error_of_two_links(0.2, mode, stiff);
  const double apart = std::max(std::fabs(even[0] - stiff[0]), std::fabs(even[1] - stiff[1]));
  list.add("12 pose of a chain without redundancy changes with its weights by, deg",
           apart / kDegree, at_most(0.02),
           "two links, a point to reach: one pose alone; what is left is the tolerance");
  if (mode == IkMode::robust) return;
  const IkChain chain = plane_chain(kStiffRoot);
  const ChainTask task = figure_4_task();
  const ChainSolve s = solve_chain(chain, task, mode);
  double worst = 0.0;
  for (std::size_t k = 0; k + 1 < s.angles_rad.size(); ++k) {
    if (s.error_m[k] > 0.04 * kChainLink_m) continue;  // where the linearisation holds
    worst = std::max(worst, contraction_norm(chain, s.angles_rad[k + 1], task.goal_m) /
                                contraction_norm(chain, s.angles_rad[k], task.goal_m));
  }
  list.add("12 an iteration leaves of the error at most", worst, at_most(0.81),
           "1 - least weight = 0.8, beside terms of second order");
}

}  // namespace

std::vector<Claim> jacobian_claims(const WalkModel& model, IkMode mode) {
  ClaimList list(kSection, mode);
  const LegBuild& leg = model.leg[kRightSide];
  list.add("9 Jacobian off central differences, m/rad", jacobian_error(leg.chain, leg.model.heel_m),
           at_most(1e-6));
  list.add("9 rows of an end-effector's Jacobian",
           static_cast<double>(point_goal(leg.model.heel_m, vec3(0.0)).size()), equal_to(3),
           "positions alone: the half Jacobian");
  list.add("9 halvings of step 5 at full rank", near_goals({}, IkMode::paper).halvings, equal_to(0),
           "with a full rank the error of step 4 is 0, so the paper's halving never acts there");
  list.add("9 solves halved at a crafted rank loss", halved_at_rank_loss(), at_least(1), "of 100");
  return list.take();
}

std::vector<Claim> chain_claims(IkMode mode) {
  ClaimList list(kSection, mode);
  figure_4_claims(mode, list);
  near_claims(mode, list);
  relative_claims(mode, list);
  limit_claims(mode, list);
  return list.take();
}

}  // namespace gaitpad
