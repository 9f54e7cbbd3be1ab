// Compiled for processors with AVX2 alone (widest_lanes() in base/lanes.h).
#include "motion/pose_rows_lanes.h"

namespace gaitpad {

template void blend_rows<4>(const BlendedRows&) noexcept;

}  // namespace gaitpad
