// gaitpad ik: solves one chain to a goal and prints the angles of each iteration.
#include "gaitpad/ik.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <vector>

#include "files/toml_file.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/print.h"

namespace gaitpad {
namespace {

struct Task {
  IkChain chain;
  IkAngles start_rad{};
  vec3 goal_m{0.0};
  double tolerance_m = 1e-4;
  double epsilon_m = 1e-6;
  int max_iterations = 200;
};

std::optional<vec3> vector_of(TomlTable& table, const char* key, double greatest) {
  const auto v = table.numbers(key, 3, 3, -greatest, greatest);
  if (!v) return std::nullopt;
  return vec3((*v)[0], (*v)[1], (*v)[2]);
}

void read_dof(TomlTable& table, IkDof& dof, double& start_rad) {
  table.require("axis");
  if (const auto axis = vector_of(table, "axis", 2.0)) {
    const double length = glm::length(*axis);
    if (std::abs(length - 1.0) > 1e-3) {
      table.reject("axis", fmt::format("the axis has length {:.6g}, not 1", length));
      return;
    }
    dof.axis = *axis / length;
  }
  dof.link_m = vector_of(table, "link_m", 1e3).value_or(vec3(0.0));
  dof.weight = table.number("weight", 0.0, 1.0).value_or(1.0);
  start_rad = table.number("angle_rad", -1e4, 1e4).value_or(0.0);
}

Result<Task> load_task(const std::string& path) {
  auto file = TomlFile::load(path);
  if (!file) return file.error();
  TomlTable root = file->root();
  Task task;
  root.require("goal_m");
  root.require("dof");
  task.goal_m = vector_of(root, "goal_m", 1e6).value_or(vec3(0.0));
  task.tolerance_m = root.number("tolerance_m", 1e-12, 1e3).value_or(task.tolerance_m);
  task.epsilon_m = root.number("epsilon_m", 0.0, 1e3).value_or(task.epsilon_m);
  task.max_iterations =
      static_cast<int>(root.integer("max_iterations", 0, 100000).value_or(task.max_iterations));
  for (TomlTable& table : root.tables("dof", kMaxIkDofs)) {
    const int j = task.chain.dofs++;
    read_dof(table, task.chain.dof[j], task.start_rad[j]);
  }
  if (root.has("dof") && task.chain.dofs == 0) root.reject("dof", "the chain has no [[dof]]");
  if (const auto problem = file->problem()) return *problem;
  return task;
}

IkResult solve(const Task& task, const std::string& mode, IkTrace& trace) {
  const auto rows = point_goal(vec3(0.0), task.goal_m);
  IkAngles angles_rad = task.start_rad;
  if (mode == "paper") {
    PaperOptions options;
    options.tolerance_m = task.tolerance_m;
    options.epsilon_m = task.epsilon_m;
    options.max_iterations = task.max_iterations;
    return solve_paper(task.chain, rows, options, angles_rad, &trace);
  }
  RobustOptions options;
  options.tolerance_m = task.tolerance_m;
  options.max_iterations = task.max_iterations;
  return solve_robust(task.chain, rows, options, angles_rad, &trace);
}

void print_csv(const Task& task, const IkTrace& trace) {
  std::string text = "iteration";
  for (int j = 0; j < task.chain.dofs; ++j) text += fmt::format(",angle_{}_rad", j);
  text += ",error_m\n";
  for (int row = 0; row < trace.rows; ++row) {
    text += fmt::format("{}", row);
    for (int j = 0; j < task.chain.dofs; ++j) {
      text += fmt::format(",{:.9g}", trace.angles_rad[row][j]);
    }
    text += fmt::format(",{:.9g}\n", trace.error_m[row]);
  }
  std::fputs(text.c_str(), stdout);
}

// The paper's method limits neither angles nor steps: says which angle exceeded a full turn.
std::string wild_turn(const Task& task, const IkTrace& trace, const IkAngles& end_rad) {
  constexpr double kTurn_rad = 6.283185307179586;
  int joint = 0, iteration = 1;
  double largest_rad = 0.0;
  bool is_wild = false;
  for (int j = 0; j < task.chain.dofs; ++j) {
    is_wild = is_wild || std::abs(end_rad[j]) > kTurn_rad;
    for (int row = 1; row < trace.rows; ++row) {
      const double step_rad = trace.angles_rad[row][j] - trace.angles_rad[row - 1][j];
      if (std::abs(step_rad) <= std::abs(largest_rad)) continue;
      largest_rad = step_rad;
      joint = j;
      iteration = row;
    }
  }
  if (!is_wild || std::abs(largest_rad) < kTurn_rad / 2.0) return {};
  return fmt::format(
      "iteration {} turns angle_{} by {:.4g} rad: J J^T is nearly singular there (the chain is "
      "stretched or folded), and the paper's step has no bound; --mode robust damps it",
      iteration, joint, largest_rad);
}

int run(const std::string& path, const std::string& mode) {
  const auto task = load_task(path);
  if (!task) return fail("ik", task.error().message);
  const auto rows = static_cast<std::size_t>(task->max_iterations) + 1;
  std::vector<IkAngles> angles_rad(rows);
  std::vector<double> error_m(rows);
  IkTrace trace{angles_rad, error_m};
  const IkResult result = solve(*task, mode, trace);
  print_csv(*task, trace);
  const char* const why = result.status == IkStatus::singular     ? "J J^T has no inverse here"
                          : result.status == IkStatus::not_finite ? "a number is not finite"
                                                                  : "the goal is not reached";
  if (result.status != IkStatus::converged) {
    print_remarks("ik", {fmt::format("{}: {}: {:.9g} m off after {} iterations", path, why,
                                     result.error_m, result.iterations)});
  }
  if (mode == "paper" && trace.rows > 0) {
    const std::string why_wild = wild_turn(*task, trace, trace.angles_rad[trace.rows - 1]);
    if (!why_wild.empty()) print_remarks("ik", {path + ": " + why_wild});
  }
  return result.status == IkStatus::not_finite ? 1 : 0;
}

}  // namespace

void add_ik(CLI::App& app, int& status) {
  struct Arguments {
    std::string path, mode = "robust";
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("ik", "moves a chain to a goal and shows the angles of each iteration");
  command->add_option("chain", arguments->path, "TOML file: goal_m, [[dof]] ...")
      ->type_name("CHAIN.toml")
      ->required();
  command->add_option("--mode", arguments->mode, "the paper's steps 1-7, or the robust solver")
      ->check(CLI::IsMember({"paper", "robust"}))
      ->capture_default_str();
  command->callback([arguments, &status] { status = run(arguments->path, arguments->mode); });
}

}  // namespace gaitpad
