#include "tools/gaitpad/calibrate_files.h"

#include <fmt/format.h>

#include <cstdio>

#include "base/files.h"
#include "base/text.h"
#include "hid/sdl_mapping.h"
#include "pads/calibration_store.h"
#include "stick/calibration_import.h"
#include "tools/gaitpad/calibrate_live.h"
#include "tools/gaitpad/calibrate_trace.h"
#include "tools/gaitpad/report_print.h"

namespace gaitpad {
namespace {

constexpr std::size_t kMaxImportBytes = std::size_t{1} << 20;

Result<std::string> import_text(const std::string& source) {
  if (source != "-") return file_text(source, kMaxImportBytes);
  std::string text;
  char bytes[4096];
  while (const std::size_t count = std::fread(bytes, 1, sizeof bytes, stdin)) {
    text.append(bytes, count);
    if (text.size() > kMaxImportBytes) return Error{"standard input: more than 1 MiB"};
  }
  return text;
}

// Opened only to ask what it is.
Result<GuidedPad> live_pad(const PadWish& wish, const PadFiles& files,
                           std::vector<std::string>& remarks) {
  auto sightings = pad_sightings(files, wish, Drivers::preferred);
  if (!sightings) return sightings.error();
  auto chosen = chosen_pads(*sightings, wish);
  if (!chosen) return chosen.error();
  if (chosen->empty()) return Error{"there is no usable pad; gaitpad doctor finds out why"};
  auto device = chosen->front().driver->open(chosen->front().listing, Detach::allowed);
  if (!device) return device.error();
  const auto factory = (*device)->factory_sticks();
  GuidedPad pad;
  pad.has_factory_sticks = factory.has_value();
  pad.info = recorded_device(files, (*device)->info(), factory, remarks).info;
  auto layout = pad_layout(pad.info, files.overrides);
  if (!layout) return Error{fmt::format("{}: {}", pad.info.name, layout.error().message)};
  pad.layout = std::move(*layout);
  return pad;
}

Result<GuidedPad> named_pad(const CalibrateArguments& arguments, const PadFiles& files) {
  std::vector<std::string> remarks;
  auto pad = arguments.traces.empty()
                 ? live_pad(arguments.wish, files, remarks)
                 : traced_pad(arguments.traces,
                              arguments.is_lenient ? Damage::skip : Damage::refuse, files, remarks);
  print_remarks("calibrate", remarks);
  return pad;
}

}  // namespace

int calibrate_failed(const std::string& sentence) {
  fmt::print(stderr, "gaitpad calibrate: {}\n", sentence);
  return 1;
}

int print_or_save(const std::string& target, const CalibrationFile& file,
                  const std::vector<std::string>& comments) {
  if (target == "-") {
    fmt::print("{}", calibration_text(file));
    return 0;
  }
  if (const auto problem = save_calibration(target, file, comments))
    return calibrate_failed(problem->message);
  fmt::print(stderr, "gaitpad calibrate: written to {}\n", target);
  return 0;
}

int import_calibration(const CalibrateArguments& arguments, const PadFiles& files) {
  auto pad = named_pad(arguments, files);
  if (!pad) return calibrate_failed(pad.error().message);
  auto text = import_text(arguments.import);
  if (!text) return calibrate_failed(text.error().message);
  const std::string source = arguments.import == "-" ? "standard input" : arguments.import;
  auto imported = calibration_import(*text, source, pad->info, pad->layout);
  if (!imported) return calibrate_failed(imported.error().message);
  CalibrationFile file = calibration_for(pad->info, pad->has_factory_sticks);
  auto target = calibration_target(arguments.out, file);
  if (!target) return calibrate_failed(target.error().message);
  std::vector<std::string> remarks;
  take_what_holds(files, pad->info, *target, file, remarks);
  print_remarks("calibrate", remarks);
  if (imported->mapping.empty()) {
    file.calibration = imported->calibration;
    file.measured = {};
    file.measured_on.clear();
  } else {
    file.mapping = imported->mapping;
  }
  return print_or_save(*target, file, {"Imported from " + printable(source)});
}

int export_sdl(const CalibrateArguments& arguments, const PadFiles& files) {
  auto pad = named_pad(arguments, files);
  if (!pad) return calibrate_failed(pad.error().message);
  // The frames of the device's own file, where there is one.
  const std::string own[] = {files.user_calibrations};
  const FoundCalibration found = find_calibration(own, identity_of(pad->info));
  auto line = sdl_mapping_text(pad->info, pad->layout, stick_axes(found.file.calibration));
  if (!line) return calibrate_failed(line.error().message);
  fmt::print("{}\n", *line);
  return 0;
}

}  // namespace gaitpad
