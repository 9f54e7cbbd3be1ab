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
  std::string node;        // path: /dev/hidraw3, /dev/input/event5, /dev/bus/usb/001/004
  std::string sysfs_path;  // sysfs folder of the node's own device
  std::string pad_path;    // as in DeviceListing
  // Driver of the HID device or USB interface: hid-generic, playstation, xpad.
  std::string kernel_driver;
  BusType bus = BusType::unknown;
  std::uint16_t vendor = 0, product = 0;
  std::uint16_t version = 0;  // version of the input device, if there is one (part of SDL's GUID)
  std::string name, unique_id, physical_path;
  // Content of report_descriptor in sysfs; only for hidraw nodes.
  std::vector<std::uint8_t> descriptor;
  double poll_rate_hz = 0.0;  // rate of the interrupt IN endpoint, 1 / bInterval; 0:
                              // unknown
  // As udev's ID_INPUT_* say.
  bool is_joystick = false, is_motion_sensor = false, is_touchpad = false;
};

// The text of a file in /sys, at most 4096 bytes, without the blanks, quotes and line ends around
// it; empty: there is no such file.
std::string sysfs_text(const std::filesystem::path& path);
// The bytes of a file in /sys, for example a report descriptor.
std::vector<std::uint8_t> sysfs_bytes(const std::filesystem::path& path);
// The hexadecimal number in a file in /sys; none: there is no such file, or no number in it.
std::optional<std::uint32_t> sysfs_hex(const std::filesystem::path& path);

// The version of the input device that the kernel made of a HID device or USB interface, as in
// SDL's GUID; 0: there is none.
std::uint16_t input_version(const std::filesystem::path& owner);

// The nodes of the subsystem "hidraw", "input" (event nodes only) or "usb" (devices; pad_path is
// empty because they have several interfaces), ordered by node.
std::vector<SystemNode> system_nodes(std::string_view subsystem);
// The listing of the node by this driver.
DeviceListing listing_of(const SystemNode& node, const char* driver);
// The pad_path of a USB interface: `1-1.2:1.0` as in /sys/bus/usb/devices.
std::string usb_interface_path(const std::string& interface_name);
// The rate at which the interface's interrupt IN endpoint is polled, by its `interval` (`4ms`,
// `125us`); 0: unknown, or there is none.
double usb_poll_rate_hz(const std::string& interface_path);
// The state of the pad's battery, as the kernel's driver reports it.
struct Battery {
  std::optional<int> percent;  // none: the pad only tells a level
  std::string level;           // critical, low, normal, high, full; empty: unknown
  std::string status;          // charging, discharging, full, not charging; empty: unknown
};
// The battery of the pad with this path; none: it has no battery, or no kernel driver that reads
// it.
std::optional<Battery> battery_of(const std::string& pad_path);
// The battery of a device that a stream has open.
std::optional<Battery> battery_of(const DeviceInfo& device);
// The reason why this user cannot open the node for reading and writing; empty: there is none.
// `/dev/hidraw3: permission denied (owner 0, group 0, mode 0600); gaitpad doctor tells the fix`
std::string access_problem(const std::string& node);

// Reports that a device was plugged in or unplugged, after udev has applied its rules.
class HotplugMonitor {
 public:
  static Result<HotplugMonitor> create();
  HotplugMonitor(HotplugMonitor&&) noexcept;
  HotplugMonitor& operator=(HotplugMonitor&&) noexcept;
  ~HotplugMonitor();
  int fd() const noexcept;
  bool has_changed() noexcept;  // True if there was a change since the last call; never waits.

 private:
  struct Impl;
  explicit HotplugMonitor(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace gaitpad
