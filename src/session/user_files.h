// Files that belong to the user: where they stand, and how one is written so that nothing is ever
// lost half-way.
#pragma once
#include <optional>
#include <string>

#include "base/result.h"

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

}  // namespace gaitpad
