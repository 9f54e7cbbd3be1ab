// Collects what the system knows of pads, whether or not a driver can open them. Reads sysfs,
// /dev and /proc and changes nothing.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/system_nodes.h"
#include "drivers/usb_interfaces.h"
#include "gaitpad/pad_overrides.h"
#include "gaitpad/pad_stream.h"

namespace gaitpad {

// One pad with all its nodes.
struct PadHardware {
  std::string path;  // equal for all nodes of one pad (DeviceListing::pad_path)
  std::string name;
  BusType bus = BusType::unknown;
  std::uint16_t vendor = 0, product = 0;
  std::vector<SystemNode> hidraw, events;
  std::optional<UsbInterface> interface;  // the pad's USB interface; none if it is not on USB
  std::string usb_node;                   // device node of the whole USB device
};

struct Machine {
  std::vector<PadHardware> pads;
  std::vector<SystemNode> usb_devices;  // USB devices without hubs
  std::vector<PadSighting> sightings;   // the pads that the drivers see
  bool has_udev = false;                // udevd is running on this machine
  bool is_container = false;
};

// `rules`: the shipped rules. A device that they name is a pad even if it cannot be read.
Machine look_at_machine(std::vector<PadSighting> sightings, const PadOverrides& overrides,
                        const std::string& rules);

// Other programs that have the node open, if this user may see them: `steam (1234), ...`.
std::string users_of(const std::string& node);

}  // namespace gaitpad
