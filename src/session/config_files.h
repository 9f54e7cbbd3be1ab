// Where the program's configuration files stand, and which of them a user's FILE|NAME means.
#pragma once
#include <string>
#include <vector>

#include "base/result.h"

namespace gaitpad {

// Folders laid out like config/, the first one that has a file wins: $GAITPAD_CONFIG, the user's
// (user_files.h; what stands there of pads and calibrations is no configuration, load_pad_files()
// leaves it out), then beside the program (../share/gaitpad, ../config), then `built_in`. Only
// those that exist.
std::vector<std::string> config_folders(const std::string& built_in);

// A path where `file_or_name` has a slash or ends in .toml, else KIND/NAME.toml of the first folder
// that has it. The sentence for an unknown name lists the known ones.
Result<std::string> config_file(const std::vector<std::string>& folders, const std::string& kind,
                                const std::string& file_or_name);

// Every KIND/NAME.toml, ordered by name; of equal names the first folder's.
std::vector<std::string> config_files(const std::vector<std::string>& folders,
                                      const std::string& kind);

// The file's name without folder and .toml: the name by which styles and characters are called.
std::string config_name(const std::string& path);

}  // namespace gaitpad
