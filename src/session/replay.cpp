#include "gaitpad/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/text.h"
#include "gaitpad/decode.h"
#include "pads/newest_reports.h"
#include "session/playback.h"
#include "session/walk_export.h"

namespace gaitpad {
namespace {

// Number of poses that are written per second.
Result<int> written_fps(const SessionSpec& spec, int rate_hz) {
  const int fps = spec.replay.fps.value_or(rate_hz);
  if (fps >= 1 && fps <= rate_hz) return fps;
  return Error{
      fmt::format("{} poses a second: 1 to {}, the tick rate, can be written", fps, rate_hz)};
}

Result<std::vector<WalkExport>> opened_exports(std::optional<OutputFiles>& files,
                                               const Simulation& simulation,
                                               const std::vector<ExportedFollower>& followers,
                                               const ExportFormat& format) {
  std::vector<WalkExport> exports;
  if (!files) return exports;
  std::vector<const Walker*> walkers;
  for (const Walker& walker : simulation.walkers()) walkers.push_back(&walker);
  for (const ExportedFollower& follower : followers) walkers.push_back(&follower.walker());
  for (std::size_t i = 0; i < walkers.size(); ++i) {
    auto opened = WalkExport::open(*files, *walkers[i], i, format);
    if (!opened) return opened.error();
    exports.push_back(std::move(*opened));
  }
  return exports;
}

// The followers whose walks are written to files.
std::vector<ExportedFollower> exported_followers(const SessionSpec& spec,
                                                 const Simulation& simulation) {
  std::vector<ExportedFollower> followers;
  if (spec.replay.out.empty()) return followers;
  const int count = std::min(spec.replay.crowd_files, simulation.followers().size());
  for (int i = 0; i < count; ++i) followers.emplace_back(simulation, i);
  return followers;
}

// Returns false if `progress` has ended the run.
bool run_to_end(const PreparedTrace& prepared, TraceRun& run,
                std::vector<ExportedFollower>& followers, std::vector<WalkExport>& exports,
                const ReplayProgress& progress) {
  constexpr std::int64_t kTicksBetween = 32;  // a tick of a large crowd takes milliseconds
  for (std::int64_t tick = 0; tick < prepared.ticks; ++tick) {
    if (progress && tick % kTicksBetween == 0 && !progress(tick, prepared.ticks)) return false;
    run.step(prepared);
    for (ExportedFollower& follower : followers) follower.follow(run.simulation());
    for (WalkExport& e : exports) e.write(tick, run.simulation().stick());
  }
  return true;
}

// Adds a remark on each pad whose reports never contain a stick.
void add_stickless(const PreparedTrace& prepared, std::vector<std::string>& remarks) {
  const std::vector<PadConfig>& pads = prepared.config.pads;
  std::vector<const TraceEvent*> stickless(pads.size());
  std::vector<bool> is_told(pads.size());
  Report report;
  for (const TraceEvent& event : prepared.trace.events) {
    if (event.kind != ReportKind::input || event.device >= pads.size()) continue;
    const PadConfig& pad = pads[event.device];
    if (is_told[event.device] || !pad.is_usable || !pad.layout) continue;
    copy_report(prepared.trace, event, report);
    const ReportLayout* layout = layout_of(*pad.layout, report);
    is_told[event.device] = layout != nullptr && tells_stick(*layout);
    stickless[event.device] = &event;
  }
  for (std::size_t i = 0; i < pads.size(); ++i) {
    if (is_told[i] || stickless[i] == nullptr) continue;
    copy_report(prepared.trace, *stickless[i], report);
    const DeviceInfo& info = prepared.trace.devices[i].info;
    remarks.push_back(fmt::format("{}: sends reports without a stick (id {:#04x})",
                                  in_quotes(info.name), report_id_of(*pads[i].layout, report)));
  }
}

std::vector<std::string> remarks_on(const PreparedTrace& prepared, const SimulationCounts& counts) {
  const Trace& trace = prepared.trace;
  std::vector<std::string> remarks = prepared.config.remarks;
  add_stickless(prepared, remarks);
  if (const auto remark = damage_remark(trace)) remarks.push_back(*remark);
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

Result<ReplayResult> replay(const SessionSpec& spec, const ReplayProgress& progress) {
  return Replayer().replay(spec, progress);
}

Replayer::Replayer() : set_ups_(std::make_unique<SetUps>()) {}
Replayer::~Replayer() = default;

Result<ReplayResult> Replayer::replay(const SessionSpec& spec, const ReplayProgress& progress) {
  SessionSpec unseen = spec;
  unseen.walk.shows_crowd = false;
  auto prepared = prepared_trace(unseen, *set_ups_);
  if (!prepared) return prepared.error();
  const int rate_hz = prepared->config.rate_hz;
  auto fps = written_fps(spec, rate_hz);
  if (!fps) return fps.error();
  TraceRun run = TraceRun::begin_only(*prepared);
  const Simulation& simulation = run.simulation();
  std::optional<OutputFiles> files;
  if (!spec.replay.out.empty()) {
    auto opened = OutputFiles::open(spec.replay.out);
    if (!opened) return opened.error();
    files.emplace(std::move(*opened));
  }
  std::vector<ExportedFollower> followers = exported_followers(spec, simulation);
  auto exports = opened_exports(files, simulation, followers, {rate_hz, *fps, spec.replay.gltf});
  if (!exports) return exports.error();

  if (!run_to_end(*prepared, run, followers, *exports, progress))
    return Error{spec.replay.trace + ": ended before its last tick; nothing was written"};
  ReplayResult result{run_summary(simulation, cast_of(simulation, prepared->config)), {}};
  result.summary.damaged_lines = prepared->trace.skipped_lines;
  std::vector<WalkerSummary> walked = result.summary.walkers;
  for (const ExportedFollower& follower : followers) walked.push_back(follower.summary(simulation));
  for (std::size_t i = 0; i < exports->size(); ++i) {
    if (auto problem = (*exports)[i].finish(summary_json(result.summary, walked[i])))
      return *problem;
  }
  if (files) {
    if (auto problem = files->publish()) return *problem;
  }
  result.remarks = remarks_on(*prepared, simulation.counts());
  return result;
}

}  // namespace gaitpad
