// Passes the packets of a recording through the quirks of its pads, as drivers do with those of an
// open pad.
#pragma once
#include "gaitpad/trace.h"

namespace gaitpad {

// Leaves out packets that are no input, replaces those that together make a state by the state, and
// turns an adapter's messages about its plugs into plugging and unplugging. A session (a trace with
// ticks) stays as it is: it was recorded behind the quirks. So does what evdev or SDL have handed
// on.
void accept_packets(Trace& trace);

}  // namespace gaitpad
