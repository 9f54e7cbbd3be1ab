// Commands, as a person or a recording gives them, and scripts: commands at given times of a
// session. config/README.md has both grammars (`C:` lines, scripts).
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/result.h"
#include "gaitpad/simulation.h"
#include "gaitpad/trace.h"

namespace gaitpad {

// What the text of a command asks for.
struct Command {
  enum class Verb : std::uint8_t {
    mark,     // nothing
    style,    // name
    set,      // name, value: a style value
    gait,     // name, value: a gait parameter
    release,  // `gait KEY stick`: name
    stick,    // `gait stick`: all parameters
    steers,   // `stick steers`
    points,   // `stick points`; value: the camera's heading, degrees
    restart,  // `reset`
    ik,       // name: paper or robust, for all walkers
  } verb = Verb::mark;
  int walker = 0;         // from 1; 0: all
  std::string_view name;  // points into the text
  double value = 0.0;     // finite
};
// Nothing if the text is malformed. Whether the names, the value and the walker exist is for the
// simulation to decide. No heap.
std::optional<Command> parsed_command(std::string_view text) noexcept;

// Why the text is no command for a session with these styles and so many characters; names what is
// known instead. None also where only the present style of a character makes it impossible (a limb
// whose joints would all be locked).
std::optional<std::string> command_problem(std::string_view text,
                                           std::span<const std::string> styles, int characters);

inline constexpr std::array<std::string_view, 2> kIkNames = {"paper", "robust"};  // by IkMode

inline constexpr std::size_t kMaxScriptEvents = 4096;

struct ScriptEvent {
  std::int64_t time_us = 0;  // of the session: tick 0 begins at 0
  std::string command;       // well-formed
  std::string where;         // "walk.toml:12", for sentences
};
struct Script {
  std::vector<ScriptEvent> events;  // in order of time
};
Result<Script> load_script(const std::string& path);
Result<Script> parsed_script(std::string_view text, const std::string& path);

// The first tick that begins at or after the event.
std::int64_t tick_of(const ScriptEvent& event, int rate_hz) noexcept;
Report report_of(const ScriptEvent& event) noexcept;

// The script of a file, checked against this simulation; an empty script if `path` is empty. Error
// also if the simulation could not obey a command: an unknown name, a value out of bounds, a
// character that does not exist.
Result<Script> script_for(const Simulation& simulation, const std::string& path);

// Inserts its events into a trace that has its ticks, each before the trace's own events of the
// same tick.
void add_script(const Script& script, int rate_hz, Trace& trace);

}  // namespace gaitpad
