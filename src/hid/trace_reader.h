// Builds a trace from its lines, in their order, and checks each (trace_read.cpp feeds it).
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hid/trace.h"
#include "hid/trace_lines.h"

namespace gaitpad {

using Cause = std::optional<std::string>;  // why a line is damaged, without its place

class TraceReader {
 public:
  explicit TraceReader(const std::string& name) { trace_.path = name; }
  Cause add(std::string_view line);
  Cause finish(Damage damage);
  void skip(const std::string& sentence);
  Trace take() { return std::move(trace_); }

 private:
  Cause add_lettered(char letter, std::string_view text);
  Cause version(Words words);
  Cause device_index(Words words);
  Cause descriptor(Words words);
  Cause identity(Words words);
  Cause driver(Words words);
  Cause set_text(std::string DeviceInfo::*member, std::string_view text);
  Cause calibration(std::string_view text);
  Cause tick(Words words);
  Cause report(Words words);
  Cause command(Words words);
  Cause plugged(Words words);
  Cause end(Words words);

  Cause check_place(std::int64_t time_us, std::uint16_t device) const;
  Cause check_order(std::int64_t time_us, std::uint16_t device) const;
  void append(TraceEvent event);
  Cause current_device(std::size_t& device);
  void drop_undescribed_devices();
  std::int64_t rate() const { return trace_.rate_hz.value_or(kDefaultRateHz); }

  Trace trace_;
  std::optional<std::size_t> current_;    // device of the last `D:`
  std::int64_t tick_ = 0;                 // of the last `T:`
  std::int64_t latest_us_ = 0;            // over all devices
  std::vector<std::int64_t> device_us_ =  // last time on each device; commands last
      std::vector<std::int64_t>(kMaxTraceDevices + 1, -1);
};

}  // namespace gaitpad
