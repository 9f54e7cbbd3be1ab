// gaitpad bench: how long a tick takes, of one character and of crowds, and its parts, beside bare
// playback of the same skeleton; and how long a motion takes to load.
#include <CLI/CLI.hpp>

#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"

#ifdef GAITPAD_HAS_BENCH
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <sched.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>

#include "base/lanes.h"
#include "tools/gaitpad/bench_work.h"
#include "tools/gaitpad/run_end.h"
#include "tools/gaitpad/window_module.h"
#ifdef GAITPAD_HAS_WINDOW
#include "draw/theme.h"
#endif

namespace gaitpad {
namespace {

using nlohmann::ordered_json;

constexpr double kBlock_s = 0.02;    // of one work in one round; at least one pass
constexpr double kMostGrowth = 1.8;  // of a character's time from a crowd of 1,000 on
constexpr int kGrowsFrom = 1000;
constexpr double kFrame_ns = 1e9 / 60.0;
constexpr int kMostStateBytes = 1024;

struct BenchArguments {
  int most_characters = 100000, rounds = 15;
  bool as_json = false;
  std::string plot;
};

// --- How it is measured --------------------------------------------------------------------------

// Keeps this thread on one core, so that moves between cores do not count, and gives it all of
// them for work that has several threads.
class Cores {
 public:
  Cores() {
    CPU_ZERO(&all_);
    CPU_ZERO(&one_);
    if (::sched_getaffinity(0, sizeof all_, &all_) != 0) return;
    for (int core = 0; core < CPU_SETSIZE; ++core)
      if (CPU_ISSET(core, &all_)) core_ = core;  // the last: the first serves most interrupts
    if (core_ >= 0) CPU_SET(core_, &one_);
  }
  ~Cores() { use_all(); }
  Cores(const Cores&) = delete;
  Cores& operator=(const Cores&) = delete;
  void use_one() const { use(one_); }
  void use_all() const { use(all_); }
  int core() const { return core_; }  // -1: not known, then nothing is pinned

 private:
  void use(const cpu_set_t& cores) const {
    if (core_ >= 0) ::sched_setaffinity(0, sizeof cores, &cores);
  }
  cpu_set_t all_, one_;
  int core_ = -1;
};

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

std::string lanes_text(int lanes) {
  const char* set = lanes >= 8 ? "AVX-512" : lanes >= 4 ? "AVX2" : "128 bits";
  return fmt::format("{} lanes ({})", lanes, set);
}

// What a unit of a work, or one of its stages, took.
struct BenchRow {
  const Work* work = nullptr;
  int stage = -1;          // in kStages; -1: the whole
  std::vector<double> ns;  // in each round
  // The value that this share of the rounds does not exceed.
  double quantile(double share) const {
    std::vector<double> sorted = ns;
    std::sort(sorted.begin(), sorted.end());
    const double place = share * static_cast<double>(sorted.size() - 1);
    const auto i = static_cast<std::size_t>(place);
    const double next = sorted[std::min(i + 1, sorted.size() - 1)];
    return sorted[i] + (next - sorted[i]) * (place - static_cast<double>(i));
  }
  double median() const { return quantile(0.5); }
};

// Keeps what Google Benchmark measures: the processor time of this thread, which other programs do
// not add to, or where several threads work the time that passes.
class Block : public benchmark::BenchmarkReporter {
 public:
  explicit Block(bool has_threads) : has_threads_(has_threads) {}
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration) continue;
      pass_ns = has_threads_ ? run.GetAdjustedRealTime() : run.GetAdjustedCPUTime();
      passes = run.iterations;
    }
  }
  double pass_ns = 0.0;
  std::int64_t passes = 0;

 private:
  bool has_threads_;
};

// So many passes of one work, or, with 0, as many as take kBlock_s.
Block measured_block(const Work& work, std::int64_t passes) {
  benchmark::ClearRegisteredBenchmarks();
  auto* registered = benchmark::RegisterBenchmark("block", [&work](benchmark::State& state) {
    if (work.stages) work.stages->fill(0.0);
    for (auto _ : state) work.pass();
  });
  if (work.is_on_all_cores) registered->UseRealTime();
  passes > 0 ? registered->Iterations(passes) : registered->MinTime(kBlock_s);
  Block block(work.is_on_all_cores);
  benchmark::RunSpecifiedBenchmarks(&block);
  return block;
}

// All works take turns, block by block, so that what the machine does besides falls on all of them.
// Before the first round each finds its number of passes.
std::vector<BenchRow> measured(const std::vector<Work>& works, int rounds, const Cores& cores) {
  std::vector<BenchRow> rows;
  std::vector<std::size_t> first_row;
  std::vector<std::int64_t> passes;
  const auto block_of = [&](const Work& work, std::int64_t count) {
    work.is_on_all_cores ? cores.use_all() : cores.use_one();
    use_lanes(work.width > 0 ? work.width : widest_lanes());
    return measured_block(work, count);
  };
  for (const Work& work : works) {
    first_row.push_back(rows.size());
    if (!work.stages) rows.push_back({&work, -1, {}});
    for (std::size_t k = 0; work.stages && k < kStages.size(); ++k)
      rows.push_back({&work, static_cast<int>(k), {}});
    passes.push_back(block_of(work, 0).passes);
  }
  Progress progress("gaitpad bench");
  for (int round = 0; round < rounds; ++round) {
    progress.show(static_cast<double>(round) / rounds);
    for (std::size_t i = 0; i < works.size(); ++i) {
      const Work& work = works[i];
      if (round % work.every != 0) continue;
      const Block block = block_of(work, passes[i]);
      if (!work.stages) rows[first_row[i]].ns.push_back(block.pass_ns / work.units);
      for (std::size_t k = 0; work.stages && k < kStages.size(); ++k) {
        const double pass_ns = 1e9 * (*work.stages)[k] / static_cast<double>(passes[i]);
        rows[first_row[i] + k].ns.push_back(pass_ns / work.units);
      }
    }
  }
  progress.clear();
  cores.use_all();
  return rows;
}

// --- The list ------------------------------------------------------------------------------------

// The median of the first row with this name, and this many characters and lanes; 0 stands for any.
// Nothing if there is none.
double median_of(const std::vector<BenchRow>& rows, std::string_view name, int characters,
                 int width) {
  for (const BenchRow& row : rows) {
    const Work& work = *row.work;
    if (work.name == name && (characters == 0 || work.characters == characters) &&
        (width == 0 || work.width == width))
      return row.median();
  }
  return std::nan("");
}

ordered_json json_of(const BenchRow& row, const std::vector<BenchRow>& rows) {
  const Work& work = *row.work;
  const double ns = row.median();
  ordered_json json = {{"name", work.name}, {"characters", work.characters}};
  if (work.width > 0) json["width"] = work.width;
  if (row.stage >= 0) json["stage"] = kStages[row.stage];
  json["ns"] = ns;
  json["ns_low"] = row.quantile(0.25);
  json["ns_high"] = row.quantile(0.75);
  json["time_us"] = ns * work.characters / 1e3;
  json["clock"] = work.is_on_all_cores ? "elapsed" : "thread";
  bool is_met = true;
  const auto add_bound = [&](const char* key, double value, double most) {
    json[key] = most;
    is_met = is_met && value <= most;
  };
  if (!work.over.empty()) {
    const double ratio = ns / median_of(rows, work.over, 0, 0);
    json["over"] = work.over;
    json["ratio"] = ratio;
    if (work.most_ratio > 0.0) add_bound("bound_ratio", ratio, work.most_ratio);
  }
  if (work.most_ns > 0.0) {
    add_bound("bound_ns", ns, work.most_ns);
    json["limit_us"] = work.most_ns * work.characters / 1e3;
    json["ratio_to_limit"] = ns / work.most_ns;
  }
  if (work.name == "crowd" && work.characters > kGrowsFrom &&
      !std::isnan(median_of(rows, "crowd", kGrowsFrom, work.width))) {
    const double growth = ns / median_of(rows, "crowd", kGrowsFrom, work.width);
    json["growth"] = growth;
    add_bound("bound_growth", growth, kMostGrowth);
  }
  if (work.width > 0) {
    const double alone_ns = median_of(rows, "crowd_alone", 0, 0);
    if (!std::isnan(alone_ns)) json["ratio_alone"] = ns / alone_ns;
  }
  if (work.width > 0 || work.name == "character_even")
    json["at_60_hz"] = std::floor(kFrame_ns / ns);
  json.update(work.notes);
  if (json.contains("bound_ns") || json.contains("bound_ratio") || json.contains("bound_growth"))
    json["met"] = is_met;
  return json;
}

// The rows as a list, and two under names of their own: a leg's share of the tick's inverse
// kinematics, and loading a clip.
ordered_json list_of(const std::vector<BenchRow>& rows, const std::string& processor) {
  ordered_json list = ordered_json::array();
  for (const BenchRow& row : rows) {
    list.push_back(json_of(row, rows));
    ordered_json again = list.back();
    if (row.work->name == "load_clip") {
      again["name"] = "load";
      list.push_back(again);
    }
    if (again.value("stage", "") == "ik") {
      again.erase("stage");
      again["name"] = "leg_ik";
      for (const char* key : {"ns", "ns_low", "ns_high", "time_us"})
        again[key] = 0.5 * again[key].get<double>();
      list.push_back(again);
    }
  }
  for (ordered_json& row : list) {
    row["processor"] = processor;
    row["lanes"] = widest_lanes();
  }
  return list;
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

// A character's time over the size of its crowd, for each width, with bare playback as lines
// across.
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
  const auto works = bench_work(arguments.most_characters);
  if (!works) return fail("bench", works.error().message);
  const Cores cores;
  const std::vector<BenchRow> rows = measured(*works, arguments.rounds, cores);
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
