// Compiled for processors with AVX-512 alone (base/lanes.h asks for them).
#include "motion/rows_lanes.h"

namespace gaitpad {

#ifndef GAITPAD_NO_VECTORS
template void blend_rows<8>(const BlendedRows&) noexcept;
template void fade_rows<8>(const BlendedRows&) noexcept;
template void sum_rows<8>(const SummedRows&) noexcept;
#endif

}  // namespace gaitpad
