#include "session/commands.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace gaitpad {
namespace {

using Verb = Command::Verb;

constexpr std::string_view kBlanks = " \t";

bool is_blank(std::string_view text) noexcept {
  return text.find_first_not_of(kBlanks) == std::string_view::npos;
}

// Cuts the first word off `text`.
std::string_view next_word(std::string_view& text) noexcept {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
  text.remove_prefix(word.size());
  return word;
}

// The whole word as a number.
template <class T>
std::optional<T> number(std::string_view word) noexcept {
  T value{};
  const char* end = word.data() + word.size();
  const auto result = std::from_chars(word.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return value;
}

// Cuts the walker's number off, where words follow it.
int next_walker(std::string_view& text) noexcept {
  std::string_view rest = text;
  const int n = number<int>(next_word(rest)).value_or(0);
  if (n <= 0 || is_blank(rest)) return 0;
  text = rest;
  return n;
}

// `KEY VALUE`, of which the key is in `command` already.
std::optional<Command> with_value(Command command, std::string_view word) noexcept {
  const auto value = number<double>(word);
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
