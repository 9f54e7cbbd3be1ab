// What a descriptor cannot say about a pad: which control a usage is, by device and driver.
// Grammar of the files: config/README.md, Pads.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gaitpad/descriptor.h"
#include "gaitpad/report.h"
#include "gaitpad/result.h"

namespace gaitpad {

// Which button numbers a pad without an own file is taken to have. Numbers count from 1.
enum class ButtonOrder {
  direct_input,  // x a b y, shoulders, triggers, back start, sticks, guide: Logitech, Switch,
                 // clones
  android,       // a b - x y - shoulders, triggers, back start guide, sticks: Xbox on Bluetooth
  top_first,     // y b a x, then as direct_input: PlayStation 2 adapters and their heirs
  xinput,        // a b x y, shoulders, back start, sticks, guide: Xbox in Windows mode
};

// The last three members are for lines of SDL's data base (hid/sdl_mapping.h); no file states them.
enum class AxisPart : std::uint8_t { whole, low, high };           // counted from the middle
enum class StickSide : std::uint8_t { both, negative, positive };  // in HID's directions

// `0001:0031`, `-0001:0031` (reversed), `0001:0030/4` (the fourth X), `000c:0081&1` (a bit),
// `button 3`.
struct ControlSource {
  std::uint32_t usage = 0;
  std::uint32_t occurrence = 1;  // the n-th field with that usage in its report
  std::uint32_t mask = 0;  // of a button: pressed where one of these bits is set; 0: any value
  bool reversed = false;   // of an axis: against HID's directions (x right, y towards the thumb)
  AxisPart part = AxisPart::whole;   // of a field: a half is 0 in the middle and full at the end
  StickSide side = StickSide::both;  // of a stick's axis: the source moves it to this side alone
  std::uint8_t directions = 0;       // of a hat, any of: 1 up, 2 right, 4 down, 8 left; 0: no hat
  bool operator==(const ControlSource&) const = default;
};
using ControlSources = std::vector<ControlSource>;

struct ControlMap {
  std::array<std::optional<ControlSources>, kAxisCount> axes;
  std::array<std::optional<ControlSources>, kButtonCount> buttons;
};

// Takes the place of the device's own descriptor, for reports of exactly these sizes (id included).
struct DescriptorReplacement {
  std::vector<std::uint8_t> descriptor;  // empty: none
  std::vector<std::uint16_t> lengths;
  ControlMap controls;
};

// One `[[pad]]` of a file.
struct PadOverride {
  std::string name;
  std::string origin;  // FILE:LINE
  std::optional<std::uint16_t> vendor;
  std::vector<std::uint16_t> products;  // empty: all
  std::vector<std::uint32_t> ids;       // vendor << 16 | product, beside vendor and products
  std::vector<std::string> drivers;     // empty: all
  std::optional<BusType> bus;
  std::optional<std::uint32_t> application;  // usage of a collection of the device's descriptor
  std::uint16_t first_version = 0, last_version = 0xffff;
  std::optional<bool> is_pad;
  bool streams = false;  // sends reports at rest too
  std::optional<ButtonOrder> order;
  ControlMap controls;
  DescriptorReplacement replacement;
};

using PadOverrides = std::vector<PadOverride>;  // the first that matches counts

Result<ControlSources> parse_sources(std::string_view text);

// One file; `config/pads/sony.toml:12: unknown key "left_z"`.
Result<PadOverrides> load_pad_file(const std::string& path);
Result<PadOverrides> parse_pad_file(std::string_view text, const std::string& name);
// Every *.toml of a folder, in the order of their names.
Result<PadOverrides> load_pad_folder(const std::string& folder);

// A report that no one named a driver for (a foreign trace) came from hidraw.
const PadOverride* find_override(const PadOverrides& overrides, const DeviceInfo& device) noexcept;

}  // namespace gaitpad
