// What the text of a command asks for. The grammar stands in config/README.md, `C:` lines.
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

namespace gaitpad {

struct Command {
  enum class Verb : std::uint8_t {
    mark,     // nothing
    style,    // name
    set,      // name, value: a style value
    gait,     // name, value: a gait parameter
    release,  // `gait KEY stick`: name
    stick,    // `gait stick`: all parameters
    restart,  // `reset`
  } verb = Verb::mark;
  int walker = 0;         // from 1; 0: all
  std::string_view name;  // within the text
  double value = 0.0;     // finite
};
// None where it is malformed. Whether names, bounds and the walker exist is not looked at. No heap.
std::optional<Command> parsed_command(std::string_view text) noexcept;

}  // namespace gaitpad
