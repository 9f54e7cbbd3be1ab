// Pads for the fuzz targets, and a check for the state of any pad.
#pragma once
#include <cstdlib>

#include "gaitpad/decode.h"
#include "hid/evdev_layout.h"
#include "tests/made_pad.h"

namespace gaitpad {

// A node of evdev: X, Y, Z, RX, RZ within these bounds and four buttons.
inline DeviceInfo made_evdev_pad(std::int32_t min, std::int32_t max) {
  const EvdevAbilities abilities{
      {{0x00, min, max}, {0x01, min, max}, {0x02, min, max}, {0x05, min, max}, {0x09, 0, max}},
      {0x130, 0x131, 0x133, 0x134}};
  DeviceInfo device;
  device.vendor = 0x1209;
  device.product = 0x0001;
  device.driver = "evdev";
  device.descriptor = evdev_layout(abilities, {}).descriptor;
  return device;
}

inline void check_bounds(const PadState& state) {
  for (const float a : state.axis) {
    if (!(a >= -1.0f && a <= 1.0f)) std::abort();
  }
}

}  // namespace gaitpad
