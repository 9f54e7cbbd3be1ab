// Plays a recording in real time to another program: its reports, or its calibrated pad tick by
// tick.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>

#include "gaitpad/pads.h"
#include "gaitpad/report.h"
#include "gaitpad/result.h"
#include "gaitpad/session_spec.h"
#include "gaitpad/trace.h"
#include "session/pad_forward.h"

namespace gaitpad {

// Waits until a time of now_ns(). Returns false if the user ends the playback earlier.
using WaitUntil = std::function<bool(std::int64_t time_ns)>;

// Hands each report, plug and unplug to `take` at `start_ns` plus its time since the first event.
// Leaves out the commands, which are for gaitpad. Returns the number of input reports. Error: the
// first one that `take` returns; the playback ends there.
Result<std::int64_t> play_reports(const Trace& trace, std::int64_t start_ns,
                                  const WaitUntil& wait_until,
                                  const std::function<std::optional<Error>(const Report&)>& take);

// A recording that is ready to be played tick by tick.
struct TickedReplay {
  Trace trace;
  Pads pads;
  int rate_hz = kDefaultRateHz;
  std::int64_t ticks = 0;
};
// Error: a file of the session is wrong, or none of the recorded devices is a pad.
Result<TickedReplay> ticked_replay(const SessionSpec& spec, Trace trace);
// Hands the state of the driving pad after each tick to `set`; if a button was pressed and released
// between two ticks, also the state with that press before it. Tick 0 is at `start_ns`. Returns the
// number of input reports; nothing if `set` returned false.
std::optional<std::int64_t> play_ticks(TickedReplay& replay, std::int64_t start_ns,
                                       const WaitUntil& wait_until,
                                       const std::function<bool(const VirtualPadState&)>& set);

}  // namespace gaitpad
