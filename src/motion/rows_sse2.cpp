// Compiled for every processor.
#include "motion/rows_lanes.h"

namespace gaitpad {

template void blend_rows<2>(const BlendedRows&) noexcept;
template void fade_rows<2>(const BlendedRows&) noexcept;
template void sum_rows<2>(const SummedRows&) noexcept;

}  // namespace gaitpad
