// Every driver of the program, one row each.
#pragma once
#include <span>
#include <string_view>

#include "hid/driver.h"

namespace gaitpad {

std::span<const DriverEntry> drivers() noexcept;
// Null where there is no driver of that name.
const DriverEntry* find_driver(std::string_view name) noexcept;

}  // namespace gaitpad
