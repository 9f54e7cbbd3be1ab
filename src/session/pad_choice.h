// Which devices there are, which of them are pads, and which driver serves a pad that several see.
#pragma once
#include <string>
#include <vector>

#include "base/result.h"
#include "hid/driver.h"
#include "session/pad_setup.h"

namespace gaitpad {

// What a user asks for; empty: any.
struct PadWish {
  std::string pad;     // a path (node or recording), a `vid:pid`, a unique id, a unique part of a name
  std::string driver;  // hidraw, evdev, sdl, usb; forces it
};

struct PadSighting {
  DeviceListing listing;
  const DriverEntry* driver = nullptr;
  bool is_pad = false;  // it has a stick, or its driver must be asked by opening
  std::string problem;  // why it is not usable: one sentence, empty: it is
};

// Every device that every driver (or the one wished for) sees, pads first. Finder thread. SDL is
// asked only where it is wished for or `all_drivers`: its start takes up to a second.
enum class Drivers { preferred, all };
Result<std::vector<PadSighting>> pad_sightings(const PadFiles& files, const PadWish& wish,
                                               Drivers drivers);

// Of the sightings those to open, one for each pad (pad_path), in the order of preference: the first
// usable one of drivers()'s order; usb only where it is wished for or no kernel driver has the pad.
// Error where `wish.pad` fits several different pads by a part of a name: it names them.
Result<std::vector<PadSighting>> chosen_pads(const std::vector<PadSighting>& sightings,
                                             const PadWish& wish);

// The same device again after unplugging: driver, ids and unique id, else port.
bool is_same_device(const DeviceInfo& a, const DeviceInfo& b) noexcept;

}  // namespace gaitpad
