#include "session/trace_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "session/script.h"

namespace gaitpad {
namespace {

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

}  // namespace

Result<PreparedTrace> prepared_trace(const SessionOptions& session, const std::string& path,
                                     std::optional<int> rate_hz, Damage damage) {
  auto trace = read_trace(path, damage);
  if (!trace) return trace.error();
  const int rate = replay_rate_hz(*trace, rate_hz);
  auto ticks = assign_ticks(*trace, rate);
  if (!ticks) return ticks.error();
  auto config = simulation_config(session, trace->devices, trace->path, rate);
  if (!config) return config.error();
  if (auto problem = settle_pads(*trace, config->pads)) return *problem;
  auto start = Simulation::create(*config);
  if (!start) return start.error();
  auto script = script_for(*start, session.script);
  if (!script) return script.error();
  add_script(*script, rate, *trace);
  return PreparedTrace{std::move(*trace), *ticks, std::move(*config), std::move(*start)};
}

std::optional<std::string> damage_remark(const Trace& trace) {
  if (trace.skipped_lines == 0) return std::nullopt;
  return fmt::format("{} damaged lines were skipped, the first: {}", trace.skipped_lines,
                     trace.first_damage);
}

void TraceRun::step(const Trace& trace) noexcept {
  const std::int64_t tick = ticks();
  Report report;
  for (; next_event_ < trace.events.size() && trace.events[next_event_].tick == tick;
       ++next_event_) {
    copy_report(trace, trace.events[next_event_], report);
    simulation_.take(report);
  }
  simulation_.step({});
}

}  // namespace gaitpad
