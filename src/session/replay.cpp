#include "session/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "session/output_files.h"
#include "session/summary.h"
#include "session/walk_export.h"

namespace gaitpad {
namespace {

struct Run {
  Trace trace;
  std::int64_t ticks = 0;
  int rate_hz = 0, fps = 0;
};

Result<Run> prepared_run(const ReplayOptions& options) {
  auto trace = read_trace(options.trace, options.damage);
  if (!trace) return trace.error();
  Run run;
  run.rate_hz = replay_rate_hz(*trace, options.rate_hz);
  run.fps = options.fps.value_or(run.rate_hz);
  if (run.fps < 1 || run.fps > run.rate_hz) {
    return Error{fmt::format("{} poses a second: 1 to {}, the tick rate, can be written", run.fps,
                             run.rate_hz)};
  }
  auto ticks = assign_ticks(*trace, run.rate_hz);
  if (!ticks) return ticks.error();
  run.ticks = *ticks;
  run.trace = std::move(*trace);
  return run;
}

Result<std::vector<WalkExport>> opened_exports(std::optional<OutputFiles>& files,
                                               const Simulation& simulation, const Run& run) {
  std::vector<WalkExport> exports;
  if (!files) return exports;
  for (std::size_t i = 0; i < simulation.walkers().size(); ++i) {
    auto opened = WalkExport::open(*files, simulation.walkers()[i], i, run.rate_hz, run.fps);
    if (!opened) return opened.error();
    exports.push_back(std::move(*opened));
  }
  return exports;
}

// A device that is plugged in later says so in its first event. Without any pad the walk has no
// stick.
std::optional<Error> settle_pads(const Trace& trace, std::vector<PadConfig>& pads) {
  std::vector<bool> is_seen(pads.size(), false);
  for (const TraceEvent& event : trace.events) {
    if (event.device >= pads.size() || is_seen[event.device]) continue;
    is_seen[event.device] = true;
    pads[event.device].is_present = event.kind != ReportKind::added;
  }
  if (std::ranges::any_of(pads, &PadConfig::is_usable)) return std::nullopt;
  return Error{trace.path + ": none of its devices is a pad with a stick"};
}

// Every tick with its reports; the path length of each walker comes out.
std::vector<double> walked_m(const Run& run, Simulation& simulation,
                             std::vector<WalkExport>& exports) {
  const std::vector<Walker>& walkers = simulation.walkers();
  std::vector<double> distance_m(walkers.size(), 0.0);
  std::vector<vec3> before_m;
  for (const Walker& w : walkers) before_m.push_back(w.state.hips_m);
  std::vector<Report> reports;
  std::size_t next = 0;
  for (std::int64_t tick = 0; tick < run.ticks; ++tick) {
    reports.clear();
    for (; next < run.trace.events.size() && run.trace.events[next].tick == tick; ++next) {
      reports.push_back(report_of(run.trace, run.trace.events[next]));
    }
    simulation.step(reports);
    for (std::size_t i = 0; i < walkers.size(); ++i) {
      const vec3 way_m =
          walkers[i].state.hips_m - std::exchange(before_m[i], walkers[i].state.hips_m);
      distance_m[i] += glm::length(vec2(way_m.x, way_m.z));
    }
    for (WalkExport& e : exports) e.write(tick, simulation.stick());
  }
  return distance_m;
}

std::vector<std::string> remarks_on(const Run& run, const SimulationCounts& counts) {
  std::vector<std::string> remarks;
  if (run.trace.skipped_lines > 0) {
    remarks.push_back(fmt::format("{} damaged lines were skipped, the first: {}",
                                  run.trace.skipped_lines, run.trace.first_damage));
  }
  if (counts.bad_reports > 0) {
    remarks.push_back(fmt::format("{} of {} reports were not what the device's descriptor promises",
                                  counts.bad_reports, counts.reports));
  }
  if (counts.bad_commands > 0) {
    remarks.push_back(
        fmt::format("{} of {} commands could not be obeyed", counts.bad_commands, counts.commands));
  }
  return remarks;
}

}  // namespace

Result<ReplayResult> replay(const ReplayOptions& options) {
  auto run = prepared_run(options);
  if (!run) return run.error();
  auto config =
      simulation_config(options.session, run->trace.devices, run->trace.path, run->rate_hz);
  if (!config) return config.error();
  if (auto problem = settle_pads(run->trace, config->pads)) return *problem;
  auto simulation = Simulation::create(*config);
  if (!simulation) return simulation.error();
  std::optional<OutputFiles> files;
  if (!options.out.empty()) {
    auto opened = OutputFiles::open(options.out);
    if (!opened) return opened.error();
    files.emplace(std::move(*opened));
  }
  auto exports = opened_exports(files, *simulation, *run);
  if (!exports) return exports.error();

  ReplayResult result;
  result.distance_m = walked_m(*run, *simulation, *exports);
  for (std::size_t i = 0; i < simulation->walkers().size(); ++i) {
    result.summaries.push_back(
        run_summary(*simulation, simulation->walkers()[i], run->rate_hz, run->trace.skipped_lines));
    if (files) (*exports)[i].finish(result.summaries.back());
  }
  if (files) {
    if (auto problem = files->publish()) return *problem;
  }
  result.remarks = remarks_on(*run, simulation->counts());
  return result;
}

}  // namespace gaitpad
