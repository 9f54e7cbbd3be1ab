// What the machine shows of pads, whether or not a driver can open them. Looking reads sysfs, /dev
// and /proc and changes nothing.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/system_nodes.h"
#include "drivers/usb_interfaces.h"
#include "gaitpad/pad_map.h"
#include "gaitpad/pad_stream.h"

namespace gaitpad {

// One pad with all its nodes.
struct PadHardware {
  std::string path;  // DeviceListing::pad_path
  std::string name;
  BusType bus = BusType::unknown;
  std::uint16_t vendor = 0, product = 0;
  std::vector<SystemNode> hidraw, events;
  std::optional<UsbInterface> interface;  // of a pad on USB
  std::string usb_node;                   // of its USB device
};

struct Machine {
  std::vector<PadHardware> pads;
  std::vector<SystemNode> usb_devices;  // all but hubs
  std::vector<PadSighting> sightings;   // of the drivers
  bool has_udev = false;                // udevd runs
  bool is_container = false;
};

// `rules`: the shipped ones. A device that they name is a pad even if nothing could be read of it.
Machine look_at_machine(std::vector<PadSighting> sightings, const PadOverrides& overrides,
                        const std::string& rules);

// The other programs that have the node open, as far as this user may see: `steam (1234), ...`.
std::string users_of(const std::string& node);
std::string own_user_name();

}  // namespace gaitpad
