#include "session/script.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/suggestion.h"
#include "base/text.h"
#include "files/toml_file.h"
#include "gaitpad/control.h"
#include "gaitpad/style.h"

namespace gaitpad {
namespace {

using Verb = Command::Verb;

constexpr std::string_view kGaps = " \t";  // characters between the words of a command
constexpr double kMostCamera_deg = 1e6;

std::string_view next_word(std::string_view& text) noexcept { return take_word(text, kGaps); }

// Removes and returns the walker's number if a word follows it.
int next_walker(std::string_view& text) noexcept {
  std::string_view rest = text;
  const int n = parse_number<int>(next_word(rest)).value_or(0);
  if (n <= 0 || trimmed(rest, kGaps).empty()) return 0;
  text = rest;
  return n;
}

// Parses the VALUE of `KEY VALUE`; `command` has the key already.
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

// Parses `steers` or `points [DEGREES]`; `command` has the first word.
std::optional<Command> stick_command(Command command, std::string_view camera_deg) noexcept {
  if (command.name == "steers" && camera_deg.empty()) {
    command.verb = Verb::steers;
    return command;
  }
  if (command.name != "points") return std::nullopt;
  command.verb = Verb::points;
  const auto given = camera_deg.empty() ? command : with_value(command, camera_deg);
  return given && std::abs(given->value) <= kMostCamera_deg ? given : std::nullopt;
}

}  // namespace

std::optional<Command> parsed_command(std::string_view text) noexcept {
  const std::string_view verb = next_word(text);
  Command command;
  if (verb == "mark") return command;
  if (verb != "reset" && verb != "stick") command.walker = next_walker(text);
  if (verb == "style") {  // the rest is the style's name, which may contain blanks
    command.verb = Verb::style;
    command.name = trimmed(text, kGaps);
    return command.name.empty() ? std::nullopt : std::optional(command);
  }
  command.name = next_word(text);
  const std::string_view second = next_word(text);
  if (!next_word(text).empty()) return std::nullopt;
  if (verb == "stick") return stick_command(command, second);
  if (verb == "reset") {
    command.verb = Verb::restart;
    return command.name.empty() ? std::optional(command) : std::nullopt;
  }
  if (command.name.empty()) return std::nullopt;
  if (verb == "ik") {
    command.verb = Verb::ik;
    const bool is_mode = command.name == kIkNames[0] || command.name == kIkNames[1];
    const bool is_for_all = command.walker == 0 && second.empty();
    return is_mode && is_for_all ? std::optional(command) : std::nullopt;
  }
  command.verb = verb == "set" ? Verb::set : Verb::gait;
  if (verb == "set") return with_value(command, second);
  return verb == "gait" ? gait_command(command, second) : std::nullopt;
}

namespace {

constexpr std::string_view kVerbs[] = {"style", "set", "gait", "stick", "reset", "ik", "mark"};
constexpr std::string_view kForms =
    "style [CHARACTER] NAME, set [CHARACTER] KEY VALUE, gait [CHARACTER] KEY VALUE|stick, gait "
    "[CHARACTER] stick, stick steers, stick points [CAMERA_DEGREES], reset [CHARACTER], ik "
    "paper|robust, mark";

std::optional<std::string> range_problem(std::string_view key, double value, double min,
                                         double max) {
  if (value >= min && value <= max) return std::nullopt;
  return fmt::format("{} of {:g} is not within {:g} .. {:g}", key, value, min, max);
}

std::optional<std::string> gait_problem(const Command& command) {
  if (const auto key = gait_key(command.name)) {
    if (command.verb == Verb::release) return std::nullopt;
    return range_problem(command.name, command.value, info_of(*key).min, info_of(*key).max);
  }
  std::vector<std::string_view> known;
  for (int k = 0; k < kGaitKeys; ++k) known.push_back(info_of(static_cast<GaitKey>(k)).name);
  return fmt::format("unknown gait parameter {}; known: {}", in_quotes(command.name),
                     fmt::join(known, ", "));
}

std::optional<std::string> set_problem(const Command& command) {
  std::vector<std::string> known;
  for (const StyleKey& key : style_keys()) {
    if (key.name == command.name) return range_problem(key.name, command.value, key.min, key.max);
    known.push_back(key.name);
  }
  const std::string nearest = suggestion(command.name, known);
  return fmt::format("unknown style value {}{}", in_quotes(command.name),
                     nearest.empty() ? "; config/README.md lists them" : nearest);
}

}  // namespace

std::optional<std::string> command_problem(std::string_view text,
                                           std::span<const std::string> styles, int characters) {
  const auto command = parsed_command(text);
  if (!command) {
    std::string_view rest = text;
    const std::string_view verb = next_word(rest);
    if (std::ranges::count(kVerbs, verb) == 0)
      return fmt::format("unknown command {}; known: {}", in_quotes(verb), fmt::join(kVerbs, ", "));
    return fmt::format("{} is no command; known: {}", in_quotes(text), kForms);
  }
  if (command->walker > characters)
    return fmt::format("there is no character {}; they are numbered 1 to {}", command->walker,
                       characters);
  switch (command->verb) {
    case Verb::style:
      if (std::ranges::count(styles, command->name) > 0) return std::nullopt;
      if (const std::string meant = suggestion(command->name, styles); !meant.empty())
        return fmt::format("unknown style {}{}", in_quotes(command->name), meant);
      return fmt::format("unknown style {}; known: {}", in_quotes(command->name),
                         fmt::join(styles, ", "));
    case Verb::set:
      return set_problem(*command);
    case Verb::gait:
    case Verb::release:
      return gait_problem(*command);
    default:
      return std::nullopt;
  }
}

namespace {

constexpr double kLatest_s = 86400.0;
constexpr std::size_t kMaxCommandBytes = 256;

ScriptEvent event_of(TomlTable& table, const std::string& path) {
  ScriptEvent event;
  for (const char* key : {"at_s", "command"}) table.require(key);
  const double at_s = table.number("at_s", 0.0, kLatest_s).value_or(0.0);
  event.time_us = static_cast<std::int64_t>(std::floor(at_s * 1e6 + 0.5));
  event.command = table.string("command").value_or("mark");
  event.where = fmt::format("{}:{}", path, table.line("command"));
  if (event.command.size() > kMaxCommandBytes) {
    table.reject("command", "the command is too long");
  } else if (!parsed_command(event.command)) {
    table.reject("command", in_quotes(event.command) + " is no command");
  }
  return event;
}

Result<Script> script_of(Result<TomlFile> file, const std::string& path) {
  if (!file) return file.error();
  Script script;
  for (TomlTable& event : file->root().tables("event", kMaxScriptEvents))
    script.events.push_back(event_of(event, path));
  if (auto problem = file->problem()) return *problem;
  std::ranges::stable_sort(script.events, {}, &ScriptEvent::time_us);
  return script;
}

}  // namespace

Result<Script> load_script(const std::string& path) {
  return script_of(TomlFile::load(path), path);
}

Result<Script> parsed_script(std::string_view text, const std::string& path) {
  return script_of(TomlFile::parse(text, path), path);
}

std::int64_t tick_of(const ScriptEvent& event, int rate_hz) noexcept {
  return (event.time_us * rate_hz + 999'999) / 1'000'000;
}

Report report_of(const ScriptEvent& event) noexcept {
  Report report;
  report.kind = ReportKind::command;
  report.size = static_cast<std::uint16_t>(event.command.size());
  std::copy(event.command.begin(), event.command.end(), report.bytes.begin());
  return report;
}

Result<Script> script_for(const Simulation& simulation, const std::string& path) {
  if (path.empty()) return Script{};
  auto script = load_script(path);
  if (!script) return script;
  Simulation scratch = simulation;
  std::vector<std::string> styles;
  for (const Style& style : simulation.styles()) styles.push_back(style.name);
  for (const ScriptEvent& event : script->events) {
    const std::int64_t before = scratch.counts().bad_commands;
    scratch.take_report(report_of(event));
    if (scratch.counts().bad_commands == before) continue;
    const auto problem =
        command_problem(event.command, styles, static_cast<int>(simulation.walkers().size()));
    return Error{fmt::format(
        "{}: {}", event.where,
        problem.value_or(in_quotes(event.command) + " would lock all joints of a limb"))};
  }
  return script;
}

void add_script(const Script& script, int rate_hz, Trace& trace) {
  std::vector<TraceEvent> events;
  events.reserve(trace.events.size() + script.events.size());
  auto own = trace.events.begin();
  for (const ScriptEvent& e : script.events) {
    const std::int64_t tick = tick_of(e, rate_hz);
    const auto next =
        std::lower_bound(own, trace.events.end(), tick,
                         [](const TraceEvent& t, std::int64_t k) { return t.tick < k; });
    events.insert(events.end(), own, next);
    own = next;
    TraceEvent& event = events.emplace_back();
    event.time_us = events.size() > 1 ? events[events.size() - 2].time_us : 0;
    event.tick = tick;
    event.kind = ReportKind::command;
    event.first_byte = static_cast<std::uint32_t>(trace.bytes.size());
    event.size = static_cast<std::uint16_t>(e.command.size());
    trace.bytes.insert(trace.bytes.end(), e.command.begin(), e.command.end());
  }
  events.insert(events.end(), own, trace.events.end());
  trace.events = std::move(events);
}

}  // namespace gaitpad
