// A recording as a session: prepared to run, run from its beginning (TraceRun), or moved through on
// a time line (Playback).
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

namespace gaitpad {

struct PreparedTrace {
  Trace trace;  // its events, and the script's, have their ticks
  std::int64_t ticks = 0;
  SimulationConfig config;  // its rate is the one to run at
  Simulation start;
  std::vector<StyleChange> style_changes;
  std::vector<UsedFile> used_files;  // besides the recording
};
// Reads `spec.replay.trace` and every file of the session, and adds the script's events. Error
// also: `spec.rate_hz` differs from the trace's rate, or none of the trace's devices is a pad.
Result<PreparedTrace> prepared_trace(const SessionSpec& spec);

// A place in a run. Copies go on from there, independent of each other.
class TraceRun {
 public:
  static TraceRun begin(const PreparedTrace& prepared) { return TraceRun(prepared.start); }

  // Runs one tick with the reports that belong to it. `prepared`: what it began with.
  void step(const PreparedTrace& prepared) noexcept;
  std::int64_t ticks() const { return simulation_.counts().ticks; }  // so far
  const Simulation& simulation() const { return simulation_; }

 private:
  explicit TraceRun(Simulation simulation) : simulation_(std::move(simulation)) {}
  Simulation simulation_;
  std::size_t next_event_ = 0, next_change_ = 0;
};

struct PlaybackMark {  // for the time line
  std::int64_t tick = 0;
  std::string text;  // `style limp_left`, `unplugged`, `plugged in`
};

// A trace on a time line: goes to any tick of it, exactly. It keeps snapshots of the simulation
// along the way and computes again what lies between them.
class Playback {
 public:
  static constexpr int kHistoryTicks = 1440;  // of samples before a place after a jump
  static constexpr std::size_t kMaxMarks = 4096;

  // The same errors as replay().
  static Result<std::unique_ptr<Playback>> open(const SessionSpec& spec);
  ~Playback();

  const Cast& cast() const noexcept;
  std::int64_t ticks() const noexcept;  // as replay runs it
  // Commands (except a bare `mark`) and plugging, in order of time; the first kMaxMarks.
  const std::vector<PlaybackMark>& marks() const noexcept;
  // What a user should know: damaged lines that were skipped.
  const std::vector<std::string>& remarks() const noexcept;
  // The devices of the trace by their index.
  const std::vector<TraceDevice>& devices() const noexcept;

  // Goes towards the state after `tick` (clamped to 0 .. ticks()-1), computing at most `budget`
  // ticks. frame() is then the place that it reached; false: not there yet, call it again. Up to
  // kHistoryTicks ahead it simply goes on. Everything else is a jump: it starts at the snapshot
  // before the history, so a jump into a known part costs kHistoryTicks and about a second of
  // ticks.
  bool seek(std::int64_t tick, int budget);
  const SessionFrame& frame() const noexcept;  // tick -1, standing, before the first seek()
  // The oldest sample that was not taken yet; false: there is none. None is left out if seek() goes
  // on without a jump and no more than kHistoryTicks wait. After a jump they begin again,
  // kHistoryTicks before the place; TickSample::tick says where.
  bool take_sample(TickSample& sample);
  // Of all ticks up to frame(); at the end the same as replay()'s.
  RunSummary summary() const;
  std::uint64_t pose_hash() const noexcept;

 private:
  Playback();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gaitpad
