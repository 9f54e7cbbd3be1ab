// What the machine shows of pads, whether or not a driver can open them: doctor's eyes. Reads
// sysfs, /dev and /proc; changes nothing.
#pragma once
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
  std::string usb_node;                   // its USB device's
};

struct Machine {
  std::vector<PadHardware> pads;
  std::vector<SystemNode> usb_devices;  // all of them, hubs left out
  std::vector<PadSighting> sightings;   // of the drivers
  bool has_udev = false;                // udevd runs
  bool is_container = false;
};

// `rules`: the shipped ones; whom they name is a pad, even where nothing could be read of it.
Machine look_at_machine(std::vector<PadSighting> sightings, const PadOverrides& overrides,
                        const std::string& rules);

// `steam (1234), ...`: the other programs that have the node open, as far as one may see; empty.
std::string users_of(const std::string& node);
// Whether another program has the event node for itself (EVIOCGRAB).
bool is_grabbed(const std::string& event_node);
std::string own_user_name();

}  // namespace gaitpad
