// Pads for tests: the shipped pad files, recordings, reports of given bytes, and event nodes as
// Linux's drivers state them.
#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "gaitpad/decode.h"
#include "gaitpad/trace.h"
#include "hid/evdev_layout.h"
#include "tests/folders.h"
#include "tests/value_of.h"

namespace gaitpad {

inline const std::string kGoldenPads = kSourceFolder + "/tests/data/pads";

inline PadOverrides shipped_pads() {
  return value_of(load_pad_folder(kSourceFolder + "/config/pads"));
}

inline Report report_of(const std::vector<std::uint8_t>& bytes, std::int64_t time_ns = 0) {
  Report report;
  report.time_ns = time_ns;
  report.size = static_cast<std::uint16_t>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), report.bytes.begin());
  return report;
}

// A recording's first device.
struct RecordedPad {
  Trace trace;
  PadLayout layout;
};
inline RecordedPad recorded_pad(const std::string& path, const PadOverrides& overrides) {
  RecordedPad pad;
  pad.trace = value_of(read_trace(path));
  pad.layout = value_of(pad_layout(pad.trace.devices.at(0).info, overrides));
  return pad;
}

// Divided by blanks.
inline std::string names_of(std::uint32_t buttons) {
  std::string names;
  for (std::size_t b = 0; b < kButtonNames.size(); ++b) {
    if ((buttons >> b) & 1u) names += (names.empty() ? "" : " ") + std::string(kButtonNames[b]);
  }
  return names;
}

// xpad, drivers/input/joystick/xpad.c.
inline EvdevAbilities xpad_node() {
  return {{{0, -32768, 32767},
           {1, -32768, 32767},
           {2, 0, 255},
           {3, -32768, 32767},
           {4, -32768, 32767},
           {5, 0, 255},
           {0x10, -1, 1},
           {0x11, -1, 1}},
          {0x130, 0x131, 0x133, 0x134, 0x136, 0x137, 0x13a, 0x13b, 0x13c, 0x13d, 0x13e}};
}
// hid-playstation and hid-sony: all eight bits wide, both ways of a trigger.
inline EvdevAbilities playstation_node() {
  return {
      {{0, 0, 255},
       {1, 0, 255},
       {2, 0, 255},
       {3, 0, 255},
       {4, 0, 255},
       {5, 0, 255},
       {0x10, -1, 1},
       {0x11, -1, 1}},
      {0x130, 0x131, 0x133, 0x134, 0x136, 0x137, 0x138, 0x139, 0x13a, 0x13b, 0x13c, 0x13d, 0x13e}};
}
inline EvdevAbilities nintendo_node() {
  return {{{0, -32767, 32767},
           {1, -32767, 32767},
           {3, -32767, 32767},
           {4, -32767, 32767},
           {0x10, -1, 1},
           {0x11, -1, 1}},
          {0x130, 0x131, 0x133, 0x134, 0x135, 0x136, 0x137, 0x138, 0x139, 0x13a, 0x13b, 0x13c,
           0x13d, 0x13e}};
}

}  // namespace gaitpad
