#include "gaitpad/driver_registry.h"

#include "drivers/driver_rows.h"
#include "drivers/event_node.h"
#include "drivers/virtual_pad.h"
#include "hid/sdl_lines.h"

namespace gaitpad {

namespace {

// The functions of a driver that was compiled; else null.
#ifdef GAITPAD_HAS_HIDRAW
#define GAITPAD_HIDRAW(function) function
#else
#define GAITPAD_HIDRAW(function) nullptr
#endif
#ifdef GAITPAD_HAS_EVDEV
#define GAITPAD_EVDEV(function) function
#else
#define GAITPAD_EVDEV(function) nullptr
#endif
#ifdef GAITPAD_HAS_USB
#define GAITPAD_USB(function) function
#else
#define GAITPAD_USB(function) nullptr
#endif
#ifdef GAITPAD_HAS_SDL
#define GAITPAD_SDL(function) function
#else
#define GAITPAD_SDL(function) nullptr
#endif

// The drivers in the order of preference: hidraw has the pad's own bytes, evdev what the kernel
// made of them, SDL reads evdev, and usb must take the pad away from the kernel.
constexpr DriverEntry kDrivers[] = {
    {.name = "hidraw",
     .library = "libhidapi-hidraw",
     .find = GAITPAD_HIDRAW(&find_hidraw_devices),
     .open = GAITPAD_HIDRAW(&open_hidraw_device)},
    {.name = "evdev",
     .library = "libevdev",
     .find = GAITPAD_EVDEV(&find_evdev_devices),
     .open = GAITPAD_EVDEV(&open_evdev_device)},
    {.name = "sdl",
     .library = "libSDL2",
     .find = GAITPAD_SDL(&find_sdl_devices),
     .open = GAITPAD_SDL(&open_sdl_device)},
    {.name = "usb",
     .library = "libusb-1.0",
     .find = GAITPAD_USB(&find_usb_devices),
     .open = GAITPAD_USB(&open_usb_device)},
    {.name = "trace", .library = "", .find = &find_trace_devices, .open = &open_trace_device},
};

}  // namespace

std::span<const DriverEntry> drivers() noexcept { return kDrivers; }

const DriverEntry* find_driver(std::string_view name) noexcept {
  for (const DriverEntry& entry : kDrivers) {
    if (name == entry.name) return &entry;
  }
  return nullptr;
}

Result<std::unique_ptr<EventNode>> EventNode::open([[maybe_unused]] const DeviceListing& listing) {
#ifdef GAITPAD_HAS_EVDEV
  return open_event_node(listing);
#else
  return Error{listing.node + ": cannot be read: the program was built without libevdev"};
#endif
}

Result<std::unique_ptr<VirtualPad>> VirtualPad::create(
    [[maybe_unused]] const VirtualPadShape& shape) {
#ifdef GAITPAD_HAS_EVDEV
  return make_evdev_virtual_pad(shape);
#else
  return Error{"no pad can be made: the program was built without libevdev"};
#endif
}

std::string sdl_mapping_of([[maybe_unused]] const DeviceInfo& device) {
#ifdef GAITPAD_HAS_SDL
  static const std::vector<std::string> lines = sdl_library_lines();
  return fitting_mapping(lines, device);
#else
  return {};
#endif
}

}  // namespace gaitpad
