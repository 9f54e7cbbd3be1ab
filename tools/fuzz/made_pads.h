// Pads for the fuzz targets, and what holds for the state of every pad.
#pragma once
#include <cstdlib>

#include "gaitpad/decode.h"
#include "hid/evdev_layout.h"

namespace gaitpad {

// X, Y, Z, Rz of 8 bits, a hat and 12 buttons, without report id: six bytes a report.
inline DeviceInfo made_hid_pad() {
  DeviceInfo device;
  device.bus = BusType::usb;
  device.vendor = 0x1209;
  device.product = 0x0001;
  device.name = "Example Walk Pad";
  device.descriptor = {0x05, 0x01, 0x09, 0x05, 0xa1, 0x01, 0x15, 0x00, 0x26, 0xff, 0x00,
                       0x75, 0x08, 0x95, 0x04, 0x09, 0x30, 0x09, 0x31, 0x09, 0x32, 0x09,
                       0x35, 0x81, 0x02, 0x15, 0x00, 0x25, 0x07, 0x75, 0x04, 0x95, 0x01,
                       0x09, 0x39, 0x81, 0x42, 0x05, 0x09, 0x15, 0x00, 0x25, 0x01, 0x75,
                       0x01, 0x95, 0x0c, 0x19, 0x01, 0x29, 0x0c, 0x81, 0x02, 0xc0};
  return device;
}

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
