// A recording as a session: prepared_trace() reads it, TraceRun runs it from its beginning, and
// Playback moves through it on a time line.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gaitpad/result.h"
#include "gaitpad/session_frame.h"
#include "gaitpad/session_spec.h"
#include "gaitpad/simulation.h"
#include "gaitpad/summary.h"
#include "gaitpad/trace.h"
#include "session/recorded_session.h"
#include "session/set_up.h"

namespace gaitpad {

struct PreparedTrace {
  Trace trace;  // the recording's events, and the script's, with their ticks
  std::int64_t ticks = 0;
  SimulationConfig config;  // the configuration, with the rate to run at
  Simulation start;
  std::vector<StyleChange> style_changes;
  std::vector<UsedFile> used_files;  // files of the recording, except the recording itself
};
// Reads `spec.replay.trace` and every file of the session, and adds the script's events. Also an
// error: `spec.rate_hz` differs from the trace's rate or none of the trace's devices is a pad.
Result<PreparedTrace> prepared_trace(const SessionSpec& spec);
// The same, for one of several recordings: takes what it shares with the one before from `set_ups`.
Result<PreparedTrace> prepared_trace(const SessionSpec& spec, SetUps& set_ups);

// State of a run after some ticks. A copy continues independently.
class TraceRun {
 public:
  static TraceRun begin(const PreparedTrace& prepared) { return TraceRun(prepared.start); }
  // The only run of `prepared`: takes its start, so that a large crowd is not copied.
  static TraceRun begin_only(PreparedTrace& prepared) {
    return TraceRun(std::move(prepared.start));
  }

  // Runs one tick with its reports. `prepared` must be the one given to begin().
  void step(const PreparedTrace& prepared) noexcept;
  std::int64_t ticks() const { return simulation_.counts().ticks; }  // Number of ticks so far.
  const Simulation& simulation() const { return simulation_; }

 private:
  explicit TraceRun(Simulation simulation) : simulation_(std::move(simulation)) {}
  Simulation simulation_;
  std::size_t next_event_ = 0, next_change_ = 0;
};

struct PlaybackMark {  // a mark of the time line
  std::int64_t tick = 0;
  std::string text;  // `style limp_left`, `unplugged`, `plugged in`
};

// Moves to any tick of a trace, exactly. It keeps snapshots of the simulation and computes the
// ticks between them again.
class Playback {
 public:
  static constexpr int kHistoryTicks = 1440;  // ticks before the target of a jump that have samples
  static constexpr std::size_t kMaxMarks = 4096;

  // Fails with the errors of replay().
  static Result<std::unique_ptr<Playback>> open(const SessionSpec& spec);
  ~Playback();

  const Cast& cast() const noexcept;
  std::int64_t ticks() const noexcept;  // number of ticks that replay() runs
  // Commands (except a bare `mark`) and plugging, ordered by time; at most kMaxMarks.
  const std::vector<PlaybackMark>& marks() const noexcept;
  // Sentences for the user: damaged lines that were skipped.
  const std::vector<std::string>& remarks() const noexcept;
  // The trace's devices by index.
  const std::vector<TraceDevice>& devices() const noexcept;

  // Moves towards the state after `tick` (clamped to 0 .. ticks()-1) and computes at most `budget`
  // ticks. frame() then shows the state that was reached; false: not there yet, call again. A
  // target up to kHistoryTicks ahead is reached tick by tick. Any other is a jump, which starts at
  // the snapshot before the target's history. A jump into a part that was computed before costs
  // kHistoryTicks and about one second of ticks.
  bool seek(std::int64_t tick, int budget);
  // The frame of the present tick; before the first seek() tick -1, standing.
  const SessionFrame& frame() const noexcept;
  // Takes the oldest sample that was not taken yet; false: there is none. None is lost while seek()
  // does not jump and at most kHistoryTicks samples wait. After a jump the samples begin
  // kHistoryTicks before the target; TickSample::tick tells the tick.
  bool take_sample(TickSample& sample);
  // Summary of all ticks up to frame(); at the end it equals replay()'s.
  RunSummary summary() const;
  std::uint64_t pose_hash() const noexcept;

 private:
  Playback();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gaitpad
