// Devices and their reports on standard output, as text or as one JSON object a line: what decode
// and monitor share.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "base/text.h"
#include "gaitpad/decode.h"
#include "gaitpad/trace.h"

namespace gaitpad {

enum class OutputForm { text, json };

// A device with what decoding needs; the state is that after its last report.
struct DecodedDevice {
  TraceDevice source;
  PadLayout layout;
  PadState state;
};

// Text of a device may hold anything; JSON holds UTF-8.
void print_json_line(const nlohmann::ordered_json& object);
std::string usage_text(std::uint32_t usage);  // 0001:0030
std::vector<std::string> button_names(const PadState& state);
nlohmann::ordered_json axes_json(const PadState& state);

void print_descriptor(const DecodedDevice& device, OutputForm form);
// Decodes it, too: false where the device's descriptor, or what replaces it, cannot hold it.
bool print_report(DecodedDevice& device, const Report& report, OutputForm form);

}  // namespace gaitpad
