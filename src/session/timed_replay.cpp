#include "session/timed_replay.h"

#include <algorithm>
#include <utility>

#include "gaitpad/pad_configuration.h"

namespace gaitpad {

Result<std::int64_t> play_reports(const Trace& trace, std::int64_t start_ns,
                                  const WaitUntil& wait_until,
                                  const std::function<std::optional<Error>(const Report&)>& take) {
  std::int64_t reports = 0;
  Report report;
  for (const TraceEvent& event : trace.events) {
    if (event.device == kNoDevice) continue;  // the event is a command to gaitpad, not a report
    const std::int64_t time_ns = (event.time_us - trace.events.front().time_us) * 1000;
    if (!wait_until(start_ns + time_ns)) break;
    copy_report(trace, event, report);
    if (auto problem = take(report)) return *problem;
    if (report.kind == ReportKind::input) ++reports;
  }
  return reports;
}

Result<TickedReplay> ticked_replay(const SessionSpec& spec, Trace trace) {
  const int rate_hz = replay_rate_hz(trace, spec.rate_hz);
  const auto files = load_pad_files(spec);
  if (!files) return files.error();
  auto configs = pad_configs(*files, trace.devices, trace.path);
  if (!configs) return configs.error();
  if (std::ranges::none_of(*configs, &PadConfig::is_usable))
    return Error{trace.path + ": none of its devices is a pad"};
  const auto ticks = assign_ticks(trace, rate_hz);
  if (!ticks) return ticks.error();
  return TickedReplay{std::move(trace), Pads(std::move(*configs), rate_hz), rate_hz, *ticks};
}

std::optional<std::int64_t> play_ticks(TickedReplay& replay, std::int64_t start_ns,
                                       const WaitUntil& wait_until,
                                       const std::function<bool(const VirtualPadState&)>& set) {
  std::int64_t reports = 0;
  ForwardedTick sent;
  Report report;
  auto event = replay.trace.events.begin();
  for (std::int64_t tick = 0; tick < replay.ticks; ++tick) {
    if (!wait_until(start_ns + tick * 1'000'000'000 / replay.rate_hz)) break;
    for (; event != replay.trace.events.end() && event->tick <= tick; ++event) {
      if (event->device == kNoDevice) continue;
      copy_report(replay.trace, *event, report);
      if (report.kind == ReportKind::added) replay.pads.add_pad(report.device);
      if (report.kind == ReportKind::removed) replay.pads.remove_pad(report.device);
      if (report.kind != ReportKind::input) continue;
      replay.pads.take_report(report);
      ++reports;
    }
    const ForwardedTick now = forwarded_tick(replay.pads, replay.pads.finish_tick());
    if (!set(between(sent, now)) || !set(now.state)) return std::nullopt;
    sent = now;
  }
  return reports;
}

}  // namespace gaitpad
