// What the numbers in a line of SDL's data base stand for on one device, for reading such lines and
// for writing them.
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "hid/descriptor.h"
#include "hid/evdev_codes.h"
#include "hid/pad_map.h"

namespace gaitpad {

// Up, right, down, left: bit k of SDL's hat mask.
inline constexpr std::size_t kHatDirections = 4;
using SdlHat = std::array<std::optional<ControlSource>, kHatDirections>;

inline constexpr std::size_t kMaxSdlSources = 8;  // of one control

struct SdlNumbers {
  std::vector<ControlSource> axes, buttons;  // a0, a1 ..., b0, b1 ...
  std::vector<SdlHat> hats;                  // h0.1, h0.2, h0.4, h0.8 ...
};
// SDL's order of an evdev node's controls (SDL 2.26, ConfigJoystick): keys from BTN_JOYSTICK on,
// then those below; axes by code without the hats; hats by code.
SdlNumbers sdl_numbers(const ReportDescriptor& descriptor, StatedBy who);

}  // namespace gaitpad
