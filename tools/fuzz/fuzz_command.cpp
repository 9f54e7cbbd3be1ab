// libFuzzer target: commands, one per line, as in C: lines and from keys, and the same bytes as a
// script. Every text that command_problem() accepts is a command with a finite value, and a
// script's events survive the conversion to reports and back.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "base/text.h"
#include "session/script.h"

namespace {

using namespace gaitpad;
constexpr int kCharacters = 2;

void check_command(std::string_view line) {
  static const std::vector<std::string> styles = {"even", "limp left"};
  const auto command = parsed_command(line);
  const auto problem = command_problem(line, styles, kCharacters);
  if (!command && !problem) std::abort();
  if (problem && problem->find('\n') != std::string::npos) std::abort();
  if (!command) return;
  if (!std::isfinite(command->value) || command->walker < 0) std::abort();
  if (!problem && command->walker > kCharacters) std::abort();
  // The name is a part of the text, so it stays valid while the text exists.
  const char* name = command->name.data();
  const bool is_inside =
      name >= line.data() && name + command->name.size() <= line.data() + line.size();
  if (!command->name.empty() && !is_inside) std::abort();
}

void check_script(std::string_view text) {
  const auto script = parsed_script(text, "fuzz.toml");
  if (!script) {
    if (script.error().message.find('\n') != std::string::npos) std::abort();
    return;
  }
  std::int64_t last_us = 0;
  for (const ScriptEvent& event : script->events) {
    if (event.time_us < last_us || tick_of(event, 240) < 0) std::abort();
    if (!parsed_command(event.command) || text_of(report_of(event)) != event.command) std::abort();
    last_us = event.time_us;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  check_script(text);
  std::string_view rest = text;
  while (!rest.empty()) check_command(take_line(rest));
  return 0;
}
