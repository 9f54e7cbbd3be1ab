// A user's own calibrations: one file for each device, and what has changed since it was written.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "gaitpad/calibration.h"
#include "gaitpad/report.h"
#include "gaitpad/result.h"

namespace gaitpad {

// Folder of the user's calibrations, in user_config_folder(); empty if there is none. It need not
// exist.
std::string user_calibration_folder();

// Makes an empty file for this device alone: named by its unique id, else by vendor, product and
// port, else (if it has neither) for its model. `drivers` is set if other drivers show other
// values: for a pad that has factory sticks, and for a kernel driver that corrects the sticks (its
// version on evdev says so).
CalibrationFile calibration_for(const DeviceInfo& device, bool has_factory_sticks);
// The path of a device's file, `FOLDER/054c_0ce6-UNIQUE.toml`: always the same for a device, and
// different for different devices.
std::string calibration_path(const std::string& folder, const CalibrationFile& file);

// Writes the file with save_text(), after checking that it can be read back. `comments` are the
// lines at its top.
std::optional<Error> save_calibration(const std::string& path, const CalibrationFile& file,
                                      const std::vector<std::string>& comments);

// The changes from `then` to `now`: sentences with both numbers ("left stick: the centre has moved
// by 0.031 ...: more than half of the inner zone"). Empty if nothing relevant has changed. From
// `now` only measured values are compared; from `then` all values, since they are in use.
std::vector<std::string> changes_since(const CalibrationFile& then, const CalibrationFile& now);

// One number of a stick in two files, as text; "-": the file does not have it.
struct ComparedNumber {
  std::string label;
  std::array<std::string, 2> values;
};
// The numbers that a repairer compares, raw: centre, reach, zones, and what was measured. `side`: 0
// left, 1 right.
std::vector<ComparedNumber> compared_numbers(const CalibrationFile& a, const CalibrationFile& b,
                                             std::size_t side);

}  // namespace gaitpad
