// gaitpad calibrate [PAD]: measures a pad's sticks, guided at the terminal or out of recordings,
// says what it found and keeps it for play, record and monitor.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <ctime>
#include <memory>
#include <utility>

#include "session/calibration_store.h"
#include "stick/pad_analysis.h"
#include "tools/gaitpad/calibrate_files.h"
#include "tools/gaitpad/calibrate_live.h"
#include "tools/gaitpad/calibrate_print.h"
#include "tools/gaitpad/calibrate_trace.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/pad_options.h"
#include "tools/gaitpad/report_print.h"
#include "view/stick_picture.h"

namespace gaitpad {
namespace {

std::string today() {
  const std::time_t now = std::time(nullptr);
  return fmt::format("{:%Y-%m-%d}", fmt::localtime(now));
}

std::vector<std::string> comments_of(const PadAnalysis& analysis) {
  std::vector<std::string> comments = {
      "Made by gaitpad calibrate; config/README.md says what the "
      "keys mean. Edit it as you like."};
  constexpr const char* kNames[] = {"left", "right"};
  for (std::size_t i = 0; i < 2; ++i) {
    if (!analysis.stick[i]) continue;
    comments.push_back(fmt::format("{} stick: {}. {}", kNames[i],
                                   name_of(analysis.stick[i]->advice.verdict),
                                   analysis.stick[i]->advice.reason));
  }
  return comments;
}

std::optional<Error> draw(const std::string& path, const GuidedPad& pad,
                          const PadAnalysis& analysis) {
  std::vector<StickPicture> pictures;
  constexpr const char* kTitles[] = {"Left stick", "Right stick"};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& stick = analysis.stick[i];
    if (!stick) continue;
    pictures.push_back({kTitles[i], stick->tracks, &stick->statistics, &stick->advice});
  }
  return write_stick_picture(path, fmt::format("{}, {}", printable(pad.info.name), today()),
                             pictures);
}

void print_changes(const std::vector<std::string>& changes, const std::string& since) {
  if (changes.empty()) fmt::print("\nnothing has changed since {}\n", since);
  for (const std::string& change : changes) fmt::print("{}\n", change);
}

// What was measured, on standard output; then the picture, the comparison or the file. Before that
// it is asked for, where `asked` is somebody at the terminal.
int finish(const CalibrateArguments& arguments, const PadFiles& files, const GuidedPad& pad,
           RunEnd* asked) {
  const PadAnalysis analysis = analysis_of(pad.layout, pad.tracks, pad.frame);
  CalibrationFile file = calibration_for(pad.info, pad.has_factory_sticks);
  std::vector<std::string> changes;
  std::string target;
  if (!arguments.check.empty()) {
    auto then = load_calibration_file(arguments.check);
    if (!then) return calibrate_failed(then.error().message);
    file.calibration = then->calibration;
    take_advice(analysis, file);
    changes = changes_since(*then, file);
  } else {
    auto path = calibration_target(arguments.out, file);
    if (!path) return calibrate_failed(path.error().message);
    target = std::move(*path);
    take_what_holds(files, pad.info, target, file);
    take_advice(analysis, file);
  }
  file.measured_on = today();

  if (arguments.as_json) {
    auto json = analysis_json(pad.info, analysis);
    if (!arguments.check.empty()) json["changes"] = changes;
    print_json_line(json);
  } else if (arguments.out != "-") {
    print_analysis(pad.info, analysis);
    if (!arguments.check.empty()) print_changes(changes, arguments.check);
  }
  if (!arguments.plot.empty()) {
    if (const auto problem = draw(arguments.plot, pad, analysis))
      return calibrate_failed(problem->message);
  }
  if (!is_useful(analysis)) {
    return calibrate_failed(
        "no stick was seen at rest, so nothing is known about its centre; nothing written");
  }
  if (!arguments.check.empty()) return 0;
  std::fflush(stdout);
  if (asked && arguments.out != "-" &&
      !confirmed(fmt::format("Enter writes {}, q leaves it as it was.", printable(target)), *asked))
    return calibrate_failed("left before the end; nothing written");
  return print_or_save(target, file, comments_of(analysis));
}

int run(const CalibrateArguments& arguments) {
  RunEnd end;
  const auto files = pad_files(arguments.map, "");
  if (!files) return calibrate_failed(files.error().message);
  if (arguments.exports_sdl) return export_sdl(arguments, *files);
  if (!arguments.import.empty()) return import_calibration(arguments, *files);
  if (arguments.traces.empty()) {
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
  print_remarks("calibrate", remarks);
  return finish(arguments, *files, *pad, nullptr);
}

}  // namespace

void add_calibrate(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "calibrate", "measures a pad's sticks, guided or from recordings, and keeps the calibration");
  const auto arguments = std::make_shared<CalibrateArguments>();
  add_pad_options(*command, arguments->wish);
  auto* trace = command->add_option("--trace", arguments->traces,
                                    "a recording instead of a guided session; again for more");
  trace->allow_extra_args(false);
  command->add_option("--out", arguments->out,
                      "the file to write, - for standard output (default: the device's own)");
  command->add_option("--plot", arguments->plot, "draws what was measured (.png)");
  command->add_option("--check", arguments->check,
                      "compares with this calibration file and writes none");
  command
      ->add_option("--pushes", arguments->pushes,
                   "what the last pushes of the recordings meant, to learn axes and signs: "
                   "forward,right,back,left")
      ->delimiter(',')
      ->needs(trace);
  command->add_option("--import", arguments->import,
                      "takes over a jscal line, evdev's absinfo or an SDL mapping; - for standard "
                      "input");
  command->add_flag("--export-sdl", arguments->exports_sdl, "prints the pad as SDL's mapping line");
  command->add_option("--map", arguments->map, "pad file that overrides config/pads");
  command->add_flag("--lenient", arguments->is_lenient,
                    "skip a recording's damaged lines and count them");
  command->add_flag("--json", arguments->as_json, "what was measured, for machines");
  command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace gaitpad
