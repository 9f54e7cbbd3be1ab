// A trace made ready to run, for all who run one: its events and a script's by ticks, and the
// session as it was set up.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "hid/trace.h"
#include "session/setup.h"
#include "session/simulation.h"

namespace gaitpad {

struct PreparedTrace {
  Trace trace;
  std::int64_t ticks = 0;
  SimulationConfig config;  // its rate is the one to run at
  Simulation start;
};
// `rate_hz`: an error where the trace says another. None of its devices being a pad is an error,
// too.
Result<PreparedTrace> prepared_trace(const SessionOptions& session, const std::string& path,
                                     std::optional<int> rate_hz, Damage damage);
// "3 damaged lines were skipped, the first: ..."; none where none were.
std::optional<std::string> damage_remark(const Trace& trace);

// A place in a run: copies of it go on from there, each for itself.
class TraceRun {
 public:
  static TraceRun begin(const PreparedTrace& prepared) { return TraceRun(prepared.start); }

  // One tick with the reports that belong to it; `trace` is the one that it began with.
  void step(const Trace& trace) noexcept;
  std::int64_t ticks() const { return simulation_.counts().ticks; }  // so far
  const Simulation& simulation() const { return simulation_; }

 private:
  explicit TraceRun(Simulation simulation) : simulation_(std::move(simulation)) {}
  Simulation simulation_;
  std::size_t next_event_ = 0;
};

}  // namespace gaitpad
