#include "paper/chain4.h"

namespace gaitpad {
namespace {

constexpr std::size_t kMaxRows = 512;
// Share of the chain's length; goals beyond it count as out of reach.
constexpr double kChainReach = 0.98;

std::array<IkRow, 2> plane_rows(const vec2& goal_m) {
  return {IkRow{vec3(0.0), vec3(1.0, 0.0, 0.0), goal_m.x},
          IkRow{vec3(0.0), vec3(0.0, 1.0, 0.0), goal_m.y}};
}

}  // namespace

IkChain plane_chain(const std::array<double, kChainLinks>& weights) {
  IkChain chain;
  chain.dofs = kChainLinks;
  for (int j = 0; j < kChainLinks; ++j) {
    IkDof& dof = chain.dof[j];
    dof.axis = vec3(0.0, 0.0, 1.0);
    dof.link_m = vec3(kChainLink_m, 0.0, 0.0);
    dof.weight = weights[static_cast<std::size_t>(j)];
  }
  return chain;
}

std::vector<vec2> plane_joints(const IkChain& chain, const IkAngles& angles_rad) {
  std::vector<vec2> joints = {vec2(0.0)};
  double angle = 0.0;
  for (int j = 0; j < chain.dofs; ++j) {
    angle += angles_rad[j];
    const SinCos s = sin_cos(angle);
    joints.push_back(joints.back() + vec2(s.cos, s.sin) * chain.dof[j].link_m.x);
  }
  return joints;
}

vec2 plane_end(const IkChain& chain, const IkAngles& angles_rad) {
  return plane_joints(chain, angles_rad).back();
}

ChainTask figure_4_task() {
  ChainTask task;
  const std::array<double, kChainLinks> start_deg = {40.0, 40.0, -50.0, -40.0};
  for (int j = 0; j < kChainLinks; ++j) {
    task.start_rad[j] = start_deg[static_cast<std::size_t>(j)] * kDegree;
  }
  task.goal_m = vec2(0.842, 0.447);
  return task;
}

ChainSolve solve_chain(const IkChain& chain, const ChainTask& task, IkMode mode) {
  ChainSolve solve;
  solve.angles_rad.resize(kMaxRows);
  solve.error_m.resize(kMaxRows);
  IkTrace trace{solve.angles_rad, solve.error_m};
  IkAngles angles = task.start_rad;
  const auto rows = plane_rows(task.goal_m);
  if (mode == IkMode::paper) {
    const PaperOptions options{.tolerance_m = kChainTolerance_m, .max_iterations = 500};
    solve.result = solve_paper(chain, rows, options, angles, &trace);
  } else {
    const RobustOptions options{.tolerance_m = kChainTolerance_m, .max_tries = 1};
    solve.result = solve_robust(chain, rows, options, angles, &trace);
  }
  const auto count = static_cast<std::size_t>(std::max(trace.rows, 1));
  if (trace.rows == 0) solve.angles_rad[0] = angles;
  solve.angles_rad.resize(count);
  solve.error_m.resize(count);
  return solve;
}

ChainTask near_task(Lcg& random, const NearGoals& what) {
  ChainTask task;
  const double reach = what.reach_links * kChainLink_m;
  do {
    for (int j = 0; j < kChainLinks; ++j) {
      task.start_rad[j] = random.between(-what.bend_rad, what.bend_rad);
    }
    const vec2 end = plane_end(plane_chain({1.0, 1.0, 1.0, 1.0}), task.start_rad);
    task.goal_m.x = end.x + random.between(-reach, reach);
    task.goal_m.y = end.y + random.between(-reach, reach);
  } while (glm::length(task.goal_m) > kChainReach * kChainLinks * kChainLink_m);
  return task;
}

}  // namespace gaitpad
