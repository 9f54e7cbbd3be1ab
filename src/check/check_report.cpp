#include "check/check_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/text.h"

namespace gaitpad {
namespace {

std::string tap_description(const std::string& path) {
  std::string text;
  for (const char c : printable(path)) {
    if (c == '#' || c == '\\') text += '\\';
    text += c;
  }
  return text;
}

// A JSON string is also a YAML string in double quotes.
std::string yaml_string(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

// XML 1.0 allows only valid UTF-8 without control characters.
std::string xml_text(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t bytes = character_bytes(text);
    const std::string_view c = text.substr(0, std::max<std::size_t>(bytes, 1));
    text.remove_prefix(c.size());
    const auto code = static_cast<unsigned char>(c.front());
    if (c == "&") {
      out += "&amp;";
    } else if (c == "<") {
      out += "&lt;";
    } else if (c == ">") {
      out += "&gt;";
    } else if (c == "\"") {
      out += "&quot;";
    } else if (c == "\n") {
      out += "&#10;";
    } else if (bytes == 0 || code < 0x20 || code == 0x7f || c == "\xef\xbf\xbe" ||
               c == "\xef\xbf\xbf") {
      out += '?';
    } else {
      out += c;
    }
  }
  return out;
}

}  // namespace

std::string tap_result(std::size_t number, const CheckedTrace& trace, const CheckResult& result,
                       bool updates) {
  std::string text = fmt::format("{}ok {} - {}\n", result.is_met ? "" : "not ", number,
                                 tap_description(trace.recording()));
  if (updates && result.is_met) {
    text += fmt::format("# {}\n", result.verdict);
    for (const std::string& line : result.details) text += fmt::format("# {}\n", printable(line));
  } else if (!result.is_met) {
    text += fmt::format("  ---\n  message: {}\n", yaml_string(result.verdict));
    if (!result.details.empty()) text += "  details:\n";
    for (const std::string& line : result.details)
      text += fmt::format("    - {}\n", yaml_string(line));
    text += "  ...\n";
  }
  return text;
}

void JunitReport::add(const CheckedTrace& trace, const CheckResult& result) {
  ++tests_;
  seconds_ += result.seconds;
  cases_ += fmt::format("    <testcase classname=\"gaitpad.check\" name=\"{}\" time=\"{:.3f}\"",
                        xml_text(trace.recording()), result.seconds);
  if (result.is_met) {
    cases_ += "/>\n";
    return;
  }
  ++failures_;
  std::string details;
  for (const std::string& line : result.details) details += line + "\n";
  cases_ += fmt::format(">\n      <failure message=\"{}\">{}</failure>\n    </testcase>\n",
                        xml_text(result.verdict), xml_text(details));
}

std::string JunitReport::text() const {
  const std::string counts = fmt::format(
      "tests=\"{}\" failures=\"{}\" errors=\"0\" time=\"{:.3f}\"", tests_, failures_, seconds_);
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites {0}>\n"
      "  <testsuite name=\"gaitpad check\" {0} skipped=\"0\">\n{1}  "
      "</testsuite>\n</testsuites>\n",
      counts, cases_);
}

}  // namespace gaitpad
