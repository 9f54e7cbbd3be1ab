// gaitpad replay TRACE: a recorded stick walks characters; files and a summary come out.
#include "session/replay.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "session/walk_export.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/session_options.h"

namespace gaitpad {
namespace {

struct ReplayArguments {
  SessionArguments session;
  std::string trace, out;
  bool json = false, lenient = false, view = false;
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
    fmt::print("  {0}/{1}  {0}/{2}  {0}/{3}\n", arguments.out, numbered_name("pose", ".bvh", i),
               numbered_name("frames", ".csv", i), numbered_name("summary", ".json", i));
  }
}

int run(const ReplayArguments& arguments) {
  if (arguments.view) return fail("--view: the window comes with a later version");
  ReplayOptions options;
  options.session = session_options(arguments.session);
  options.trace = arguments.trace;
  options.out = arguments.out;
  options.damage = arguments.lenient ? Damage::skip : Damage::refuse;
  if (arguments.session.rate_hz > 0) options.rate_hz = arguments.session.rate_hz;
  if (arguments.fps > 0) options.fps = arguments.fps;
  const auto result = replay(options);
  if (!result) return fail(result.error().message);
  for (const std::string& remark : result->remarks)
    fmt::print(stderr, "gaitpad replay: {}\n", remark);
  if (arguments.json) {
    print_summaries_json(result->summaries);
  } else {
    print_text(arguments, *result);
  }
  return 0;
}

}  // namespace

void add_replay(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("replay", "walks characters along a recorded stick");
  const auto arguments = std::make_shared<ReplayArguments>();
  command->add_option("trace", arguments->trace, "the recording (.hid)")->required();
  command->add_option("--out", arguments->out, "folder for pose.bvh, frames.csv and summary.json");
  add_session_options(*command, arguments->session, "the trace's, else 240");
  command->add_option("--fps", arguments->fps, "poses a second in pose.bvh (default: every tick)")
      ->check(CLI::Range(1, kMaxRateHz));
  command->add_flag("--lenient", arguments->lenient, "skip damaged lines and count them");
  command->add_flag("--view", arguments->view, "open the window (comes later)");
  command->add_flag("--json", arguments->json, "the summary, for machines");
  command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace gaitpad
