// The strides of the built-in walk, solved while gaitpad was built
// (tools/strides/made_strides.cpp).
#pragma once
#include <cstdint>
#include <span>

namespace gaitpad {

// Bits of doubles: solver_input() of procedural_gait(), then each number of its family.
std::span<const std::uint64_t> made_strides() noexcept;

}  // namespace gaitpad
