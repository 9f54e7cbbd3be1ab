#include "drivers/usb_interfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "drivers/system_nodes.h"

namespace gaitpad {

namespace {

namespace fs = std::filesystem;

// The entries of a folder; none or some if the device is being unplugged.
std::vector<fs::path> entries(const fs::path& folder) {
  std::vector<fs::path> paths;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    paths.push_back(it->path());
  }
  return paths;
}

std::uint8_t byte_attribute(const fs::path& path) {
  return static_cast<std::uint8_t>(sysfs_hex(path).value_or(0));
}

std::string driver_of(const fs::path& device) {
  std::error_code error;
  return fs::read_symlink(device / "driver", error).filename().string();
}

// The HID device (`0003:054C:09CC.0001`) that usbhid has made below the interface.
std::optional<fs::path> hid_device_below(const fs::path& interface) {
  for (const fs::path& entry : entries(interface)) {
    if (entry.filename().string().starts_with("0003:")) return entry;
  }
  return std::nullopt;
}

}  // namespace

std::optional<UsbInterface> usb_interface(const std::string& path) {
  const fs::path folder(path);
  const auto number = sysfs_hex(folder / "bInterfaceNumber");
  if (!number) return std::nullopt;
  UsbInterface interface;
  interface.path = path;
  interface.number = static_cast<std::uint8_t>(*number);
  interface.ids.interface_class = byte_attribute(folder / "bInterfaceClass");
  interface.ids.subclass = byte_attribute(folder / "bInterfaceSubClass");
  interface.ids.protocol = byte_attribute(folder / "bInterfaceProtocol");
  interface.poll_rate_hz = usb_poll_rate_hz(path);
  interface.kernel_driver = driver_of(folder);
  interface.version = input_version(folder);
  if (const auto hid = hid_device_below(folder)) {
    interface.hid_driver = driver_of(*hid);
    interface.version = input_version(*hid);
    interface.descriptor = sysfs_bytes(*hid / "report_descriptor");
  }
  return interface;
}

std::vector<UsbInterface> usb_interfaces(const std::string& device_path) {
  std::vector<UsbInterface> interfaces;
  for (const fs::path& entry : entries(device_path)) {
    if (entry.filename().string().find(':') == std::string::npos) continue;
    if (auto interface = usb_interface(entry.string())) interfaces.push_back(std::move(*interface));
  }
  std::sort(interfaces.begin(), interfaces.end(),
            [](const UsbInterface& a, const UsbInterface& b) { return a.number < b.number; });
  return interfaces;
}

bool may_be_pad(const UsbInterface& interface) noexcept {
  const UsbInterfaceClass& ids = interface.ids;
  const bool is_360 = ids.interface_class == 0xff && ids.subclass == 0x5d && ids.protocol == 0x01;
  const bool is_gip = ids.interface_class == 0xff && ids.subclass == 0x47 && ids.protocol == 0xd0 &&
                      interface.number == 0;
  return interface.poll_rate_hz > 0.0 && (ids.interface_class == kHidClass || is_360 || is_gip);
}

std::string boot_device(const UsbInterface& interface) {
  const UsbInterfaceClass& ids = interface.ids;
  if (ids.interface_class != kHidClass || ids.subclass != 1) return {};
  return ids.protocol == 1 ? "it is a keyboard" : ids.protocol == 2 ? "it is a mouse" : "";
}

std::string usb_physical_path(const std::string& device_path, std::uint8_t interface_number) {
  // Find the controller: the folder above the root hub's, as in .../0000:00:14.0/usb1/1-1/1-1.2
  fs::path hub(device_path);
  const auto is_root_hub = [](const fs::path& path) {
    const std::string name = path.filename().string();
    return name.starts_with("usb") && name.find_first_not_of("0123456789", 3) == std::string::npos;
  };
  while (hub.has_relative_path() && !is_root_hub(hub)) hub = hub.parent_path();
  const std::string controller = hub.parent_path().filename().string();
  const std::string name = fs::path(device_path).filename().string();
  const std::size_t dash = name.find('-');
  if (controller.empty() || dash == std::string::npos) return {};
  return fmt::format("usb-{}-{}/input{}", controller, std::string_view(name).substr(dash + 1),
                     interface_number);
}

}  // namespace gaitpad
