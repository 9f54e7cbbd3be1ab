// HID devices that are several pads: Nintendo's adapter for four GameCube controllers, and devices
// whose descriptor has several pad collections with report ids of their own (adapters for two pads,
// the two halves of a Legion Go).
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "gaitpad/driver.h"

namespace gaitpad {

// A listing for each pad of the device; empty: it is one pad, or none. The first keeps its node,
// the others are `NODE:2` and so on, with ids and ports of their own. Each states a descriptor in
// which the other pads are none.
std::vector<DeviceListing> split_pads(const DeviceListing& device);
// The same listings, the split ones in place of the whole.
std::vector<DeviceListing> with_split_pads(const std::vector<DeviceListing>& devices);
// The node or port of the whole device.
std::string without_number(const std::string& part);
// Whether the descriptor is one that split_pads() states.
bool is_one_of_several(const std::vector<std::uint8_t>& descriptor);

}  // namespace gaitpad
