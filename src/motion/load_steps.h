// What loading has in common for all formats: legs, up, units; and the formats beside BVH.
#pragma once
#include <string>

#include "motion/load.h"

namespace gaitpad {

enum class UpAxis { y = 1, z = 2 };

// Names the motion after its file, finds legs and pelvis, and the axis along which the hips stand
// above the ankles. `motion` is still in file units.
Result<UpAxis> find_body(Motion& motion, const std::string& path, const LoadOptions& options);

// To metres, y up. `stated_unit_m` is the length of the unit by the file itself, 0 where it says
// nothing; the options go before it.
Result<Motion> finished(Motion motion, UpAxis up, double stated_unit_m, const std::string& path,
                        const LoadOptions& options);

// load_motion() for .amc and .asf.
Result<Motion> load_amc(const std::string& path, const LoadOptions& options);
Result<Motion> load_asf(const std::string& path, const LoadOptions& options);

}  // namespace gaitpad
