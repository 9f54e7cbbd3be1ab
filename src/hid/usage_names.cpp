#include "hid/usage_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "gaitpad/descriptor.h"

namespace gaitpad {
namespace {

struct UsageName {
  std::uint32_t usage;  // page << 16 | id
  const char* name;
};

// The part of the HID Usage Tables 1.4 that pads, their motors and lights use.
constexpr UsageName kNames[] = {
    {0x00010001, "Pointer"},
    {0x00010002, "Mouse"},
    {0x00010004, "Joystick"},
    {0x00010005, "Game pad"},
    {0x00010006, "Keyboard"},
    {0x00010007, "Keypad"},
    {0x00010008, "Multi-axis controller"},
    {0x00010030, "X"},
    {0x00010031, "Y"},
    {0x00010032, "Z"},
    {0x00010033, "Rx"},
    {0x00010034, "Ry"},
    {0x00010035, "Rz"},
    {0x00010036, "Slider"},
    {0x00010037, "Dial"},
    {0x00010038, "Wheel"},
    {0x00010039, "Hat switch"},
    {0x0001003a, "Counted buffer"},
    {0x0001003b, "Byte count"},
    {0x0001003d, "Start"},
    {0x0001003e, "Select"},
    {0x00010040, "Vx"},
    {0x00010041, "Vy"},
    {0x00010042, "Vz"},
    {0x00010080, "System control"},
    {0x00010081, "System power down"},
    {0x00010082, "System sleep"},
    {0x00010083, "System wake up"},
    {0x00010085, "System main menu"},
    {0x00010090, "D-pad up"},
    {0x00010091, "D-pad down"},
    {0x00010092, "D-pad right"},
    {0x00010093, "D-pad left"},
    {0x000200b0, "Aileron"},
    {0x000200b8, "Elevator"},
    {0x000200ba, "Rudder"},
    {0x000200bb, "Throttle"},
    {0x000200c4, "Accelerator"},
    {0x000200c5, "Brake"},
    {0x000200c6, "Clutch"},
    {0x000200c7, "Shifter"},
    {0x000200c8, "Steering"},
    {0x00060020, "Battery strength"},
    {0x000c0001, "Consumer control"},
    {0x000c0040, "Menu"},
    {0x000c00b2, "Record"},
    {0x000c00cd, "Play/pause"},
    {0x000c00e2, "Mute"},
    {0x000c0223, "Home"},
    {0x000c0224, "Back"},
    {0x000f0021, "Set effect report"},
    {0x000f0022, "Effect block index"},
    {0x000f0050, "Duration"},
    {0x000f0053, "Trigger button"},
    {0x000f0070, "Magnitude"},
    {0x000f0097, "DC enable actuators"},
    {0x000f007c, "Loop count"},
    {0x000f00a7, "Start delay"},
};
constexpr std::uint32_t kButtonPage = 0x09, kFirstVendorPage = 0xff00;

}  // namespace

std::string usage_name(std::uint32_t usage) {
  if (page_of(usage) >= kFirstVendorPage) return "Vendor";
  if (page_of(usage) == kButtonPage) return "Button " + std::to_string(id_of(usage));
  const auto found = std::ranges::find(kNames, usage, &UsageName::usage);
  return found == std::end(kNames) ? "" : found->name;
}

std::string usage_text(std::uint32_t usage) {
  return fmt::format("{:04x}:{:04x}", page_of(usage), id_of(usage));
}

}  // namespace gaitpad
