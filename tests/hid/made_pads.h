// Pads for tests: the shipped pad files, recordings, reports of given bytes, states in words, and
// event nodes of Linux's drivers.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
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

// The first device of a recording.
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

// A foreign recording of a made DualShock 4 on hid-playstation, through the evdev driver: a state
// at rest, which is handed back, and 1.5 s later the left stick right and the south button.
inline void expect_push_of_dualshock(const Trace& trace, const std::string& name, PadState& rest) {
  ASSERT_EQ(trace.devices.size(), 1u);
  const DeviceInfo& info = trace.devices[0].info;
  EXPECT_EQ(info.name, name);
  EXPECT_EQ(info.bus, BusType::usb);
  EXPECT_EQ(info.vendor, 0x054c);
  EXPECT_EQ(info.product, 0x09cc);
  EXPECT_EQ(info.version, 0x8111);
  EXPECT_EQ(info.driver, "evdev");
  ASSERT_EQ(trace.events.size(), 2u);
  EXPECT_EQ(trace.events[1].time_us - trace.events[0].time_us, 1'500'000);
  const PadLayout layout = value_of(pad_layout(info, shipped_pads()));
  ASSERT_TRUE(decode(layout, report_of(trace, trace.events[0]), rest));
  EXPECT_NEAR(rest.axis[kLeftX], 1.0 / 255.0, 1e-6);
  EXPECT_EQ(rest.buttons, 0u);
  PadState state = rest;
  ASSERT_TRUE(decode(layout, report_of(trace, trace.events[1]), state));
  EXPECT_EQ(state.axis[kLeftX], 1.0f);
  EXPECT_TRUE(pressed(state, kButtonA));
}

// The names of these buttons, separated by blanks.
inline std::string names_of(std::uint32_t buttons) {
  std::string names;
  for (std::size_t b = 0; b < kButtonNames.size(); ++b) {
    if ((buttons >> b) & 1u) names += (names.empty() ? "" : " ") + std::string(kButtonNames[b]);
  }
  return names;
}

// A state in words, as in tests/data/pads: the axes that are not 0 (to 0.01), then `buttons` and
// the pressed ones: "left_x 1 left_y -0.5 buttons a dpup".
inline void expect_state(const PadState& state, const std::string& words) {
  std::array<float, kAxisCount> axis{};
  std::uint32_t buttons = 0;
  std::istringstream in(words);
  bool in_buttons = false;
  const auto place_in = [&](const auto& names, const std::string& word) {
    const auto it = std::find(names.begin(), names.end(), word);
    if (it == names.end()) throw std::runtime_error("no control \"" + word + "\" in: " + words);
    return static_cast<std::size_t>(it - names.begin());
  };
  for (std::string word; in >> word;) {
    if (in_buttons)
      buttons |= 1u << place_in(kButtonNames, word);
    else if (!(in_buttons = word == "buttons"))
      in >> axis[place_in(kAxisNames, word)];
  }
  for (int a = 0; a < kAxisCount; ++a)
    EXPECT_NEAR(state.axis[a], axis[a], 0.01) << kAxisNames[a] << " of: " << words;
  EXPECT_EQ(names_of(state.buttons), names_of(buttons)) << "of: " << words;
}

// The event node that xpad makes (drivers/input/joystick/xpad.c).
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
// The event node that hid-playstation and hid-sony make: all axes have eight bits, and a trigger is
// an axis and a key.
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
