// gaitpad bench: how long a tick takes, and its inverse kinematics, beside bare playback; and how
// long a motion takes to load.
#include <CLI/CLI.hpp>

#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"

#ifdef GAITPAD_HAS_BENCH
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "animation/walk_parts.h"
#include "files/stride_cache.h"
#include "gaitpad/config_files.h"
#include "gaitpad/session_spec.h"
#include "gaitpad/trace.h"

namespace gaitpad {
namespace {

using nlohmann::ordered_json;

constexpr double kLimit_us = 20.0;  // for one tick of four characters on one core
constexpr int kLimitWalkers = 4;
constexpr double kBuiltInLimit_us = 0.15e6, kClipLimit_us = 0.8e6;  // to load a motion
constexpr std::int64_t kFirstTick = 480,
                       kLastTick = 2880;  // of the bundled trace: walking, turning

struct Session {
  SimulationConfig config;
  std::vector<std::vector<Report>> ticks;
};

std::string bundled_trace(const std::vector<std::string>& config_folders) {
  const std::string name = "traces/round.hid";
  for (const std::string& folder : config_folders) {
    const std::filesystem::path path = std::filesystem::path(folder) / name;
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored)) return path.string();
  }
  return name;
}

Result<Session> bench_session(const std::vector<std::string>& styles) {
  SessionSpec spec;
  spec.config_folders = config_folders();
  spec.walk.styles = styles;
  auto trace = read_trace(bundled_trace(spec.config_folders));
  if (!trace) return trace.error();
  const int rate_hz = replay_rate_hz(*trace, std::nullopt);
  const auto count = assign_ticks(*trace, rate_hz);
  if (!count) return count.error();
  const auto files = load_pad_files(spec);
  if (!files) return files.error();
  auto pads = pad_configs(*files, trace->devices, trace->path);
  if (!pads) return pads.error();
  auto config = simulation_config(spec, rate_hz);
  if (!config) return config.error();
  config->pads = std::move(*pads);
  Session session{std::move(*config), {}};
  session.ticks.resize(static_cast<std::size_t>(kLastTick));
  for (const TraceEvent& event : trace->events) {
    if (event.tick < kLastTick) session.ticks[event.tick].push_back(report_of(*trace, event));
  }
  return session;
}

// Keeps what Google Benchmark measures: the time of one pass of the function.
class Collected : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type == Run::RT_Iteration) time_us = run.GetAdjustedRealTime() / 1e3;
    }
  }
  double time_us = 0.0;
};

template <class F>
double measured_us(const std::string& name, F pass) {
  benchmark::ClearRegisteredBenchmarks();
  benchmark::RegisterBenchmark(name.c_str(), [&pass](benchmark::State& state) {
    for (auto _ : state) pass();
  })->MinTime(0.5);
  Collected collected;
  benchmark::RunSpecifiedBenchmarks(&collected);
  return collected.time_us;
}

struct StepCost {
  double time_us = 0.0;
  double iterations_a_leg = 0.0;
};

StepCost step_cost(const Session& session, Simulation simulation) {
  std::int64_t tick = 0;
  for (; tick < kFirstTick; ++tick) simulation.step(session.ticks[tick]);
  std::int64_t iterations = 0, legs = 0;
  StepCost cost;
  cost.time_us = measured_us("step", [&] {
    simulation.step(session.ticks[tick]);
    if (++tick == kLastTick) tick = kFirstTick;
    for (const Walker& w : simulation.walkers()) {
      for (const int n : w.state.frame.ik_iterations) iterations += n;
      legs += 2;
    }
  });
  cost.iterations_a_leg = static_cast<double>(iterations) / static_cast<double>(legs);
  return cost;
}

// One leg's inverse kinematics alone, over the states of a walk.
double leg_ik_us(const Session& session, Simulation simulation) {
  const Walker& w = simulation.walkers().front();
  std::vector<WalkState> states;
  std::vector<StridePlan> plans;
  std::vector<Pelvis> pelvises;
  for (std::int64_t tick = 0; tick < kLastTick; ++tick) {
    simulation.step(session.ticks[tick]);
    if (tick < kFirstTick || tick % 8 != 0) continue;
    states.push_back(w.state);
    plans.push_back(stride_now(*w.model, w.state));
    Pelvis& pelvis = pelvises.emplace_back(pelvis_over_ground(*w.model, w.state, plans.back()));
    pelvis.position_m.y = w.state.frame.pelvis_m.y;
  }
  const GaitParams params = gait_params(simulation.stick(), simulation.styles()[w.style], w.limits);
  const Tick tick{*w.model, params, 1.0 / session.config.rate_hz, is_flat(*w.model->terrain)};
  std::size_t i = 0;
  return measured_us("legs",
                     [&] {
                       pose_legs(tick, session.config.ik, plans[i], pelvises[i], states[i]);
                       i = (i + 1) % states.size();
                     }) /
         2.0;
}

// The peer: the same motion played back without feet that hold the ground.
double playback_us(const Session& session) {
  Pose pose;
  double phase = 0.0;
  return measured_us("playback", [&] {
    for (int n = 0; n < kLimitWalkers; ++n) sample_local(session.config.cycle, phase, pose);
    phase += 1.0 / session.config.rate_hz;
    benchmark::DoNotOptimize(pose);
  });
}

// Times to make a character of a motion in memory: of the built-in one, of the same as a captured
// clip, whose halves are not known to be alike, and of that with a cache that knows its strides.
struct LoadCost {
  double built_in_us = 0.0, clip_us = 0.0, cached_us = 0.0;
};

Result<LoadCost> load_cost() {
  namespace fs = std::filesystem;
  std::optional<Error> problem;
  const auto load = [&problem](Result<GaitCycle> cycle, const std::string& cache) {
    if (cycle) cycle = cached_clean_strides(std::move(*cycle), cache);
    if (!cycle) return void(problem = cycle.error());
    const auto model = walk_model(*cycle, Character{});
    if (!model) problem = model.error();
  };
  const Motion clip = procedural_motion();
  std::error_code ignored;
  const fs::path cache =
      fs::temp_directory_path(ignored) / fmt::format("gaitpad_bench_{}", ::getpid());
  LoadCost cost;
  cost.built_in_us = measured_us("built-in", [&] { load(procedural_gait(), ""); });
  cost.clip_us = measured_us("clip", [&] { load(gait_cycle(clip), ""); });
  load(gait_cycle(clip), cache.string());
  cost.cached_us = measured_us("cached", [&] { load(gait_cycle(clip), cache.string()); });
  fs::remove_all(cache, ignored);
  if (problem) return *problem;
  return cost;
}

Result<ordered_json> measured() {
  auto one = bench_session({"even"});
  if (!one) return one.error();
  auto four = bench_session({"even", "stiff_hip", "stiff_knee", "limp_left"});
  if (!four) return four.error();
  auto one_walker = Simulation::create(one->config);
  if (!one_walker) return one_walker.error();
  auto four_walkers = Simulation::create(four->config);
  if (!four_walkers) return four_walkers.error();

  const StepCost single = step_cost(*one, *one_walker);
  const StepCost many = step_cost(*four, *four_walkers);
  const double leg_us = leg_ik_us(*one, *one_walker);
  const double peer_us = playback_us(*four);
  const auto load = load_cost();
  if (!load) return load.error();
  const auto row = [](const char* name, int characters, double time_us) {
    return ordered_json{{"name", name}, {"characters", characters}, {"time_us", time_us}};
  };
  ordered_json list = {row("step", 1, single.time_us),
                       row("step", kLimitWalkers, many.time_us),
                       row("leg_ik", 1, leg_us),
                       row("playback", kLimitWalkers, peer_us),
                       row("load_built_in", 1, load->built_in_us),
                       row("load_clip", 1, load->clip_us),
                       row("load_cached", 1, load->cached_us)};
  list[0]["iterations_per_leg"] = single.iterations_a_leg;
  list[1]["iterations_per_leg"] = many.iterations_a_leg;
  list[1]["limit_us"] = kLimit_us;
  list[1]["ratio_to_limit"] = many.time_us / kLimit_us;
  for (const auto& [at, limit_us] : {std::pair(4, kBuiltInLimit_us), {5, kClipLimit_us}}) {
    list[at]["limit_us"] = limit_us;
    list[at]["ratio_to_limit"] = list[at]["time_us"].get<double>() / limit_us;
  }
  list[1]["peer"] = "playback";
  list[1]["ratio_to_peer"] = many.time_us / peer_us;
  return list;
}

void print_text(const ordered_json& list) {
  const auto time = [&list](int i) { return list[i]["time_us"].get<double>(); };
  fmt::print("step, 1 character (even)            {:8.2f} us   {:.1f} IK iterations a leg\n",
             time(0), list[0]["iterations_per_leg"].get<double>());
  fmt::print("step, 4 characters (even, 3 styles) {:8.2f} us   {:.1f} IK iterations a leg\n",
             time(1), list[1]["iterations_per_leg"].get<double>());
  fmt::print("  of the limit of {:.0f} us            {:8.2f} x\n", kLimit_us,
             list[1]["ratio_to_limit"].get<double>());
  fmt::print("  of playback alone (the peer)      {:8.2f} x   (4 characters {:.2f} us)\n",
             list[1]["ratio_to_peer"].get<double>(), time(3));
  fmt::print("inverse kinematics of one leg       {:8.2f} us   {:.0f} % of a step with two legs\n",
             time(2), 200.0 * time(2) / time(0));
  const auto load = [&](const char* what, int at) {
    fmt::print("load of {:27} {:8.2f} ms   {:.2f} x of the limit of {:.0f} ms\n", what,
               time(at) / 1e3, list[at]["ratio_to_limit"].get<double>(),
               list[at]["limit_us"].get<double>() / 1e3);
  };
  load("the built-in motion", 4);
  load("a clip", 5);
  fmt::print("  with its strides in the cache     {:8.2f} ms\n", time(6) / 1e3);
}

int run(bool as_json) {
  const auto list = measured();
  if (!list) return fail("bench", list.error().message);
  if (as_json) {
    print_json(*list);
  } else {
    print_text(*list);
  }
  return 0;
}

}  // namespace

void add_bench(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "bench", "the times that a tick and loading a motion take, beside their limits");
  const auto as_json = std::make_shared<bool>(false);
  command->add_flag("--json", *as_json, "a list of measurements, for machines");
  command->callback([as_json, &status] { status = run(*as_json); });
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
