// A trace made ready to run, for all who run one: its events and a script's by ticks, and the
// session as it was set up.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gaitpad/result.h"
#include "gaitpad/session_frame.h"
#include "gaitpad/setup.h"
#include "gaitpad/simulation.h"
#include "gaitpad/trace.h"

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

// A trace on a time line: any tick of it, exact, from the deterministic core. Snapshots of the
// simulation's state stand along the way, what is between them is computed again.

struct PlaybackMark {  // for the time line
  std::int64_t tick = 0;
  std::string text;  // `style limp_left`, `unplugged`, `plugged in`
};

class Playback {
 public:
  static constexpr int kHistoryTicks = 1440;  // of samples before a place that was jumped to
  static constexpr std::size_t kMaxMarks = 4096;

  // As `replay` opens it, the same errors.
  static Result<std::unique_ptr<Playback>> open(const SessionOptions& session,
                                                const std::string& trace,
                                                std::optional<int> rate_hz, Damage damage);
  ~Playback();

  const Cast& cast() const noexcept;
  std::int64_t ticks() const noexcept;  // as replay runs it
  // Commands (but for a bare `mark`) and plugging, in order of time; the first kMaxMarks.
  const std::vector<PlaybackMark>& marks() const noexcept;
  // What a user should know: damaged lines that were skipped.
  const std::vector<std::string>& remarks() const noexcept;
  // The devices of the trace by their index.
  const std::vector<TraceDevice>& devices() const noexcept;

  // On the way to the state after `tick` (clamped to 0 .. ticks()-1), computing at most `budget`
  // ticks; false: not there yet, ask again. frame() is then the place that was reached.
  // Up to kHistoryTicks ahead it goes on, everything else is a jump: from the snapshot before the
  // history, so about kHistoryTicks and a second's ticks are computed where it has been before.
  bool seek(std::int64_t tick, int budget);
  const SessionFrame& frame() const noexcept;  // tick -1, standing, before the first seek()
  // The oldest sample that was not taken yet; none is left out as long as seek() goes on and they
  // are taken before there are more than kHistoryTicks. After a jump they begin again,
  // kHistoryTicks before the place (TickSample::tick tells).
  bool take(TickSample& sample);
  // Over all ticks up to frame(): at the end the same as replay's.
  std::uint64_t pose_hash() const noexcept;

 private:
  Playback();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gaitpad
