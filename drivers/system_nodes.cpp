#include "drivers/system_nodes.h"

#include <errno.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <libudev.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>

#include "base/text.h"
#include "drivers/pads/pads_of_devices.h"
#include "gaitpad/descriptor.h"

namespace gaitpad {

namespace {

namespace fs = std::filesystem;

struct Unref {
  void operator()(udev* p) const { udev_unref(p); }
  void operator()(udev_device* p) const { udev_device_unref(p); }
  void operator()(udev_enumerate* p) const { udev_enumerate_unref(p); }
  void operator()(udev_monitor* p) const { udev_monitor_unref(p); }
};
using Udev = std::unique_ptr<udev, Unref>;
using UdevDevice = std::unique_ptr<udev_device, Unref>;

std::string text(const char* value) { return value ? value : ""; }
std::string attribute(udev_device* device, const char* name) {
  return text(udev_device_get_sysattr_value(device, name));
}
std::string property(udev_device* device, const char* name) {
  return text(udev_device_get_property_value(device, name));
}
bool is_marked(udev_device* device, const char* name) { return property(device, name) == "1"; }

// Removes quotes and blanks: the kernel puts some texts in quotes, and a name may end with blanks.
std::string unquoted(std::string_view value) { return std::string(trimmed(value, " \"\n")); }

std::uint16_t hex16(std::string_view digits) {
  return static_cast<std::uint16_t>(take_number<std::uint32_t>(digits, 16).value_or(0));
}

// Adds the facts of the HID device and the USB interface above the node.
void add_parents(udev_device* device, SystemNode& node) {
  udev_device* hid = udev_device_get_parent_with_subsystem_devtype(device, "hid", nullptr);
  udev_device* usb = udev_device_get_parent_with_subsystem_devtype(device, "usb", "usb_interface");
  if (usb) {
    node.pad_path = text(udev_device_get_syspath(usb));
    node.kernel_driver = text(udev_device_get_driver(usb));
    node.poll_rate_hz = usb_poll_rate_hz(node.pad_path);
  }
  if (hid) {
    if (!usb) node.pad_path = text(udev_device_get_syspath(hid));
    node.kernel_driver = text(udev_device_get_driver(hid));
  }
}

// HID_ID is bus, vendor and product: `0003:0000054C:000009CC`.
void add_hid_ids(const std::string& hid_id, SystemNode& node) {
  const std::size_t vendor = hid_id.find(':');
  const std::size_t product = hid_id.find(':', vendor + 1);
  if (vendor == std::string::npos || product == std::string::npos) return;
  node.bus = static_cast<BusType>(hex16(std::string_view(hid_id).substr(0, vendor)));
  node.vendor = hex16(std::string_view(hid_id).substr(vendor + 1, product - vendor - 1));
  node.product = hex16(std::string_view(hid_id).substr(product + 1));
}

bool add_hidraw(udev_device* device, SystemNode& node) {
  udev_device* hid = udev_device_get_parent_with_subsystem_devtype(device, "hid", nullptr);
  if (!hid) return false;
  const std::string path = text(udev_device_get_syspath(hid));
  add_hid_ids(property(hid, "HID_ID"), node);
  node.name = unquoted(property(hid, "HID_NAME"));
  node.unique_id = property(hid, "HID_UNIQ");
  node.physical_path = property(hid, "HID_PHYS");
  node.version = input_version(path);
  node.descriptor = sysfs_bytes(fs::path(path) / "report_descriptor");
  return true;
}

bool add_input(udev_device* device, SystemNode& node) {
  if (!text(udev_device_get_sysname(device)).starts_with("event")) return false;
  udev_device* input = udev_device_get_parent_with_subsystem_devtype(device, "input", nullptr);
  if (!input) return false;
  node.name = unquoted(attribute(input, "name"));
  node.unique_id = attribute(input, "uniq");
  node.physical_path = attribute(input, "phys");
  node.bus = static_cast<BusType>(hex16(attribute(input, "id/bustype")));
  node.vendor = hex16(attribute(input, "id/vendor"));
  node.product = hex16(attribute(input, "id/product"));
  node.version = hex16(attribute(input, "id/version"));
  node.is_joystick = is_marked(device, "ID_INPUT_JOYSTICK");
  node.is_motion_sensor = is_marked(device, "ID_INPUT_ACCELEROMETER");
  node.is_touchpad = is_marked(device, "ID_INPUT_TOUCHPAD");
  if (node.pad_path.empty()) node.pad_path = text(udev_device_get_syspath(input));
  udev_device* usb = udev_device_get_parent_with_subsystem_devtype(device, "usb", "usb_interface");
  if (!usb) return true;
  node.physical_path = port_behind_receiver(node.physical_path, node.kernel_driver,
                                            hex16(attribute(usb, "bInterfaceNumber")));
  node.pad_path =
      path_behind_receiver(node.pad_path, node.kernel_driver,
                           text(udev_device_get_syspath(udev_device_get_parent(input))));
  return true;
}

bool add_usb(udev_device* device, SystemNode& node) {
  if (text(udev_device_get_devtype(device)) != "usb_device") return false;
  node.bus = BusType::usb;
  node.vendor = hex16(attribute(device, "idVendor"));
  node.product = hex16(attribute(device, "idProduct"));
  node.version = hex16(attribute(device, "bcdDevice"));
  node.name = unquoted(attribute(device, "manufacturer") + " " + attribute(device, "product"));
  node.unique_id = attribute(device, "serial");
  return true;
}

std::optional<SystemNode> system_node(udev_device* device, std::string_view subsystem) {
  const char* path = udev_device_get_devnode(device);
  if (!path) return std::nullopt;
  SystemNode node;
  node.node = path;
  node.sysfs_path = text(udev_device_get_syspath(device));
  if (subsystem != "usb") add_parents(device, node);
  const bool is_known = subsystem == "hidraw"  ? add_hidraw(device, node)
                        : subsystem == "input" ? add_input(device, node)
                                               : add_usb(device, node);
  if (!is_known) return std::nullopt;
  return node;
}

// Orders by number: event2 before event10.
bool is_before(const SystemNode& a, const SystemNode& b) {
  return a.node.size() != b.node.size() ? a.node.size() < b.node.size() : a.node < b.node;
}

}  // namespace

std::vector<std::uint8_t> sysfs_bytes(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::vector<std::uint8_t> bytes(kMaxDescriptorBytes);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
  return bytes;
}

std::string sysfs_text(const fs::path& path) {
  const std::vector<std::uint8_t> bytes = sysfs_bytes(path);
  return unquoted({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::optional<std::uint32_t> sysfs_hex(const fs::path& path) {
  const std::string text = sysfs_text(path);
  std::string_view digits = text;
  return take_number<std::uint32_t>(digits, 16);
}

std::uint16_t input_version(const fs::path& owner) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(owner / "input", error)) {
    if (const auto version = sysfs_hex(entry.path() / "id" / "version"))
      return static_cast<std::uint16_t>(*version);
  }
  return 0;
}

std::vector<SystemNode> system_nodes(std::string_view subsystem) {
  std::vector<SystemNode> nodes;
  const Udev context(udev_new());
  if (!context) return nodes;
  const std::unique_ptr<udev_enumerate, Unref> all(udev_enumerate_new(context.get()));
  if (!all) return nodes;
  udev_enumerate_add_match_subsystem(all.get(), std::string(subsystem).c_str());
  udev_enumerate_scan_devices(all.get());
  for (udev_list_entry* entry = udev_enumerate_get_list_entry(all.get()); entry;
       entry = udev_list_entry_get_next(entry)) {
    const UdevDevice device(
        udev_device_new_from_syspath(context.get(), udev_list_entry_get_name(entry)));
    if (!device) continue;  // the device was unplugged after the scan
    if (auto node = system_node(device.get(), subsystem)) nodes.push_back(std::move(*node));
  }
  std::sort(nodes.begin(), nodes.end(), is_before);
  return nodes;
}

DeviceListing listing_of(const SystemNode& node, const char* driver) {
  DeviceListing listing;
  listing.info.bus = node.bus;
  listing.info.vendor = node.vendor;
  listing.info.product = node.product;
  listing.info.version = node.version;
  listing.info.driver = driver;
  listing.info.name = node.name;
  listing.info.unique_id = node.unique_id;
  listing.info.physical_path = node.physical_path;
  listing.info.descriptor = node.descriptor;
  listing.node = node.node;
  listing.pad_path = node.pad_path;
  listing.kernel_driver = node.kernel_driver;
  listing.poll_rate_hz = node.poll_rate_hz;
  return listing;
}

std::string usb_interface_path(const std::string& interface_name) {
  std::error_code error;
  const fs::path path = fs::canonical("/sys/bus/usb/devices/" + interface_name, error);
  return error ? std::string() : path.string();
}

double usb_poll_rate_hz(const std::string& interface_path) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(interface_path, error)) {
    if (!entry.path().filename().string().starts_with("ep_")) continue;
    if (sysfs_text(entry.path() / "direction") != "in") continue;
    if (sysfs_text(entry.path() / "type") != "Interrupt") continue;
    const std::string interval = sysfs_text(entry.path() / "interval");
    std::string_view unit = interval;  // the letters after the number
    const double value = take_number<double>(unit).value_or(0.0);
    if (value <= 0.0) return 0.0;
    return unit == "us" ? 1e6 / value : unit == "ms" ? 1e3 / value : 0.0;
  }
  return 0.0;
}

namespace {

// A word of the power supply; empty for `Unknown`.
std::string power_word(const fs::path& path) {
  const std::string word = lower_case(sysfs_text(path));
  return word == "unknown" ? std::string() : word;
}

}  // namespace

// The battery's folder is below that of the HID device, the interface, or the GIP client.
std::optional<Battery> battery_of(const std::string& pad_path) {
  if (pad_path.empty()) return std::nullopt;
  std::vector<fs::path> owners = {pad_path};
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(pad_path, error)) owners.push_back(entry.path());
  for (const fs::path& owner : owners) {
    for (const auto& supply : fs::directory_iterator(owner / "power_supply", error)) {
      Battery battery;
      battery.level = power_word(supply.path() / "capacity_level");
      battery.status = power_word(supply.path() / "status");
      const std::string percent = sysfs_text(supply.path() / "capacity");
      if (!percent.empty()) battery.percent = parse_number<int>(percent);
      if (battery.percent || !battery.level.empty()) return battery;
    }
  }
  return std::nullopt;
}

std::optional<Battery> battery_of(const DeviceInfo& device) {
  for (const char* subsystem : {"hidraw", "input"}) {
    for (const SystemNode& node : system_nodes(subsystem)) {
      if (node.vendor != device.vendor || node.product != device.product ||
          node.physical_path != device.physical_path || node.unique_id != device.unique_id)
        continue;
      if (auto battery = battery_of(node.pad_path)) return battery;
    }
  }
  return std::nullopt;
}

std::string access_problem(const std::string& node) {
  if (::faccessat(AT_FDCWD, node.c_str(), R_OK | W_OK, AT_EACCESS) == 0) return {};
  if (errno != EACCES && errno != EPERM) return fmt::format("{}: {}", node, std::strerror(errno));
  struct stat status = {};
  if (::stat(node.c_str(), &status) != 0) return fmt::format("{}: permission denied", node);
  return fmt::format(
      "{}: permission denied (owner {}, group {}, mode {:04o}); gaitpad doctor tells "
      "the fix",
      node, status.st_uid, status.st_gid, status.st_mode & 07777);
}

struct HotplugMonitor::Impl {
  Udev context;
  std::unique_ptr<udev_monitor, Unref> monitor;
};

HotplugMonitor::HotplugMonitor(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
HotplugMonitor::HotplugMonitor(HotplugMonitor&&) noexcept = default;
HotplugMonitor& HotplugMonitor::operator=(HotplugMonitor&&) noexcept = default;
HotplugMonitor::~HotplugMonitor() = default;

Result<HotplugMonitor> HotplugMonitor::create() {
  auto impl = std::make_unique<Impl>();
  impl->context.reset(udev_new());
  if (!impl->context) return Error{"udev: cannot be asked for devices"};
  // Without udevd (in containers) only the kernel reports changes.
  const bool has_udevd = ::access("/run/udev/control", F_OK) == 0;
  impl->monitor.reset(
      udev_monitor_new_from_netlink(impl->context.get(), has_udevd ? "udev" : "kernel"));
  if (!impl->monitor) return Error{"udev: cannot be monitored, so plugging in is not noticed"};
  for (const char* subsystem : {"hidraw", "input", "usb"})
    udev_monitor_filter_add_match_subsystem_devtype(impl->monitor.get(), subsystem, nullptr);
  if (udev_monitor_enable_receiving(impl->monitor.get()) < 0)
    return Error{"udev: cannot be monitored, so plugging in is not noticed"};
  return HotplugMonitor(std::move(impl));
}

int HotplugMonitor::fd() const noexcept { return udev_monitor_get_fd(impl_->monitor.get()); }

bool HotplugMonitor::has_changed() noexcept {
  bool has_changed = false;
  while (const UdevDevice device{udev_monitor_receive_device(impl_->monitor.get())}) {
    has_changed = true;
  }
  return has_changed;
}

}  // namespace gaitpad
