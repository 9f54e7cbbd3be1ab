// A user's own styles: files in the user's folder, found by every session from then on.
#pragma once
#include <string>
#include <vector>

#include "base/result.h"
#include "control/style.h"

namespace gaitpad {

// STYLES/NAME.toml in user_config_folder(), its path. `name` is for a file and for commands: at
// most 48 letters, digits, `_`, `-`; blanks become `_`. Error where it is not, or where a style of
// `config_folders` (config_files.h) has it that is not the user's own; the user's own is replaced,
// and kept as PATH.old.
Result<std::string> save_style(const std::vector<std::string>& config_folders,
                               const std::string& name, const StyleValues& values);

}  // namespace gaitpad
