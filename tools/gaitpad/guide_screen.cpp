#include "tools/gaitpad/guide_screen.h"

#include <fmt/format.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <utility>

#include "tools/gaitpad/report_print.h"

namespace gaitpad {
namespace {

constexpr std::int64_t kRewriteNs = 50'000'000;  // in place
constexpr std::int64_t kPrintNs = 500'000'000;   // line below line
constexpr std::size_t kBarWidth = 55;            // narrower screens have no room for bars
constexpr int kBarCells = 10;

constexpr const char* kUnplugged = "UNPLUGGED: plug it in again, it goes on from here.";
constexpr const char* kKeys = "Enter next   r repeat   b back   q quit   ? help";
constexpr const char* kHelp[] = {
    "Steps go on by themselves. Enter or s: to the next step, what was seen is kept;",
    "r: forget this step and begin it again; b: the step before, again;",
    "q or Ctrl-C: end, nothing is written."};

struct Size {
  std::size_t columns = 79, rows = 24;
};
Size screen_size() noexcept {
  winsize window = {};
  if (::ioctl(2, TIOCGWINSZ, &window) != 0 || window.ws_col < 2 || window.ws_row < 2) return {};
  return {window.ws_col - 1u, window.ws_row};
}

std::string title(const CalibrationGuide& guide, const ShownPad& pad) {
  const std::string driver = pad.info.driver.empty() ? "recording" : pad.info.driver;
  return fmt::format("Step {} of {}: {}   {} ({:04x}:{:04x}, {})", guide.index() + 1,
                     guide.steps().size() - 1, name_of(guide.step()), printable(pad.info.name),
                     pad.info.vendor, pad.info.product, driver);
}

// Breaks at blanks.
std::vector<std::string> wrapped_lines(const std::string& text, std::size_t width) {
  std::vector<std::string> lines;
  std::size_t begin = 0;
  while (text.size() - begin > width) {
    std::size_t end = text.rfind(' ', begin + width);
    if (end == std::string::npos || end <= begin) end = begin + width;
    lines.push_back(text.substr(begin, end - begin));
    begin = end < text.size() && text[end] == ' ' ? end + 1 : end;
  }
  lines.push_back(text.substr(begin));
  return lines;
}

// One line, or more where its text is longer: `left stick    [####......] +0.012 -0.004  text`.
std::vector<std::string> control_lines(const GuideProgress& control, bool is_stick,
                                       std::size_t width) {
  const double share = std::clamp(control.done, 0.0, 1.0);
  if (width < kBarWidth)
    return {fmt::format("{} {:.0f} %: {}", control.control, share * 100.0, control.text)};
  const auto cells = static_cast<std::size_t>(share * kBarCells);
  const std::string bar = std::string(cells, '#') + std::string(kBarCells - cells, '.');
  const std::string place = is_stick ? fmt::format("{:+.3f} {:+.3f}", control.raw.x, control.raw.y)
                                     : fmt::format("{:.3f}", control.raw.x);
  std::string begin = fmt::format("  {:<13} [{}] {}  ", control.control, bar, place);
  std::vector<std::string> lines;
  for (const std::string& part : wrapped_lines(control.text, width - begin.size())) {
    lines.push_back(begin + part);
    begin.assign(begin.size(), ' ');
  }
  return lines;
}

}  // namespace

void GuideScreen::toggle_help() noexcept {
  has_help_ = !has_help_;
  shown_ns_ = 0;
  if (line_.is_terminal()) return;
  for (const char* text : kHelp) fmt::print(stderr, "{}\n", text);
}

void GuideScreen::show(const CalibrationGuide& guide, const ShownPad& pad) {
  if (guide.step() == GuideStep::done) return;
  const bool is_new_step = shown_step_ != guide.step();
  const std::int64_t time_ns = now_ns();
  if (!is_new_step && time_ns < shown_ns_ + (line_.is_terminal() ? kRewriteNs : kPrintNs)) return;
  shown_ns_ = time_ns;
  shown_step_ = guide.step();
  if (line_.is_terminal()) {
    rewrite(guide, pad);
  } else {
    print_news(guide, pad);
  }
}

void GuideScreen::rewrite(const CalibrationGuide& guide, const ShownPad& pad) {
  const Size size = screen_size();
  const std::string instruction = pad.is_plugged ? guide.instruction() : kUnplugged;
  std::vector<std::string> lines = wrapped_lines(instruction, size.columns);
  const bool is_of_sticks = guide.step() != GuideStep::triggers;
  for (const GuideProgress& control : guide.progress())
    for (std::string& text : control_lines(control, is_of_sticks, size.columns))
      lines.push_back(std::move(text));
  if (lines.size() + 1 <= size.rows) lines.insert(lines.begin(), title(guide, pad));
  if (lines.size() + 1 <= size.rows) lines.push_back(kKeys);
  for (const char* text : kHelp)
    if (has_help_ && lines.size() + 1 <= size.rows) lines.push_back(text);
  if (lines.size() > size.rows) lines.resize(size.rows);
  line_.show(lines);
}

void GuideScreen::print_news(const CalibrationGuide& guide, const ShownPad& pad) {
  const std::vector<GuideProgress> controls = guide.progress();
  if (printed_step_ != guide.step()) {
    printed_step_ = guide.step();
    printed_.assign(controls.size() + 1, "");
    fmt::print(stderr, "{}\n{}\n", title(guide, pad), guide.instruction());
  }
  const auto print = [this](std::size_t index, const std::string& text) {
    if (index >= printed_.size() || printed_[index] == text) return;
    printed_[index] = text;
    if (!text.empty()) fmt::print(stderr, "{}\n", text);
  };
  print(controls.size(), pad.is_plugged ? "" : kUnplugged);
  for (std::size_t i = 0; i < controls.size(); ++i)
    print(i, fmt::format("{}: {}", controls[i].control, controls[i].text));
}

}  // namespace gaitpad
