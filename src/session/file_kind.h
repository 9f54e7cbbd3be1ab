// Files that a person opens or drops: what they are, and which session they make.
#pragma once
#include <string>

#include "gaitpad/result.h"
#include "gaitpad/session_spec.h"

namespace gaitpad {

enum class FileKind { motion, character, style, calibration, terrain, recording };

// Known by its ending; a .toml by its folder (styles, characters, calibration, terrain, motions),
// else by its content. Fails if it is not a file or none of these.
Result<FileKind> kind_of_file(const std::string& path);

// The given options with this file. A style or a character is for walker `walker`, or for all of
// them if that is -1. The new session is not recorded.
SessionSpec with_file(SessionSpec options, const std::string& path, FileKind kind, int walker,
                      int walker_count);

}  // namespace gaitpad
