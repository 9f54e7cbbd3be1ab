// gaitpad decode: what report descriptors say, and what each report says by them, from a trace or
// from a device as it is used.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "gaitpad/pad_stream.h"
#include "gaitpad/trace.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/live_run.h"
#include "tools/gaitpad/pad_options.h"
#include "tools/gaitpad/report_print.h"

namespace gaitpad {
namespace {

struct DecodeArguments {
  PadWish wish;
  std::string map;
  double seconds = 0.0;
  bool descriptor_only = false, as_json = false, lenient = false;
};

OutputForm form_of(const DecodeArguments& arguments) {
  return arguments.as_json ? OutputForm::json : OutputForm::text;
}

int fail(const std::string& sentence) {
  fmt::print(stderr, "gaitpad decode: {}\n", sentence);
  return 1;
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

// A report counts as good where the device's descriptor, or what replaces it, can hold it.
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
    fmt::print(stderr, "gaitpad decode: {} reports are too short or have an unknown id\n", bad);
}

// What exists and is no device, and what looks like the path of a file.
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
  const auto trace =
      read_trace(arguments.wish.pad, arguments.lenient ? Damage::skip : Damage::refuse);
  if (!trace) return fail(trace.error().message);
  auto devices = devices_of(*trace, overrides);
  if (!devices) return fail(devices.error().message);
  if (trace->skipped_lines > 0) {
    fmt::print(stderr, "gaitpad decode: {} damaged lines were skipped, the first: {}\n",
               trace->skipped_lines, trace->first_damage);
  }
  for (const DecodedDevice& device : *devices) print_descriptor(device, form_of(arguments));
  if (!arguments.descriptor_only) print_reports(arguments, *trace, *devices);
  return 0;
}

// By its node, also where it is no pad; else as play chooses it.
Result<PadSighting> sighting_of(const PadFiles& files, const PadWish& wish) {
  auto sightings = pad_sightings(files, wish, Drivers::preferred);
  if (!sightings) return sightings.error();
  std::error_code ignored;
  const std::string node = std::filesystem::canonical(wish.pad, ignored).string();
  for (const PadSighting& sighting : *sightings) {
    if (!node.empty() && sighting.listing.node == node) return sighting;
  }
  auto chosen = chosen_pads(*sightings, wish);
  if (!chosen) return chosen.error();
  if (!chosen->empty()) return chosen->front();
  const auto wished = wished_pads(*sightings, wish);
  const bool is_told = wished && !wished->empty() && !wished->front().problem.empty();
  if (is_told) return wished->front();  // its opening says why not, its descriptor may be readable
  return Error{fmt::format("{}: no driver sees such a device; gaitpad pads lists them", wish.pad)};
}

// Reports as they come, their time counted from the first one. Returns when the device is gone.
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
    if (std::fflush(stdout) != 0) return;  // main says so
    end.wait(std::chrono::milliseconds(200), device.poll_fds());
  }
}

// As a recording of it would be decoded.
Result<DecodedDevice> decoded_device(const DeviceInfo& info, const PadFiles& files) {
  std::vector<std::string> ignored;  // of calibrations, which decoding does not use
  TraceDevice recorded = recorded_device(files, info, std::nullopt, ignored);
  auto layout = pad_layout(recorded.info, files.overrides);
  if (!layout) return Error{fmt::format("{}: {}", info.name, layout.error().message)};
  return DecodedDevice{std::move(recorded), std::move(*layout), {}};
}

int run_live(const DecodeArguments& arguments, const PadFiles& files) {
  RunEnd end;
  const auto sighting = sighting_of(files, arguments.wish);
  if (!sighting) return fail(sighting.error().message);
  std::unique_ptr<Device> device;
  // The system shows many a descriptor to those, too, who may not open the device.
  if (!arguments.descriptor_only || sighting->listing.info.descriptor.empty()) {
    auto opened = sighting->driver->open(sighting->listing, Detach::allowed);
    if (!opened) return fail(opened.error().message);
    device = std::move(*opened);
  }
  auto decoded = decoded_device(device ? device->info() : sighting->listing.info, files);
  if (!decoded) return fail(decoded.error().message);
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
  if (!files) return fail(files.error().message);
  return arguments.wish.driver.empty() && is_trace(arguments.wish.pad)
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
      ->add_option("TRACE", arguments->wish.pad,
                   "a recording (.hid), a node such as /dev/hidraw0, or a pad as for play")
      ->required();
  add_driver_option(*command, arguments->wish);
  add_seconds_option(*command, arguments->seconds);
  command->add_flag("--descriptor", arguments->descriptor_only, "only the descriptors");
  command->add_flag("--json", arguments->as_json, "one JSON object a line");
  command->add_flag("--lenient", arguments->lenient,
                    "skip a recording's damaged lines and count them");
  command->add_option("--map", arguments->map, "pad file that overrides config/pads");
  command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace gaitpad
