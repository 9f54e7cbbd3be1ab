// The drivers that gaitpad has: find devices with them and open these (contract: driver.h).
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "gaitpad/driver.h"

namespace gaitpad {

// In the order of preference: if several drivers see a pad, the first that can open it serves it.
std::span<const DriverEntry> drivers() noexcept;
// hidraw, evdev, sdl, usb or trace; null: there is no driver of that name.
const DriverEntry* find_driver(std::string_view name) noexcept;

// The line for this device, by bus, ids and version, in the data base that SDL's library brings
// along. It is read as text; nothing of SDL is started. Empty: there is none.
std::string sdl_mapping_of(const DeviceInfo& device);

}  // namespace gaitpad
