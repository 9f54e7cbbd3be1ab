// gaitpad decode: prints report descriptors and the values of each report, from a trace or from a
// live device.
#include "gaitpad/decode.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "drivers/pads/recorded_packets.h"
#include "gaitpad/pad_stream.h"
#include "gaitpad/trace.h"
#include "pad_report/decode_report.h"
#include "terminal/run_end.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"

namespace gaitpad {
namespace {

enum class OutputForm { text, json };

void print_descriptor(const DecodedDevice& device, OutputForm form) {
  if (form == OutputForm::json) {
    print_json_line(descriptor_json(device));
  } else {
    say(stdout, descriptor_text(device));
  }
}

// Prints a report and decodes it. False: the device cannot send this report.
bool print_report(DecodedDevice& device, const Report& report, OutputForm form) {
  const bool is_good = decode(device.layout, report, device.state);
  if (form == OutputForm::json) {
    print_json_line(report_json(device, report, is_good));
  } else {
    say(stdout, report_text(device, report, is_good));
  }
  return is_good;
}

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
      "decode", "shows the report descriptors and decoded reports of a recording or a live device");
  command
      ->add_option("TRACE", arguments->selector.pad,
                   "a recording (.hid), a node such as /dev/hidraw0, or a pad as for play")
      ->required();
  add_driver_option(*command, arguments->selector);
  add_seconds_option(*command, arguments->seconds);
  command->add_flag("--descriptor", arguments->descriptor_only, "print only the descriptors");
  command->add_flag("--json", arguments->as_json, "print one JSON object a line");
  command->add_flag("--lenient", arguments->lenient,
                    "skip a recording's damaged lines and count them");
  command->add_option("--map", arguments->map, "pad file that overrides config/pads");
  command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace gaitpad
