#include "doctor/machine.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>

#include "base/text.h"
#include "doctor/udev_rules.h"
#include "drivers/system_users.h"
#include "gaitpad/decode.h"

namespace gaitpad {
namespace fs = std::filesystem;

namespace {

using PadsByPath = std::map<std::string, PadHardware>;

constexpr std::uint8_t kHubClass = 9;

PadHardware& pad_at(PadsByPath& pads, const std::string& path, const SystemNode& node) {
  PadHardware& pad = pads[path];
  pad.path = path;
  if (pad.vendor != 0 || pad.product != 0) return pad;
  pad.name = node.name;
  pad.bus = node.bus;
  pad.vendor = node.vendor;
  pad.product = node.product;
  return pad;
}

RuleSubject subject_of(const SystemNode& node) {
  return {static_cast<std::uint16_t>(node.bus), node.vendor, node.product, std::nullopt};
}

// True if the descriptor or config/pads says that it is a pad.
bool describes_pad(const SystemNode& node, const PadOverrides& overrides) {
  DeviceInfo info;
  info.bus = node.bus;
  info.vendor = node.vendor;
  info.product = node.product;
  info.driver = "hidraw";
  info.name = node.name;
  info.descriptor = node.descriptor;
  const auto layout = pad_layout(info, overrides);
  return layout && layout->is_pad;
}

// True if a driver could read that the node is a pad. Without udev this is the only evidence.
bool is_sighted(const std::vector<PadSighting>& sightings, const std::string& node) {
  return std::ranges::any_of(sightings, [&](const PadSighting& sighting) {
    return sighting.is_pad && sighting.listing.node == node &&
           !sighting.listing.info.descriptor.empty();
  });
}

void add_hidraw(const Machine& machine, const PadOverrides& overrides, PadsByPath& pads) {
  for (const SystemNode& node : system_nodes("hidraw")) {
    if (describes_pad(node, overrides) || is_sighted(machine.sightings, node.node))
      pad_at(pads, node.pad_path, node).hidraw.push_back(node);
  }
}

// Adds event nodes; motion sensors and touchpads belong to their pad.
void add_events(const Machine& machine, PadsByPath& pads) {
  const std::vector<SystemNode> nodes = system_nodes("input");
  for (const SystemNode& node : nodes) {
    const bool is_part = node.is_motion_sensor || node.is_touchpad;
    if (!is_part && (node.is_joystick || is_sighted(machine.sightings, node.node)))
      pad_at(pads, node.pad_path, node);
  }
  for (const SystemNode& node : nodes) {
    if (auto pad = pads.find(node.pad_path); pad != pads.end()) pad->second.events.push_back(node);
  }
}

bool is_hub(const SystemNode& device) {
  return sysfs_hex(device.sysfs_path + "/bDeviceClass") == kHubClass;
}

bool has_pad_name(std::string_view device_name) {
  const std::string name = lower_case(device_name);
  return std::ranges::any_of(
      std::initializer_list<const char*>{"gamepad", "game pad", "joystick", "joypad"},
      [&](const char* word) { return name.find(word) != std::string::npos; });
}

// A vendor-class interface is judged by its class. A HID interface that no specific driver serves
// and that is not a keyboard or mouse may be a pad if its name or the rules say so, or if usbhid is
// not bound to it: the kernel binds every HID interface, so a program has detached it.
bool looks_like_pad(const SystemNode& device, const UsbInterface& interface,
                    const std::string& rules) {
  if (interface.ids.interface_class != kHidClass) return may_be_pad(interface);
  if (!interface.hid_driver.empty() || !boot_device(interface).empty()) return false;
  std::error_code ignored;
  const bool was_taken =
      interface.kernel_driver.empty() && fs::exists("/sys/bus/usb/drivers/usbhid", ignored);
  return was_taken || has_pad_name(device.name) || opens_hidraw(rules, subject_of(device));
}

void add_usb(Machine& machine, const std::string& rules, PadsByPath& pads) {
  for (const SystemNode& device : system_nodes("usb")) {
    if (is_hub(device)) continue;
    machine.usb_devices.push_back(device);
    for (UsbInterface& interface : usb_interfaces(device.sysfs_path)) {
      if (!pads.contains(interface.path) && !looks_like_pad(device, interface, rules)) continue;
      PadHardware& pad = pad_at(pads, interface.path, device);
      pad.usb_node = device.node;
      pad.interface = std::move(interface);
    }
  }
}

bool is_in_container() {
  std::error_code ignored;
  return fs::exists("/.dockerenv", ignored) || fs::exists("/run/.containerenv", ignored) ||
         fs::exists("/run/systemd/container", ignored);
}

}  // namespace

Machine look_at_machine(std::vector<PadSighting> sightings, const PadOverrides& overrides,
                        const std::string& rules) {
  Machine machine;
  machine.sightings = std::move(sightings);
  std::error_code ignored;
  machine.has_udev = fs::exists("/run/udev/control", ignored);
  machine.is_container = is_in_container();
  PadsByPath pads;
  add_hidraw(machine, overrides, pads);
  add_events(machine, pads);
  add_usb(machine, rules, pads);
  for (auto& [path, pad] : pads) machine.pads.push_back(std::move(pad));
  return machine;
}

std::string users_of(const std::string& node) {
  std::string users;
  std::error_code error;
  for (const fs::directory_entry& process : fs::directory_iterator("/proc", error)) {
    const std::string id = process.path().filename().string();
    if (id.find_first_not_of("0123456789") != std::string::npos) continue;
    if (id == std::to_string(own_process_id())) continue;
    std::error_code closed;  // another user's process, or one that has ended
    fs::directory_iterator file(process.path() / "fd", closed);
    for (; !closed && file != fs::directory_iterator(); file.increment(closed)) {
      std::error_code gone;
      if (fs::read_symlink(file->path(), gone) != node) continue;
      std::ifstream in(process.path() / "comm");
      std::string name;
      std::getline(in, name);
      users += fmt::format("{}{} ({})", users.empty() ? "" : ", ", name, id);
      break;
    }
  }
  return users;
}

}  // namespace gaitpad
