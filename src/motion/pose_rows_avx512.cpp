// Compiled for processors with AVX-512 alone (widest_lanes() in base/lanes.h).
#include "motion/pose_rows_lanes.h"

namespace gaitpad {

template void blend_rows<8>(const BlendedRows&) noexcept;

}  // namespace gaitpad
