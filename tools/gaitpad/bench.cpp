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
#include "bench/measured.h"
#include "terminal/run_end.h"
#include "tools/gaitpad/window_module.h"
#ifdef GAITPAD_HAS_WINDOW
#include "draw/theme.h"
#endif

namespace gaitpad {
namespace {

using nlohmann::ordered_json;

constexpr int kMostStateBytes = 1024;

struct BenchArguments {
  int most_characters = 100000, rounds = 15;
  bool as_json = false;
  std::string plot;
};

std::string lanes_text(int lanes) {
  const char* set = lanes >= 8 ? "AVX-512" : lanes >= 4 ? "AVX2" : "128 bits";
  return fmt::format("{} lanes ({})", lanes, set);
}

// --- The table -----------------------------------------------------------------------------------

std::string time_text(double ns) {
  if (ns < 1e4) return fmt::format("{:.0f} ns", ns);
  return ns < 1e6 ? fmt::format("{:.1f} us", ns / 1e3) : fmt::format("{:.1f} ms", ns / 1e6);
}

const char* heading_of(const std::string& name) {
  if (name.starts_with("leg")) return "one leg, the solve alone";
  if (name.starts_with("playback")) return "bare playback of the skeleton";
  if (name == "stage") return "one character's tick, by stage";
  if (name.ends_with("60_hz")) return "a character, at 60 Hz";
  if (name.starts_with("char") || name == "step") return "a character, at the trace's 240 Hz";
  if (name == "crowd_alone") return "members of the crowd below, each walking alone";
  if (name.starts_with("replay")) return "a replay of 20 s, the program running already";
  if (name == "crowd") return "a character in a crowd, ticks of 1/60 s";
  if (name == "crowd_all_cores") return "the same on all cores";
  if (name == "crowd_memory") return "a character's state and pose, moved and not computed";
  return "loading";
}

std::string bounds_text(const ordered_json& row) {
  std::string text;
  const auto add = [&](const char* bound, const char* value, const std::string& limit) {
    if (!row.contains(bound)) return;
    const bool is_met = row[value].get<double>() <= row[bound].get<double>();
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", limit, is_met ? "met" : "MISSED");
  };
  if (row.contains("bound_ns")) add("bound_ns", "ns", time_text(row["bound_ns"]));
  if (row.contains("bound_ratio"))
    add("bound_ratio", "ratio", fmt::format("{} x", row["bound_ratio"].get<double>()));
  if (row.contains("bound_growth"))
    add("bound_growth", "growth",
        fmt::format("{:.2f} of 1,000's, {} x", row["growth"].get<double>(),
                    row["bound_growth"].get<double>()));
  return text;
}

void print_bench(const std::vector<BenchRow>& rows, const ordered_json& list, const Cores& cores,
                 int rounds) {
  const ordered_json& first = list.front();
  say("{}, {}{}; medians over {} rounds, quartiles, times the peer, bound\n",
      first["processor"].get<std::string>(), lanes_text(first["lanes"]),
      cores.core() >= 0 ? fmt::format(", core {}", cores.core()) : "", rounds);
  std::string heading;
  for (const BenchRow& row : rows) {
    const ordered_json json = json_of(row, rows);
    const std::string next = heading_of(row.work->name);
    if (next != heading) say("{}\n", next);
    heading = next;
    const std::string label = row.stage >= 0 ? kStages[row.stage] : row.work->label;
    const std::string spread =
        fmt::format("{} - {}", time_text(json["ns_low"]), time_text(json["ns_high"]));
    std::string line = fmt::format("  {:34} {:>9}  {:>19}", label, time_text(json["ns"]), spread);
    line += json.contains("ratio") ? fmt::format("  {:6.2f} x", json["ratio"].get<double>())
                                   : std::string(10, ' ');
    if (json.contains("ratio_alone"))
      line += fmt::format("  {:5.2f} x alone", json["ratio_alone"].get<double>());
    if (json.contains("at_60_hz"))
      line += fmt::format("  {:6.0f} at 60 Hz", json["at_60_hz"].get<double>());
    const std::string bounds = bounds_text(json);
    if (!bounds.empty()) line += "  " + bounds;
    if (json.contains("iterations_per_leg"))
      line += fmt::format("  {:.2f} iterations a leg", json["iterations_per_leg"].get<double>());
    if (json.contains("bytes")) line += fmt::format("  {:.0f} bytes", json["bytes"].get<double>());
    line.erase(line.find_last_not_of(' ') + 1);
    say("{}\n", line);
  }
  for (const ordered_json& row : list) {
    if (row["name"] != "character_even") continue;
    const double state = row["state_bytes"];
    say("a character's state {:.0f} bytes (bound {}, {}), parameters {}, pose {}; "
        "a build's model {:.0f} KB, shared\n",
        state, kMostStateBytes, state <= kMostStateBytes ? "met" : "MISSED",
        row["params_bytes"].get<int>(), row["pose_bytes"].get<int>(),
        row["model_bytes"].get<double>() / 1e3);
  }
}

// --- The picture ---------------------------------------------------------------------------------

#ifdef GAITPAD_HAS_WINDOW
std::string plot_problem(const std::string& path) {
  return path.ends_with(".png") ? "" : "the picture is a PNG: its name ends with .png";
}

// A character's time over the size of its crowd, for each width, with bare playback as horizontal
// lines.
std::optional<Error> write_plot(const std::string& path, const std::vector<BenchRow>& rows,
                                const std::string& processor) {
  constexpr std::array kColours = {colour::kBlue, colour::kGreen, colour::kOrange, colour::kPurple};
  const auto module = window_module();
  if (!module) return module.error();
  double largest = 1.0;
  for (const BenchRow& row : rows)
    if (row.work->name == "crowd") largest = std::max(largest, double(row.work->characters));
  std::vector<CrowdCurve> curves;
  for (int lanes = widest_lanes(); lanes >= 1; lanes /= 2) {
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
    const double ns = median_of(rows, work, 0, 0);
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
    print_bench(rows, list, cores, arguments.rounds);
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
      "the times of a tick, of crowds and of loading, beside bare playback and their bounds");
  const auto arguments = std::make_shared<BenchArguments>();
  command->add_option("--crowd", arguments->most_characters, "the largest crowd")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->add_option("--rounds", arguments->rounds, "how often each measurement is repeated")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_flag("--json", arguments->as_json, "a list of measurements, for machines");
  command->add_option("--plot", arguments->plot, "draws a crowd's time over its size (.png)")
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
