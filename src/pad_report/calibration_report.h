// The result of a calibration and the comparison of two, as text for people and JSON for machines.
#pragma once
#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "gaitpad/calibration.h"
#include "pads/calibration_store.h"
#include "stick/pad_analysis.h"

namespace gaitpad {

// One row for each measured value of both sticks and triggers, each with its source.
std::string analysis_text(const DeviceInfo& device, const PadAnalysis& analysis);
// The same values; null: not known.
nlohmann::ordered_json analysis_json(const DeviceInfo& device, const PadAnalysis& analysis);

struct ComparedFiles {
  std::array<CalibrationFile, 2> file;
  std::array<std::string, 2> names;                    // names of the two files, without folders
  std::array<std::vector<ComparedNumber>, 2> numbers;  // numbers of the left and the right stick
};
// Both values of each number side by side; a star marks those that differ.
std::string comparison_text(const ComparedFiles& files);

}  // namespace gaitpad
