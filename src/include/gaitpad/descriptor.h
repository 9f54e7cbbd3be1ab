// HID report-descriptor parser (Device Class Definition for HID 1.11, section 6.2.2). Where the
// document leaves a choice, this parser chooses as Linux does. Descriptors come from any device, so
// everything is bounded. Parsing allocates; the functions marked noexcept do not.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gaitpad/result.h"

namespace gaitpad {

inline constexpr std::size_t kMaxDescriptorBytes = 4096;  // Linux's HID_MAX_DESCRIPTOR_SIZE
inline constexpr std::uint32_t kMaxFieldBits = 256;
inline constexpr std::uint32_t kMaxReportBits = 16384 * 8;  // Linux's HID_MAX_BUFFER_SIZE
inline constexpr std::size_t kMaxFields = 32768;            // most fields of all reports together

enum class FieldKind : std::uint8_t { input, output, feature };

// Usage page and id in one number, as in a 4-byte usage item: page << 16 | id.
constexpr std::uint32_t usage_of(std::uint16_t page, std::uint16_t id) noexcept {
  return (std::uint32_t{page} << 16) | id;
}
constexpr std::uint16_t page_of(std::uint32_t usage) noexcept {
  return static_cast<std::uint16_t>(usage >> 16);
}
constexpr std::uint16_t id_of(std::uint32_t usage) noexcept {
  return static_cast<std::uint16_t>(usage & 0xffff);
}

// Usages by the HID Usage Tables 1.4: generic desktop (01), simulation (02), consumer (0c).
namespace usage {
inline constexpr std::uint32_t kJoystick = usage_of(0x01, 0x04);
inline constexpr std::uint32_t kGamePad = usage_of(0x01, 0x05);
inline constexpr std::uint32_t kMultiAxis = usage_of(0x01, 0x08);
inline constexpr std::uint32_t kX = usage_of(0x01, 0x30);
inline constexpr std::uint32_t kY = usage_of(0x01, 0x31);
inline constexpr std::uint32_t kZ = usage_of(0x01, 0x32);
inline constexpr std::uint32_t kRx = usage_of(0x01, 0x33);
inline constexpr std::uint32_t kRy = usage_of(0x01, 0x34);
inline constexpr std::uint32_t kRz = usage_of(0x01, 0x35);
inline constexpr std::uint32_t kHatSwitch = usage_of(0x01, 0x39);
inline constexpr std::uint32_t kSelect = usage_of(0x01, 0x3e);
inline constexpr std::uint32_t kStart = usage_of(0x01, 0x3d);
inline constexpr std::uint32_t kSystemMainMenu = usage_of(0x01, 0x85);
inline constexpr std::uint32_t kDpadUp = usage_of(0x01, 0x90);
inline constexpr std::uint32_t kDpadDown = usage_of(0x01, 0x91);
inline constexpr std::uint32_t kDpadRight = usage_of(0x01, 0x92);
inline constexpr std::uint32_t kDpadLeft = usage_of(0x01, 0x93);
inline constexpr std::uint32_t kRudder = usage_of(0x02, 0xba);
inline constexpr std::uint32_t kThrottle = usage_of(0x02, 0xbb);
inline constexpr std::uint32_t kAccelerator = usage_of(0x02, 0xc4);
inline constexpr std::uint32_t kBrake = usage_of(0x02, 0xc5);
inline constexpr std::uint32_t kConsumerRecord = usage_of(0x0c, 0xb2);
inline constexpr std::uint32_t kConsumerHome = usage_of(0x0c, 0x223);
inline constexpr std::uint32_t kConsumerBack = usage_of(0x0c, 0x224);
inline constexpr std::uint16_t kButtonPage = 0x09;
}  // namespace usage

struct UsageRange {  // usages of one page; both ends belong to the range
  std::uint32_t first = 0;
  std::uint32_t last = 0;
  bool operator==(const UsageRange&) const = default;
};

// One value of a report: an element of a main item (6.2.2.4). Constant and empty elements have no
// Field.
struct Field {
  FieldKind kind = FieldKind::input;
  std::uint8_t report_id = 0;  // id of the field's report; 0: reports have no ids
  bool is_array = false;       // the value names one of several usages (array_usage)
  bool has_null = false;       // the main item's Null State flag
  bool is_relative = false;    // the main item's Relative flag
  // Minimum was above maximum, so the unsigned range of the bits is used.
  bool has_odd_range = false;
  // Position of the lowest bit, counted from the first bit after the report id.
  std::uint32_t bit_offset = 0;
  std::uint32_t bit_size = 0;
  std::uint32_t usage = 0;       // page << 16 | id; for an array the first usage that it can name
  std::int64_t logical_min = 0;  // raw counts; both ends belong to the range
  std::int64_t logical_max = 0;
  std::int64_t physical_min = 0;  // in units of the device; both 0: the same as the logical range
  std::int64_t physical_max = 0;
  std::uint16_t application = 0;  // index in ReportDescriptor::applications, or kNoApplication
  // For an array: index of its first usages in ReportDescriptor::ranges.
  std::uint32_t first_range = 0;
  std::uint32_t range_count = 0;
};
inline constexpr std::uint16_t kNoApplication = 0xffff;
inline bool is_dpad(const Field& field) {
  return field.usage >= usage::kDpadUp && field.usage <= usage::kDpadLeft;
}

struct ReportLength {
  std::uint8_t report_id = 0;
  FieldKind kind = FieldKind::input;
  std::uint32_t bits = 0;  // length without the report id
};

// A parsed descriptor; parse_descriptor() fills it.
struct ReportDescriptor {
  bool numbered = false;  // every report begins with its id
  std::vector<Field> fields;
  // Usages of the application collections, in the descriptor's order.
  std::vector<std::uint32_t> applications;
  std::vector<UsageRange> ranges;
  // Lengths of the reports, in the order in which they first occur.
  std::vector<ReportLength> reports;
};

// Parses a descriptor. Errors name the byte of the item: `byte 12: report size of 300 bits, at most
// 256 are read`.
Result<ReportDescriptor> parse_descriptor(std::span<const std::uint8_t> bytes);

// Length of a report in bytes, including its id; 0: there is no such report.
std::size_t report_bytes(const ReportDescriptor& descriptor, FieldKind kind,
                         std::uint8_t report_id);

// The bits offset .. offset + size - 1, least significant first, size <= 64; 0 beyond the data.
std::uint64_t bits_at(std::span<const std::uint8_t> data, std::uint64_t offset,
                      std::uint32_t size) noexcept;
// The field's raw count, sign-extended if its minimum is negative. `data` starts after the report
// id. A field of more than 64 bits gives its lowest 64.
std::int64_t field_value(const Field& field, std::span<const std::uint8_t> data) noexcept;
// The usage that a value of an array field names; 0: it names none.
std::uint32_t array_usage(const ReportDescriptor& descriptor, const Field& field,
                          std::int64_t value) noexcept;

// Index of the first application collection that is a pad: a joystick (1:4), game pad (1:5) or
// multi-axis controller (1:8) with X and Y as input. None: the device is no pad.
std::optional<std::size_t> pad_application(const ReportDescriptor& descriptor);

}  // namespace gaitpad
