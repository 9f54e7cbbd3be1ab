// Styles, characters and terrains as files, and the folders in which a program finds them by name.
// config/README.md describes the grammar of the files. Reading is strict: an unknown key, a wrong
// type and a value out of its bounds are errors, `FILE:LINE: cause`.
//
//   const auto folders = gaitpad::config_folders("/usr/share/mygame/gaitpad");
//   const auto path = gaitpad::config_file(folders, "styles", "limp");
//   if (!path) return fail(path.error().message);
//   const auto style = gaitpad::load_style(*path);
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/result.h"
#include "gaitpad/style.h"
#include "gaitpad/terrain.h"
#include "gaitpad/walk_model.h"

namespace gaitpad {

// Reads a style. Values that the file leaves out are the plain style's.
Result<Style> load_style(const std::string& path);
// The text of a file from which load_style() reads the same values; never empty.
std::string style_text(const Style& style);

// Reads a character's build: its name, its scale, the ratio of its legs.
Result<Character> load_character(const std::string& path);

// Reads a terrain, and the height pictures (grey PNG) that it names, relative to the file.
Result<Terrain> load_terrain(const std::string& path);
// Reads a terrain from a text. `path` is used in error sentences, and pictures are relative to it.
Result<Terrain> parsed_terrain(std::string_view text, const std::string& path);

// The folder of a user's own files: $XDG_CONFIG_HOME/gaitpad, else $HOME/.config/gaitpad. Empty if
// neither variable is an absolute path. The folder need not exist.
std::string user_config_folder();

// The folders of configuration that exist, laid out like this repository's config/, the most
// important one first: $GAITPAD_CONFIG, ../share/gaitpad and ../config beside the program's folder,
// `built_in` (empty: none), the user's. Of files with the same name the first folder's counts, so a
// user's file never hides a bundled one. Calibrations and pad files in the user's folder are found
// by other functions.
std::vector<std::string> config_folders(const std::string& built_in);

// The path that a user's FILE|NAME means: FILE itself if it has a slash or ends in .toml, else
// KIND/NAME.toml in the first folder that has it. `kind` is a sub-folder: "styles", "characters",
// "terrain", "motions". The error for an unknown name lists the known ones.
Result<std::string> config_file(const std::vector<std::string>& folders, const std::string& kind,
                                const std::string& file_or_name);

// All files KIND/NAME.toml (or with another ending), ordered by name; of equal names the first
// folder's.
std::vector<std::string> config_files(const std::vector<std::string>& folders,
                                      const std::string& kind, std::string_view ending = ".toml");

// The name of a file in options: without its folder and without .toml.
std::string config_name(const std::string& path);

// A configuration file or recording in one sentence: the first sentence of the comment at its
// beginning, without brackets and their content; empty if there is none.
std::string config_summary(const std::string& path);

// Saves a style of the user's own as styles/NAME.toml in user_config_folder() and returns the path.
// Error if check() refuses the values, if the name is not of 1 to 48 letters, digits, blanks, `_`
// and `-`, if a style in `config_folders` that is not the user's own has it, or if the file cannot
// be written. A style of the same name is replaced and kept as PATH.old.
Result<std::string> save_style(const std::vector<std::string>& config_folders,
                               const std::string& name, const StyleValues& values);

}  // namespace gaitpad
