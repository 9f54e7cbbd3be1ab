// frames.csv: one row a tick, what a character did, in metres, seconds and radians of the world.
#pragma once
#include <fmt/format.h>

#include <cstdint>

#include "animation/walk.h"
#include "stick/stick.h"

namespace gaitpad {

void append_frames_header(fmt::memory_buffer& out);
// The state after `tick`, which had `stick` and ran at rate_hz.
void append_frames_row(std::int64_t tick, int rate_hz, const Stick& stick, const WalkFrame& frame,
                       fmt::memory_buffer& out);

}  // namespace gaitpad
