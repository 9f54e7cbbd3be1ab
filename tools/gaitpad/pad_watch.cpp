#include "tools/gaitpad/pad_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gaitpad/calibration.h"
#include "tools/gaitpad/live_run.h"
#include "tools/gaitpad/report_print.h"

namespace gaitpad {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kMaxKept = 20000;  // times of one second: at most so many are looked at

void keep(std::vector<double>& values, double value) {
  if (values.size() < kMaxKept) values.push_back(value);
}
double greatest(const std::vector<double>& values) {
  return values.empty() ? 0.0 : *std::ranges::max_element(values);
}
double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}
// Standard deviation of the intervals.
double jitter(const std::vector<double>& values) {
  if (values.size() < 2) return 0.0;
  double sum = 0.0, squares = 0.0;
  for (double v : values) sum += v;
  const double mean = sum / static_cast<double>(values.size());
  for (double v : values) squares += (v - mean) * (v - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

double rate_hz(const Window& window) {
  return static_cast<double>(window.reports) / window.duration_s;
}

Stick stick_of(const MonitoredPad& pad) {
  return stick_position(pad.config.calibration, pad.state);
}

struct Triggers {
  double left, right;
};
Triggers triggers_of(const MonitoredPad& pad) {
  const Calibration& c = pad.config.calibration;
  return {trigger_position(c.left_trigger, pad.state.axis[kLeftTrigger]),
          trigger_position(c.right_trigger, pad.state.axis[kRightTrigger])};
}

std::string pad_name(const DeviceInfo& info) {
  return fmt::format("{} ({})", printable(info.name),
                     info.driver.empty() ? "recording" : info.driver);
}

}  // namespace

std::string calibration_remark(const TraceDevice& device) {
  const auto file = parse_calibration(device.calibration, "");
  const std::string name = file ? printable(file->name) : "";
  return fmt::format("{}: calibration \"{}\"", pad_name(device.info),
                     name.empty() ? "without a name" : name);
}

bool take(const Report& report, PadStream& stream, MonitoredPads& pads) {
  if (report.device == kNoDevice) return false;
  if (report.kind == ReportKind::added) {
    auto [pad, is_first] = pads.try_emplace(report.device);
    if (is_first) pad->second.config = std::move(stream.config(report.device));
    pad->second.is_plugged = true;
    return is_first;
  }
  const auto found = pads.find(report.device);
  if (found == pads.end()) return false;
  MonitoredPad& pad = found->second;
  if (report.kind == ReportKind::removed) {
    pad.is_plugged = false;
    pad.state = {};
    pad.last_ns = 0;
    return false;
  }
  keep(pad.running.latency_us, static_cast<double>(now_ns() - report.time_ns) / 1e3);
  if (pad.last_ns != 0)
    keep(pad.running.interval_us, static_cast<double>(report.time_ns - pad.last_ns) / 1e3);
  pad.last_ns = report.time_ns;
  ++pad.running.reports;
  if (!decode(*pad.config.layout, report, pad.state)) ++pad.running.bad_reports;
  return false;
}

ordered_json pad_json(std::uint16_t index, const MonitoredPad& pad, const PadStream& stream,
                      double time_s) {
  const DeviceInfo& info = stream.device(index).info;
  const Stick stick = stick_of(pad);
  const Triggers triggers = triggers_of(pad);
  const Window& w = pad.shown;
  return {{"device", index},
          {"name", info.name},
          {"driver", info.driver},
          {"time_s", time_s},
          {"plugged", pad.is_plugged},
          {"rate_hz", rate_hz(w)},
          {"interval_us_median", median(w.interval_us)},
          {"jitter_us", jitter(w.interval_us)},
          {"longest_gap_us", greatest(w.interval_us)},
          {"latency_us_median", median(w.latency_us)},
          {"latency_us_max", greatest(w.latency_us)},
          {"bad_reports", w.bad_reports},
          {"lost", stream.counts().lost},
          {"axes", axes_json(pad.state)},
          {"sticks",
           {{"left", {stick.left.x, stick.left.y}}, {"right", {stick.right.x, stick.right.y}}}},
          {"triggers", {{"left", triggers.left}, {"right", triggers.right}}},
          {"buttons", button_names(pad.state)}};
}

std::string pad_header() {
  return "left         right        triggers     Hz jitter   gap ms latency max us lost buttons, "
         "pad";
}

std::string pad_text(std::uint16_t index, const MonitoredPad& pad, const PadStream& stream) {
  const std::string who = pad_name(stream.device(index).info);
  if (!pad.is_plugged) return "unplugged: " + who;
  const Stick stick = stick_of(pad);
  const Triggers triggers = triggers_of(pad);
  const Window& w = pad.shown;
  std::string buttons;
  for (const std::string& name : button_names(pad.state)) buttons += name + " ";
  return fmt::format(
      "{:+.2f} {:+.2f}  {:+.2f} {:+.2f}  {:.2f} {:.2f}  {:>5.0f} {:>6.2f} {:>8.1f} {:>7.0f} "
      "{:>6.0f} {:>4} {}{}",
      stick.left.x, stick.left.y, stick.right.x, stick.right.y, triggers.left, triggers.right,
      rate_hz(w), jitter(w.interval_us) / 1e3, greatest(w.interval_us) / 1e3, median(w.latency_us),
      greatest(w.latency_us), stream.counts().lost, buttons, who);
}

}  // namespace gaitpad
