#include "drivers/pads/pad_quirks.h"

#include <algorithm>

#include "gaitpad/descriptor.h"

namespace gaitpad {

std::unique_ptr<PadQuirks> make_pad_quirks(const DeviceInfo& device) {
  for (const auto make : {make_one_of_several_quirks, make_sony_quirks, make_switch_quirks,
                          make_steam_quirks, make_motor_quirks}) {
    if (auto quirks = make(device)) return quirks;
  }
  return std::make_unique<PadQuirks>();
}

std::size_t first_packet(PadPort& port, const std::vector<std::uint8_t>& descriptor,
                         std::span<std::uint8_t> packet) noexcept {
  constexpr std::chrono::milliseconds kSilence(30);
  if (const std::size_t size = port.read(packet, kSilence); size > 0) return size;
  const auto parsed = parse_descriptor(descriptor);
  const auto pad = parsed ? pad_application(*parsed) : std::nullopt;
  if (!pad) return 0;
  for (const Field& field : parsed->fields) {
    if (field.kind != FieldKind::input || field.usage != usage::kX || field.application != *pad)
      continue;
    const std::size_t size = report_bytes(*parsed, field.kind, field.report_id);
    // The answer begins with an id even if the reports have none.
    const std::size_t skipped = field.report_id == 0 ? 1 : 0;
    if (size + skipped > packet.size()) continue;
    const auto answer = packet.first(size + skipped);
    if (port.input(field.report_id, answer) != answer.size()) continue;
    const auto is_zero = [](std::uint8_t byte) { return byte == 0; };
    if (std::ranges::all_of(answer.subspan(1), is_zero)) continue;
    std::copy(answer.begin() + static_cast<std::ptrdiff_t>(skipped), answer.end(), packet.begin());
    return size;
  }
  return 0;
}

}  // namespace gaitpad
