// How many walks a crowd computes side by side.
#pragma once

namespace gaitpad {

// Numbers in the widest registers of this processor: 16 with AVX-512, 8 with AVX2, otherwise 4.
// Code that is compiled for wider ones must not be called.
int widest_lanes() noexcept;
// Lanes in use: widest_lanes(), unless tests and measurements set fewer by use_lanes() (1, 4, 8,
// 16). Results have the same bits. With 1, the walks of a crowd are computed one by one.
int lanes_in_use() noexcept;
void use_lanes(int lanes) noexcept;

}  // namespace gaitpad
