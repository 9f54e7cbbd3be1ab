// The facts that sysfs has about a USB device's interfaces: which of them may be pads, at which
// port they are, which driver has them. Nothing here opens a device.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/pads/pad_quirks.h"
#include "gaitpad/driver.h"

namespace gaitpad {

inline constexpr std::uint8_t kHidClass = 3;

struct UsbInterface {
  std::string path;  // path of the interface's sysfs folder, `.../1-1.2:1.0`
  std::uint8_t number = 0;
  UsbInterfaceClass ids;
  double poll_rate_hz = 0.0;  // rate of the interrupt IN endpoint; 0: there is none
  // Driver of the interface: usbhid, xpad, usbfs (a program); empty: none is bound.
  std::string kernel_driver;
  std::string hid_driver;     // driver of the HID device that usbhid made: hid-generic, playstation
  std::uint16_t version = 0;  // version of the input device that the kernel made; 0: there is none
  std::vector<std::uint8_t> descriptor;  // report descriptor in the kernel's version; empty: none
};

// The interface with that folder; none if it is no interface, or was unplugged.
std::optional<UsbInterface> usb_interface(const std::string& path);
// The interfaces of the device with that folder, ordered by number.
std::vector<UsbInterface> usb_interfaces(const std::string& device_path);

// True if the interface is HID, Xbox 360 wired (ff/5d/01) or the first of the three interfaces of
// an Xbox One or Series pad (ff/47/d0), with an endpoint to read reports from.
bool may_be_pad(const UsbInterface& interface) noexcept;
// `it is a keyboard` or `it is a mouse`, if the interface says so itself (HID boot protocol); else
// empty.
std::string boot_device(const UsbInterface& interface);

// The port in the kernel's form (HIDIOCGRAWPHYS, EVIOCGPHYS): `usb-0000:00:14.0-1.2/input0`.
std::string usb_physical_path(const std::string& device_path, std::uint8_t interface_number);

}  // namespace gaitpad
