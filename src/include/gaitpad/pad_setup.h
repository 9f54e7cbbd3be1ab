// From a device to a pad that can drive: its layout (config/pads, SDL's data base) and its
// calibration.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "gaitpad/driver.h"
#include "gaitpad/pad_map.h"
#include "gaitpad/pads.h"
#include "gaitpad/result.h"
#include "gaitpad/trace.h"

namespace gaitpad {

// What calibrations tell devices apart by.
DeviceIdentity identity_of(const DeviceInfo& info);

// What stands in files about pads, read once.
struct PadFiles {
  PadOverrides overrides;                        // --map first, then config/pads
  std::optional<CalibrationFile> calibration;    // --calibration
  std::string user_calibrations;                 // the user's folder, for live pads alone
  std::vector<std::string> calibration_folders;  // else the best fitting file of these
};
// `map` and `calibration` are paths, empty for none.
Result<PadFiles> load_pad_files(const std::vector<std::string>& config_folders,
                                const std::string& map, const std::string& calibration);

// A device of a recording: calibration is --calibration's, else the recording's own, else the best
// fitting file's, and never one of the user's folder: a replay is the same on every machine. The
// mapping that this calibration may hold goes before the controls that config/pads names; a
// descriptor that config/pads replaces stays as it is there. Sentences begin with `origin`.
Result<PadConfig> pad_config(const PadFiles& files, const TraceDevice& device,
                             const std::string& origin);
// All devices of one recording, `source` being its path.
Result<std::vector<PadConfig>> pad_configs(const PadFiles& files,
                                           const std::vector<TraceDevice>& devices,
                                           const std::string& source);

// A live device as a recording will hold it: with the calibration in force as text, and with its
// mapping, else SDL's line where config/pads has no entry for the pad. A file for this one device
// (unique id, port) comes before the pad's own factory sticks, these before a file for its model
// (whose zones they keep); of equal fit the user's file counts. `remarks` gets a sentence for each
// damaged file, which is left out.
TraceDevice recorded_device(const PadFiles& files, const DeviceInfo& info,
                            const std::optional<FactorySticks>& factory,
                            std::vector<std::string>& remarks);

// A live device as a recording will hold it, and the configuration to play with: the one that
// pad_config() makes of `recorded`, bit by bit. An error of the configuration begins with `origin`.
struct LivePad {
  TraceDevice recorded;
  Result<PadConfig> config;
};
LivePad live_pad(const PadFiles& files, const DeviceInfo& info,
                 const std::optional<FactorySticks>& factory, const std::string& origin,
                 std::vector<std::string>& remarks);

}  // namespace gaitpad
