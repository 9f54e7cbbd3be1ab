// Commands, as a user or a recording gives them, and scripts: commands at given times of a session.
// config/README.md has both grammars (`C:` lines, scripts).
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

// A parsed command.
struct Command {
  enum class Verb : std::uint8_t {
    mark,     // has no effect
    style,    // needs a name
    set,      // a style value; needs a name and a value
    gait,     // a gait parameter; needs a name and a value
    release,  // `gait KEY stick`: the stick sets the parameter again; needs a name
    stick,    // `gait stick`: the stick sets all parameters again
    steers,   // `stick steers`
    points,   // `stick points`; value: the camera's heading, degrees
    restart,  // `reset`
    ik,       // a mode, paper or robust, for all walkers; needs a name
  } verb = Verb::mark;
  int walker = 0;         // number of the walker, from 1; 0: all walkers
  std::string_view name;  // the name in the command; points into its text
  double value = 0.0;     // the value; finite
};
// Returns nothing if the text is malformed. The simulation checks whether the names, the value and
// the walker exist. No heap.
std::optional<Command> parsed_command(std::string_view text) noexcept;

// Explains why the text is no command for a session with these styles and this number of
// characters, and lists the known names. Returns none if only a character's present style makes the
// command impossible (a limb with all joints locked).
std::optional<std::string> command_problem(std::string_view text,
                                           std::span<const std::string> styles, int characters);

// Names, indexed by IkMode.
inline constexpr std::array<std::string_view, 2> kIkNames = {"paper", "robust"};

inline constexpr std::size_t kMaxScriptEvents = 4096;

struct ScriptEvent {
  std::int64_t time_us = 0;  // time since tick 0
  std::string command;       // a well-formed command
  std::string where;         // place in the script, "walk.toml:12", for messages
};
struct Script {
  std::vector<ScriptEvent> events;  // events in order of time
};
Result<Script> load_script(const std::string& path);
Result<Script> parsed_script(std::string_view text, const std::string& path);

// The first tick that begins at or after the event.
std::int64_t tick_of(const ScriptEvent& event, int rate_hz) noexcept;
Report report_of(const ScriptEvent& event) noexcept;

// Loads the script and checks it against this simulation; an empty `path` gives an empty script.
// Also an error: the simulation cannot obey a command: an unknown name, a value out of bounds, or a
// character that does not exist.
Result<Script> script_for(const Simulation& simulation, const std::string& path);

// Inserts the script's events into a trace that has ticks, before the trace's own events of the
// same tick.
void add_script(const Script& script, int rate_hz, Trace& trace);

}  // namespace gaitpad
