// The memory of this process.
#pragma once
#include <cstdint>

namespace gaitpad {

// All that it has mapped, and what of that is in memory now. 0 if not known.
std::int64_t mapped_bytes();
std::int64_t resident_bytes();

}  // namespace gaitpad
