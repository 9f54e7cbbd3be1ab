#include "pad_report/decode_report.h"

#include <fmt/format.h>

#include <span>

#include "base/shown_number.h"
#include "base/text.h"
#include "hid/usage_names.h"
#include "pads/newest_reports.h"
#include "terminal/terminal.h"

namespace gaitpad {

using nlohmann::ordered_json;

namespace {

const char* kind_name(FieldKind kind) {
  switch (kind) {
    case FieldKind::input:
      return "input";
    case FieldKind::output:
      return "output";
    case FieldKind::feature:
      return "feature";
  }
  return "";
}

// True if two fields differ only in their position; such neighbours are printed as one row.
bool continues(const Field& a, const Field& b) {
  return a.kind == b.kind && a.report_id == b.report_id && a.usage == b.usage &&
         a.bit_size == b.bit_size && a.logical_min == b.logical_min &&
         a.logical_max == b.logical_max && a.is_array == b.is_array;
}

// The values by usage. A repeated usage has the value of its first field; each usage that an array
// names has 1.
ordered_json values_json(const ReportDescriptor& descriptor, const Report& report,
                         std::uint8_t id) {
  ordered_json values = ordered_json::object();
  const std::size_t skip = descriptor.numbered ? 1 : 0;
  if (report.size < skip) return values;
  const std::span<const std::uint8_t> data(report.bytes.data() + skip, report.size - skip);
  for (const Field& f : descriptor.fields) {
    if (f.kind != FieldKind::input || f.report_id != id || f.bit_size > 64) continue;
    const std::int64_t value = field_value(f, data);
    const std::uint32_t usage = f.is_array ? array_usage(descriptor, f, value) : f.usage;
    if (f.is_array && id_of(usage) == 0) continue;
    const std::string key = usage_text(usage);
    if (!values.contains(key)) values[key] = f.is_array ? 1 : value;
  }
  return values;
}

std::vector<std::string> pressed_names(const DecodedDevice& device, const Report& report,
                                       std::uint8_t id) {
  std::vector<std::string> names = button_names(device.state);
  const std::size_t skip = device.layout.descriptor.numbered ? 1 : 0;
  if (report.size < skip) return names;
  const std::span<const std::uint8_t> data(report.bytes.data() + skip, report.size - skip);
  for (const UnnamedButton& u : device.layout.unnamed) {
    if (u.report_id != id || bits_at(data, u.bits.bit_offset, u.bits.bit_size) == 0) continue;
    names.push_back(fmt::format("button_{}", u.number));
  }
  return names;
}

}  // namespace

std::vector<std::string> button_names(const PadState& state) {
  std::vector<std::string> names;
  for (int b = 0; b < kButtonCount; ++b) {
    if (pressed(state, static_cast<PadButton>(b))) names.emplace_back(kButtonNames[b]);
  }
  return names;
}

ordered_json axes_json(const PadState& state) {
  ordered_json axes = ordered_json::object();
  for (int a = 0; a < kAxisCount; ++a) axes[std::string(kAxisNames[a])] = state.axis[a];
  return axes;
}

ordered_json battery_json(const std::optional<Battery>& battery) {
  if (!battery) return nullptr;
  const auto text = [](const std::string& word) {
    return word.empty() ? ordered_json() : ordered_json(word);
  };
  return {{"percent", battery->percent ? ordered_json(*battery->percent) : ordered_json()},
          {"level", text(battery->level)},
          {"status", text(battery->status)}};
}

ordered_json descriptor_json(const DecodedDevice& device) {
  const DeviceInfo& info = device.source.info;
  ordered_json fields = ordered_json::array();
  for (const Field& f : device.layout.descriptor.fields) {
    fields.push_back({{"report_id", f.report_id},
                      {"bit_offset", f.bit_offset},
                      {"bit_size", f.bit_size},
                      {"usage_page", page_of(f.usage)},
                      {"usage", id_of(f.usage)},
                      {"logical_min", f.logical_min},
                      {"logical_max", f.logical_max},
                      {"kind", kind_name(f.kind)}});
  }
  return {{"device",
           {{"name", info.name},
            {"bus", static_cast<unsigned>(info.bus)},
            {"vendor", info.vendor},
            {"product", info.product}}},
          {"pad", device.layout.is_pad},
          {"fields", std::move(fields)}};
}

ordered_json report_json(const DecodedDevice& device, const Report& report, bool is_good) {
  const std::uint8_t id = report_id_of(device.layout, report);
  ordered_json line = {
      {"device", device.source.index},
      {"time_s", static_cast<double>(report.time_ns) / 1e9},
      {"report_id", id},
      {"values",
       is_good ? values_json(device.layout.descriptor, report, id) : ordered_json::object()},
      {"axes", device.layout.is_pad ? axes_json(device.state) : ordered_json::object()},
      {"buttons", is_good ? pressed_names(device, report, id) : std::vector<std::string>{}}};
  if (!is_good) line["bad"] = true;
  return line;
}

std::string descriptor_text(const DecodedDevice& device) {
  const DeviceInfo& info = device.source.info;
  std::string text = fmt::format(
      "device {}: {} (bus {:x}, {:04x}:{:04x}), {}, {} bytes of descriptor\n", device.source.index,
      printable(info.name), static_cast<unsigned>(info.bus), info.vendor, info.product,
      device.layout.is_pad ? "a pad" : "no pad", info.descriptor.size());
  if (!device.layout.override_origin.empty()) {
    text += fmt::format("controls by {}\n", printable(device.layout.override_origin));
  }
  std::vector<TableRow> table = {
      {"kind", "id", "bit", "size", "count", "usage", "name", "min", "max"}};
  const std::vector<Field>& fields = device.layout.descriptor.fields;
  for (std::size_t i = 0; i < fields.size();) {
    const Field& f = fields[i];
    std::size_t end = i + 1;
    while (end < fields.size() && continues(f, fields[end])) ++end;
    table.push_back({std::string(kind_name(f.kind)), fmt::format("{:x}", f.report_id),
                     fmt::format("{}", f.bit_offset), fmt::format("{}", f.bit_size),
                     fmt::format("{}", end - i), usage_text(f.usage), usage_name(f.usage),
                     fmt::format("{}", f.logical_min),
                     fmt::format("{}{}", f.logical_max, f.is_array ? " array" : "")});
    i = end;
  }
  return text + table_text(table);
}

std::string report_text(const DecodedDevice& device, const Report& report, bool is_good) {
  const std::uint8_t id = report_id_of(device.layout, report);
  std::string line =
      fmt::format("{:>12.6f} device {} report {:2x}", static_cast<double>(report.time_ns) / 1e9,
                  device.source.index, id);
  if (!is_good)
    return fmt::format("{}  {} bytes: too short, or an unknown id\n", line, report.size);
  if (device.layout.is_pad) {
    const auto& a = device.state.axis;
    line += fmt::format("  left {} {}  right {} {}  triggers {:.3f} {:.3f} ",
                        signed_number(a[kLeftX], 3), signed_number(a[kLeftY], 3),
                        signed_number(a[kRightX], 3), signed_number(a[kRightY], 3), a[kLeftTrigger],
                        a[kRightTrigger]);
    for (const std::string& name : pressed_names(device, report, id)) line += " " + name;
  }
  return line + "\n";
}

}  // namespace gaitpad
