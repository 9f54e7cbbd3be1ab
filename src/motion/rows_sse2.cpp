// Compiled for every processor.
#include "motion/rows_lanes.h"

namespace gaitpad {

template void blend_rows<kLeastLanes>(const BlendedRows&) noexcept;
template void fade_rows<kLeastLanes>(const BlendedRows&) noexcept;
template void sum_rows<kLeastLanes>(const SummedRows&) noexcept;

}  // namespace gaitpad
