// Output of commands: sentences on standard error, JSON and texts of devices on standard output.
#pragma once
#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/text.h"
#include "gaitpad/summary.h"
#include "terminal/run_end.h"

namespace gaitpad {

// Prints text for people. On a terminal its lines are broken to the width (fitted()); in a pipe or
// a file they stay whole. Throws std::system_error if the file cannot be written.
void say(std::FILE* file, std::string_view text);
template <class... T>
void say(fmt::format_string<T...> format, T&&... values) {
  say(stdout, fmt::format(format, std::forward<T>(values)...));
}

// Prints a text on standard error; ignores write errors.
void warn(std::string_view text);
// The exit status after arguments that do not fit together.
inline constexpr int kWrongUsage = 2;
// Prints `gaitpad COMMAND: SENTENCE` on standard error and returns the exit status 1.
int fail(std::string_view command, const std::string& sentence);
// Prints `gaitpad COMMAND: REMARK` for each remark. Each sentence is made printable(), because it
// may quote names of devices and files. Clears `line` first.
void print_remarks(std::string_view command, const std::vector<std::string>& remarks,
                   StatusLine* line = nullptr);

// Prints JSON on one line, or indented. Texts of devices may hold any bytes: invalid UTF-8 is
// replaced and non-ASCII is escaped, so that no text can control the terminal.
void print_json_line(const nlohmann::ordered_json& object);
void print_json(const nlohmann::ordered_json& value);
// One object for one character, else a list.
nlohmann::ordered_json one_or_list(const std::vector<nlohmann::ordered_json>& summaries);

// Prints the session in one line: `SOURCE: 120 reports, 480 ticks ...`.
void print_session(const std::string& source, const RunSummary& run);
// Prints the results of one character. The style in which it walked is printed only for replays.
enum class Way { shown, left_out };
void print_character(const RunSummary& run, std::size_t walker, Way way);

}  // namespace gaitpad
