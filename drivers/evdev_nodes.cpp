#include "drivers/evdev_nodes.h"

#include <errno.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <linux/input.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <map>
#include <mutex>
#include <string_view>
#include <utility>

#include "drivers/driver_entries.h"
#include "drivers/system_nodes.h"

namespace gaitpad {

namespace {

// Kernel drivers that give out codes of their own (sony, playstation, nintendo) mark the version.
constexpr int kArrangedByKernel = 0x8000;

// A sentence for errno, with the cure where it is a permission.
Error open_error(const std::string& node, int error) {
  const std::string access = error == EACCES || error == EPERM ? access_problem(node) : "";
  return Error{access.empty() ? fmt::format("{}: {}", node, std::strerror(error)) : access};
}

EvdevAbilities abilities_of(const libevdev* device) {
  EvdevAbilities abilities;
  for (std::uint16_t code = 0; code <= evdev::kAbsMax; ++code) {
    const input_absinfo* range = libevdev_get_abs_info(device, code);
    if (range) abilities.axes.push_back({code, range->minimum, range->maximum});
  }
  for (std::uint16_t code = 0; code <= evdev::kKeyMax; ++code) {
    if (libevdev_has_event_code(device, EV_KEY, code)) abilities.keys.push_back(code);
  }
  return abilities;
}

// The first 4096 bytes of a small file of sysfs; empty where there is none.
std::vector<std::uint8_t> sysfs_bytes(const std::string& node, const char* name) {
  const std::string device = node.substr(node.rfind('/') + 1);
  std::ifstream in(fmt::format("/sys/class/input/{}/device/{}", device, name), std::ios::binary);
  std::vector<std::uint8_t> bytes(kMaxDescriptorBytes);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
  return bytes;
}

}  // namespace

Result<InputNode> open_input_node(const std::string& node, int mode) {
  InputNode opened;
  opened.fd = OwnedFd(::open(node.c_str(), mode | O_NONBLOCK | O_CLOEXEC));
  if (opened.fd.get() < 0) return open_error(node, errno);
  opened.may_write = mode == O_RDWR;
  // Before libevdev reads the state: a change of clock throws queued events away.
  int clock = CLOCK_MONOTONIC;
  if (::ioctl(opened.fd.get(), EVIOCSCLOCKID, &clock) != 0) return open_error(node, errno);
  libevdev_set_log_function(nullptr, nullptr);  // it would print to stderr about odd devices
  libevdev* device = nullptr;
  const int status = libevdev_new_from_fd(opened.fd.get(), &device);
  if (status != 0) return open_error(node, -status);
  opened.device.reset(device);
  return opened;
}

EvdevLayout input_node_layout(const InputNode& opened, const std::string& node) {
  std::vector<std::uint8_t> own_descriptor;
  if ((libevdev_get_id_version(opened.device.get()) & kArrangedByKernel) == 0) {
    own_descriptor = sysfs_bytes(node, "device/report_descriptor");
  }
  return evdev_layout(abilities_of(opened.device.get()), own_descriptor);
}

namespace {

bool has_key_between(const libevdev* device, unsigned first, unsigned end) {
  for (unsigned code = first; code < end; ++code) {
    if (libevdev_has_event_code(device, EV_KEY, code)) return true;
  }
  return false;
}

// What else than the sticks and buttons of a pad the node is; empty: it is a pad.
const char* what_else(const libevdev* device, const SystemNode& node) {
  if (libevdev_has_property(device, INPUT_PROP_ACCELEROMETER) || node.name.ends_with("(IMU)") ||
      node.name.ends_with(" IMU")) {
    return "the motion sensor of a pad";
  }
  const bool has_stick = libevdev_has_event_code(device, EV_ABS, ABS_X) &&
                         libevdev_has_event_code(device, EV_ABS, ABS_Y);
  const bool has_buttons = has_key_between(device, BTN_JOYSTICK, BTN_DIGI);
  if (!has_buttons && has_key_between(device, BTN_DIGI, BTN_WHEEL)) {
    return "a touchpad or tablet";
  }
  if (!has_buttons && has_key_between(device, BTN_MOUSE, BTN_JOYSTICK)) return "a mouse";
  if (!has_stick) return "a device without a stick";
  const bool has_other_buttons = has_key_between(device, BTN_MISC, BTN_MOUSE) ||
                                 has_key_between(device, BTN_WHEEL, BTN_GEAR_UP + 1) ||
                                 has_key_between(device, BTN_DPAD_UP, BTN_DPAD_RIGHT + 1) ||
                                 has_key_between(device, BTN_TRIGGER_HAPPY, KEY_MAX + 1);
  if (has_buttons || has_other_buttons || node.is_joystick) return "";
  return "a device without buttons";
}

// Keyboards, mice and power buttons have neither ABS_X nor ABS_Y; they need not be opened to say
// so. The file holds words in hexadecimal, the lowest last.
bool cannot_have_a_stick(const std::string& node) {
  const std::vector<std::uint8_t> bits = sysfs_bytes(node, "capabilities/abs");
  const std::string text(bits.begin(), bits.end());
  const std::size_t end = text.find_last_not_of(" \n");
  if (end == std::string::npos) return false;  // unknown
  const char lowest = text[end];
  return std::string_view("37bfBF").find(lowest) == std::string_view::npos;
}

// What a node turned out to be once it was opened.
struct Seen {
  std::string other;  // what it is if it is no pad
  std::vector<std::uint8_t> descriptor;
};
// By what udev says of the input device, whose number is never used again. Kept, because nodes are
// looked at whenever anything is plugged in, and opening a HID pad takes the kernel 50 ms.
using Memory = std::map<std::string, Seen>;

// What the node is if it is no pad, or its descriptor; or why it cannot be opened.
Result<Seen> look_at(const SystemNode& node, const Memory& known) {
  if (node.is_motion_sensor) return Seen{"the motion sensor of a pad", {}};
  if (node.is_touchpad) return Seen{"a touchpad or tablet", {}};
  if (cannot_have_a_stick(node.node)) return Seen{"a device without a stick", {}};
  if (::access(node.node.c_str(), R_OK) != 0) return open_error(node.node, errno);
  const auto it = known.find(node.sysfs_path + (node.is_joystick ? " joystick" : ""));
  if (it != known.end()) return it->second;
  const auto opened = open_input_node(node.node, O_RDONLY);
  if (!opened) return opened.error();
  return Seen{what_else(opened->device.get(), node),
              input_node_layout(*opened, node.node).descriptor};
}

}  // namespace

std::vector<DeviceListing> find_evdev_devices() {
  static std::mutex one_at_a_time;
  static Memory known;
  const std::lock_guard lock(one_at_a_time);
  std::vector<DeviceListing> listings;
  Memory still_there;
  for (const SystemNode& node : system_nodes("input")) {
    DeviceListing& listing = listings.emplace_back(listing_of(node, "evdev"));
    auto seen = look_at(node, known);
    if (!seen) {
      listing.problem = seen.error().message;
      continue;
    }
    listing.info.descriptor = seen->descriptor;
    if (!seen->other.empty()) {
      listing.is_other = true;
      listing.problem = fmt::format("{}: {} is {}, not a pad", node.node, node.name, seen->other);
    }
    if (seen->descriptor.empty()) continue;
    still_there[node.sysfs_path + (node.is_joystick ? " joystick" : "")] = std::move(*seen);
  }
  known = std::move(still_there);
  return listings;
}

}  // namespace gaitpad
