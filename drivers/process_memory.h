// The memory that this process uses.
#pragma once
#include <cstdint>

namespace gaitpad {

// Bytes that the process has mapped, and bytes of those that are in memory now. 0 if not known.
std::int64_t mapped_bytes();
std::int64_t resident_bytes();

}  // namespace gaitpad
