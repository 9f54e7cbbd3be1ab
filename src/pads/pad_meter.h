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

// Counts and times of one second.
struct ReportWindow {
  double duration_s = 1.0;
  std::int64_t reports = 0, bad_reports = 0;
  std::vector<double> interval_us, latency_us;
  std::vector<double> frame_us;  // times from each report to the line on the terminal that shows it
};

struct MonitoredPad {
  PadConfig config;
  PadState state;
  JumpFilter filter;
  NewValueCount new_values;
  GyroMeter gyro;
  // Watches the left and the right stick for movements that the user did not make.
  std::array<UntouchedWatch, 2> watch;
  int untouched = 0;       // number of times that a stick moved by itself
  bool is_warned = false;  // the user was warned that a stick moves by itself
  bool is_plugged = true;
  std::optional<Battery> battery;
  // The request for the battery that has not been answered; on its own thread, because the kernel
  // may wait for the pad.
  std::future<std::optional<Battery>> asked_battery;
  std::int64_t battery_ns = 0;           // time of the last request for the battery;
                                         // 0: there was none
  std::int64_t last_ns = 0;              // stamp of the last report; 0: none has come since
                                         // plugging in
  ReportWindow running, shown;           // the window of the present second, and of the last full
                                         // one
  std::vector<std::int64_t> unshown_ns;  // stamps of the reports that no line has shown yet
};
using MonitoredPads = std::map<std::uint16_t, MonitoredPad>;

double greatest(const std::vector<double>& values);
// Standard deviation of the intervals in `values`.
double jitter(const std::vector<double>& values);
double rate_hz(const ReportWindow& window);

Stick stick_of(const MonitoredPad& pad);
struct Triggers {
  double left, right;
};
Triggers triggers_of(const MonitoredPad& pad);

// Takes one report of the stream. Returns true if it announces a pad for the first time.
bool take_report(const Report& report, PadStream& stream, MonitoredPads& pads);
// Call it when no report has come: a pad that reports only changes is silent while its sticks stand
// still.
void take_silence(MonitoredPad& pad);
// Ends the running interval of measurement; its figures are shown until the next one ends. Asks for
// the battery once a minute.
void end_window(MonitoredPad& pad, const DeviceInfo& info, std::int64_t time_ns, double duration_s);
// Call it when the line with these reports has just been written.
void note_shown(MonitoredPads& pads);

}  // namespace gaitpad
