// gaitpad bench: times of a tick of one character and of crowds, of its parts, and of loading a
// motion, compared with bare playback of the same skeleton.
#include <CLI/CLI.hpp>

#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"

#ifdef GAITPAD_HAS_BENCH
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "base/lanes.h"
#include "bench/bench_table.h"
#include "bench/measured.h"
#include "terminal/run_end.h"
#include "tools/gaitpad/window_module.h"
#ifdef GAITPAD_HAS_WINDOW
#include "draw/theme.h"
#endif

namespace gaitpad {
namespace {

using nlohmann::ordered_json;

struct BenchArguments {
  int most_characters = 100000, rounds = 15;
  bool as_json = false;
  std::string plot;
};

// --- The picture ---------------------------------------------------------------------------------

#ifdef GAITPAD_HAS_WINDOW
std::string plot_problem(const std::string& path) {
  return path.ends_with(".png") ? "" : "the picture is a PNG: its name ends with .png";
}

// Plots the time of a character over the size of its crowd, for each width, with bare playback as
// horizontal lines.
std::optional<Error> write_plot(const std::string& path, const std::vector<BenchRow>& rows,
                                const std::string& processor) {
  constexpr std::array kColours = {colour::kBlue, colour::kGreen, colour::kOrange, colour::kPurple};
  const auto module = window_module();
  if (!module) return module.error();
  double largest = 1.0;
  for (const BenchRow& row : rows)
    if (row.work->name == "crowd") largest = std::max(largest, double(row.work->characters));
  std::vector<CrowdCurve> curves;
  for (int lanes = widest_lanes(); lanes >= 1; lanes = lanes > 4 ? lanes / 2 : lanes - 3) {
    CrowdCurve& curve = curves.emplace_back();
    curve.name = lanes_text(lanes);
    curve.colour = kColours[(curves.size() - 1) % kColours.size()];
    for (const BenchRow& row : rows)
      if (row.work->name == "crowd" && row.work->width == lanes)
        curve.points.emplace_back(row.work->characters, row.median());
  }
  CrowdCurve all_cores = {"all cores", colour::kVermilion, false, {}};
  for (const BenchRow& row : rows)
    if (row.work->name == "crowd_all_cores")
      all_cores.points.emplace_back(row.work->characters, row.median());
  if (!all_cores.points.empty()) curves.push_back(std::move(all_cores));
  const auto add_line = [&](const char* work, const char* name, unsigned colour) {
    const double ns = median_ns(rows, work, 0, 0);
    curves.push_back({name, colour, true, {{1.0, ns}, {largest, ns}}});
  };
  add_line("playback", "bare playback, scalar", colour::kInk);
  add_line("playback_world", "the same with world frames", colour::kFaint);
  return (*module)->draw_crowd(curves, processor, path);
}
#else
std::string plot_problem(const std::string&) { return missing_window(); }
std::optional<Error> write_plot(const std::string&, const std::vector<BenchRow>&,
                                const std::string&) {
  return Error{missing_window()};
}
#endif

int run(const BenchArguments& arguments) {
  const auto works = bench_work(arguments.most_characters, config_folders());
  if (!works) return fail("bench", works.error().message);
  const Cores cores;
  Progress progress("gaitpad bench");
  const std::vector<BenchRow> rows =
      measured(*works, arguments.rounds, cores, [&](double share) { progress.show(share); });
  progress.clear();
  const std::string processor = processor_name();
  const ordered_json list = list_of(rows, processor);
  if (arguments.as_json) {
    print_json(list);
  } else {
    for (const std::string& line : bench_lines(rows, list, cores.core(), arguments.rounds))
      say("{}\n", line);
  }
  std::fflush(stdout);
  if (arguments.plot.empty()) return 0;
  const auto problem = write_plot(arguments.plot, rows, processor);
  return problem ? fail("bench", problem->message) : 0;
}

}  // namespace

void add_bench(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "bench",
      "measures a tick, crowds and loading, and compares them with bare playback and with bounds");
  const auto arguments = std::make_shared<BenchArguments>();
  command
      ->add_option("--crowd", arguments->most_characters,
                   "number of characters in the largest crowd")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command
      ->add_option("--rounds", arguments->rounds,
                   "number of times that each measurement is repeated")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_flag("--json", arguments->as_json, "print the measurements as a JSON list");
  command
      ->add_option("--plot", arguments->plot,
                   "draw the time of a tick over the size of the crowd (.png)")
      ->check(plot_problem);
  command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace gaitpad

#else

namespace gaitpad {

void add_bench(CLI::App& app, int& status) {
  add_missing_command(app, status, "bench", "the time that a tick takes, beside its limit",
                      missing_bench());
}

}  // namespace gaitpad

#endif
