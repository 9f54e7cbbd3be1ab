// What was measured, for people and for machines.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "gaitpad/report.h"
#include "stick/pad_analysis.h"

namespace gaitpad {

void print_analysis(const DeviceInfo& device, const PadAnalysis& analysis);
// As interface.md has it, with further keys.
nlohmann::ordered_json analysis_json(const DeviceInfo& device, const PadAnalysis& analysis);

}  // namespace gaitpad
