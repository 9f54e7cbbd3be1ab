// The drivers that gaitpad has: find devices with them and open these (contract: driver.h).
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "gaitpad/driver.h"

namespace gaitpad {

// The drivers in the order of preference: if several drivers see a pad, the first that can open it
// serves it.
std::span<const DriverEntry> drivers() noexcept;
// The driver of this name: hidraw, evdev, sdl, usb or trace; null: there is none.
const DriverEntry* find_driver(std::string_view name) noexcept;

// The line for this device, by bus, ids and version, in the data base that SDL's library brings
// along. It is read as text; nothing of SDL is started. Empty: there is none.
std::string sdl_mapping_of(const DeviceInfo& device);

}  // namespace gaitpad
