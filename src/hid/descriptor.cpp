#include "gaitpad/descriptor.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "hid/descriptor_items.h"

namespace gaitpad {

namespace {

// One prefix byte, then 0, 1, 2 or 4 bytes of data (HID 1.11, 6.2.2.2).
struct ShortItem {
  ItemType type = ItemType::reserved;
  std::uint8_t tag = 0;
  std::uint8_t size = 0;    // size of the item's data: 0, 1, 2 or 4
  std::uint32_t value = 0;  // the data, zero-extended
};

struct ItemAt {
  ShortItem item;
  bool is_long = false;   // a long item, which has no defined meaning and is skipped
  std::size_t bytes = 0;  // including the prefix; 0: the item runs over the end
};

ItemAt item_at(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
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

constexpr std::size_t kMaxPushed = 4;  // Linux's HID_GLOBAL_STACK_SIZE
constexpr std::size_t kMaxCollections = 64;
constexpr std::size_t kMaxUsages = 12288;  // Linux's HID_MAX_USAGES

// An item's data and width: whether a maximum is signed depends on its minimum.
struct ItemData {
  std::uint32_t value = 0;
  int size = 0;
};
std::int64_t as_signed(const ItemData& d) {
  if (d.size == 1) return static_cast<std::int8_t>(d.value);
  if (d.size == 2) return static_cast<std::int16_t>(d.value);
  return static_cast<std::int32_t>(d.value);
}

struct Range {
  std::int64_t min = 0, max = 0;
};
// The maximum is signed only if the minimum is negative.
Range range_of(const ItemData& min, const ItemData& max) {
  const std::int64_t low = as_signed(min);
  return {low, low < 0 ? as_signed(max) : std::int64_t{max.value}};
}

struct Globals {
  std::uint16_t usage_page = 0;
  ItemData logical_min, logical_max, physical_min, physical_max;
  std::uint32_t report_size = 0;
  std::uint32_t report_count = 0;
  std::uint8_t report_id = 0;
};

struct LocalUsage {
  UsageRange range;
  bool extended = false;  // a usage of 4 bytes, which includes its page
};

struct Locals {
  std::vector<LocalUsage> usages;
  std::size_t usage_count = 0;
  std::optional<ItemData> minimum, maximum;  // a range's ends, which may come in either order
  int delimiter_depth = 0;
  int delimiter_sets = 0;
};

struct Collection {
  std::uint16_t application = kNoApplication;
};

class Parser {
 public:
  // Returns the cause of an error, without its place.
  std::optional<std::string> add(const ShortItem& item);
  std::optional<std::string> finish() const;
  ReportDescriptor take() { return std::move(result_); }

 private:
  std::optional<std::string> add_main(const ShortItem& item);
  std::optional<std::string> add_global(const ShortItem& item);
  std::optional<std::string> add_local(const ShortItem& item);
  std::optional<std::string> add_usage_range();
  std::optional<std::string> add_field_item(FieldKind kind, std::uint32_t flags);
  std::optional<std::string> open_collection(std::uint32_t type);
  std::optional<std::string> push_globals();
  std::optional<std::string> pop_globals();
  std::optional<std::string> set_report_id(std::uint32_t id);
  std::optional<std::string> push_usage(UsageRange range, bool extended);
  std::optional<std::string> delimit(std::uint32_t opens);
  void apply_last_page();
  Field field_template(FieldKind kind, std::uint32_t flags) const;
  std::optional<std::string> add_variables(Field field);
  std::optional<std::string> add_array(Field field);
  ReportLength& length_of(FieldKind kind);
  bool ignores_usages() const { return locals_.delimiter_sets > 1; }

  ReportDescriptor result_;
  Globals globals_;
  Locals locals_;
  std::vector<Globals> pushed_;
  std::vector<Collection> open_;
};

std::optional<std::string> Parser::add(const ShortItem& item) {
  switch (item.type) {
    case ItemType::main: {
      auto error = add_main(item);
      locals_ = {};
      return error;
    }
    case ItemType::global:
      return add_global(item);
    case ItemType::local:
      return add_local(item);
    case ItemType::reserved:
      return std::nullopt;
  }
  return std::nullopt;
}

std::optional<std::string> Parser::add_main(const ShortItem& item) {
  if (locals_.delimiter_depth != 0) return "a delimiter is open at a main item";
  apply_last_page();
  switch (item.tag) {
    case tag::kInput:
      return add_field_item(FieldKind::input, item.value);
    case tag::kOutput:
      return add_field_item(FieldKind::output, item.value);
    case tag::kFeature:
      return add_field_item(FieldKind::feature, item.value);
    case tag::kCollection:
      return open_collection(item.value);
    case tag::kEndCollection:
      if (open_.empty()) return "the end of a collection that was not begun";
      open_.pop_back();
      return std::nullopt;
    default:
      return std::nullopt;  // several Xbox pads end with a NUL: a main item without meaning
  }
}

std::optional<std::string> Parser::open_collection(std::uint32_t type) {
  if (open_.size() >= kMaxCollections) {
    return fmt::format("more than {} collections inside each other", kMaxCollections);
  }
  Collection collection = open_.empty() ? Collection{} : open_.back();
  if (type == kApplicationCollection) {
    collection.application = static_cast<std::uint16_t>(result_.applications.size());
    const bool named = !locals_.usages.empty();
    result_.applications.push_back(named ? locals_.usages.front().range.first : 0);
  }
  open_.push_back(collection);
  return std::nullopt;
}

std::optional<std::string> Parser::add_global(const ShortItem& item) {
  const ItemData data{item.value, item.size};
  switch (item.tag) {
    case tag::kUsagePage:
      if (item.value > 0xffff) return fmt::format("usage page {:#x} is above 0xffff", item.value);
      globals_.usage_page = static_cast<std::uint16_t>(item.value);
      return std::nullopt;
    case tag::kLogicalMinimum:
      globals_.logical_min = data;
      return std::nullopt;
    case tag::kLogicalMaximum:
      globals_.logical_max = data;
      return std::nullopt;
    case tag::kPhysicalMinimum:
      globals_.physical_min = data;
      return std::nullopt;
    case tag::kPhysicalMaximum:
      globals_.physical_max = data;
      return std::nullopt;
    case tag::kReportSize:
      if (item.value > kMaxFieldBits) {
        return fmt::format("report size of {} bits, at most {} are read", item.value,
                           kMaxFieldBits);
      }
      globals_.report_size = item.value;
      return std::nullopt;
    case tag::kReportId:
      return set_report_id(item.value);
    case tag::kReportCount:
      globals_.report_count = item.value;  // bounded together with the size, where both are used
      return std::nullopt;
    case tag::kPush:
      return push_globals();
    case tag::kPop:
      return pop_globals();
    default:
      return std::nullopt;  // unit and exponent do not change values; others are reserved
  }
}

std::optional<std::string> Parser::push_globals() {
  if (pushed_.size() >= kMaxPushed) return fmt::format("more than {} pushes", kMaxPushed);
  pushed_.push_back(globals_);
  return std::nullopt;
}

std::optional<std::string> Parser::pop_globals() {
  if (pushed_.empty()) return "a pop without a push";
  globals_ = pushed_.back();
  pushed_.pop_back();
  return std::nullopt;
}

std::optional<std::string> Parser::set_report_id(std::uint32_t id) {
  if (id == 0 || id > 255) return fmt::format("report id {} is not within 1 .. 255", id);
  globals_.report_id = static_cast<std::uint8_t>(id);
  result_.numbered = true;
  return std::nullopt;
}

std::optional<std::string> Parser::add_local(const ShortItem& item) {
  switch (item.tag) {
    case tag::kUsage: {
      const bool extended = item.size == 4;
      const std::uint32_t full =
          extended ? item.value
                   : usage_of(globals_.usage_page, static_cast<std::uint16_t>(item.value));
      return push_usage({full, full}, extended);
    }
    case tag::kUsageMinimum:
      if (locals_.minimum) return "a second usage minimum without a maximum";
      locals_.minimum = ItemData{item.value, item.size};
      return add_usage_range();
    case tag::kUsageMaximum:
      if (locals_.maximum) return "a second usage maximum without a minimum";
      locals_.maximum = ItemData{item.value, item.size};
      return add_usage_range();
    case tag::kDelimiter:
      return delimit(item.value);
    default:
      return std::nullopt;  // designators and strings are ignored
  }
}

// Alternative usages: the first set counts, the others are skipped.
std::optional<std::string> Parser::delimit(std::uint32_t opens) {
  if (opens != 0) {
    if (locals_.delimiter_depth != 0) return "a delimiter inside a delimiter";
    ++locals_.delimiter_depth;
    ++locals_.delimiter_sets;
    return std::nullopt;
  }
  if (locals_.delimiter_depth == 0) return "the end of a delimiter that was not begun";
  --locals_.delimiter_depth;
  return std::nullopt;
}

std::optional<std::string> Parser::add_usage_range() {
  if (!locals_.minimum || !locals_.maximum) return std::nullopt;
  const ItemData minimum = *locals_.minimum, maximum = *locals_.maximum;
  locals_.minimum.reset();
  locals_.maximum.reset();
  const bool extended = maximum.size == 4 || minimum.size == 4;
  const std::uint16_t page = maximum.size == 4   ? page_of(maximum.value)
                             : minimum.size == 4 ? page_of(minimum.value)
                                                 : globals_.usage_page;
  if (minimum.size == 4 && page_of(minimum.value) != page) {
    return fmt::format("usage minimum {:#x} and maximum {:#x} are on two pages", minimum.value,
                       maximum.value);
  }
  const std::uint16_t low = id_of(minimum.value), high = id_of(maximum.value);
  if (low > high) return fmt::format("usage minimum {:#x} is above the maximum {:#x}", low, high);
  return push_usage({usage_of(page, low), usage_of(page, high)}, extended);
}

std::optional<std::string> Parser::push_usage(UsageRange range, bool extended) {
  if (ignores_usages()) return std::nullopt;
  const std::size_t room = kMaxUsages - locals_.usage_count;
  if (room == 0) return std::nullopt;  // the item is ignored, as in Linux
  const std::size_t count = std::min<std::size_t>(range.last - range.first + 1, room);
  range.last = range.first + static_cast<std::uint32_t>(count) - 1;
  locals_.usage_count += count;
  locals_.usages.push_back({range, extended});
  return std::nullopt;
}

// A short usage has the page in force at its place. But a page that is declared after the last
// usage also applies to the short usages at the end of the list, back to one that is already on it
// (as in Linux).
void Parser::apply_last_page() {
  for (auto it = locals_.usages.rbegin(); it != locals_.usages.rend(); ++it) {
    if (it->extended) continue;
    if (page_of(it->range.first) == globals_.usage_page) return;
    it->range = {usage_of(globals_.usage_page, id_of(it->range.first)),
                 usage_of(globals_.usage_page, id_of(it->range.last))};
  }
}

ReportLength& Parser::length_of(FieldKind kind) {
  for (ReportLength& r : result_.reports) {
    if (r.kind == kind && r.report_id == globals_.report_id) return r;
  }
  result_.reports.push_back({globals_.report_id, kind, 0});
  return result_.reports.back();
}

std::optional<std::string> Parser::add_field_item(FieldKind kind, std::uint32_t flags) {
  if (locals_.minimum) return "a usage minimum without a usage maximum";
  if (locals_.maximum) return "a usage maximum without a usage minimum";
  ReportLength& length = length_of(kind);
  const std::uint64_t bits = std::uint64_t{globals_.report_size} * globals_.report_count;
  if (length.bits + bits > kMaxReportBits) {
    return fmt::format("report {} grows to {} bits, at most {} are read", globals_.report_id,
                       length.bits + bits, kMaxReportBits);
  }
  Field field = field_template(kind, flags);
  field.bit_offset = length.bits;
  length.bits += static_cast<std::uint32_t>(bits);
  const bool constant = (flags & main_flag::kConstant) != 0;
  if (constant || bits == 0) return std::nullopt;
  if (result_.fields.size() + globals_.report_count > kMaxFields) {
    return fmt::format("more than {} fields", kMaxFields);
  }
  return field.is_array ? add_array(field) : add_variables(field);
}

Field Parser::field_template(FieldKind kind, std::uint32_t flags) const {
  Field field;
  field.kind = kind;
  field.report_id = globals_.report_id;
  field.is_array = (flags & main_flag::kVariable) == 0;
  field.has_null = (flags & main_flag::kNullState) != 0;
  field.is_relative = (flags & main_flag::kRelative) != 0;
  field.bit_size = globals_.report_size;
  field.application = open_.empty() ? kNoApplication : open_.back().application;
  const Range logical = range_of(globals_.logical_min, globals_.logical_max);
  field.logical_min = logical.min;
  field.logical_max = logical.max;
  if (logical.min > logical.max) {
    field.has_odd_range = true;
    field.logical_min = 0;
    const std::uint32_t bits = std::min<std::uint32_t>(field.bit_size, 32);
    field.logical_max = (std::int64_t{1} << bits) - 1;
  }
  const Range physical = range_of(globals_.physical_min, globals_.physical_max);
  field.physical_min = physical.min;
  field.physical_max = physical.max;
  return field;
}

// The last usage applies to all remaining fields; without any usage a field has the page and id 0.
std::optional<std::string> Parser::add_variables(Field field) {
  field.usage = usage_of(globals_.usage_page, 0);
  std::size_t range = 0;
  std::uint32_t step = 0;
  for (std::uint32_t i = 0; i < globals_.report_count; ++i) {
    if (range < locals_.usages.size()) {
      const UsageRange& usages = locals_.usages[range].range;
      field.usage = usages.first + step;
      if (++step > usages.last - usages.first) {
        ++range;
        step = 0;
      }
    }
    result_.fields.push_back(field);
    field.bit_offset += field.bit_size;
  }
  return std::nullopt;
}

std::optional<std::string> Parser::add_array(Field field) {
  field.first_range = static_cast<std::uint32_t>(result_.ranges.size());
  field.range_count = static_cast<std::uint32_t>(locals_.usages.size());
  for (const LocalUsage& u : locals_.usages) result_.ranges.push_back(u.range);
  field.usage = locals_.usages.empty() ? usage_of(globals_.usage_page, 0)
                                       : locals_.usages.front().range.first;
  for (std::uint32_t i = 0; i < globals_.report_count; ++i) {
    result_.fields.push_back(field);
    field.bit_offset += field.bit_size;
  }
  return std::nullopt;
}

std::optional<std::string> Parser::finish() const {
  if (!open_.empty()) return fmt::format("{} collections are not ended", open_.size());
  if (locals_.delimiter_depth != 0) return "a delimiter is not ended";
  return std::nullopt;
}

}  // namespace

Result<ReportDescriptor> parse_descriptor(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return Error{"byte 0: the report descriptor is empty"};
  if (bytes.size() > kMaxDescriptorBytes) {
    return Error{fmt::format("byte {}: the report descriptor has {} bytes, at most {} are read",
                             kMaxDescriptorBytes, bytes.size(), kMaxDescriptorBytes)};
  }
  Parser parser;
  std::size_t at = 0;
  while (at < bytes.size()) {
    const ItemAt item = item_at(bytes, at);
    if (item.bytes == 0) return Error{fmt::format("byte {}: the item runs over the end", at)};
    if (!item.is_long) {
      if (auto cause = parser.add(item.item)) return Error{fmt::format("byte {}: {}", at, *cause)};
    }
    at += item.bytes;
  }
  if (auto cause = parser.finish()) return Error{fmt::format("byte {}: {}", at, *cause)};
  return parser.take();
}

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
