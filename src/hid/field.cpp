#include <algorithm>

#include "hid/descriptor.h"

namespace gaitpad {

std::size_t report_bytes(const ReportDescriptor& descriptor, FieldKind kind,
                         std::uint8_t report_id) {
  for (const ReportLength& r : descriptor.reports) {
    if (r.kind != kind || r.report_id != report_id) continue;
    return (r.bits + 7) / 8 + (descriptor.numbered ? 1 : 0);
  }
  return 0;
}

std::uint64_t bits_at(std::span<const std::uint8_t> data, std::uint64_t offset,
                      std::uint32_t size) noexcept {
  std::uint64_t value = 0;
  std::uint32_t done = 0;
  while (done < size && done < 64) {
    const std::uint64_t byte = (offset + done) / 8;
    const std::uint32_t shift = (offset + done) % 8;
    const std::uint32_t take = std::min({8 - shift, size - done, 64 - done});
    if (byte < data.size()) {
      const std::uint64_t part = (std::uint64_t{data[byte]} >> shift) & ((1u << take) - 1);
      value |= part << done;
    }
    done += take;
  }
  return value;
}

std::int64_t field_value(const Field& field, std::span<const std::uint8_t> data) noexcept {
  const std::uint32_t size = std::min<std::uint32_t>(field.bit_size, 64);
  const std::uint64_t raw = bits_at(data, field.bit_offset, size);
  if (field.logical_min >= 0 || size == 0 || size == 64) return static_cast<std::int64_t>(raw);
  const std::uint64_t sign = std::uint64_t{1} << (size - 1);
  return static_cast<std::int64_t>((raw ^ sign) - sign);
}

std::uint32_t array_usage(const ReportDescriptor& descriptor, const Field& field,
                          std::int64_t value) noexcept {
  if (!field.is_array || value < field.logical_min || value > field.logical_max) return 0;
  std::uint64_t index = static_cast<std::uint64_t>(value - field.logical_min);
  for (std::uint32_t i = 0; i < field.range_count; ++i) {
    const UsageRange& range = descriptor.ranges[field.first_range + i];
    const std::uint64_t count = std::uint64_t{range.last} - range.first + 1;
    if (index < count) return range.first + static_cast<std::uint32_t>(index);
    index -= count;
  }
  return 0;
}

std::optional<std::size_t> pad_application(const ReportDescriptor& descriptor) {
  constexpr std::uint8_t kHasX = 1, kHasY = 2;
  std::vector<std::uint8_t> axes(descriptor.applications.size());
  for (const Field& f : descriptor.fields) {
    if (f.kind != FieldKind::input || f.is_array || f.application >= axes.size()) continue;
    if (f.usage == usage::kX) axes[f.application] |= kHasX;
    if (f.usage == usage::kY) axes[f.application] |= kHasY;
  }
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const std::uint32_t what = descriptor.applications[i];
    const bool named_so =
        what == usage::kJoystick || what == usage::kGamePad || what == usage::kMultiAxis;
    if (named_so && axes[i] == (kHasX | kHasY)) return i;
  }
  return std::nullopt;
}

}  // namespace gaitpad
