// gaitpad check PATH...: replays and judges recordings that have an expectation beside them. Prints
// TAP on standard output; writes JUnit's XML and pictures to files.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "check/check_report.h"
#include "check/trace_check.h"
#include "session/workers.h"
#include "system/whole_file.h"
#include "terminal/run_end.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"
#include "tools/gaitpad/window_module.h"

namespace gaitpad {
namespace {

constexpr const char* kCheckCommand = "check";
constexpr int kMaxJobs = 1024;

struct CheckArguments {
  std::vector<std::string> paths;
  bool updates = false, is_strict = false, user_styles = false;
  int jobs = machine_threads();
  std::string shard, junit, plot;
  std::optional<double> max_hours;
};

std::string shard_problem(const std::string& text) {
  return parse_shard(text) ? "" : in_quotes(text) + " is not I/N with 1 <= I <= N, such as 2/8";
}

// --shard, else GAITPAD_SHARD_INDEX and GAITPAD_SHARD_TOTAL, else all.
Result<Shard> asked_shard(const std::string& option) {
  if (!option.empty()) return *parse_shard(option);
  const char *index = std::getenv("GAITPAD_SHARD_INDEX"),
             *total = std::getenv("GAITPAD_SHARD_TOTAL");
  if (index == nullptr && total == nullptr) return Shard{};
  const std::string text = fmt::format("{}/{}", index ? index : "", total ? total : "");
  if (const auto shard = parse_shard(text)) return *shard;
  return Error{"GAITPAD_SHARD_INDEX/GAITPAD_SHARD_TOTAL: " + shard_problem(text)};
}

// --- the picture of two curves

#ifdef GAITPAD_HAS_WINDOW
std::optional<Error> draw_curves(const JointCurves& curves, const std::string& title,
                                 const std::string& path) {
  const auto module = window_module();
  return module ? (*module)->draw_curves(curves, title, path) : module.error();
}
std::string joints_plot_problem(const std::string&) { return ""; }
#else
std::optional<Error> draw_curves(const JointCurves&, const std::string&, const std::string&) {
  return Error{missing_window()};
}
std::string joints_plot_problem(const std::string&) { return missing_window(); }
#endif

// --- the command

// Names recordings without an expectation. Printed last, so that it is noticed. Returns the exit
// status.
int tell_of_left_out(const CheckArguments& arguments, const std::vector<std::string>& without) {
  if (without.empty()) return 0;
  std::string text = fmt::format("recordings without an expectation, left out: {}", without.size());
  if (!arguments.is_strict) {
    print_remarks(kCheckCommand, {text});
    return 0;
  }
  return fail(kCheckCommand, fmt::format("{}; the first is {}", text, without.front()));
}

int run(const CheckArguments& arguments) {
  const auto shard = asked_shard(arguments.shard);
  if (!shard) return fail(kCheckCommand, shard.error().message), kWrongUsage;
  auto found = found_traces(arguments.paths, arguments.updates);
  if (!found) return fail(kCheckCommand, found.error().message);
  if (found->traces.empty()) {
    return fail(kCheckCommand,
                found->without.empty()
                    ? "no recording is there"
                    : "no recording has an expectation beside it; --update writes them");
  }
  const std::vector<CheckedTrace> traces = part_of(found->traces, *shard);

  const CheckOptions options = {config_folders(), arguments.updates, !arguments.plot.empty(),
                                arguments.max_hours, arguments.user_styles};
  const int jobs = std::min(arguments.jobs, std::max(1, static_cast<int>(traces.size())));
  JunitReport junit;
  int failures = 0;
  std::vector<std::string> problems;
  Progress progress(kCheckCommand);
  double done = 0.0;
  fmt::print("TAP version 14\n1..{}\n", traces.size());
  check_all(traces, options, jobs, [&](std::size_t i, CheckResult&& result) {
    const CheckedTrace& trace = traces[i];
    failures += !result.is_met;
    progress.clear();
    fmt::print("{}", tap_result(i + 1, trace, result, arguments.updates));
    std::fflush(stdout);
    progress.show(++done / static_cast<double>(traces.size()));
    junit.add(trace, result);
    if (!result.curves) return;
    const std::string path = picture_path(arguments.plot, trace);
    const auto problem = draw_curves(*result.curves, printable(trace.recording()), path);
    problems.push_back(problem ? problem->message : "drawn: " + path);
    failures += problem.has_value();
  });
  progress.clear();
  print_remarks(kCheckCommand, problems);
  if (!arguments.junit.empty()) {
    if (auto problem = write_file(arguments.junit, junit.text()))
      return fail(kCheckCommand, problem->message);
  }
  int status = 0;
  if (failures > 0) {
    status = fail(kCheckCommand,
                  fmt::format("{} of {} recordings are not as expected", failures, traces.size()));
  }
  return arguments.updates ? status : std::max(status, tell_of_left_out(arguments, found->without));
}

}  // namespace

void add_check(CLI::App& app, int& status) {
  CLI::App* command =
      app.add_subcommand("check", "replays recordings and compares them with their expectations");
  const auto arguments = std::make_shared<CheckArguments>();
  command
      ->add_option("PATH", arguments->paths,
                   "recordings (NAME.hid, with NAME.expect.toml beside it), and folders to search")
      ->required();
  command->add_flag("--update", arguments->updates,
                    "write the expectations that are missing or not met, and print what changed");
  command->add_flag("--strict", arguments->is_strict, "fail if a recording has no expectation")
      ->excludes("--update");
  command
      ->add_option("-j,--jobs", arguments->jobs,
                   "number of parallel jobs (default: the number of cores)")
      ->check(CLI::Range(1, kMaxJobs));
  command
      ->add_option("--shard", arguments->shard,
                   "I/N: check only part I of N equal parts, the first is 1 (default: "
                   "$GAITPAD_SHARD_INDEX of $GAITPAD_SHARD_TOTAL, else all)")
      ->check(shard_problem);
  command->add_option("--junit", arguments->junit,
                      "also write the results to this file, as JUnit's XML");
  command
      ->add_option("--plot", arguments->plot,
                   "folder for a picture of each pose that differs: the joint's angle in both runs")
      ->check(joints_plot_problem);
  add_max_hours_option(*command, arguments->max_hours);
  add_user_styles_option(*command, arguments->user_styles);
  command->footer(
      "Results are TAP on standard output. Exit status: 0 all are met, 1 one is not, 2 wrong "
      "usage.\n"
      "Examples:\n"
      "  gaitpad check --update walks\n"
      "  gaitpad check walks --strict --junit results.xml --plot out\n"
      "  gaitpad check walks --shard 2/8 -j 2");
  command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace gaitpad
