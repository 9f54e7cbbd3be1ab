// gaitpad replay TRACE: a recorded stick walks characters; files and a summary come out, or a
// window shows it on a time line.
#include "gaitpad/replay.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "session/walk_export.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/live_run.h"
#include "tools/gaitpad/session_options.h"
#include "tools/gaitpad/window_options.h"

namespace gaitpad {
namespace {

struct ReplayArguments {
  SessionArguments session;
  WindowArguments window;
  std::string trace, out;
  bool json = false, lenient = false, view = false, gltf = false;
  int fps = 0;  // 0: not given
};

int fail(const std::string& sentence) {
  fmt::print(stderr, "gaitpad replay: {}\n", sentence);
  return 1;
}

void print_text(const ReplayArguments& arguments, const ReplayResult& result) {
  print_session(arguments.trace, result.summaries.front());
  for (std::size_t i = 0; i < result.summaries.size(); ++i) {
    print_character(i, result.summaries[i], result.distance_m[i]);
    if (arguments.out.empty()) continue;
    if (arguments.gltf) {
      fmt::print("  {}/{}\n", arguments.out, numbered_name("pose", ".glb", i));
    }
    fmt::print("  {0}/{1}  {0}/{2}  {0}/{3}\n", arguments.out, numbered_name("pose", ".bvh", i),
               numbered_name("frames", ".csv", i), numbered_name("summary", ".json", i));
  }
}

// The files and the summary.
int run_through(const ReplayArguments& arguments) {
  ReplayOptions options;
  options.session = session_options(arguments.session);
  options.trace = arguments.trace;
  options.out = arguments.out;
  options.gltf = arguments.gltf;
  options.damage = arguments.lenient ? Damage::skip : Damage::refuse;
  if (arguments.session.rate_hz > 0) options.rate_hz = arguments.session.rate_hz;
  if (arguments.fps > 0) options.fps = arguments.fps;
  const auto result = replay(options);
  if (!result) return fail(result.error().message);
  print_remarks("replay", result->remarks);
  if (arguments.json) {
    print_summaries_json(result->summaries);
  } else {
    print_text(arguments, *result);
  }
  std::fflush(stdout);
  return 0;
}

int view(const ReplayArguments& arguments) {
  RunEnd end;
  WindowOptions options = window_options(arguments.window, true);
  options.live.session = session_options(arguments.session);
  options.trace = arguments.trace;
  options.damage = arguments.lenient ? Damage::skip : Damage::refuse;
  options.is_trace_rate_given = arguments.session.rate_hz > 0;
  if (options.is_trace_rate_given) options.live.rate_hz = arguments.session.rate_hz;
  options.is_ended_from_outside = [&end] { return end.is_reached(); };
  const auto result = run_window(options);
  if (!result) return fail(result.error().message);
  print_remarks("replay", result->remarks);
  return 0;
}

int run(const ReplayArguments& arguments) {
  if (!arguments.view) return run_through(arguments);
  const int status = view(arguments);
  const bool wants_result = !arguments.out.empty() || arguments.json;
  return status == 0 && wants_result ? run_through(arguments) : status;
}

}  // namespace

void add_replay(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("replay", "walks characters along a recorded stick");
  const auto arguments = std::make_shared<ReplayArguments>();
  command->add_option("trace", arguments->trace, "the recording (.hid)")->required();
  auto* out = command->add_option("--out", arguments->out,
                                  "folder for pose.bvh, frames.csv and summary.json");
  command
      ->add_flag("--gltf", arguments->gltf,
                 "pose.glb too: binary glTF 2.0, joints, one animation and a plain body")
      ->needs(out);
  add_session_options(*command, arguments->session, "the trace's, else 240");
  command
      ->add_option("--fps", arguments->fps,
                   "poses a second in pose.bvh and pose.glb (default: every tick)")
      ->check(CLI::Range(1, kMaxRateHz));
  command->add_flag("--lenient", arguments->lenient, "skip damaged lines and count them");
  auto* in_window = command->add_flag("--view", arguments->view,
                                      "open the window: a time line to scrub, any speed");
  for (CLI::Option* option : add_window_options(*command, arguments->window))
    option->needs(in_window);
  command->add_flag("--json", arguments->json, "the summary, for machines");
  command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace gaitpad
