// libFuzzer target: a pad file. A refusal is one sentence. With an accepted file, reports of the
// pads of its entries are decoded within bounds.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "gaitpad/decode.h"
#include "tools/fuzz/made_pads.h"

namespace {

using namespace gaitpad;

void decode_with(const PadOverrides& pads, const PadOverride& entry) {
  DeviceInfo device = made_pad();
  device.vendor = entry.vendor.value_or(0x1209);
  if (!entry.products.empty()) device.product = entry.products.front();
  if (!entry.ids.empty()) {
    device.vendor = static_cast<std::uint16_t>(entry.ids.front() >> 16);
    device.product = static_cast<std::uint16_t>(entry.ids.front() & 0xffff);
  }
  if (!entry.drivers.empty()) device.driver = entry.drivers.front();
  device.bus = entry.bus.value_or(BusType::usb);
  device.version = entry.first_version;
  const auto layout = pad_layout(device, pads);
  if (!layout) return;
  Report report;
  PadState state;
  for (int filling : {0x00, 0x5a, 0xff}) {
    report.size = kMaxReportBytes;
    report.bytes.fill(static_cast<std::uint8_t>(filling));
    for (const ReportLayout& one : layout->reports) {
      report.bytes[0] = one.numbered ? one.report_id : report.bytes[0];
      for (const std::uint16_t bytes : {std::uint16_t{64}, one.min_size}) {
        report.size = std::min<std::uint16_t>(bytes, kMaxReportBytes);
        decode(*layout, report, state);
        check_bounds(state);
      }
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto pads = parse_pad_file(text, "fuzz.toml");
  if (!pads) {
    const std::string& message = pads.error().message;
    if (!message.starts_with("fuzz.toml:") || message.find('\n') != message.npos) std::abort();
    return 0;
  }
  for (std::size_t i = 0; i < std::min<std::size_t>(pads->size(), 8); ++i)
    decode_with(*pads, (*pads)[i]);
  return 0;
}
