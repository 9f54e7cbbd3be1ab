// From a device to a pad that can drive: its layout (config/pads, else a line of the user's data
// base or of SDL's) and its calibration. Set-up code: it reads files and allocates.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "gaitpad/driver.h"
#include "gaitpad/pad_overrides.h"
#include "gaitpad/pads.h"
#include "gaitpad/result.h"
#include "gaitpad/trace.h"

namespace gaitpad {

// What calibration files tell devices apart by.
DeviceIdentity identity_of(const DeviceInfo& info);

// What files say about pads; load_pad_files() fills it. A session reads them once.
struct PadFiles {
  PadOverrides overrides;                        // --map first, then config/pads
  std::optional<CalibrationFile> calibration;    // --calibration: for every pad but the keyboard
  std::string user_calibrations;                 // the user's folder, for live pads alone
  std::vector<std::string> calibration_folders;  // searched for the best fitting file otherwise
  // Lines of SDL's data base that the user has, the most important first, for live pads alone:
  // $SDL_GAMECONTROLLERCONFIG, $SDL_GAMECONTROLLERCONFIG_FILE, user_mapping_file(). And why one of
  // the files cannot be read; empty: none, or they can.
  std::vector<std::string> mappings;
  std::string mapping_problem;
};
// gamecontrollerdb.txt in the user's folder, whether it exists or not; empty: there is no folder.
std::string user_mapping_file();
// Writes these lines into such a file, over those of the same pads; the others stay. Returns how
// many there are now.
Result<std::size_t> save_mappings(const std::string& path, const std::vector<std::string>& lines);
inline constexpr std::size_t kMaxMappingFileBytes = std::size_t{8} << 20;

// `map` and `calibration` are paths; empty: none. Error: a file that cannot be read.
Result<PadFiles> load_pad_files(const std::vector<std::string>& config_folders,
                                const std::string& map, const std::string& calibration);

// The configuration of a device with this calibration. The calibration's mapping, if it has one,
// replaces the controls that config/pads names; a descriptor that config/pads replaces stays
// replaced. Error sentences begin with `origin`.
Result<PadConfig> pad_config(const PadFiles& files, const DeviceInfo& info,
                             const CalibrationFile& calibration, const std::string& origin);
// The configuration of a device of a recording. Its calibration is --calibration's, else the
// recording's own, else the best fitting file's; files of the user's folder are never used, so that
// a replay is the same on every machine.
Result<PadConfig> pad_config(const PadFiles& files, const TraceDevice& device,
                             const std::string& origin);
// All devices of the recording `source`.
Result<std::vector<PadConfig>> pad_configs(const PadFiles& files,
                                           const std::vector<TraceDevice>& devices,
                                           const std::string& source);

// A live device as a recording will hold it, and the calibration in force. pad_config() of either
// gives the same configuration bit by bit, so a replay is exact.
struct RecordedDevice {
  TraceDevice device;           // with the calibration as text, and with a mapping
  CalibrationFile calibration;  // only what the text keeps: name, mapping, numbers
};
// A calibration file for this one device (by unique id or port) counts more than the pad's factory
// sticks, and these count more than a file for its model (whose dead zones stay). Of files that fit
// equally well the user's counts. Without a mapping in the calibration the device gets a line of
// the user's data base, else of SDL's, if config/pads has no entry for it.
// `remarks` receives a sentence for each damaged file that was left out.
RecordedDevice recorded_device(const PadFiles& files, const DeviceInfo& info,
                               const std::optional<FactorySticks>& factory,
                               std::vector<std::string>& remarks);

}  // namespace gaitpad
