#include "tools/gaitpad/calibrate_live.h"

#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "tools/gaitpad/guide_screen.h"
#include "tools/gaitpad/pad_options.h"
#include "tools/gaitpad/report_print.h"
#include "tools/gaitpad/terminal_keys.h"

namespace gaitpad {
namespace {

constexpr std::chrono::milliseconds kWait{20};
constexpr const char* kCommand = "calibrate";

std::string name_of(const DeviceInfo& info) {
  const std::string name = printable(info.name);
  return name.empty() ? fmt::format("{:04x}:{:04x}", info.vendor, info.product) : name;
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
Wish obey_keys(TerminalKeys& keys, CalibrationGuide* guide, GuideScreen& screen) {
  while (const std::optional<char> key = keys.take()) {
    if (guide && guide->step() == GuideStep::done) return Wish::go_on;
    const bool is_quit = *key == 'q' || *key == 'Q';
    if (guide ? obey(*key, *guide, screen) == Wish::give_up : is_quit) return Wish::give_up;
  }
  return keys.is_at_end() ? Wish::give_up : Wish::go_on;
}

// True: to the end. False: given up.
Result<bool> run_guide(GuidedCalibration& calibration, const PadWish& wish, RunEnd& end) {
  GuideScreen screen;
  TerminalKeys keys;  // goes before the stream, whose closing may take its time
  MissingPad missing(kCommand, wish);
  while (!end.is_reached()) {
    const bool was_there = calibration.guide() != nullptr;
    calibration.look(kWait);
    CalibrationGuide* guide = calibration.guide();
    print_remarks(kCommand, calibration.take_remarks(), &screen.line());
    missing.look(calibration.plugged(), screen.line());
    if (guide && !was_there) {
      if (guide->steps().size() <= 1)  // nothing but `done`
        return Error{name_of(calibration.pad()) + ": has no stick to calibrate"};
      print_remarks(kCommand, driver_remarks(calibration.pad()), &screen.line());
    }
    if (obey_keys(keys, guide, screen) == Wish::give_up) return false;
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

Result<std::optional<GuidedPad>> guided_pad(const PadFiles& files, const PadWish& wish,
                                            RunEnd& end) {
  auto calibration = GuidedCalibration::start(files, wish);
  if (!calibration) return calibration.error();
  const auto is_done = run_guide(**calibration, wish, end);
  if (!is_done) return is_done.error();
  if (!*is_done) return std::optional<GuidedPad>();
  return std::optional((*calibration)->finish());
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
