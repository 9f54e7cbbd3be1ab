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

// From here on pads that no file names are looked up in the database that SDL brings along. It
// starts SDL's joysticks on the thread that finds devices (up to a second): for a program that does
// not use SDL's joysticks itself. Without this call nothing of SDL runs but the driver sdl.
void use_sdl_database() noexcept;
// Its line for this device, by bus, ids and version; empty: there is none, or it is not in use.
std::string sdl_mapping_of(const DeviceInfo& device);

}  // namespace gaitpad
