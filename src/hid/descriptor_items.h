// The numbers of report-descriptor items (HID 1.11, 6.2.2.2 to 6.2.2.8), for the parser and for
// drivers that state a descriptor.
#pragma once
#include <cstdint>

namespace gaitpad {

enum class ItemType : std::uint8_t { main = 0, global = 1, local = 2, reserved = 3 };

namespace tag {
inline constexpr std::uint8_t kInput = 0x8, kOutput = 0x9, kCollection = 0xa, kFeature = 0xb,
                              kEndCollection = 0xc;  // tags of main items
inline constexpr std::uint8_t kUsagePage = 0x0, kLogicalMinimum = 0x1, kLogicalMaximum = 0x2,
                              kPhysicalMinimum = 0x3, kPhysicalMaximum = 0x4, kReportSize = 0x7,
                              kReportId = 0x8, kReportCount = 0x9, kPush = 0xa,
                              kPop = 0xb;  // tags of global items
inline constexpr std::uint8_t kUsage = 0x0, kUsageMinimum = 0x1, kUsageMaximum = 0x2,
                              kDelimiter = 0xa;  // tags of local items
}  // namespace tag

inline constexpr std::uint8_t kApplicationCollection = 0x01;  // kinds of collections

namespace main_flag {
inline constexpr std::uint32_t kConstant = 0x01, kVariable = 0x02, kRelative = 0x04,
                               kNullState = 0x40;
}  // namespace main_flag

}  // namespace gaitpad
