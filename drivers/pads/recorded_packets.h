// The packets of a recording through the quirks of its pads, as drivers take those of an open pad.
#pragma once
#include "gaitpad/trace.h"

namespace gaitpad {

// Leaves out packets that are no input, replaces those that together make a state by the state, and
// makes plugging of what an adapter says about its plugs. A session (a trace with ticks) stays as
// it is: it was recorded behind the quirks. So does what evdev or SDL have handed on.
void accept_packets(Trace& trace);

}  // namespace gaitpad
