// A live pad as `gaitpad monitor` shows it: position, buttons, and how regularly its reports come.
#pragma once
#include <array>
#include <cstdint>
#include <future>
#include <map>
#include <optional>
#include <vector>

#include "drivers/system_nodes.h"
#include "gaitpad/calibration.h"
#include "gaitpad/pad_stream.h"
#include "gaitpad/untouched.h"
#include "pads/gyroscope.h"
#include "stick/new_values.h"

namespace gaitpad {

// What came within one second.
struct ReportWindow {
  double duration_s = 1.0;
  std::int64_t reports = 0, bad_reports = 0;
  std::vector<double> interval_us, latency_us;
  std::vector<double> frame_us;  // from the report to the line that shows it, on a terminal
};

struct MonitoredPad {
  PadConfig config;
  PadState state;
  JumpFilter filter;
  NewValueCount new_values;
  GyroMeter gyro;
  std::array<UntouchedWatch, 2> watch;  // left, right
  int untouched = 0;                    // how often a stick moved by itself
  bool is_warned = false;               // of that
  bool is_plugged = true;
  std::optional<Battery> battery;
  std::future<std::optional<Battery>> asked_battery;  // the kernel may wait for the pad
  std::int64_t battery_ns = 0;                        // when it was asked last; 0: never
  std::int64_t last_ns = 0;              // stamp of the last report; 0: none since plugging in
  ReportWindow running, shown;           // the present second, and the last full one
  std::vector<std::int64_t> unshown_ns;  // stamps of the reports since the last line
};
using MonitoredPads = std::map<std::uint16_t, MonitoredPad>;

double greatest(const std::vector<double>& values);
// Standard deviation of the intervals.
double jitter(const std::vector<double>& values);
double rate_hz(const ReportWindow& window);

Stick stick_of(const MonitoredPad& pad);
struct Triggers {
  double left, right;
};
Triggers triggers_of(const MonitoredPad& pad);

// Takes one report of the stream in. True if it announces a pad for the first time.
bool take_report(const Report& report, PadStream& stream, MonitoredPads& pads);
// A pad that reports changes only is silent while its sticks stand still.
void take_silence(MonitoredPad& pad);
// The running window becomes the one that is shown. Asks for the battery once a minute.
void end_window(MonitoredPad& pad, const DeviceInfo& info, std::int64_t time_ns, double duration_s);
// The line with these reports has just been written.
void note_shown(MonitoredPads& pads);

}  // namespace gaitpad
