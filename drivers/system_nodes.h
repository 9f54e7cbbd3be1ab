// The system's knowledge (sysfs and udev, through libudev) of input hardware: its nodes, what they
// belong to, plugging in and unplugging. Used by the drivers' `find`, the finder and `gaitpad
// doctor`.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/driver.h"
#include "gaitpad/result.h"

namespace gaitpad {

// A node in /dev and what sysfs knows of the hardware behind it.
struct SystemNode {
  std::string node;           // /dev/hidraw3, /dev/input/event5, /dev/bus/usb/001/004
  std::string sysfs_path;     // of the node's own device
  std::string pad_path;       // as in DeviceListing
  std::string kernel_driver;  // of the HID device or USB interface: hid-generic, playstation, xpad
  BusType bus = BusType::unknown;
  std::uint16_t vendor = 0, product = 0;
  std::uint16_t version = 0;  // of the input device if there is one (part of SDL's GUID)
  std::string name, unique_id, physical_path;
  std::vector<std::uint8_t> descriptor;  // report_descriptor in sysfs; hidraw nodes only
  double poll_rate_hz = 0.0;             // 1 / bInterval of the interrupt IN endpoint; 0: unknown
  bool is_joystick = false, is_motion_sensor = false, is_touchpad = false;  // udev's ID_INPUT_*
};

// A file in /sys, at most 4096 bytes, without the blanks, quotes and line ends around it; empty:
// there is none.
std::string sysfs_text(const std::filesystem::path& path);
// The same as it is: a report descriptor.
std::vector<std::uint8_t> sysfs_bytes(const std::filesystem::path& path);
// The number that it holds, in hexadecimal; none: there is no such file, or no number.
std::optional<std::uint32_t> sysfs_hex(const std::filesystem::path& path);

// The version of the input device that the kernel made of a HID device or USB interface, as in
// SDL's GUID; 0: there is none.
std::uint16_t input_version(const std::filesystem::path& owner);

// The nodes of "hidraw", "input" (event nodes only) or "usb" (devices; pad_path is empty because
// they have several interfaces), ordered by node.
std::vector<SystemNode> system_nodes(std::string_view subsystem);
// The node as a driver lists it.
DeviceListing listing_of(const SystemNode& node, const char* driver);
// pad_path of a USB interface: `1-1.2:1.0` as in /sys/bus/usb/devices.
std::string usb_interface_path(const std::string& interface_name);
// The rate at which the interface's interrupt IN endpoint is polled, by its `interval` (`4ms`,
// `125us`); 0: unknown, or there is none.
double usb_poll_rate_hz(const std::string& interface_path);
// The state of the pad's battery, as the kernel's driver has it.
struct Battery {
  std::optional<int> percent;  // none: the pad tells a level only
  std::string level;           // critical, low, normal, high, full; empty: unknown
  std::string status;          // charging, discharging, full, not charging; empty: unknown
};
// The battery of the pad with this path; none: it has no battery, or no kernel driver that asks for
// it.
std::optional<Battery> battery_of(const std::string& pad_path);
// The same for a device that a stream has open.
std::optional<Battery> battery_of(const DeviceInfo& device);
// The reason why this user cannot open the node for reading and writing; empty: there is none.
// `/dev/hidraw3: permission denied (owner 0, group 0, mode 0600); gaitpad doctor tells the fix`
std::string access_problem(const std::string& node);

// Tells when something was plugged in or unplugged, after udev has applied its rules.
class HotplugMonitor {
 public:
  static Result<HotplugMonitor> create();
  HotplugMonitor(HotplugMonitor&&) noexcept;
  HotplugMonitor& operator=(HotplugMonitor&&) noexcept;
  ~HotplugMonitor();
  int fd() const noexcept;
  bool has_changed() noexcept;  // reads all that has come; never waits

 private:
  struct Impl;
  explicit HotplugMonitor(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace gaitpad
