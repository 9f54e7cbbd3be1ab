// How many walks a crowd computes side by side.
//
// Registers are the vector types of GCC and Clang. For other compilers, and where
// GAITPAD_NO_VECTORS is defined, a crowd computes one walk after the other.
#pragma once
#include <array>

#if !defined(GAITPAD_NO_VECTORS) && !defined(__GNUC__)
#define GAITPAD_NO_VECTORS
#endif

namespace gaitpad {

// The numbers of walks that the tick is compiled for.
#ifdef GAITPAD_NO_VECTORS
inline constexpr std::array<int, 1> kLaneCounts = {1};
inline constexpr int kLeastLanes = 1;
#else
inline constexpr std::array<int, 4> kLaneCounts = {16, 8, 4, 1};
inline constexpr int kLeastLanes = 4;  // of the narrowest registers
#endif

// Numbers in the widest registers of this processor: 16 with AVX-512, 8 with AVX2, otherwise 4;
// without vector types 1.
// Code that is compiled for wider ones must not be called.
int widest_lanes() noexcept;
// Lanes in use: widest_lanes(), unless tests and measurements set fewer by use_lanes() (1, 4, 8,
// 16). Results have the same bits. With 1, the walks of a crowd are computed one by one.
int lanes_in_use() noexcept;
void use_lanes(int lanes) noexcept;

}  // namespace gaitpad
