// How an evdev input node is stated as a HID device: its axes, hats and keys as one unnumbered
// report, so that the one decoder reads it. Plain data in, plain data out; the node itself is the
// evdev driver's (drivers/evdev_driver.cpp).
#pragma once
#include <array>
#include <bitset>
#include <cstdint>
#include <span>
#include <vector>

#include "hid/evdev_codes.h"
#include "hid/report.h"

namespace gaitpad {

struct EvdevAxis {
  std::uint16_t code = 0;
  std::int32_t min = 0,
               max = 0;  // as the kernel states them; a minimum that is no smaller: unknown
};
// What a node can tell, by code upwards.
struct EvdevAbilities {
  std::vector<EvdevAxis> axes;
  std::vector<std::uint16_t> keys;
};

struct EvdevState {
  std::array<std::int32_t, evdev::kAbsMax + 1> axis{};
  std::bitset<evdev::kKeyMax + 1> keys;  // pressed
};

// Where a code stands in the report.
struct EvdevField {
  EvdevCode code;
  bool is_hat = false;  // a whole one: this code and the next
  std::uint16_t bit_offset = 0;
  std::uint8_t bit_size = 0;
  std::int32_t min = 0, max = 0;
};
struct EvdevLayout {
  std::vector<std::uint8_t> descriptor;
  std::vector<EvdevField> fields;
  std::uint16_t report_bytes = 0;  // far below kMaxReportBytes, whatever a node claims
};

// Axes of multi-touch are left out. `own_descriptor` is that of the HID device behind the node,
// empty where there is none or where its kernel driver gave out codes of its own: the axes then
// stand in its order, because whether Z, Rz or Rx, Ry are the right stick shows in nothing else.
EvdevLayout evdev_layout(const EvdevAbilities& abilities,
                         std::span<const std::uint8_t> own_descriptor);

// Bytes of the report for that state. Values beyond an axis' range count as its end.
void put_state(const EvdevLayout& layout, const EvdevState& state, Report& report) noexcept;

}  // namespace gaitpad
