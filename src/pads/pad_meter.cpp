#include "pads/pad_meter.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "system/clock.h"

namespace gaitpad {
namespace {

constexpr std::size_t kMaxKept = 20000;  // most times of one second that are evaluated

template <class T>
void keep(std::vector<T>& values, T value) {
  if (values.size() < kMaxKept) values.push_back(value);
}

void watch_sticks(MonitoredPad& pad, std::int64_t time_ns) {
  const Calibration& c = pad.config.calibration;
  const Stick stick = stick_of(pad);
  const auto& axis = pad.state.axis;
  pad.untouched += pad.watch[0].take(time_ns, c.left, {axis[kLeftX], axis[kLeftY]}, stick.left);
  pad.untouched += pad.watch[1].take(time_ns, c.right, {axis[kRightX], axis[kRightY]}, stick.right);
}

// Called once a second: asks for the battery once a minute, and takes the answer when it has come.
void look_at_battery(MonitoredPad& pad, const DeviceInfo& info, std::int64_t time_ns) {
  constexpr std::int64_t kMinuteNs = 60'000'000'000;
  if (pad.battery_ns == 0 || time_ns >= pad.battery_ns + kMinuteNs) {
    pad.battery_ns = time_ns;
    pad.asked_battery = std::async(std::launch::async, [info] { return battery_of(info); });
  }
  using namespace std::chrono_literals;
  if (pad.asked_battery.valid() && pad.asked_battery.wait_for(0s) == std::future_status::ready)
    pad.battery = pad.asked_battery.get();
}

}  // namespace

double greatest(const std::vector<double>& values) {
  return values.empty() ? 0.0 : *std::ranges::max_element(values);
}
double jitter(const std::vector<double>& values) {
  if (values.size() < 2) return 0.0;
  double sum = 0.0, squares = 0.0;
  for (double v : values) sum += v;
  const double mean = sum / static_cast<double>(values.size());
  for (double v : values) squares += (v - mean) * (v - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

double rate_hz(const ReportWindow& window) {
  return static_cast<double>(window.reports) / window.duration_s;
}

Stick stick_of(const MonitoredPad& pad) {
  const Calibration& calibration = pad.config.calibration;
  return stick_position(calibration, pad.filter.filtered(calibration, pad.state));
}

Triggers triggers_of(const MonitoredPad& pad) {
  const Calibration& c = pad.config.calibration;
  return {trigger_position(c.left_trigger, pad.state.axis[kLeftTrigger]),
          trigger_position(c.right_trigger, pad.state.axis[kRightTrigger])};
}

void take_silence(MonitoredPad& pad) {
  const std::int64_t time_ns = now_ns();
  const double silent_s = 1e-9 * static_cast<double>(time_ns - pad.last_ns);
  if (pad.last_ns == 0 || silent_s < JumpFilter::kSettled_s) return;
  pad.filter.settle();
  watch_sticks(pad, time_ns);
}

bool take_report(const Report& report, PadStream& stream, MonitoredPads& pads) {
  if (report.device == kNoDevice) return false;
  if (report.kind == ReportKind::added) {
    auto [pad, is_first] = pads.try_emplace(report.device);
    if (is_first) {
      pad->second.config = stream.take_config(report.device);
      pad->second.gyro = {stream.device(report.device).info, pad->second.config.factory_gyro};
    }
    pad->second.is_plugged = true;
    return is_first;
  }
  const auto found = pads.find(report.device);
  if (found == pads.end()) return false;
  MonitoredPad& pad = found->second;
  if (report.kind == ReportKind::removed) {
    pad.is_plugged = false;
    pad.state = {};
    pad.filter = {};
    pad.new_values = {};
    pad.watch = {};
    pad.gyro.cut();
    pad.last_ns = 0;
    return false;
  }
  keep(pad.running.latency_us, static_cast<double>(now_ns() - report.time_ns) / 1e3);
  if (pad.last_ns != 0)
    keep(pad.running.interval_us, static_cast<double>(report.time_ns - pad.last_ns) / 1e3);
  pad.last_ns = report.time_ns;
  keep(pad.unshown_ns, report.time_ns);
  ++pad.running.reports;
  pad.gyro.take(report);
  if (!decode(*pad.config.layout, report, pad.state)) {
    ++pad.running.bad_reports;
  } else {
    pad.filter.take(pad.state);
    const auto& axis = pad.state.axis;
    pad.new_values.take(report.time_ns, {axis[kLeftX], axis[kLeftY]},
                        {axis[kRightX], axis[kRightY]});
    watch_sticks(pad, report.time_ns);
  }
  return false;
}

void end_window(MonitoredPad& pad, const DeviceInfo& info, std::int64_t time_ns,
                double duration_s) {
  look_at_battery(pad, info, time_ns);
  pad.shown = std::exchange(pad.running, {});
  pad.shown.duration_s = duration_s;
}

void note_shown(MonitoredPads& pads) {
  const std::int64_t time_ns = now_ns();
  for (auto& [index, pad] : pads) {
    for (const std::int64_t report_ns : std::exchange(pad.unshown_ns, {}))
      keep(pad.running.frame_us, static_cast<double>(time_ns - report_ns) / 1e3);
  }
}

}  // namespace gaitpad
