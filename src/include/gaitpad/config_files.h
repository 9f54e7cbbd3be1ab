// Files that belong to the user: where they stand, and how one is written so that nothing is ever
// lost half-way.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "gaitpad/result.h"
#include "gaitpad/style.h"

namespace gaitpad {

// $XDG_CONFIG_HOME/gaitpad, else $HOME/.config/gaitpad; empty where neither is an absolute path. It
// need not exist.
std::string user_config_folder();

// Why nothing could be saved there, as far as that is seen before it is tried.
std::optional<Error> saving_problem(const std::string& path);

// Makes the folder, writes a temporary file beside `path`, puts it in its place at once; what stood
// there before is kept as PATH.old. Where `path` is a symbolic link, both happen where it points to
// and it stays one. On error `path` is as it was.
std::optional<Error> save_text(const std::string& path, const std::string& text);

// Where the program's configuration files stand, and which of them a user's FILE|NAME means.

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

// A user's own styles: files in the user's folder, found by every session from then on.

// STYLES/NAME.toml in user_config_folder(), its path. `name` is for a file and for commands: at
// most 48 letters, digits, `_`, `-`; blanks become `_`. Error where it is not, or where a style of
// `config_folders` (config_files.h) has it that is not the user's own; the user's own is replaced,
// and kept as PATH.old.
Result<std::string> save_style(const std::vector<std::string>& config_folders,
                               const std::string& name, const StyleValues& values);

}  // namespace gaitpad
