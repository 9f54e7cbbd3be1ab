#include "tools/gaitpad/calibrate_live.h"

#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <utility>

#include "session/pad_stream.h"
#include "stick/guide.h"
#include "tools/gaitpad/guide_screen.h"
#include "tools/gaitpad/pad_options.h"
#include "tools/gaitpad/report_print.h"
#include "tools/gaitpad/terminal_keys.h"

namespace gaitpad {
namespace {

constexpr std::chrono::milliseconds kWait{20};
constexpr std::int64_t kOnTheWayNs = 50'000'000;  // silence shorter than that may be none
constexpr const char* kCommand = "calibrate";

// The pad that is calibrated: the first one that came. It stays where it is, the guide looks at its
// layout.
struct Subject {
  std::uint16_t device = kNoDevice;
  DeviceInfo info;
  PadConfig config;
  bool is_plugged = false;
  std::optional<CalibrationGuide> guide;
};

std::string name_of(const DeviceInfo& info) {
  const std::string name = printable(info.name);
  return name.empty() ? fmt::format("{:04x}:{:04x}", info.vendor, info.product) : name;
}

void take(const Report& report, PadStream& stream, Subject& subject) {
  if (report.kind == ReportKind::added && subject.device == kNoDevice) {
    subject.device = report.device;
    subject.info = stream.device(report.device).info;
    subject.config = std::move(stream.config(report.device));
    subject.guide.emplace(*subject.config.layout);
  }
  if (report.device != subject.device || subject.device == kNoDevice) return;
  if (report.kind == ReportKind::added) subject.is_plugged = true;
  if (report.kind == ReportKind::removed) subject.is_plugged = false;
  subject.guide->take(report);
}

enum class Wish { go_on, give_up };

Wish obey(char key, CalibrationGuide& guide, GuideScreen& screen) {
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
      return Wish::give_up;
    default:
      break;
  }
  return Wish::go_on;
}

// Before a pad has come only q counts.
Wish obey_keys(TerminalKeys& keys, Subject& subject, GuideScreen& screen) {
  while (const std::optional<char> key = keys.take()) {
    if (subject.guide && subject.guide->step() == GuideStep::done) return Wish::go_on;
    const bool is_quit = *key == 'q' || *key == 'Q';
    if (subject.guide ? obey(*key, *subject.guide, screen) == Wish::give_up : is_quit)
      return Wish::give_up;
  }
  return keys.is_at_end() ? Wish::give_up : Wish::go_on;
}

void end_recording(Subject& subject, GuideScreen& screen) {
  if (!subject.guide || subject.guide->step() == GuideStep::done) return;
  print_remarks(kCommand, {"the recording has ended: what it did not show is left out"},
                &screen.line());
  while (subject.guide->step() != GuideStep::done) subject.guide->skip();
}

// True: to the end. False: given up.
Result<bool> run_guide(PadStream& stream, const PadWish& wish, RunEnd& end, Subject& subject) {
  GuideScreen screen;
  TerminalKeys keys;  // goes before the stream, whose closing may take its time
  MissingPad missing(kCommand, wish);
  while (!end.is_reached()) {
    stream.wait(kWait);
    const bool was_there = subject.guide.has_value();
    const bool has_ended = stream.has_ended();
    for (; const Report* report = stream.front(); stream.pop()) take(*report, stream, subject);
    print_remarks(kCommand, stream.take_remarks(), &screen.line());
    missing.look(stream.counts().plugged, screen.line());
    if (subject.guide && !was_there) {
      if (subject.guide->step() == GuideStep::done)
        return Error{name_of(subject.info) + ": has no stick to calibrate"};
      print_remarks(kCommand, driver_remarks(subject.info), &screen.line());
    }
    if (subject.guide) subject.guide->tick(now_ns() - kOnTheWayNs);
    if (has_ended) end_recording(subject, screen);
    if (obey_keys(keys, subject, screen) == Wish::give_up) return false;
    if (!subject.guide && has_ended) return false;
    if (!subject.guide) continue;
    screen.show(*subject.guide, {subject.info, subject.is_plugged});
    if (subject.guide->step() == GuideStep::done) return true;
  }
  return false;
}

}  // namespace

std::vector<std::string> driver_remarks(const DeviceInfo& info) {
  if (info.driver != "evdev" && info.driver != "sdl") return {};
  return {
      fmt::format("{}: through {} the kernel may filter small changes (fuzz) and correct the "
                  "sticks, so noise and centre are not the pad's own; --driver hidraw or usb sees "
                  "more, where the pad has it",
                  name_of(info), info.driver)};
}

Result<std::optional<GuidedPad>> guided_pad(const PadFiles& files, const PadWish& wish,
                                            RunEnd& end) {
  auto stream = PadStream::start({files, wish});
  if (!stream) return stream.error();
  const auto subject = std::make_unique<Subject>();
  const auto is_done = run_guide(**stream, wish, end, *subject);
  if (!is_done) return is_done.error();
  if (!*is_done) return std::optional<GuidedPad>();
  const CalibrationGuide& guide = *subject->guide;
  GuidedPad pad;
  pad.info = std::move(subject->info);
  pad.has_factory_sticks = subject->config.has_factory_sticks;
  pad.tracks = guide.tracks();
  pad.frame = {guide.frame(0), guide.frame(1)};
  subject->guide.reset();  // it looks at the layout
  pad.layout = *subject->config.layout;
  return std::optional(std::move(pad));
}

bool confirmed(const std::string& question, RunEnd& end) {
  TerminalKeys keys(TerminalKeys::Earlier::forgotten);
  fmt::print(stderr, "{}\n", question);
  while (!end.is_reached()) {
    while (const std::optional<char> key = keys.take()) {
      if (*key == '\n') return true;
      if (*key == 'q' || *key == 'Q' || *key == 'n' || *key == 'N') return false;
    }
    if (keys.is_at_end()) return false;
    end.wait(kWait);
  }
  return false;
}

}  // namespace gaitpad
