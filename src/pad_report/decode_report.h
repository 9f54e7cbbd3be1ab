// A device's descriptor, its decoded reports and its battery, as text for people and JSON for
// machines.
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "drivers/system_nodes.h"
#include "gaitpad/decode.h"
#include "gaitpad/trace.h"

namespace gaitpad {

// The names of the pressed buttons.
std::vector<std::string> button_names(const PadState& state);
// The axes by name, as decode() gives them: sticks -1 .. 1, triggers 0 .. 1.
nlohmann::ordered_json axes_json(const PadState& state);
// Null if the pad does not report its battery.
nlohmann::ordered_json battery_json(const std::optional<Battery>& battery);

// A device and everything that decoding needs. `state` is the state after its last report.
struct DecodedDevice {
  TraceDevice source;
  PadLayout layout;
  PadState state;
};
// The device, and a table of the fields of its descriptor; equal neighbours are one row.
std::string descriptor_text(const DecodedDevice& device);
// The same on one line, with one object for each field.
nlohmann::ordered_json descriptor_json(const DecodedDevice& device);
// A report, which `device.state` has taken over. `is_good`: decode()'s answer.
std::string report_text(const DecodedDevice& device, const Report& report, bool is_good);
nlohmann::ordered_json report_json(const DecodedDevice& device, const Report& report, bool is_good);

}  // namespace gaitpad
