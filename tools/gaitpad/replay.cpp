// gaitpad replay TRACE: a recorded stick walks characters; files and a summary come out, or a
// window shows it on a time line.
#include "gaitpad/replay.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <memory>

#include "session/walk_export.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"
#include "tools/gaitpad/window_options.h"

namespace gaitpad {
namespace {

constexpr const char* kCommand = "replay";
constexpr int kMaxCrowdFiles = 256;  // each takes three open files

struct ReplayArguments {
  SessionSpec spec;
  WindowArguments window;
  bool json = false, is_lenient = false, view = false;
};

void print_text(const SessionSpec::Replay& wanted, const RunSummary& run) {
  print_session(wanted.trace, run);
  for (std::size_t i = 0; i < run.walkers.size(); ++i) {
    print_character(run, i, Way::shown);
    if (wanted.out.empty()) continue;
    if (wanted.gltf)
      fmt::print("  {}/{}\n", printable(wanted.out), numbered_name("pose", ".glb", i));
    fmt::print("  {0}/{1}  {0}/{2}  {0}/{3}\n", printable(wanted.out),
               numbered_name("pose", ".bvh", i), numbered_name("frames", ".csv", i),
               numbered_name("summary", ".json", i));
  }
}

// How far a long replay is: a line on the terminal, and its speed at the end.
class Progress {
 public:
  void show(std::int64_t done, std::int64_t ticks) {
    ticks_ = ticks;
    const Clock::time_point now = Clock::now();
    if (now < next_) return;
    next_ = now + std::chrono::milliseconds(200);
    const double seconds = std::chrono::duration<double>(now - start_).count();
    line_.show(fmt::format("replay: {:.0f} % of {} ticks, {:.0f} ticks a second",
                           100.0 * static_cast<double>(done) / static_cast<double>(ticks), ticks,
                           static_cast<double>(done) / seconds));
  }
  void finish() {
    line_.clear();
    const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    if (seconds < 5.0) return;
    print_remarks(kCommand, {fmt::format("{} ticks in {:.1f} s, {:.0f} ticks a second", ticks_,
                                         seconds, static_cast<double>(ticks_) / seconds)});
  }

 private:
  using Clock = std::chrono::steady_clock;
  StatusLine line_{STDERR_FILENO};
  std::int64_t ticks_ = 0;
  Clock::time_point start_ = Clock::now(), next_ = start_ + std::chrono::seconds(1);
};

// The files and the summary.
int run_through(const ReplayArguments& arguments) {
  Progress progress;
  const auto result = replay(arguments.spec, [&progress](std::int64_t done, std::int64_t ticks) {
    progress.show(done, ticks);
  });
  progress.finish();
  if (!result) return fail(kCommand, result.error().message);
  print_remarks(kCommand, result->remarks);
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
  options.is_ended_from_outside = [&end] { return end.is_reached(); };
  const auto result = run_window(options);
  if (!result) return fail(kCommand, result.error().message);
  print_remarks(kCommand, result->remarks);
  return 0;
}
#else
int view(const ReplayArguments&) { return fail(kCommand, missing_window()); }
#endif

int run(ReplayArguments& arguments) {
  arguments.spec.replay.damage = arguments.is_lenient ? Damage::skip : Damage::refuse;
  if (!arguments.view) return run_through(arguments);
  const int status = view(arguments);
  const bool wants_result = !arguments.spec.replay.out.empty() || arguments.json;
  return status == 0 && wants_result ? run_through(arguments) : status;
}

}  // namespace

void add_replay(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("replay", "walks characters along a recorded stick");
  const auto arguments = std::make_shared<ReplayArguments>();
  SessionSpec::Replay& wanted = arguments->spec.replay;
  command->add_option("trace", wanted.trace, "the recording (.hid)")->required();
  auto* out =
      command->add_option("--out", wanted.out, "folder for pose.bvh, frames.csv and summary.json");
  command
      ->add_flag("--gltf", wanted.gltf,
                 "pose.glb too: binary glTF 2.0, joints, one animation and a plain body")
      ->needs(out);
  add_session_options(*command, arguments->spec, "the trace's, else 240");
  command
      ->add_option("--fps", wanted.fps,
                   "poses a second in pose.bvh and pose.glb (default: every tick)")
      ->check(CLI::Range(1, kMaxRateHz));
  command
      ->add_option("--crowd-files", wanted.crowd_files,
                   "of the crowd the first so many get files in --out, too (default: 32)")
      ->check(CLI::Range(0, kMaxCrowdFiles))
      ->needs(out);
  command->add_flag("--lenient", arguments->is_lenient, "skip damaged lines and count them");
  auto* in_window = command->add_flag("--view", arguments->view,
                                      "open the window: a time line to scrub, any speed");
  for (CLI::Option* option : add_window_options(*command, arguments->window))
    option->needs(in_window);
  command->add_flag("--json", arguments->json, "the summary, for machines");
  command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace gaitpad
