#include "drivers/pads/recorded_packets.h"

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "drivers/pads/pad_quirks.h"
#include "drivers/pads/pads_of_devices.h"

namespace gaitpad {

namespace {

struct RecordedPad {
  std::unique_ptr<PadQuirks> quirks;  // null: the device's packets are reports already
  PlugWatch plug;
};

RecordedPad recorded_pad(const DeviceInfo& info) {
  if (!info.driver.empty() && info.driver != "hidraw" && info.driver != "usb") return {};
  // Pads without HID are known by the descriptor that their quirks state.
  VendorPad vendor_pads[] = {make_xbox_360_pad({0xff, 0x5d, 0x01}, info),
                             make_gip_pad({0xff, 0x47, 0xd0}, info)};
  for (VendorPad& pad : vendor_pads) {
    if (pad.descriptor == info.descriptor) return {std::move(pad.quirks), {}};
  }
  return {make_pad_quirks(info), {}};
}

// False: the event has to be left out.
bool accept(RecordedPad& pad, TraceEvent& event, std::vector<std::uint8_t>& bytes) {
  const std::span<const std::uint8_t> packet(bytes.data() + event.first_byte, event.size);
  OutPacket reply;  // is not used: it was sent when the packet came
  const bool is_input = pad.quirks->accept(packet, reply);
  if (Report plug; pad.plug.has_changed(*pad.quirks, plug)) {
    event.kind = plug.kind;
    event.size = 0;
    return true;
  }
  if (!is_input) return false;
  const std::span<const std::uint8_t> input = pad.quirks->report_of(packet);
  if (input.data() == packet.data()) return true;
  event.first_byte = static_cast<std::uint32_t>(bytes.size());
  event.size = static_cast<std::uint16_t>(input.size());
  bytes.insert(bytes.end(), input.begin(), input.end());
  return true;
}

}  // namespace

void accept_packets(Trace& trace) {
  if (trace.has_ticks) return;
  std::vector<RecordedPad> pads;
  for (const TraceDevice& device : trace.devices) pads.push_back(recorded_pad(device.info));
  std::vector<TraceEvent> events;
  events.reserve(trace.events.size());
  for (TraceEvent event : trace.events) {
    // Quirks are made anew: they serve a pad until it is unplugged.
    if (event.kind == ReportKind::added)
      pads[event.device] = recorded_pad(trace.devices[event.device].info);
    // An empty report is kept, so that it is counted.
    const bool is_packet =
        event.kind == ReportKind::input && event.size > 0 && pads[event.device].quirks;
    if (!is_packet || accept(pads[event.device], event, trace.bytes)) events.push_back(event);
  }
  trace.events = std::move(events);
}

}  // namespace gaitpad
