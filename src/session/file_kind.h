// Files that a user opens or drops: their kind, and the session that each of them makes.
#pragma once
#include <string>

#include "gaitpad/result.h"
#include "gaitpad/session_spec.h"

namespace gaitpad {

enum class FileKind { motion, character, style, calibration, terrain, recording };

// The file name's ending tells the kind. For a .toml its folder does (styles, characters,
// calibration, terrain, motions), else its content. Error: not a file, or none of these kinds.
Result<FileKind> kind_of_file(const std::string& path);

// `options` with this file added. A style or a character applies to walker `walker`, or to all
// walkers if that is -1. The new session is not recorded.
SessionSpec with_file(SessionSpec options, const std::string& path, FileKind kind, int walker,
                      int walker_count);

}  // namespace gaitpad
