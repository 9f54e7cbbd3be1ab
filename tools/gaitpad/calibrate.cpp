// gaitpad calibrate [PAD]: measures a pad's sticks, guided at the terminal or from recordings,
// prints the result and stores it for play, record and monitor.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <utility>

#include "base/text.h"
#include "gaitpad/config_files.h"
#include "hid/sdl_lines.h"
#include "pad_report/calibration_report.h"
#include "pads/calibration_store.h"
#include "pads/traced_pad.h"
#include "stick/calibration_import.h"
#include "stick/guide.h"
#include "stick/pad_analysis.h"
#include "system/whole_file.h"
#include "tools/gaitpad/calibrate_guide.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"
#include "tools/gaitpad/window_module.h"

namespace gaitpad {
namespace {

struct CalibrateArguments {
  PadSelector selector;
  std::vector<std::string> traces, pushes, compare;
  std::string out, plot, check, import, map;
  bool as_json = false, exports_sdl = false, is_lenient = false;
};

// --- the files around a calibration

Result<std::string> import_text(const std::string& source) {
  if (source != "-") return file_text(source, kMaxMappingFileBytes);
  std::string text;
  char bytes[4096];
  while (const std::size_t count = std::fread(bytes, 1, sizeof bytes, stdin)) {
    text.append(bytes, count);
    if (text.size() > kMaxMappingFileBytes) return Error{"standard input: more than 8 MiB"};
  }
  return text;
}

// Opens the pad only to identify it.
Result<GuidedPad> live_pad(const PadSelector& selector, const PadFiles& files,
                           std::vector<std::string>& remarks) {
  auto sightings = pad_sightings(files, selector, Drivers::preferred);
  if (!sightings) return sightings.error();
  auto chosen = chosen_pads(*sightings, selector);
  if (!chosen) return chosen.error();
  if (chosen->empty()) return Error{"there is no usable pad; gaitpad doctor finds out why"};
  auto device = chosen->front().driver->open(chosen->front().listing, detach_asked(selector));
  if (!device) return device.error();
  const auto factory = (*device)->factory_sticks();
  GuidedPad pad;
  pad.has_factory_sticks = factory.has_value();
  pad.info = recorded_device(files, (*device)->info(), factory, remarks).device.info;
  auto layout = pad_layout(pad.info, files.overrides);
  if (!layout) return Error{fmt::format("{}: {}", pad.info.name, layout.error().message)};
  pad.layout = std::move(*layout);
  return pad;
}

Result<GuidedPad> named_pad(const CalibrateArguments& arguments, const PadFiles& files) {
  std::vector<std::string> remarks;
  auto pad = arguments.traces.empty()
                 ? live_pad(arguments.selector, files, remarks)
                 : traced_pad(arguments.traces,
                              arguments.is_lenient ? Damage::skip : Damage::refuse, files, remarks);
  print_remarks(kCalibrateCommand, remarks);
  return pad;
}

// Writes the file to the target; `-` is standard output. Returns the exit status.
int print_or_save(const std::string& target, const CalibrationFile& file,
                  const std::vector<std::string>& comments) {
  if (target == "-") {
    fmt::print("{}", calibration_text(file));
    return 0;
  }
  if (const auto problem = save_calibration(target, file, comments))
    return fail(kCalibrateCommand, problem->message);
  print_remarks(kCalibrateCommand, {"written to " + target});
  return 0;
}

// True if the text is a data base: it has Linux lines for different pads.
bool is_data_base(const std::vector<std::string>& lines) {
  return std::ranges::any_of(lines, [&lines](const std::string& line) {
    return line.substr(0, line.find(',')) != lines.front().substr(0, lines.front().find(','));
  });
}

// --import of a gamecontrollerdb.txt without a pad: stores every Linux line in the user's own file.
int import_data_base(const std::string& source, const std::vector<std::string>& lines) {
  const std::string target = user_mapping_file();
  const auto count = save_mappings(target, lines);
  if (!count) return fail(kCalibrateCommand, count.error().message);
  print_remarks(kCalibrateCommand,
                {fmt::format("{}: {} Linux mappings taken over; {} are in {} now", source,
                             lines.size(), *count, target)});
  return 0;
}

// --import, for the pad of the recordings, else for the requested one. Returns the exit status.
int import_calibration(const CalibrateArguments& arguments, const PadFiles& files) {
  const std::string origin = arguments.import == "-" ? "standard input" : arguments.import;
  auto given = import_text(arguments.import);
  if (!given) return fail(kCalibrateCommand, given.error().message);
  const bool is_for_a_pad =
      !arguments.selector.pad.empty() || !arguments.traces.empty() || !arguments.out.empty();
  if (const auto lines = mapping_lines(*given); !is_for_a_pad && is_data_base(lines))
    return import_data_base(origin, lines);
  auto pad = named_pad(arguments, files);
  if (!pad) return fail(kCalibrateCommand, pad.error().message);
  auto imported = calibration_import(*given, origin, pad->info, pad->layout);
  if (!imported) return fail(kCalibrateCommand, imported.error().message);
  CalibrationFile file = calibration_for(pad->info, pad->has_factory_sticks);
  auto target = calibration_target(arguments.out, file);
  if (!target) return fail(kCalibrateCommand, target.error().message);
  // The file is changed, so no other program may change it meanwhile.
  const auto lock = FolderLock::wait(*target);
  if (!lock) return fail(kCalibrateCommand, lock.error().message);
  std::vector<std::string> remarks;
  take_what_holds(files, pad->info, *target, file, remarks);
  print_remarks(kCalibrateCommand, remarks);
  if (imported->mapping.empty()) {
    file.calibration = imported->calibration;
    file.measured = {};
    file.measured_on.clear();
  } else {
    file.mapping = imported->mapping;
  }
  return print_or_save(*target, file, {"Imported from " + printable(origin)});
}

// Runs --export-sdl, for the pad of the recordings or the requested one. Returns the exit status.
int export_sdl(const CalibrateArguments& arguments, const PadFiles& files) {
  auto pad = named_pad(arguments, files);
  if (!pad) return fail(kCalibrateCommand, pad.error().message);
  // The stick's axes as in the device's own file, if there is one.
  const std::string own[] = {files.user_calibrations};
  const FoundCalibration found = find_calibration(own, identity_of(pad->info));
  auto line = sdl_mapping_text(pad->info, pad->layout, stick_axes(found.file.calibration));
  if (!line) return fail(kCalibrateCommand, line.error().message);
  fmt::print("{}\n", printable(*line));
  return 0;
}

// --- the command

#ifdef GAITPAD_HAS_WINDOW
std::optional<Error> draw(const CalibrateArguments& arguments, const GuidedPad& pad,
                          const PadAnalysis& analysis) {
  // A recording does not say its date, so the picture has none.
  const std::string date = arguments.traces.empty() ? ", " + today() : "";
  std::vector<StickPicture> pictures;
  constexpr const char* kTitles[] = {"Left stick", "Right stick"};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& stick = analysis.stick[i];
    if (!stick) continue;
    pictures.push_back({kTitles[i], stick->tracks, &stick->statistics, &stick->advice});
  }
  const auto module = window_module();
  if (!module) return module.error();
  return (*module)->write_stick_picture(arguments.plot, printable(pad.info.name) + date, pictures);
}

std::optional<Error> draw_comparison(const std::string& path, const ComparedFiles& files) {
  std::vector<ComparedStick> sticks;
  for (std::size_t side = 0; side < 2; ++side) {
    ComparedStick& stick = sticks.emplace_back();
    stick.title = side == 0 ? "Left stick" : "Right stick";
    stick.numbers = files.numbers[side];
    for (std::size_t i = 0; i < 2; ++i) {
      const Calibration& c = files.file[i].calibration;
      stick.names[i] = files.names[i];
      stick.calibrations[i] = side == 0 ? &c.left : &c.right;
    }
  }
  const auto module = window_module();
  if (!module) return module.error();
  return (*module)->write_comparison(path, files.names[0] + " and " + files.names[1], sticks);
}
#else
std::optional<Error> draw(const CalibrateArguments&, const GuidedPad&, const PadAnalysis&) {
  return Error{missing_window()};
}
std::optional<Error> draw_comparison(const std::string&, const ComparedFiles&) {
  return Error{missing_window()};
}
#endif

void print_changes(const std::vector<std::string>& changes, const std::string& if_none) {
  say("\n");
  if (changes.empty()) say("{}\n", if_none);
  for (const std::string& change : changes) say("{}\n", printable(change));
}

// --compare: two files of one pad. Returns the exit status.
int compare(const CalibrateArguments& arguments) {
  ComparedFiles files;
  for (std::size_t i = 0; i < 2; ++i) {
    auto file = load_calibration_file(arguments.compare[i]);
    if (!file) return fail(kCalibrateCommand, file.error().message);
    files.file[i] = std::move(*file);
    files.names[i] = printable(std::filesystem::path(arguments.compare[i]).filename().string());
  }
  const auto& [a, b] = files.file;
  if (a.unique_id != b.unique_id || a.devices != b.devices)
    print_remarks(kCalibrateCommand, {"the files are of different devices; compared all the same"});
  for (std::size_t side = 0; side < 2; ++side) files.numbers[side] = compared_numbers(a, b, side);
  say(stdout, comparison_text(files));
  print_changes(changes_since(a, b), "what was measured for both files has not changed");
  if (arguments.plot.empty()) return 0;
  const auto problem = draw_comparison(arguments.plot, files);
  return problem ? fail(kCalibrateCommand, problem->message) : 0;
}

// Finds problems before the guided steps instead of after them.
std::optional<Error> problem_beforehand(const CalibrateArguments& arguments) {
  if (!arguments.check.empty()) {
    const auto file = load_calibration_file(arguments.check);
    return file ? std::nullopt : std::optional(file.error());
  }
  if (arguments.out == "-") return std::nullopt;
  if (!arguments.out.empty()) return saving_problem(arguments.out);
  // The device's own file is not known before the pad is; any name tells whether there is a folder.
  const auto any = calibration_target("", CalibrationFile());
  return any ? saving_problem(std::filesystem::path(*any).replace_filename("*.toml"))
             : std::optional(any.error());
}

std::optional<Error> show(const CalibrateArguments& arguments, const GuidedPad& pad,
                          const PadAnalysis& analysis,
                          const std::optional<std::vector<std::string>>& changes) {
  if (arguments.as_json) {
    auto json = analysis_json(pad.info, analysis);
    if (changes) json["changes"] = *changes;
    print_json_line(json);
  } else if (arguments.out != "-") {
    say(stdout, analysis_text(pad.info, analysis));
    if (changes && has_a_centre(analysis))
      print_changes(*changes,
                    "nothing that was seen has changed since " + printable(arguments.check));
  }
  std::fflush(stdout);
  if (!arguments.plot.empty()) {
    if (auto problem = draw(arguments, pad, analysis)) return problem;
  }
  return std::nullopt;
}

int check(const CalibrateArguments& arguments, const GuidedPad& pad, const PadAnalysis& analysis) {
  const auto then = load_calibration_file(arguments.check);
  if (!then) return fail(kCalibrateCommand, then.error().message);
  if (calibration_fit(*then, identity_of(pad.info)) == 0) {
    print_remarks("calibrate",
                  {fmt::format("{}: is the file of \"{}\", and its devices, unique_id, port or "
                               "drivers do not fit {} ({:04x}:{:04x}); compared all the same",
                               arguments.check, printable(then->name), printable(pad.info.name),
                               pad.info.vendor, pad.info.product)});
  }
  const auto changes = changes_since(*then, seen_today(analysis, *then));
  if (const auto problem = show(arguments, pad, analysis, changes))
    return fail(kCalibrateCommand, problem->message);
  if (has_a_centre(analysis)) return 0;
  return fail(kCalibrateCommand, "no stick was seen at rest with hands off: nothing to compare");
}

// Prints the result and writes the file. If `asked` is not null, a user is at the terminal and is
// asked first.
int keep(const CalibrateArguments& arguments, const PadFiles& files, const GuidedPad& pad,
         const PadAnalysis& analysis, RunEnd* asked) {
  CalibrationFile file = calibration_for(pad.info, pad.has_factory_sticks);
  const auto target = calibration_target(arguments.out, file);
  if (!target) return fail(kCalibrateCommand, target.error().message);
  std::vector<std::string> remarks;
  take_what_holds(files, pad.info, *target, file, remarks);
  print_remarks(kCalibrateCommand, remarks);
  take_advice(analysis, file);
  take_gyro_bias(pad, file);
  file.measured_on = today();
  if (const auto problem = show(arguments, pad, analysis, std::nullopt))
    return fail(kCalibrateCommand, problem->message);
  if (!is_useful(analysis))
    return fail(kCalibrateCommand, why_useless(analysis) + "; nothing is written");
  for (std::size_t i = 0; i < 2; ++i) {
    if (analysis.stick[i] && !is_known(analysis, i)) {
      print_remarks(
          kCalibrateCommand,
          {fmt::format("the {} stick is unknown: its calibration is kept", kSideNames[i])});
    }
  }
  if (asked && *target != "-" &&
      !confirmed(fmt::format("Enter writes {}, q leaves it unchanged.", printable(*target)),
                 *asked))
    return fail(kCalibrateCommand, "left before the end; nothing written");
  return print_or_save(*target, file, calibration_comments(analysis));
}

int finish(const CalibrateArguments& arguments, const PadFiles& files, const GuidedPad& pad,
           RunEnd* asked) {
  const PadAnalysis analysis = analysis_of(pad.layout, pad.tracks, pad.frame);
  print_remarks(kCalibrateCommand, axes_questions(pad));
  return arguments.check.empty() ? keep(arguments, files, pad, analysis, asked)
                                 : check(arguments, pad, analysis);
}

int run(const CalibrateArguments& arguments) {
  if (!arguments.compare.empty()) return compare(arguments);
  RunEnd end;
  const auto files = pad_files(arguments.map, "");
  if (!files) return fail(kCalibrateCommand, files.error().message);
  if (arguments.exports_sdl) return export_sdl(arguments, *files);
  if (!arguments.import.empty()) return import_calibration(arguments, *files);
  if (arguments.traces.empty()) {
    if (const auto problem = problem_beforehand(arguments))
      return fail(kCalibrateCommand, problem->message);
    const auto pad = guided_pad(*files, arguments.selector, end);
    if (!pad) return fail(kCalibrateCommand, pad.error().message);
    if (!*pad) return fail(kCalibrateCommand, "left before the end; nothing written");
    return finish(arguments, *files, **pad, &end);
  }
  std::vector<std::string> remarks;
  auto pad = traced_pad(arguments.traces, arguments.is_lenient ? Damage::skip : Damage::refuse,
                        *files, remarks);
  if (!pad) return fail(kCalibrateCommand, pad.error().message);
  const auto problem = learn_frames(arguments.pushes, *pad, remarks);
  if (problem) return fail(kCalibrateCommand, problem->message);
  print_remarks(kCalibrateCommand, driver_remarks(pad->info));
  print_remarks(kCalibrateCommand, remarks);
  return finish(arguments, *files, *pad, nullptr);
}

std::string png_problem([[maybe_unused]] const std::string& path) {
#ifndef GAITPAD_HAS_WINDOW
  return missing_window();
#else
  return path.ends_with(".png") ? "" : "the picture is a PNG: its name ends with .png";
#endif
}

// Options of measuring and of the result.
void add_measuring(CLI::App& command, CalibrateArguments& arguments) {
  add_pad_options(command, arguments.selector);
  auto* trace = command.add_option(
      "--trace", arguments.traces,
      "measure this recording instead of a live pad; repeat it for more recordings");
  trace->allow_extra_args(false);
  trace->excludes(command.get_option("PAD"))->excludes(command.get_option("--driver"));
  command.add_option("--out", arguments.out,
                     "file to write, - for standard output (default: the device's own file)");
  command.add_option("--plot", arguments.plot, "draw what was measured (.png)")->check(png_problem);
  command
      .add_option("--check", arguments.check, "compare with this calibration file; write nothing")
      ->excludes(command.get_option("--out"));
  command
      .add_option("--pushes", arguments.pushes,
                  "directions of the last pushes in the recordings, to learn axes and signs: "
                  "forward,right,back,left")
      ->delimiter(',')
      ->check(CLI::IsMember({"forward", "right", "back", "left"}))
      ->needs(trace);
  command.add_flag("--json", arguments.as_json, "print what was measured as JSON");
  command.add_option("--map", arguments.map, "pad file that overrides config/pads");
  command.add_flag("--lenient", arguments.is_lenient,
                   "skip a recording's damaged lines and count them");
}

// Options that convert instead of measuring.
void add_conversions(CLI::App& command, CalibrateArguments& arguments) {
  auto* import = command.add_option(
      "--import", arguments.import,
      "import the axes from a recording of evemu, libinput or umockdev, or from an SDL mapping; "
      "without PAD import all Linux lines of a gamecontrollerdb.txt; - for standard input");
  auto* export_sdl = command.add_flag("--export-sdl", arguments.exports_sdl,
                                      "print the pad as a mapping line of SDL");
  export_sdl->excludes(import)->excludes(command.get_option("--out"));
  auto* compare = command.add_option(
      "--compare", arguments.compare,
      "compare two calibration files, such as before and after a repair; --plot draws both");
  compare->expected(2)->type_name("A B");
  for (const char* other :
       {"PAD", "--trace", "--out", "--check", "--pushes", "--json", "--import", "--export-sdl"})
    compare->excludes(command.get_option(other));
  for (const char* measuring : {"--plot", "--check", "--pushes", "--json"}) {
    import->excludes(command.get_option(measuring));
    export_sdl->excludes(command.get_option(measuring));
  }
}

}  // namespace

void add_calibrate(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "calibrate", "measures a pad's sticks, guided or from recordings, and saves the calibration");
  const auto arguments = std::make_shared<CalibrateArguments>();
  add_measuring(*command, *arguments);
  add_conversions(*command, *arguments);
  command->callback([arguments, &status] {
    if (arguments->as_json && arguments->out == "-")
      throw CLI::ValidationError("--json, --out -", "both are for standard output");
    status = run(*arguments);
  });
}

}  // namespace gaitpad
