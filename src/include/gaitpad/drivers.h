// Every driver of the program, one row each, and what else the vendor libraries know.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "gaitpad/driver.h"

namespace gaitpad {

// In the order of preference: for a pad that several see, the first that can open it serves it.
std::span<const DriverEntry> drivers() noexcept;
// Null where there is no driver of that name.
const DriverEntry* find_driver(std::string_view name) noexcept;

// The line of SDL's controller data base for this device (SDL_GameControllerMappingForGUID, by bus,
// ids and version); empty where it has none or the program was built without SDL. Finder thread.
std::string sdl_mapping_of(const DeviceInfo& device);

}  // namespace gaitpad
