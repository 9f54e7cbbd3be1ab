// The motion that a session walks by.
#pragma once
#include <string>

#include "base/result.h"
#include "motion/load.h"

namespace gaitpad {

// A BVH or AMC file, or a .toml file beside one that says what cannot be found in it: its unit, its
// skeleton, its frame rate, the joints of the legs (config/README.md, Motions).
// `given` goes before what the .toml file says.
Result<Motion> load_motion_source(const std::string& path, const LoadOptions& given = {});

}  // namespace gaitpad
