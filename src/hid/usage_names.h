// Names of HID usages, as the USB HID Usage Tables have them, for people.
#pragma once
#include <cstdint>
#include <string>

namespace gaitpad {

// "X", "Hat switch", "Button 3"; "Vendor" of a vendor's page; empty if the tables of gamepads do
// not name it.
std::string usage_name(std::uint32_t usage);
std::string usage_text(std::uint32_t usage);  // A usage in the form 0001:0030.

}  // namespace gaitpad
