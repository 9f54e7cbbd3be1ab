// A script: commands at given times of a session, besides those that people give.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/result.h"
#include "gaitpad/simulation.h"
#include "gaitpad/trace.h"

namespace gaitpad {

inline constexpr std::size_t kMaxScriptEvents = 4096;

struct ScriptEvent {
  std::int64_t time_us = 0;  // of the session: tick 0 begins at 0
  std::string command;       // well-formed
  std::string where;         // "walk.toml:12", for sentences
};
// Immutable after load, in the order of time.
struct Script {
  std::vector<ScriptEvent> events;
};
// The grammar stands in config/README.md.
Result<Script> load_script(const std::string& path);
Result<Script> parsed_script(std::string_view text, const std::string& path);

// The first tick that begins at or after it.
std::int64_t tick_of(const ScriptEvent& event, int rate_hz) noexcept;
Report report_of(const ScriptEvent& event) noexcept;

// A file's, for such a session; of an empty path none. What that could not obey is an error:
// unknown names, values out of bounds, characters that are not there.
Result<Script> script_for(const Simulation& simulation, const std::string& path);

// Its events ahead of the trace's own of the same tick. `trace` has its ticks.
void add_script(const Script& script, int rate_hz, Trace& trace);

}  // namespace gaitpad
