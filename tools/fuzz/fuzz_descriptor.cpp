// libFuzzer target: two bytes of descriptor length, a descriptor, then reports of up to 64 bytes.
// Parses the descriptor, builds the layout with and without the shipped overrides, and decodes the
// reports. The mapping that is written for it is read back.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "gaitpad/decode.h"
#include "gaitpad/trace.h"
#include "hid/sdl_lines.h"
#include "tools/fuzz/made_pads.h"

namespace {

const gaitpad::PadOverrides& overrides() {
  static const gaitpad::PadOverrides all = [] {
    auto loaded = gaitpad::load_pad_folder(GAITPAD_CONFIG_DIR "/pads");
    if (!loaded) std::abort();
    return *loaded;
  }();
  return all;
}

void decode_all(const gaitpad::PadLayout& layout, std::span<const std::uint8_t> reports) {
  gaitpad::Report report;
  gaitpad::PadState state;
  while (!reports.empty()) {
    report.size = static_cast<std::uint16_t>(std::min<std::size_t>(reports.size(), 64));
    std::copy_n(reports.begin(), report.size, report.bytes.begin());
    gaitpad::decode(layout, report, state);
    gaitpad::check_bounds(state);
    const std::span<const std::uint8_t> data(report.bytes.data(), report.size);
    for (const gaitpad::Field& f : layout.descriptor.fields) {
      gaitpad::array_usage(layout.descriptor, f, gaitpad::field_value(f, data));
    }
    reports = reports.subspan(report.size);
  }
}

void write_mapping(const gaitpad::DeviceInfo& device, const gaitpad::PadLayout& layout) {
  const auto line = gaitpad::sdl_mapping_text(device, layout);
  if (!line || line->size() > gaitpad::kMaxTraceTextBytes) return;
  if (!gaitpad::sdl_controls(*line, layout.descriptor, device.driver)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 6) return 0;
  gaitpad::DeviceInfo device;
  // Pick one of the existing overrides by the low bits of the ids.
  const auto& pads = overrides();
  const auto& pad = pads[data[0] % pads.size()];
  if ((data[1] & 1) != 0 && pad.vendor && !pad.products.empty()) {
    device.vendor = *pad.vendor;
    device.product = pad.products.front();
  }
  const std::size_t length = std::min<std::size_t>(data[2] | (data[3] << 8), size - 4);
  device.descriptor.assign(data + 4, data + 4 + length);
  const auto layout = gaitpad::pad_layout(device, pads);
  if (!layout) return 0;
  decode_all(*layout, {data + 4 + length, size - 4 - length});
  write_mapping(device, *layout);
  return 0;
}
