// gaitpad calibrate [PAD]: measures a pad's sticks, guided at the terminal or out of recordings,
// says what it found and keeps it for play, record and monitor.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>

#include "gaitpad/config_files.h"
#include "pads/calibration_store.h"
#include "stick/pad_analysis.h"
#include "tools/gaitpad/calibrate_files.h"
#include "tools/gaitpad/calibrate_live.h"
#include "tools/gaitpad/calibrate_print.h"
#include "tools/gaitpad/calibrate_trace.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/pad_options.h"
#include "tools/gaitpad/report_print.h"
#include "draw/stick_picture.h"

namespace gaitpad {
namespace {

std::optional<Error> draw(const CalibrateArguments& arguments, const GuidedPad& pad,
                          const PadAnalysis& analysis) {
  // When a recording was made is not known.
  const std::string date = arguments.traces.empty() ? ", " + today() : "";
  std::vector<StickPicture> pictures;
  constexpr const char* kTitles[] = {"Left stick", "Right stick"};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& stick = analysis.stick[i];
    if (!stick) continue;
    pictures.push_back({kTitles[i], stick->tracks, &stick->statistics, &stick->advice});
  }
  return write_stick_picture(arguments.plot, printable(pad.info.name) + date, pictures);
}

void print_changes(const std::vector<std::string>& changes, const std::string& since) {
  fmt::print("\n");
  if (changes.empty()) fmt::print("nothing that was seen has changed since {}\n", since);
  for (const std::string& change : changes) fmt::print("{}\n", change);
}

// What a person should not learn only after the guided steps.
std::optional<Error> problem_beforehand(const CalibrateArguments& arguments) {
  if (!arguments.check.empty()) {
    const auto file = load_calibration_file(arguments.check);
    return file ? std::nullopt : std::optional(file.error());
  }
  if (arguments.out == "-") return std::nullopt;
  if (!arguments.out.empty()) return saving_problem(arguments.out);
  // Which pad it will be is not known yet.
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
    print_analysis(pad.info, analysis);
    if (changes && is_useful(analysis)) print_changes(*changes, arguments.check);
  }
  std::fflush(stdout);
  if (!arguments.plot.empty()) {
    if (auto problem = draw(arguments, pad, analysis)) return problem;
  }
  if (is_useful(analysis)) return std::nullopt;
  return Error{"no stick was seen at rest, so no centre is known; nothing written"};
}

int check(const CalibrateArguments& arguments, const GuidedPad& pad, const PadAnalysis& analysis) {
  const auto then = load_calibration_file(arguments.check);
  if (!then) return calibrate_failed(then.error().message);
  if (calibration_fit(*then, identity_of(pad.info)) == 0) {
    print_remarks("calibrate",
                  {fmt::format("{}: is the file of \"{}\", and its devices, unique_id, port or "
                               "drivers do not fit {} ({:04x}:{:04x}); compared all the same",
                               arguments.check, printable(then->name), printable(pad.info.name),
                               pad.info.vendor, pad.info.product)});
  }
  CalibrationFile now;
  now.calibration = then->calibration;
  take_advice(analysis, now);
  const auto problem = show(arguments, pad, analysis, changes_since(*then, now));
  return problem ? calibrate_failed(problem->message) : 0;
}

// Shows what was measured and keeps it. Before that it is asked for, where `asked` is somebody at
// the terminal.
int keep(const CalibrateArguments& arguments, const PadFiles& files, const GuidedPad& pad,
         const PadAnalysis& analysis, RunEnd* asked) {
  CalibrationFile file = calibration_for(pad.info, pad.has_factory_sticks);
  const auto target = calibration_target(arguments.out, file);
  if (!target) return calibrate_failed(target.error().message);
  std::vector<std::string> remarks;
  take_what_holds(files, pad.info, *target, file, remarks);
  print_remarks("calibrate", remarks);
  take_advice(analysis, file);
  file.measured_on = today();
  if (const auto problem = show(arguments, pad, analysis, std::nullopt))
    return calibrate_failed(problem->message);
  if (asked && *target != "-" &&
      !confirmed(fmt::format("Enter writes {}, q leaves it as it was.", printable(*target)),
                 *asked))
    return calibrate_failed("left before the end; nothing written");
  return print_or_save(*target, file, calibration_comments(analysis));
}

int finish(const CalibrateArguments& arguments, const PadFiles& files, const GuidedPad& pad,
           RunEnd* asked) {
  const PadAnalysis analysis = analysis_of(pad.layout, pad.tracks, pad.frame);
  return arguments.check.empty() ? keep(arguments, files, pad, analysis, asked)
                                 : check(arguments, pad, analysis);
}

int run(const CalibrateArguments& arguments) {
  RunEnd end;
  const auto files = pad_files(arguments.map, "");
  if (!files) return calibrate_failed(files.error().message);
  if (arguments.exports_sdl) return export_sdl(arguments, *files);
  if (!arguments.import.empty()) return import_calibration(arguments, *files);
  if (arguments.traces.empty()) {
    if (const auto problem = problem_beforehand(arguments))
      return calibrate_failed(problem->message);
    const auto pad = guided_pad(*files, arguments.wish, end);
    if (!pad) return calibrate_failed(pad.error().message);
    if (!*pad) return calibrate_failed("left before the end; nothing written");
    return finish(arguments, *files, **pad, &end);
  }
  std::vector<std::string> remarks;
  auto pad = traced_pad(arguments.traces, arguments.is_lenient ? Damage::skip : Damage::refuse,
                        *files, remarks);
  if (!pad) return calibrate_failed(pad.error().message);
  const auto problem = learn_frames(arguments.pushes, *pad, remarks);
  if (problem) return calibrate_failed(problem->message);
  print_remarks("calibrate", driver_remarks(pad->info));
  print_remarks("calibrate", remarks);
  return finish(arguments, *files, *pad, nullptr);
}

std::string png_problem(const std::string& path) {
  return path.ends_with(".png") ? "" : "the picture is a PNG: its name ends with .png";
}

// What is measured, and what becomes of it.
void add_measuring(CLI::App& command, CalibrateArguments& arguments) {
  add_pad_options(command, arguments.wish);
  auto* trace = command.add_option("--trace", arguments.traces,
                                   "a recording instead of a guided session; again for more");
  trace->allow_extra_args(false);
  trace->excludes(command.get_option("PAD"))->excludes(command.get_option("--driver"));
  command.add_option("--out", arguments.out,
                     "the file to write, - for standard output (default: the device's own)");
  command.add_option("--plot", arguments.plot, "draws what was measured (.png)")
      ->check(png_problem);
  command
      .add_option("--check", arguments.check, "compares with this calibration file and writes none")
      ->excludes(command.get_option("--out"));
  command
      .add_option("--pushes", arguments.pushes,
                  "what the last pushes of the recordings meant, to learn axes and signs: "
                  "forward,right,back,left")
      ->delimiter(',')
      ->check(CLI::IsMember({"forward", "right", "back", "left"}))
      ->needs(trace);
  command.add_flag("--json", arguments.as_json, "what was measured, for machines");
  command.add_option("--map", arguments.map, "pad file that overrides config/pads");
  command.add_flag("--lenient", arguments.is_lenient,
                   "skip a recording's damaged lines and count them");
}

// Nothing is measured then.
void add_conversions(CLI::App& command, CalibrateArguments& arguments) {
  auto* import = command.add_option("--import", arguments.import,
                                    "takes over a jscal line, evdev's absinfo or an SDL mapping; "
                                    "- for standard input");
  auto* export_sdl = command.add_flag("--export-sdl", arguments.exports_sdl,
                                      "prints the pad as SDL's mapping line");
  export_sdl->excludes(import)->excludes(command.get_option("--out"));
  for (const char* measuring : {"--plot", "--check", "--pushes", "--json"}) {
    import->excludes(command.get_option(measuring));
    export_sdl->excludes(command.get_option(measuring));
  }
}

}  // namespace

void add_calibrate(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "calibrate", "measures a pad's sticks, guided or from recordings, and keeps the calibration");
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
