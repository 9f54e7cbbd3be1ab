#include "tools/gaitpad/print.h"

#include <fmt/format.h>

#include <cstdio>

#include "terminal/terminal.h"

namespace gaitpad {

using nlohmann::ordered_json;

void say(std::FILE* file, std::string_view text) {
  const auto columns = terminal_columns(::fileno(file));
  fmt::print(file, "{}", columns ? fitted(text, *columns) : std::string(text));
}

void warn(std::string_view text) {
  const auto columns = terminal_columns(::fileno(stderr));
  const std::string shown = columns ? fitted(text, *columns) : std::string(text);
  std::fputs(shown.c_str(), stderr);
}

void print_remarks(std::string_view command, const std::vector<std::string>& remarks,
                   StatusLine* line) {
  if (line && !remarks.empty()) line->clear();
  for (const std::string& remark : remarks)
    warn(fmt::format("gaitpad {}: {}\n", command, printable(remark)));
}

int fail(std::string_view command, const std::string& sentence) {
  print_remarks(command, {sentence});
  return 1;
}

void print_json_line(const ordered_json& object) {
  fmt::print("{}\n", object.dump(-1, ' ', true, ordered_json::error_handler_t::replace));
}

void print_json(const ordered_json& value) {
  fmt::print("{}\n", value.dump(2, ' ', true, ordered_json::error_handler_t::replace));
}

ordered_json one_or_list(const std::vector<ordered_json>& summaries) {
  return summaries.size() == 1 ? summaries[0] : ordered_json(summaries);
}

void print_session(const std::string& source, const RunSummary& run) {
  say("{}: {} reports, {} ticks at {} Hz ({:.1f} s), pose hash {:016x}\n", printable(source),
      run.reports, run.ticks, run.rate_hz, static_cast<double>(run.ticks) / run.rate_hz,
      run.pose_hash);
  if (run.crowd > 0) say("a crowd of {} behind character 1\n", run.crowd);
}

void print_character(const RunSummary& run, std::size_t walker, Way way) {
  const WalkerSummary& w = run.walkers[walker];
  say("character {}: {}, style {} at the end, leg {:.3f} m: {}{} steps, {} IK failures\n",
      walker + 1, printable(w.motion), printable(w.style), w.leg_length_m,
      way == Way::shown ? fmt::format("{:.1f} m in ", w.distance_m) : "", w.steps[0] + w.steps[1],
      w.ik_failures);
}

}  // namespace gaitpad
