// Facts about a pad that its descriptor lacks: which usage is which control, by device and driver.
// It comes from files (config/pads; grammar in config/README.md, Pads) or is stated in code. Set-up
// code; it allocates.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/descriptor.h"
#include "gaitpad/report.h"
#include "gaitpad/result.h"

namespace gaitpad {

// The number that each button has on HID's button page, counted from 1.
enum class ButtonOrder {
  direct_input,  // x a b y, shoulders, triggers, back start, sticks, guide: Logitech, Switch,
                 // clones
  android,       // a b - x y - shoulders, triggers, back start guide, sticks: Xbox on Bluetooth
  top_first,     // y b a x, then the order of direct_input: PlayStation 2 adapters and similar pads
  xinput,        // a b x y, shoulders, back start, sticks, guide: Xbox in Windows mode
};

// The part of an axis that counts. Halves begin in the middle. Only mappings state halves.
enum class AxisPart : std::uint8_t { whole, low, high };
// In HID's directions: negative is left or away from the player.
enum class StickSide : std::uint8_t { both, negative, positive };

// The source of a control, as pad files write it: `0001:0031` (a usage), `-0001:0031` (reversed),
// `0001:0030/4` (the fourth X), `000c:0081&1` (a bit of its value), `button 3`, `hat up`; for a pad
// without a stick `negative button 20` (one side of a stick's axis).
struct ControlSource {
  std::uint32_t usage = 0;
  // Number of the field among those of its report with that usage, from 1.
  std::uint32_t occurrence = 1;
  // For a button: it is pressed if one of these bits is set; 0: pressed by the range.
  std::uint32_t mask = 0;
  // For an axis: it grows against HID's directions (x right, y towards the player).
  bool reversed = false;
  AxisPart part = AxisPart::whole;   // a half is 0 in the middle and full at the end
  StickSide side = StickSide::both;  // for a stick's axis: the side to which the source moves it
  // For a hat: any of 1 up, 2 right, 4 down, 8 left; 0: the source is no hat.
  std::uint8_t directions = 0;
  bool operator==(const ControlSource&) const = default;
};
using ControlSources = std::vector<ControlSource>;

// The sources of each control. None: the default; an empty list: the pad has no such control.
struct ControlMap {
  std::array<std::optional<ControlSources>, kAxisCount> axes;
  std::array<std::optional<ControlSources>, kButtonCount> buttons;
};

// Replaces the device's own descriptor for reports of exactly these lengths (bytes, with the id).
struct DescriptorReplacement {
  std::vector<std::uint8_t> descriptor;  // the other descriptor; empty: none
  std::vector<std::uint16_t> lengths;
  ControlMap controls;
};

// One `[[pad]]` entry of a file: which devices it is for, and what is known of them.
struct PadOverride {
  std::string name;
  std::string origin;  // FILE:LINE of the entry
  std::optional<std::uint16_t> vendor;
  std::vector<std::uint16_t> products;  // product ids that the entry is for; empty: all
  std::vector<std::uint32_t> ids;       // models that it is for: vendor << 16 | product; empty: all
  std::vector<std::string> drivers;     // drivers that it is for; empty: all
  std::optional<BusType> bus;
  // Only devices whose descriptor has this application collection.
  std::optional<std::uint32_t> application;
  std::uint16_t first_version = 0, last_version = 0xffff;
  std::optional<bool> is_pad;
  bool streams = false;  // the pad reports at rest as well
  std::optional<ButtonOrder> order;
  ControlMap controls;
  DescriptorReplacement replacement;
};

// In order of precedence: the first entry that matches is used.
using PadOverrides = std::vector<PadOverride>;

// Reads sources divided by `|`, such as `0001:0030 | button 3`; an empty text gives none.
Result<ControlSources> parse_sources(std::string_view text);

// Reads one file. Errors: `config/pads/sony.toml:12: unknown key "left_z"`.
Result<PadOverrides> load_pad_file(const std::string& path);
// Reads the text of a file; `name` replaces the path in errors.
Result<PadOverrides> parse_pad_file(std::string_view text, const std::string& name);
// Reads every *.toml file of a folder, in the order of their names.
Result<PadOverrides> load_pad_folder(const std::string& folder);

// The first entry for this device; null: none. An empty DeviceInfo::driver (a foreign trace) counts
// as hidraw.
const PadOverride* find_override(const PadOverrides& overrides, const DeviceInfo& device) noexcept;

}  // namespace gaitpad
