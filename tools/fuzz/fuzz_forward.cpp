// libFuzzer target: a hostile pad is forwarded to other programs. A byte of choices, the length of
// a descriptor (two bytes), the descriptor, or the axes and keys of an evdev node; then reports and
// plug events. The virtual pad has stated every event that it gets, with its range.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "drivers/virtual_pad.h"
#include "hid/evdev_layout.h"
#include "session/pad_forward.h"

namespace gaitpad {
// Fuzzing must not create a pad in the kernel.
Result<std::unique_ptr<VirtualPad>> VirtualPad::create(const VirtualPadShape&) {
  return Error{"not while fuzzing"};
}
}  // namespace gaitpad

namespace {

using namespace gaitpad;
constexpr int kRate_hz = 240;
enum Choice : std::uint8_t { kIsNode = 1, kStreams = 2, kIsFallback = 4, kIsUnplugged = 8 };

// An evdev node's axes and keys. Six bytes for each axis: its code, its bounds (16 bits, shifted by
// the code's high bits); then the keys.
std::vector<std::uint8_t> node_descriptor(std::span<const std::uint8_t> bytes) {
  EvdevAbilities node;
  while (bytes.size() >= 6 && bytes[0] != 0xff) {
    const auto half = [&](std::size_t i) {
      return static_cast<std::int16_t>(bytes[i] | (bytes[i + 1] << 8));
    };
    const int factor = 1 << (bytes[1] % 17);
    node.axes.push_back(
        {static_cast<std::uint16_t>(bytes[0] & 0x3f), half(2) * factor, half(4) * factor});
    bytes = bytes.subspan(6);
  }
  for (std::size_t i = 1; i + 1 < bytes.size(); i += 2)
    node.keys.push_back(static_cast<std::uint16_t>((bytes[i] | (bytes[i + 1] << 8)) & 0x2ff));
  std::ranges::sort(node.axes, {}, &EvdevAxis::code);
  std::ranges::sort(node.keys);
  return evdev_layout(node, {}).descriptor;
}

void check_events(const VirtualPadState& from, const VirtualPadState& to, XboxKind kind) {
  static const std::array shapes = {shape_of(XboxKind::calibrated), shape_of(XboxKind::xbox_360)};
  const VirtualPadShape& shape = shapes[static_cast<std::size_t>(kind)];
  for (const VirtualPadEvent& event : events_between(from, to, kind)) {
    const auto is_stated = [&event](const VirtualPadAxis& axis) {
      return event.code == axis.code && event.value >= axis.min && event.value <= axis.max;
    };
    const bool is_key = event.type == 1 && (event.value == 0 || event.value == 1) &&
                        std::ranges::count(shape.keys, event.code) == 1;
    const bool is_axis = event.type == 3 && std::ranges::any_of(shape.axes, is_stated);
    if (!is_key && !is_axis) std::abort();
  }
}

Report next_report(std::span<const std::uint8_t>& bytes) {
  Report report;
  report.device = 0;
  const std::size_t size = std::min<std::size_t>(bytes[0] % 66, bytes.size() - 1);
  report.size = static_cast<std::uint16_t>(size);
  std::copy_n(bytes.begin() + 1, size, report.bytes.begin());
  bytes = bytes.subspan(size + 1);
  return report;
}

void forward(PadConfig config, std::span<const std::uint8_t> bytes) {
  Pads pads({std::move(config)}, kRate_hz);
  ForwardedTick sent;
  while (!bytes.empty()) {
    if (bytes[0] == 0xff) pads.remove_pad(0);
    if (bytes[0] == 0xfe) pads.add_pad(0);
    pads.take_report(next_report(bytes));
    const Stick stick = pads.finish_tick();
    const ForwardedTick tick = forwarded_tick(pads, stick);
    const VirtualPadState half_way = between(sent, tick);
    for (const XboxKind kind : {XboxKind::calibrated, XboxKind::xbox_360}) {
      check_events(sent.state, half_way, kind);
      check_events(half_way, tick.state, kind);
    }
    sent = tick;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 4) return 0;
  const std::size_t length = std::min<std::size_t>(data[1] | (data[2] << 8), size - 3);
  const std::span<const std::uint8_t> described(data + 3, length);
  const std::span<const std::uint8_t> reports(data + 3 + length, size - 3 - length);
  DeviceInfo device;
  device.descriptor.assign(described.begin(), described.end());
  if ((data[0] & kIsNode) != 0) {
    device.descriptor = node_descriptor(described);
    device.driver = "evdev";
  }
  auto layout = pad_layout(device);
  if (!layout) return 0;
  PadConfig config;
  config.is_usable = layout->is_pad;
  config.layout = std::make_shared<const PadLayout>(std::move(*layout));
  config.streams = (data[0] & kStreams) != 0;
  config.is_fallback = (data[0] & kIsFallback) != 0;
  config.is_present = (data[0] & kIsUnplugged) == 0;
  forward(std::move(config), reports);
  return 0;
}
