// From what was measured to what to do: zones, a calibration and a verdict in plain words.
#pragma once
#include <cstdint>
#include <string>

#include "stick/calibration.h"
#include "stick/statistics.h"

namespace gaitpad {

enum class Verdict : std::uint8_t { good, worn, replace, unknown };
const char* name_of(Verdict verdict) noexcept;

struct StickAdvice {
  StickCalibration calibration;  // what is not known is as for an unknown stick
  double inner_zone = 0.0;       // raw: max(0.05, 3 sigma + hysteresis)
  double outer_zone = 0.0;       // raw
  Verdict verdict = Verdict::unknown;
  std::string reason;  // one sentence with its numbers
};
// `statistics` are in `frame`.
StickAdvice stick_advice(const StickStatistics& statistics, const StickFrame& frame);
TriggerCalibration trigger_advice(const TriggerStatistics& statistics) noexcept;

}  // namespace gaitpad
