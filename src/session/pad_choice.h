// Which devices there are, which of them are pads, and which driver serves a pad that several see.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "drivers/registry.h"
#include "hid/driver.h"
#include "session/pad_setup.h"

namespace gaitpad {

// What a user asks for; empty: any.
struct PadWish {
  std::string pad;  // a path (node or recording), a `vid:pid`, a unique id, a unique part of a name
  std::string driver;  // hidraw, evdev, sdl, usb; forces it
};

struct PadSighting {
  DeviceListing listing;
  const DriverEntry* driver = nullptr;
  bool is_pad = false;  // it has a stick, or its driver must be asked by opening
  std::string problem;  // why it is not usable: one sentence, empty: it is
};

// The same for what several drivers see of one pad.
std::string pad_key(const PadSighting& sighting);

// Every device that every driver (or the one wished for) sees, pads first; where the wish names a
// recording, its devices alone. Finder thread. SDL is asked only where it is wished for, or for
// Drivers::all, or where no other driver of kernel devices was built: its start takes up to a
// second. Error where the wish itself is wrong: an unknown driver, one that was not built, a
// damaged recording. `table` is for tests.
enum class Drivers { preferred, all };
Result<std::vector<PadSighting>> pad_sightings(
    const PadFiles& files, const PadWish& wish, Drivers drivers,
    std::span<const DriverEntry> table = gaitpad::drivers());

// Of the sightings those to open, in the order of preference: each pad (pad_path) by the first
// driver of drivers()'s order that can; usb only where it is wished for or no kernel driver has the
// pad. What one driver shows as several, such as an adapter with an input node for each of its
// plugs, are several pads. Empty where nothing fits. Error where `wish.pad` fits several different
// pads by a part of a name: it names them.
Result<std::vector<PadSighting>> chosen_pads(const std::vector<PadSighting>& sightings,
                                             const PadWish& wish);

// The sightings of pads that `wish.pad` means, usable or not, in the order of preference; all
// pads where it is empty. Error as above.
Result<std::vector<PadSighting>> wished_pads(const std::vector<PadSighting>& sightings,
                                             const PadWish& wish);
// Whether PAD names a recording: an existing file, or a path that ends in .hid.
bool is_recording(const std::string& pad);

// The same device again after unplugging: driver, ids and unique id, else port.
bool is_same_device(const DeviceInfo& a, const DeviceInfo& b) noexcept;

}  // namespace gaitpad
