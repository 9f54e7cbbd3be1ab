// The items of a report descriptor: one prefix byte, 0, 1, 2 or 4 bytes of data
// (HID 1.11, 6.2.2.2).
#pragma once
#include <cstdint>
#include <span>

namespace gaitpad {

enum class ItemType : std::uint8_t { main = 0, global = 1, local = 2, reserved = 3 };

namespace tag {
inline constexpr std::uint8_t kInput = 0x8, kOutput = 0x9, kCollection = 0xa, kFeature = 0xb,
                              kEndCollection = 0xc;  // main
inline constexpr std::uint8_t kUsagePage = 0x0, kLogicalMinimum = 0x1, kLogicalMaximum = 0x2,
                              kPhysicalMinimum = 0x3, kPhysicalMaximum = 0x4, kReportSize = 0x7,
                              kReportId = 0x8, kReportCount = 0x9, kPush = 0xa,
                              kPop = 0xb;  // global
inline constexpr std::uint8_t kUsage = 0x0, kUsageMinimum = 0x1, kUsageMaximum = 0x2,
                              kDelimiter = 0xa;  // local
}  // namespace tag

namespace main_flag {
inline constexpr std::uint32_t kConstant = 0x01, kVariable = 0x02, kRelative = 0x04,
                               kNullState = 0x40;
}  // namespace main_flag

struct ShortItem {
  ItemType type = ItemType::reserved;
  std::uint8_t tag = 0;
  std::uint8_t size = 0;    // of the data: 0, 1, 2 or 4
  std::uint32_t value = 0;  // zero-extended
};

struct ItemAt {
  ShortItem item;
  bool is_long = false;   // carries nothing that anyone defined; skipped
  std::size_t bytes = 0;  // with its prefix; 0 where it runs over the end
};

inline ItemAt item_at(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  constexpr std::uint8_t kLongItem = 0xfe;
  const std::size_t left = bytes.size() - at;
  ItemAt result;
  if (left == 0) return result;
  const std::uint8_t prefix = bytes[at];
  if (prefix == kLongItem) {
    result.is_long = true;
    if (left < 3 || left - 3 < bytes[at + 1]) return result;
    result.bytes = std::size_t{3} + bytes[at + 1];
    return result;
  }
  const std::uint8_t size = (prefix & 3) == 3 ? 4 : prefix & 3;
  if (left - 1 < size) return result;
  result.item.type = static_cast<ItemType>((prefix >> 2) & 3);
  result.item.tag = prefix >> 4;
  result.item.size = size;
  for (std::uint8_t i = 0; i < size; ++i) {
    result.item.value |= std::uint32_t{bytes[at + 1 + i]} << (8 * i);
  }
  result.bytes = std::size_t{1} + size;
  return result;
}

}  // namespace gaitpad
