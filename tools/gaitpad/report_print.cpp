#include "tools/gaitpad/report_print.h"

#include <fmt/format.h>

#include <span>

namespace gaitpad {

using nlohmann::ordered_json;

void print_json_line(const ordered_json& object) {
  fmt::print("{}\n", object.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
}

std::string usage_text(std::uint32_t usage) {
  return fmt::format("{:04x}:{:04x}", page_of(usage), id_of(usage));
}

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

// Neighbours that differ only in their place are one row.
bool continues(const Field& a, const Field& b) {
  return a.kind == b.kind && a.report_id == b.report_id && a.usage == b.usage &&
         a.bit_size == b.bit_size && a.logical_min == b.logical_min &&
         a.logical_max == b.logical_max && a.is_array == b.is_array;
}

std::uint8_t report_id_of(const PadLayout& layout, const Report& report) {
  return layout.descriptor.numbered && report.size > 0 ? report.bytes[0] : 0;
}

// A usage that occurs several times gives its first field; an array gives a 1 for each usage it
// names.
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

void print_descriptor_text(const DecodedDevice& device) {
  const DeviceInfo& info = device.source.info;
  fmt::print("device {}: {} (bus {:x}, {:04x}:{:04x}), {}, {} bytes of descriptor\n",
             device.source.index, printable(info.name), static_cast<unsigned>(info.bus),
             info.vendor, info.product, device.layout.is_pad ? "a pad" : "no pad",
             info.descriptor.size());
  if (!device.layout.override_origin.empty()) {
    fmt::print("controls by {}\n", device.layout.override_origin);
  }
  fmt::print("{:<8} {:>2} {:>7} {:>5} {:>5}  {:<9} {:>12} {:>12}\n", "kind", "id", "bit", "size",
             "count", "usage", "min", "max");
  const std::vector<Field>& fields = device.layout.descriptor.fields;
  for (std::size_t i = 0; i < fields.size();) {
    const Field& f = fields[i];
    std::size_t end = i + 1;
    while (end < fields.size() && continues(f, fields[end])) ++end;
    fmt::print("{:<8} {:>2x} {:>7} {:>5} {:>5}  {:<9} {:>12} {:>12}{}\n", kind_name(f.kind),
               f.report_id, f.bit_offset, f.bit_size, end - i, usage_text(f.usage), f.logical_min,
               f.logical_max, f.is_array ? "  array" : "");
    i = end;
  }
}

void print_report_text(const DecodedDevice& device, const Report& report, bool is_good) {
  const std::uint8_t id = report_id_of(device.layout, report);
  fmt::print("{:>12.6f} device {} report {:2x}", static_cast<double>(report.time_ns) / 1e9,
             device.source.index, id);
  if (!is_good) {
    fmt::print("  {} bytes: too short, or an unknown id\n", report.size);
    return;
  }
  if (device.layout.is_pad) {
    const auto& a = device.state.axis;
    fmt::print("  left {:+.3f} {:+.3f}  right {:+.3f} {:+.3f}  triggers {:.3f} {:.3f} ", a[kLeftX],
               a[kLeftY], a[kRightX], a[kRightY], a[kLeftTrigger], a[kRightTrigger]);
    for (const std::string& name : pressed_names(device, report, id)) fmt::print(" {}", name);
  }
  fmt::print("\n");
}

}  // namespace

void print_descriptor(const DecodedDevice& device, OutputForm form) {
  if (form == OutputForm::json) {
    print_json_line(descriptor_json(device));
  } else {
    print_descriptor_text(device);
  }
}

bool print_report(DecodedDevice& device, const Report& report, OutputForm form) {
  const bool is_good = decode(device.layout, report, device.state);
  if (form == OutputForm::json) {
    print_json_line(report_json(device, report, is_good));
  } else {
    print_report_text(device, report, is_good);
  }
  return is_good;
}

}  // namespace gaitpad
