// The motion that a session walks by.
#pragma once
#include <string>
#include <vector>

#include "base/result.h"
#include "motion/load.h"

namespace gaitpad {

// Which file a user's FILE|NAME means: motions/NAME.toml of the configuration, unless it is a path
// (has a dot or a slash) or a file of that name stands here.
Result<std::string> motion_path(const std::vector<std::string>& folders,
                                const std::string& file_or_name);

// A BVH or AMC file, or a .toml file beside one that says what cannot be found in it: its unit, its
// skeleton, its frame rate, the joints of the legs; or a .toml file of poses (config/README.md,
// Motions).
// `given` goes before what the .toml file says.
Result<Motion> load_motion_source(const std::string& path, const LoadOptions& given = {});

}  // namespace gaitpad
