// A file that somebody opens or drops: what it is, and the session that it makes.
#pragma once
#include <string>

#include "gaitpad/result.h"
#include "view/show.h"

namespace gaitpad {

enum class FileKind { motion, character, style, calibration, terrain, recording };

// By its ending; a .toml by the folder that it stands in (styles, characters, calibration,
// terrain, motions), else by what stands in it. Error where it is no file or none of these.
Result<FileKind> kind_of_file(const std::string& path);

// The show that runs, with this file. A style or a character is for walker `walker`, -1: for all.
// Nothing is recorded in it.
SessionSpec with_file(SessionSpec options, const std::string& path, FileKind kind, int walker,
                      int walker_count);

}  // namespace gaitpad
