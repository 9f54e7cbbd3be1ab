// A user's own calibrations: one file a device, found again by it, never lost half-way.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "gaitpad/calibration.h"
#include "gaitpad/report.h"
#include "gaitpad/result.h"

namespace gaitpad {

// In user_config_folder(); empty where there is none. It need not exist.
std::string user_calibration_folder();

// For this device alone: by its unique id, else by vendor, product and port (where it has neither,
// for its model). `drivers` is set where another driver's values differ: a pad that corrects its
// sticks itself (`has_factory_sticks`, or a kernel driver that does so, as its version on evdev
// tells).
CalibrationFile calibration_for(const DeviceInfo& device, bool has_factory_sticks);
// `FOLDER/054c_0ce6-UNIQUE.toml`: the same for the same device, another one for any other.
std::string calibration_path(const std::string& folder, const CalibrationFile& file);

// As save_text() does it, once it is sure that it can be read back. `comments` stand at the top,
// each a line.
std::optional<Error> save_calibration(const std::string& path, const CalibrationFile& file,
                                      const std::vector<std::string>& comments);

// What has changed from `then` to `now`, a sentence each with both numbers ("left stick: the centre
// has moved by 0.031 ...: more than half of the inner zone"); empty where nothing counts. Of `now`
// only what was measured is looked at; of `then` also what stands there unmeasured, since it
// steers.
std::vector<std::string> changes_since(const CalibrationFile& then, const CalibrationFile& now);

}  // namespace gaitpad
