// libFuzzer target: a mapping as in an M: line of a recording, then further mappings as in a user's
// file. Pads with this mapping are decoded within bounds, and a mapping that is written for such a
// layout is read back.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "base/text.h"
#include "gaitpad/trace.h"
#include "hid/sdl_lines.h"
#include "tools/fuzz/made_pads.h"

namespace {

using namespace gaitpad;

void check_pad(DeviceInfo device, std::string_view mapping) {
  device.mapping = mapping;
  const auto layout = pad_layout(device);
  if (!layout) {
    if (layout.error().message.find('\n') != std::string::npos) std::abort();
    return;
  }
  Report report;
  report.size = 64;
  PadState state;
  for (int filling : {0x00, 0x5a, 0xa5, 0xff}) {
    report.bytes.fill(static_cast<std::uint8_t>(filling));
    decode(*layout, report, state);
    check_bounds(state);
  }
  const auto line = sdl_mapping_text(device, *layout);
  if (!line || line->size() > kMaxTraceTextBytes) return;
  if (!sdl_controls(*line, layout->descriptor, device.driver)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::array pads = {made_pad(), made_evdev_pad(0, 255),
                                  made_evdev_pad(-32768, 32767)};
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  std::string_view rest = text;
  const std::string_view first = take_line(rest);
  for (const DeviceInfo& pad : pads) check_pad(pad, first);
  const std::vector<std::string> lines = mapping_lines(text);
  for (const DeviceInfo& pad : pads) {
    const std::string fitting = fitting_mapping(lines, pad);
    if (!fitting.empty() && !is_one_line(fitting)) std::abort();
  }
  if (merged_mappings(lines, lines).size() > lines.size()) std::abort();
  return 0;
}
