// gaitpad replay TRACE: a recorded stick walks characters; writes files and a summary, or shows the
// walk on a time line in a window.
#include "gaitpad/replay.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <memory>

#include "session/walk_export.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"
#include "tools/gaitpad/replay_to.h"
#include "tools/gaitpad/window_options.h"

namespace gaitpad {
namespace {

// Most members of a crowd that get files; each opens three.
constexpr int kMaxCrowdFiles = 256;
// The speed of a replay is printed if the replay took longer than this.
constexpr double kLong_s = 5.0;

struct ReplayArguments {
  SessionSpec spec;
  WindowArguments window;
  ReplayTo to;
  bool json = false, is_lenient = false, view = false;
};

void print_text(const SessionSpec::Replay& wanted, const RunSummary& run) {
  print_session(wanted.trace, run);
  for (std::size_t i = 0; i < run.walkers.size(); ++i) {
    print_character(run, i, Way::shown);
    if (wanted.out.empty()) continue;
    if (wanted.gltf) say("  {}/{}\n", printable(wanted.out), numbered_name("pose", ".glb", i));
    say("  {0}/{1}  {0}/{2}  {0}/{3}\n", printable(wanted.out), numbered_name("pose", ".bvh", i),
        numbered_name("frames", ".csv", i), numbered_name("summary", ".json", i));
  }
}

// Writes the files and the summary.
int run_through(const ReplayArguments& arguments) {
  RunEnd end;
  Progress progress(kReplayCommand);
  const auto result = replay(arguments.spec, [&](std::int64_t done, std::int64_t ticks) {
    progress.show(static_cast<double>(done) / static_cast<double>(ticks));
    return !end.is_reached();
  });
  progress.clear();
  if (!result) {
    const int status = fail(kReplayCommand, result.error().message);
    return end.cut_off_status() != 0 ? end.cut_off_status() : status;
  }
  print_remarks(kReplayCommand, result->remarks);
  if (const double seconds = progress.seconds(); seconds >= kLong_s) {
    const auto ticks = static_cast<double>(result->summary.ticks);
    print_remarks(kReplayCommand, {fmt::format("{:.0f} ticks in {:.1f} s, {:.0f} ticks a second",
                                               ticks, seconds, ticks / seconds)});
  }
  if (arguments.json) {
    std::vector<nlohmann::ordered_json> summaries;
    for (std::size_t i = 0; i < result->summary.walkers.size(); ++i)
      summaries.push_back(summary_json(result->summary, i));
    print_summaries_json(summaries);
  } else {
    print_text(arguments.spec.replay, result->summary);
  }
  std::fflush(stdout);
  return 0;
}

#ifdef GAITPAD_HAS_WINDOW
int view(const ReplayArguments& arguments) {
  RunEnd end;
  WindowOptions options = window_options(arguments.window, true);
  options.session = arguments.spec;
  options.without_display = "leave out --view to replay without one";
  WindowResult result;
  return show_window(kReplayCommand, options, end, result);
}
#else
int view(const ReplayArguments&) { return fail(kReplayCommand, missing_window()); }
#endif

int run(ReplayArguments& arguments) {
  arguments.spec.replay.damage = arguments.is_lenient ? Damage::skip : Damage::refuse;
  if (!arguments.to.target.empty()) return replay_to(arguments.spec, arguments.to);
  if (!arguments.view) return run_through(arguments);
  const int status = view(arguments);
  const bool wants_result = !arguments.spec.replay.out.empty() || arguments.json;
  return status == 0 && wants_result ? run_through(arguments) : status;
}

}  // namespace

void add_replay(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("replay", "walks characters by a recorded stick");
  const auto arguments = std::make_shared<ReplayArguments>();
  SessionSpec::Replay& wanted = arguments->spec.replay;
  command->add_option("trace", wanted.trace, "the recording (.hid)")->required();
  auto* out =
      command->add_option("--out", wanted.out, "folder for pose.bvh, frames.csv and summary.json");
  command
      ->add_flag("--gltf", wanted.gltf,
                 "also write pose.glb: binary glTF 2.0 with joints, one animation and a plain body")
      ->needs(out);
  add_session_options(*command, arguments->spec, "the trace's, else 240");
  command
      ->add_option("--fps", wanted.fps,
                   "poses a second in pose.bvh and pose.glb (default: every tick)")
      ->check(CLI::Range(1, kMaxRateHz));
  command
      ->add_option(
          "--crowd-files", wanted.crowd_files,
          "number of followers that also get files in --out, from the first on (default: 32)")
      ->check(CLI::Range(0, kMaxCrowdFiles))
      ->needs(out);
  command->add_flag("--lenient", arguments->is_lenient, "skip damaged lines and count them");
  add_max_hours_option(*command, wanted.max_hours);
  add_user_styles_option(*command, wanted.user_styles);
  auto* in_window =
      command->add_flag("--view", arguments->view, "show the walk in a window with a time line");
  for (CLI::Option* option : add_window_options(*command, arguments->window))
    option->needs(in_window);
  auto* json = command->add_flag("--json", arguments->json, "print the summary as JSON");
  auto* to =
      command
          ->add_option(
              "--to", arguments->to.target,
              "play the recording to other programs in real time, as a calibrated pad (uinput) or "
              "as the recorded devices (uhid), or write it for evemu (FILE.evemu)")
          ->check(target_problem)
          ->excludes(out)
          ->excludes(in_window)
          ->excludes(json);
  command
      ->add_option("--delay", arguments->to.delay_s,
                   "seconds before the first report and after the last (default: 1)")
      ->check(CLI::Range(0.0, 3600.0))
      ->needs(to);
  command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace gaitpad
