// Passes the packets of a recording through the quirks of its pads, as drivers do with those of an
// open pad.
#pragma once
#include "gaitpad/trace.h"

namespace gaitpad {

// Leaves out packets that are no input, replaces those that together make a state by the state, and
// turns an adapter's messages about its plugs into plugging and unplugging. A session (a trace with
// ticks) stays unchanged, because it was recorded behind the quirks; so do devices of evdev and
// SDL.
void accept_packets(Trace& trace);

}  // namespace gaitpad
