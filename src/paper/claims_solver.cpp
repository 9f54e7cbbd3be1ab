// Assertions 9-12: the solver and figure 4. 23: goals out of reach. 21: "no extra computational
// cost".

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>

#include "base/numeric.h"
#include "paper/chain4.h"
#include "paper/claims.h"
#include "paper/study.h"

namespace gaitpad {
namespace {

constexpr int kTasks = 1000;  // number of random near goals
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

// Largest difference between the leg's Jacobian and central differences, metres per radian.
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

// Straight chains along directions that are parallel to no axis, so that J J^T loses a rank except
// for rounding.
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

// Most bend at each joint, for chains that are bent like an arm.
constexpr double kGentle_rad = 1.2;
// Distance of a goal in links, as far as a walk's goal moves in a few ticks.
constexpr double kTickReach = 0.1;

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

// Claim 10: the root turns less, the other joints more.
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

// Claim 11: only the ratios of the weights count.
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

// sqrt(e^T (J J^T)^-1 e): the norm in which eq. (5) is a contraction.
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

// Claim 12: without redundancy weights have no effect; and the rate of convergence of eq. (5).
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
    // Compare only near the goal, where the linearisation is valid.
    if (s.error_m[k] > 0.04 * kChainLink_m) continue;
    worst = std::max(worst, contraction_norm(chain, s.angles_rad[k + 1], task.goal_m) /
                                contraction_norm(chain, s.angles_rad[k], task.goal_m));
  }
  list.add("12 an iteration leaves of the error at most", worst, at_most(0.81),
           "1 - least weight = 0.8, beside terms of second order");
}

constexpr int kFrames = 60;            // frames on the way to the goal, and as many at the goal
constexpr double kFar = 1.5;           // distance of a very high step from the hip, in leg lengths
constexpr double kMostTurn_rad = kPi;  // most that a leg's joint can turn between two frames

IkResult solve(const IkChain& chain, const vec3& heel_m, const vec3& goal_m, IkMode mode,
               IkAngles& angles) {
  const auto rows = point_goal(heel_m, goal_m);
  if (mode == IkMode::paper) return solve_paper(chain, rows, {}, angles);
  return solve_robust(chain, rows, {.max_tries = 1}, angles);
}

// Assertion 21. Times are medians of processor time over alternating blocks of one run, so that
// other load on the machine affects both sides equally.

constexpr int kRounds = 61;
constexpr double kHipWeight = 0.2;
constexpr int kCostTicks = 6 * kPaperRate_hz, kWarmUpTicks = 2 * kPaperRate_hz;

double seconds_now() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}
// Processor time of this process, without other programs.
double cpu_seconds_now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Pair {
  double even_s = 0.0, weighted_s = 0.0, ratio = 0.0;
};
// Runs each block once to warm up, then both alternately.
template <class A, class B>
Pair in_turns(A even, B weighted) {
  std::vector<double> a, b, ratio;
  even(), weighted();
  for (int n = 0; n < kRounds; ++n) {
    const double t0 = cpu_seconds_now();
    even();
    const double t1 = cpu_seconds_now();
    weighted();
    const double t2 = cpu_seconds_now();
    a.push_back(t1 - t0), b.push_back(t2 - t1), ratio.push_back((t2 - t1) / (t1 - t0));
  }
  return {median(a), median(b), median(ratio)};
}

// The goals of one leg's heel during the flights of a walk, one for each tick.
struct HeelPath {
  IkChain even, weighted;
  vec3 heel_m{0.0};
  std::vector<IkAngles> start_rad;  // the walk's pose before each goal
  std::vector<vec3> goal_m;
};
HeelPath heel_path(const WalkModel& model, const Walk& walk) {
  const LegBuild& leg = model.leg[kRightSide];
  HeelPath path{leg.chain, leg.chain, leg.model.heel_m, {}, {}};
  for (const int j : {kHipX, kHipZ, kHipY}) path.weighted.dof[j].weight = kHipWeight;
  for (const Ticks& f : flights(walk, kRightSide, 3.0)) {
    for (std::size_t k = f.begin + 1; k < f.end; ++k) {
      IkAngles before{}, now{};
      std::ranges::copy(walk.samples[k - 1].angles_rad[kRightSide], before.begin());
      std::ranges::copy(walk.samples[k].angles_rad[kRightSide], now.begin());
      const IkFrame end = end_frame(leg.chain, now);
      path.start_rad.push_back(before);
      path.goal_m.push_back(end.position_m + end.rotation * path.heel_m);
    }
  }
  return path;
}

// One iteration (steps 1-6) from each pose.
void paper_passes(const HeelPath& path, const IkChain& chain) {
  for (std::size_t i = 0; i < path.goal_m.size(); ++i) {
    IkAngles q = path.start_rad[i];
    paper_iteration(chain, point_goal(path.heel_m, path.goal_m[i]), {}, q);
  }
}
void robust_passes(const HeelPath& path, const IkChain& chain) {
  const RobustOptions once{.tolerance_m = 0.0, .max_iterations = 1, .max_tries = 1};
  for (std::size_t i = 0; i < path.goal_m.size(); ++i) {
    IkAngles q = path.start_rad[i];
    solve_robust(chain, point_goal(path.heel_m, path.goal_m[i]), once, q);
  }
}
// Solves along the path, each time from the previous answer; returns the iterations.
template <class Solve>
int solves(const HeelPath& path, Solve solve) {
  int iterations = 0;
  IkAngles q = path.start_rad.front();
  for (const vec3& goal : path.goal_m) {
    iterations += solve(point_goal(path.heel_m, goal), q).iterations;
  }
  return iterations;
}
int robust_solves(const HeelPath& path, const IkChain& chain) {
  const RobustOptions options{.max_tries = 1};
  return solves(
      path, [&](const auto& rows, IkAngles& q) { return solve_robust(chain, rows, options, q); });
}
int paper_solves(const HeelPath& path, const IkChain& chain) {
  return solves(path,
                [&](const auto& rows, IkAngles& q) { return solve_paper(chain, rows, {}, q); });
}

std::string microseconds(const Pair& p, double count) {
  return fmt::format("{:.2f} against {:.2f} us", 1e6 * p.weighted_s / count,
                     1e6 * p.even_s / count);
}

void solver_claims(const HeelPath& path, ClaimList& paper, ClaimList& robust) {
  const double n = static_cast<double>(path.goal_m.size());
  const Pair pass =
      in_turns([&] { paper_passes(path, path.even); }, [&] { paper_passes(path, path.weighted); });
  paper.add("21 time of an iteration with weights over without", pass.ratio, at_most(1.05),
            microseconds(pass, n));
  const Pair step = in_turns([&] { robust_passes(path, path.even); },
                             [&] { robust_passes(path, path.weighted); });
  robust.add("21 time of an iteration with weights over without", step.ratio, at_most(1.05),
             microseconds(step, n));
  const Pair solve = in_turns([&] { robust_solves(path, path.even); },
                              [&] { robust_solves(path, path.weighted); });
  robust.add("21 time of a solve with weights over without", solve.ratio, at_most(1.15),
             microseconds(solve, n) + fmt::format("; {:.2f} against {:.2f} iterations",
                                                  robust_solves(path, path.weighted) / n,
                                                  robust_solves(path, path.even) / n));
  const Pair letter =
      in_turns([&] { paper_solves(path, path.even); }, [&] { paper_solves(path, path.weighted); });
  paper.add(
      "21 time of a solve with weights over without", letter.ratio, at_most(1.15),
      microseconds(letter, n) +
          fmt::format("; {:.1f} against {:.1f} iterations: eq. (5) leaves up to 1 - least "
                      "weight of the error in each, so \"no extra cost\" is true of an "
                      "iteration, not of a solve; planar prototype 17.2 against 1.9",
                      paper_solves(path, path.weighted) / n, paper_solves(path, path.even) / n));
}

double iterations_a_leg(const Walk& walk) {
  double sum = 0.0;
  for (const WalkSample& s : walk.samples) {
    sum += s.frame.ik_iterations[kLeftSide] + s.frame.ik_iterations[kRightSide];
  }
  return sum / (2.0 * static_cast<double>(walk.samples.size()));
}

// Time of a whole character's tick with stiff hips / time with even weights.
double tick_ratio(Study& study, std::string& text) {
  const auto stride = [&](const char* style) {
    return [&study, values = StyleValues(style_of(study.source(), style))] {
      WalkCase what;
      what.model = &study.model();
      what.style = values;
      what.end_s = 3.0;
      walked(what);
    };
  };
  const Pair p = in_turns(stride("even"), stride("stiff_hip"));
  text = microseconds(p, 3.0 * kPaperRate_hz) +
         fmt::format("; {:.1f} against {:.1f} iterations a leg",
                     iterations_a_leg(study.walk("stiff_hip", IkMode::robust)),
                     iterations_a_leg(study.walk("even", IkMode::robust)));
  return p.ratio;
}

double p99_ms(const Study& study, IkMode mode) {
  const FigureStyles &a = styles_of_5a(), &b = styles_of_5b();
  std::vector<Style> styles;
  for (const std::string& name : {a.red, a.green, a.blue, b.red}) {
    styles.push_back(style_of(study.source(), name));
  }
  auto simulation = Simulation::create(paper_session(study.source().cycle, styles, mode));
  if (!simulation) return kNoNumber;
  std::vector<double> times;
  for (int k = 0; k < kCostTicks; ++k) {
    std::vector<Report> reports;
    if (k == 0) reports.push_back(paper_report(vec2(0.0, 0.8)));
    if (k == kCostTicks / 2) reports.push_back(paper_report(vec2(0.4, 0.7)));
    const double begin = seconds_now();
    simulation->step(reports);
    if (k >= kWarmUpTicks) times.push_back(seconds_now() - begin);
  }
  std::ranges::sort(times);
  return 1e3 * times[times.size() * 99 / 100];
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
  return list.take_claims();
}

std::vector<Claim> chain_claims(IkMode mode) {
  ClaimList list(kSection, mode);
  figure_4_claims(mode, list);
  near_claims(mode, list);
  relative_claims(mode, list);
  limit_claims(mode, list);
  return list.take_claims();
}

std::vector<Claim> reach_claims(const WalkModel& model, IkMode mode) {
  const LegBuild& leg = model.leg[kRightSide];
  IkAngles angles{};
  angles[kHipX] = -4.0 * kDegree, angles[kKneeX] = 8.0 * kDegree, angles[kAnkleX] = -4.0 * kDegree;
  const IkFrame end = end_frame(leg.chain, angles);
  const vec3 start = end.position_m + end.rotation * leg.model.heel_m;
  const vec3 far = glm::normalize(vec3(0.0, 0.5, 1.0)) * (kFar * leg.model.length_m());
  double most = 0.0;
  int broken = 0, flagged = 0, beyond = 0;
  for (int n = 1; n <= 2 * kFrames; ++n) {
    const double share = std::min(1.0, static_cast<double>(n) / kFrames);
    const IkAngles before = angles;
    const IkResult result =
        solve(leg.chain, leg.model.heel_m, start + (far - start) * share, mode, angles);
    for (int j = 0; j < kLegDofs; ++j) {
      const double turn = std::fabs(angles[j] - before[j]);
      broken += !std::isfinite(turn);
      most = std::max(most, turn);
    }
    beyond += n >= kFrames;
    flagged += n >= kFrames && result.status != IkStatus::converged;
  }
  ClaimList list("3.3.2", mode);
  list.add("23 angles that are no number", broken, equal_to(0), "heel to a place 1.5 legs away");
  list.add("23 a joint turns from frame to frame by, rad", most, at_most(kMostTurn_rad),
           mode == IkMode::paper ? "no damping and no limits: windings beside the stretched leg; "
                                   "planar prototype 7062 rad"
                                 : "");
  list.add("23 frames out of reach that are flagged", static_cast<double>(flagged) / beyond,
           equal_to(1.0));
  return list.take_claims();
}

std::vector<Claim> cost_claims(Study& study) {
  ClaimList paper("3.3 and 4", IkMode::paper), robust("3.3 and 4", IkMode::robust);
  for (ClaimList* list : {&paper, &robust}) {
    const IkMode mode = list == &paper ? IkMode::paper : IkMode::robust;
    list->add("21 99th percentile of a tick of four characters, ms", p99_ms(study, mode),
              less_than(1000.0 / 60.0), "the paper: real time; aim 1 ms; by the clock on the wall");
  }
  const HeelPath path = heel_path(study.model(), study.walk("even", IkMode::robust));
  if (!path.goal_m.empty()) solver_claims(path, paper, robust);
  std::string text;
  const double ratio = tick_ratio(study, text);
  robust.add("21 time of a character's tick with stiff hips over even", ratio, at_most(1.15),
             text +
                 "; beside the even pose, which it starts from, the walk solves each leg twice "
                 "more where weights show");
  std::vector<Claim> all = paper.take_claims();
  for (Claim& claim : robust.take_claims()) all.push_back(std::move(claim));
  return all;
}

}  // namespace gaitpad
