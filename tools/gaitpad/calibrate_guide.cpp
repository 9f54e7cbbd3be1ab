#include "tools/gaitpad/calibrate_guide.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

#include "base/shown_number.h"
#include "stick/guide.h"
#include "terminal/terminal.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"

namespace gaitpad {
namespace {

// --- what is shown

struct ShownPad {
  const DeviceInfo& info;
  bool is_plugged = true;
};

class GuideScreen {
 public:
  StatusLine& line() noexcept { return line_; }
  void toggle_help() noexcept;
  void show(const CalibrationGuide& guide, const ShownPad& pad);

 private:
  void rewrite(const CalibrationGuide& guide, const ShownPad& pad);
  void print_news(const CalibrationGuide& guide, const ShownPad& pad);

  StatusLine line_{2};
  bool has_help_ = false;
  std::int64_t shown_ns_ = 0;
  GuideStep shown_step_ = GuideStep::done;
  // Without a terminal: the text of each control, and then of the plug, as it was printed last.
  GuideStep printed_step_ = GuideStep::done;
  std::vector<std::string> printed_;
};

// Period of the guide that is rewritten in place.
constexpr std::int64_t kGuideRewriteNs = 50'000'000;
constexpr std::int64_t kPrintNs = 500'000'000;  // period of lines that are printed below each
                                                // other
constexpr std::size_t kBarWidth = 55;           // columns that a bar needs; a narrower screen
                                                // shows no bars
constexpr int kBarCells = 10;

constexpr const char* kUnplugged = "UNPLUGGED: plug it in again, it goes on from here.";
constexpr const char* kKeys = "Enter next   r repeat   b back   q quit   ? help";
constexpr const char* kHelp[] = {
    "Steps go on by themselves. Enter or s: to the next step, what was seen is kept;",
    "r: forget this step and begin it again; b: the step before, again;",
    "q or Ctrl-C: end, nothing is written."};

std::string title(const CalibrationGuide& guide, const ShownPad& pad) {
  const std::string driver = pad.info.driver.empty() ? "recording" : pad.info.driver;
  return fmt::format("Step {} of {}: {}   {} ({:04x}:{:04x}, {})", guide.index() + 1,
                     guide.steps().size() - 1, name_of(guide.step()), printable(pad.info.name),
                     pad.info.vendor, pad.info.product, driver);
}

// `left stick    [####......] +0.012 -0.004  text`; more lines if the text is long.
std::vector<std::string> control_lines(const GuideProgress& control, bool is_stick,
                                       std::size_t width) {
  const double share = std::clamp(control.done, 0.0, 1.0);
  if (width < kBarWidth)
    return {fmt::format("{} {:.0f} %: {}", control.control, share * 100.0, control.text)};
  const auto cells = static_cast<std::size_t>(share * kBarCells);
  const std::string bar = std::string(cells, '#') + std::string(kBarCells - cells, '.');
  const std::string place = is_stick ? fmt::format("{} {}", signed_number(control.raw.x, 3),
                                                   signed_number(control.raw.y, 3))
                                     : fmt::format("{:.3f}", control.raw.x);
  std::string begin = fmt::format("  {:<13} [{}] {}  ", control.control, bar, place);
  std::vector<std::string> lines;
  for (const std::string& part : wrapped_lines(control.text, width - begin.size())) {
    lines.push_back(begin + part);
    begin.assign(begin.size(), ' ');
  }
  return lines;
}

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
  if (!is_new_step && time_ns < shown_ns_ + (line_.is_terminal() ? kGuideRewriteNs : kPrintNs))
    return;
  shown_ns_ = time_ns;
  shown_step_ = guide.step();
  if (line_.is_terminal()) {
    rewrite(guide, pad);
  } else {
    print_news(guide, pad);
  }
}

void GuideScreen::rewrite(const CalibrationGuide& guide, const ShownPad& pad) {
  const ScreenSize size = screen_size();
  const std::string instruction = pad.is_plugged ? guide.instruction() : kUnplugged;
  std::vector<std::string> lines = wrapped_lines(instruction, size.columns);
  const bool is_of_sticks = guide.step() != GuideStep::triggers;
  for (const GuideProgress& control : guide.progress())
    for (std::string& text : control_lines(control, is_of_sticks, size.columns))
      lines.push_back(std::move(text));
  if (lines.size() + 1 <= size.rows) lines.insert(lines.begin(), title(guide, pad));
  if (lines.size() + 1 <= size.rows) lines.emplace_back(kKeys);
  for (const char* text : kHelp)
    if (has_help_ && lines.size() + 1 <= size.rows) lines.emplace_back(text);
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

// --- the guide

constexpr std::chrono::milliseconds kGuideWait{20};

std::string name_of(const DeviceInfo& info) {
  const std::string name = printable(info.name);
  return name.empty() ? fmt::format("{:04x}:{:04x}", info.vendor, info.product) : name;
}

enum class Next { go_on, give_up };

Next obey(char key, CalibrationGuide& guide, GuideScreen& screen) {
  switch (key) {
    case '\n':
    case 's':
    case 'S':
      guide.skip();
      break;
    case 'r':
    case 'R':
      guide.repeat();
      break;
    case 'b':
    case 'B':
      guide.back();
      break;
    case '?':
    case 'h':
    case 'H':
      screen.toggle_help();
      break;
    case 'q':
    case 'Q':
      return Next::give_up;
    default:
      break;
  }
  return Next::go_on;
}

// Carries out a key. Before a pad has come only q has an effect.
Next obey_keys(TerminalKeys& keys, CalibrationGuide* guide, GuideScreen& screen) {
  while (const std::optional<char> key = keys.take_key()) {
    if (guide && guide->step() == GuideStep::done) return Next::go_on;
    const bool is_quit = *key == 'q' || *key == 'Q';
    if (guide ? obey(*key, *guide, screen) == Next::give_up : is_quit) return Next::give_up;
  }
  return keys.is_at_end() ? Next::give_up : Next::go_on;
}

// Runs the guide to its end. True: it is finished. False: the user gave up.
Result<bool> run_guide(GuidedCalibration& calibration, const PadSelector& selector, RunEnd& end) {
  GuideScreen screen;
  // Declared last, so that it is destroyed before the stream, which may take long to close.
  TerminalKeys keys;
  MissingPad missing(kCalibrateCommand, selector);
  while (!end.is_reached()) {
    const bool was_there = calibration.guide() != nullptr;
    calibration.look(kGuideWait);
    CalibrationGuide* guide = calibration.guide();
    print_remarks(kCalibrateCommand, calibration.take_remarks(), &screen.line());
    missing.look(calibration.plugged(), screen.line());
    if (guide && !was_there) {
      if (guide->steps().size() <= 1)  // the only step is `done`
        return Error{name_of(calibration.pad()) + ": has no stick to calibrate"};
      print_remarks(kCalibrateCommand, driver_remarks(calibration.pad()), &screen.line());
    }
    if (obey_keys(keys, guide, screen) == Next::give_up) return false;
    if (!guide && calibration.has_ended()) return false;
    if (!guide) continue;
    screen.show(*guide, {calibration.pad(), calibration.is_plugged()});
    if (guide->step() == GuideStep::done) return true;
  }
  return false;
}

}  // namespace

std::vector<std::string> driver_remarks(const DeviceInfo& info) {
  const std::string remark = driver_remark(info);
  if (remark.empty()) return {};
  return {name_of(info) + ": " + remark};
}

Result<std::optional<GuidedPad>> guided_pad(const PadFiles& files, const PadSelector& selector,
                                            RunEnd& end) {
  auto calibration = GuidedCalibration::start(files, selector);
  if (!calibration) return calibration.error();
  const auto is_done = run_guide(**calibration, selector, end);
  if (!is_done) return is_done.error();
  if (!*is_done) return std::optional<GuidedPad>();
  return std::optional((*calibration)->finish());
}

bool confirmed(const std::string& question, RunEnd& end) {
  TerminalKeys keys(TerminalKeys::Earlier::forgotten);
  fmt::print(stderr, "{}\n", question);
  while (!end.is_reached()) {
    while (const std::optional<char> key = keys.take_key()) {
      if (*key == '\n') return true;
      if (*key == 'q' || *key == 'Q' || *key == 'n' || *key == 'N') return false;
    }
    if (keys.is_at_end()) return false;
    end.wait(kGuideWait);
  }
  return false;
}

}  // namespace gaitpad
