// Live pads as monitor shows them: position, buttons, and how regularly reports come.
#pragma once
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "gaitpad/pad_stream.h"

namespace gaitpad {

// What came within the running second.
struct Window {
  double duration_s = 1.0;
  std::int64_t reports = 0, bad_reports = 0;
  std::vector<double> interval_us, latency_us;
};

struct MonitoredPad {
  PadConfig config;
  PadState state;
  bool is_plugged = true;
  std::int64_t last_ns = 0;  // stamp of the last report, 0: none since plugging in
  Window running, shown;     // shown: the last full second
};
using MonitoredPads = std::map<std::uint16_t, MonitoredPad>;

// Takes one report of the stream in. True where it announces a pad for the first time.
bool take(const Report& report, PadStream& stream, MonitoredPads& pads);
// Whose calibration is in force: `PAD (DRIVER): calibration "NAME"`.
std::string calibration_remark(const TraceDevice& device);

nlohmann::ordered_json pad_json(std::uint16_t index, const MonitoredPad& pad,
                                const PadStream& stream, double time_s);
// A line of a table, and its head.
std::string pad_header();
std::string pad_text(std::uint16_t index, const MonitoredPad& pad, const PadStream& stream);

}  // namespace gaitpad
