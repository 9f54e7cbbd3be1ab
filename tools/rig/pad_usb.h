// A pad as a USB device: a configfs gadget with one FunctionFS function on dummy_udc.INDEX.
#pragma once
#include "pad_kinds.h"

// Open endpoints of the function; both data endpoints are interrupt endpoints of 64 bytes.
struct endpoints {
  int control, in, out;
};

// Mounts the function below `folder` and states its descriptors; ends the program if that fails.
struct endpoints make_gadget(const struct pad_kind* kind, int index, const char* serial,
                             const char* folder);
void plug_gadget(int index, bool on);
