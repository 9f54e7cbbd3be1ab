// gaitpad decode: prints report descriptors and the values of each report, from a trace or from a
// live device.
#include "gaitpad/decode.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "drivers/pads/recorded_packets.h"
#include "gaitpad/pad_stream.h"
#include "gaitpad/trace.h"
#include "hid/usage_names.h"
#include "pads/newest_reports.h"
#include "terminal/run_end.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"

namespace gaitpad {
namespace {

enum class OutputForm { text, json };

// A device and everything that decoding needs. `state` is the state after its last report.
struct DecodedDevice {
  TraceDevice source;
  PadLayout layout;
  PadState state;
};

// --- a descriptor and a report, printed

using nlohmann::ordered_json;

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
  say("device {}: {} (bus {:x}, {:04x}:{:04x}), {}, {} bytes of descriptor\n", device.source.index,
      printable(info.name), static_cast<unsigned>(info.bus), info.vendor, info.product,
      device.layout.is_pad ? "a pad" : "no pad", info.descriptor.size());
  if (!device.layout.override_origin.empty()) {
    say("controls by {}\n", printable(device.layout.override_origin));
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
  print_table(table);
}

void print_report_text(const DecodedDevice& device, const Report& report, bool is_good) {
  const std::uint8_t id = report_id_of(device.layout, report);
  std::string line =
      fmt::format("{:>12.6f} device {} report {:2x}", static_cast<double>(report.time_ns) / 1e9,
                  device.source.index, id);
  if (!is_good) return say("{}  {} bytes: too short, or an unknown id\n", line, report.size);
  if (device.layout.is_pad) {
    const auto& a = device.state.axis;
    line += fmt::format("  left {:+.3f} {:+.3f}  right {:+.3f} {:+.3f}  triggers {:.3f} {:.3f} ",
                        a[kLeftX], a[kLeftY], a[kRightX], a[kRightY], a[kLeftTrigger],
                        a[kRightTrigger]);
    for (const std::string& name : pressed_names(device, report, id)) line += " " + name;
  }
  say("{}\n", line);
}

void print_descriptor(const DecodedDevice& device, OutputForm form) {
  if (form == OutputForm::json) {
    print_json_line(descriptor_json(device));
  } else {
    print_descriptor_text(device);
  }
}

// Prints a report and decodes it. False: the device cannot send this report.
bool print_report(DecodedDevice& device, const Report& report, OutputForm form) {
  const bool is_good = decode(device.layout, report, device.state);
  if (form == OutputForm::json) {
    print_json_line(report_json(device, report, is_good));
  } else {
    print_report_text(device, report, is_good);
  }
  return is_good;
}

// --- the command

struct DecodeArguments {
  PadSelector selector;
  std::string map;
  double seconds = 0.0;
  bool descriptor_only = false, as_json = false, lenient = false;
};

OutputForm form_of(const DecodeArguments& arguments) {
  return arguments.as_json ? OutputForm::json : OutputForm::text;
}

Result<std::vector<DecodedDevice>> devices_of(const Trace& trace, const PadOverrides& overrides) {
  std::vector<DecodedDevice> devices;
  for (const TraceDevice& source : trace.devices) {
    auto layout = pad_layout(source.info, overrides);
    if (!layout) {
      return Error{
          fmt::format("{}: device {}: {}", trace.path, source.index, layout.error().message)};
    }
    devices.push_back({source, std::move(*layout), {}});
  }
  return devices;
}

// Prints the reports of a recording. A report is good if the device's descriptor, or its
// replacement, can hold it.
void print_reports(const DecodeArguments& arguments, const Trace& trace,
                   std::vector<DecodedDevice>& devices) {
  long bad = 0;
  Report report;
  for (const TraceEvent& event : trace.events) {
    if (event.kind != ReportKind::input) continue;
    copy_report(trace, event, report);
    if (!print_report(devices[event.device], report, form_of(arguments))) ++bad;
  }
  if (bad > 0)
    print_remarks("decode", {fmt::format("{} reports are too short or have an unknown id", bad)});
}

// True for anything that exists and is not a device, and for anything that looks like a path.
bool is_trace(const std::string& source) {
  std::error_code ignored;
  for (const char* nodes : {"/dev/hidraw", "/dev/input/", "/dev/bus/"}) {
    if (source.starts_with(nodes)) return false;
  }
  if (std::filesystem::is_character_file(source, ignored)) return false;
  return std::filesystem::exists(source, ignored) || source.ends_with(".hid") ||
         source.find('/') != std::string::npos;
}

int run_trace(const DecodeArguments& arguments, const PadOverrides& overrides) {
  auto trace =
      read_trace(arguments.selector.pad, arguments.lenient ? Damage::skip : Damage::refuse);
  if (!trace) return fail("decode", trace.error().message);
  accept_packets(*trace);
  auto devices = devices_of(*trace, overrides);
  if (!devices) return fail("decode", devices.error().message);
  if (const auto remark = damage_remark(*trace)) print_remarks("decode", {*remark});
  for (const DecodedDevice& device : *devices) print_descriptor(device, form_of(arguments));
  if (!arguments.descriptor_only) print_reports(arguments, *trace, *devices);
  return 0;
}

// The device with that node, pad or not; if none has it, the device that play would choose.
Result<PadSighting> sighting_of(const PadFiles& files, const PadSelector& selector) {
  auto sightings = pad_sightings(files, selector, Drivers::preferred);
  if (!sightings) return sightings.error();
  std::error_code ignored;
  const std::string node = std::filesystem::canonical(selector.pad, ignored).string();
  for (const PadSighting& sighting : *sightings) {
    if (!node.empty() && sighting.listing.node == node) return sighting;
  }
  auto chosen = chosen_pads(*sightings, selector);
  if (!chosen) return chosen.error();
  if (!chosen->empty()) return chosen->front();
  const auto matching = matching_pads(*sightings, selector);
  const bool is_told = matching && !matching->empty() && !matching->front().problem.empty();
  if (is_told)
    return matching->front();  // opening the device will report the reason, and its descriptor may
                               // be readable
  return Error{
      fmt::format("{}: no driver sees such a device; gaitpad pads lists them", selector.pad)};
}

// Prints reports as they arrive, with times since the first one. Returns when the device is gone.
void print_live(Device& device, DecodedDevice& decoded, OutputForm form, RunEnd& end) {
  std::optional<std::int64_t> start_ns;
  Report report;
  while (!end.is_reached()) {
    const Device::Status status = device.read(report);
    print_remarks("decode", device.take_remarks());
    if (status == Device::Status::gone) {
      print_remarks("decode", {decoded.source.info.name + ": unplugged"});
      return;
    }
    if (status == Device::Status::report) {
      if (!start_ns) start_ns = report.time_ns;
      report.time_ns -= *start_ns;
      print_report(decoded, report, form);
      continue;
    }
    if (std::fflush(stdout) != 0) return;  // main reports the failed write
    end.wait(std::chrono::milliseconds(200), device.poll_fds());
  }
}

// Makes a device that is decoded in the same way as a recording of it.
Result<DecodedDevice> decoded_device(const DeviceInfo& info, const PadFiles& files) {
  std::vector<std::string> ignored;  // errors in calibrations, which decoding does not use
  TraceDevice recorded = recorded_device(files, info, std::nullopt, ignored).device;
  auto layout = pad_layout(recorded.info, files.overrides);
  if (!layout) return Error{fmt::format("{}: {}", info.name, layout.error().message)};
  return DecodedDevice{std::move(recorded), std::move(*layout), {}};
}

int run_live(const DecodeArguments& arguments, const PadFiles& files) {
  RunEnd end;
  const auto sighting = sighting_of(files, arguments.selector);
  if (!sighting) return fail("decode", sighting.error().message);
  std::unique_ptr<Device> device;
  // The system shows most descriptors even to users without access to the device.
  if (!arguments.descriptor_only || sighting->listing.info.descriptor.empty()) {
    auto opened = sighting->driver->open(sighting->listing, detach_asked(arguments.selector));
    if (!opened) return fail("decode", opened.error().message);
    device = std::move(*opened);
  }
  auto decoded = decoded_device(device ? device->info() : sighting->listing.info, files);
  if (!decoded) return fail("decode", decoded.error().message);
  print_descriptor(*decoded, form_of(arguments));
  if (arguments.descriptor_only) return 0;
  end.end_after(arguments.seconds);
  print_live(*device, *decoded, form_of(arguments), end);
  if (const std::int64_t lost = device->lost(); lost > 0)
    print_remarks("decode", {fmt::format("{} reports were lost", lost)});
  return 0;
}

int run(const DecodeArguments& arguments) {
  const auto files = pad_files(arguments.map, "");
  if (!files) return fail("decode", files.error().message);
  return arguments.selector.driver.empty() && is_trace(arguments.selector.pad)
             ? run_trace(arguments, files->overrides)
             : run_live(arguments, *files);
}

}  // namespace

void add_decode(CLI::App& app, int& status) {
  auto arguments = std::make_shared<DecodeArguments>();
  CLI::App* command = app.add_subcommand(
      "decode",
      "shows report descriptors and each report decoded, of a recording or a live device");
  command
      ->add_option("TRACE", arguments->selector.pad,
                   "a recording (.hid), a node such as /dev/hidraw0, or a pad as for play")
      ->required();
  add_driver_option(*command, arguments->selector);
  add_seconds_option(*command, arguments->seconds);
  command->add_flag("--descriptor", arguments->descriptor_only, "only the descriptors");
  command->add_flag("--json", arguments->as_json, "one JSON object a line");
  command->add_flag("--lenient", arguments->lenient,
                    "skip a recording's damaged lines and count them");
  command->add_option("--map", arguments->map, "pad file that overrides config/pads");
  command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace gaitpad
