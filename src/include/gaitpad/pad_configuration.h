// Makes a device a pad that can drive: its layout (config/pads, else a line of the user's data base
// or of SDL's) and its calibration. Set-up code: it reads files and allocates.
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

// The facts by which calibration files tell devices apart.
DeviceIdentity identity_of(const DeviceInfo& info);

// Everything that files say about pads; load_pad_files() fills it. A session reads them once.
struct PadFiles {
  PadOverrides overrides;  // --map first, then config/pads
  // The file of --calibration, for every pad except the keyboard.
  std::optional<CalibrationFile> calibration;
  std::string user_calibrations;  // the user's folder, for live pads only
  // Folders that are otherwise searched for the best fitting file.
  std::vector<std::string> calibration_folders;
  // Mappings of the user's data base, the most important first, for live pads only:
  // $SDL_GAMECONTROLLERCONFIG, $SDL_GAMECONTROLLERCONFIG_FILE, user_mapping_file().
  // `mapping_problem` says why one of the files cannot be read; empty: all were read.
  std::vector<std::string> mappings;
  std::string mapping_problem;
};
// Path of gamecontrollerdb.txt in the user's folder, whether it exists or not; empty: there is no
// folder.
std::string user_mapping_file();
// Writes these mappings into such a file. They replace those of the same pads; the others stay.
// Returns the number of mappings in the file.
Result<std::size_t> save_mappings(const std::string& path, const std::vector<std::string>& lines);
inline constexpr std::size_t kMaxMappingFileBytes = std::size_t{8} << 20;

// Reads all of it. `map` and `calibration` are paths; empty: none. Error: a file that cannot be
// read.
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
// The configurations of all devices of the recording `source`.
Result<std::vector<PadConfig>> pad_configs(const PadFiles& files,
                                           const std::vector<TraceDevice>& devices,
                                           const std::string& source);

// A live device as a recording will hold it, and the calibration in force. pad_config() of either
// gives the same configuration bit by bit, so a replay is exact.
struct RecordedDevice {
  TraceDevice device;           // has the calibration as text, and a mapping
  CalibrationFile calibration;  // the parts of it that the text keeps: name, mapping, numbers
};
// Chooses a live device's calibration. A file for this one device (by unique id or port) takes
// precedence over the pad's factory sticks, and these over a file for its model (whose dead zones
// stay). Of files that fit equally well the user's is taken. Without a mapping in the calibration
// the device gets one of the user's data base, else of SDL's, if config/pads has no entry for it.
// `remarks` receives a sentence for each damaged file that was skipped.
RecordedDevice recorded_device(const PadFiles& files, const DeviceInfo& info,
                               const std::optional<FactorySticks>& factory,
                               std::vector<std::string>& remarks);

}  // namespace gaitpad
