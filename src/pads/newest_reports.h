// Coalescing: a newer report takes the place of an older one that is still waiting to be used.
#pragma once
#include <array>
#include <cstdint>

#include "gaitpad/decode.h"
#include "gaitpad/report.h"
#include "gaitpad/trace.h"

namespace gaitpad {

// The id of a report; 0 if the pad's reports have no ids.
inline std::uint8_t report_id_of(const PadLayout& layout, const Report& report) noexcept {
  return layout.descriptor.numbered && report.size > 0 ? report.bytes[0] : 0;
}

// For each device and report id, the waiting input report that a newer one may replace. It points
// to reports that the caller keeps. Devices are numbered below kMaxTraceDevices.
class NewestReports {
 public:
  Report* find(std::uint16_t device, std::uint8_t id) const noexcept { return newest_[device][id]; }
  void set(std::uint16_t device, std::uint8_t id, Report* report) noexcept {
    newest_[device][id] = report;
  }
  // From now on none of the device's waiting reports may be replaced.
  void forget(std::uint16_t device) noexcept { newest_[device].fill(nullptr); }

 private:
  std::array<std::array<Report*, 256>, kMaxTraceDevices> newest_{};
};

}  // namespace gaitpad
