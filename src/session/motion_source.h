// The motion that a session walks by.
#pragma once
#include <string>

#include "base/result.h"
#include "motion/motion.h"

namespace gaitpad {

// A BVH file, or a .toml file beside one that says what cannot be found in it: its unit and the
// joints of the legs (config/README.md, Motions).
Result<Motion> load_motion_source(const std::string& path);

}  // namespace gaitpad
