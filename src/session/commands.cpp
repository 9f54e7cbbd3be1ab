#include "session/commands.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"

namespace gaitpad {
namespace {

using Verb = Command::Verb;

constexpr std::string_view kGaps = " \t";  // between the words of a command

bool is_blank(std::string_view text) noexcept {
  return text.find_first_not_of(kGaps) == std::string_view::npos;
}

// Cuts the first word off `text`.
std::string_view next_word(std::string_view& text) noexcept { return take_word(text, kGaps); }

// Cuts the walker's number off, where words follow it.
int next_walker(std::string_view& text) noexcept {
  std::string_view rest = text;
  const int n = parse_number<int>(next_word(rest)).value_or(0);
  if (n <= 0 || is_blank(rest)) return 0;
  text = rest;
  return n;
}

// `KEY VALUE`, of which the key is in `command` already.
std::optional<Command> with_value(Command command, std::string_view word) noexcept {
  const auto value = parse_number<double>(word);
  if (!value || !std::isfinite(*value)) return std::nullopt;
  command.value = *value;
  return command;
}

std::optional<Command> gait_command(Command command, std::string_view second) noexcept {
  if (command.name == "stick") {
    command.verb = Verb::stick;
    return second.empty() ? std::optional(command) : std::nullopt;
  }
  if (second != "stick") return with_value(command, second);
  command.verb = Verb::release;
  return command;
}

}  // namespace

std::optional<Command> parsed_command(std::string_view text) noexcept {
  const std::string_view verb = next_word(text);
  Command command;
  if (verb == "mark") return command;
  if (verb != "reset") command.walker = next_walker(text);
  command.name = next_word(text);
  const std::string_view second = next_word(text);
  if (!next_word(text).empty()) return std::nullopt;
  if (verb == "reset") {
    command.verb = Verb::restart;
    return command.name.empty() ? std::optional(command) : std::nullopt;
  }
  if (command.name.empty()) return std::nullopt;
  if (verb == "style") {
    command.verb = Verb::style;
    return second.empty() ? std::optional(command) : std::nullopt;
  }
  command.verb = verb == "set" ? Verb::set : Verb::gait;
  if (verb == "set") return with_value(command, second);
  return verb == "gait" ? gait_command(command, second) : std::nullopt;
}

}  // namespace gaitpad
