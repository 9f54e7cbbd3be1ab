// gaitpad replay TRACE...: recorded sticks walk characters; writes files and summaries, or shows
// the walk of one on a time line in a window.
#include "gaitpad/replay.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "session/walk_export.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"
#include "tools/gaitpad/replay_to.h"
#include "tools/gaitpad/window_options.h"

namespace gaitpad {
namespace fs = std::filesystem;
namespace {

// Most members of a crowd that get files; each opens three.
constexpr int kMaxCrowdFiles = 256;
// The speed of a replay is printed if the replay took longer than this.
constexpr double kLong_s = 5.0;

struct ReplayArguments {
  SessionSpec spec;  // of every recording; its trace is set for one
  std::vector<std::string> traces;
  WindowArguments window;
  ReplayTo to;
  bool json = false, is_lenient = false, view = false;
};

// Name of a recording's folder in --out if there are several: `walk` for walks/walk.hid.
std::string folder_name(const std::string& trace) {
  const fs::path file = fs::path(trace).filename();
  const std::string name = file.stem().string();
  return name == "." || name == ".." ? file.string() : name;
}

// Why these arguments do not fit several recordings; empty: they do.
std::string problem_of_several(const ReplayArguments& arguments) {
  const std::vector<std::string>& traces = arguments.traces;
  const auto for_one = [&traces](std::string_view option) {
    return fmt::format("{} takes one recording, and {} are given", option, traces.size());
  };
  if (arguments.view) return for_one("--view");
  if (!arguments.to.target.empty()) return for_one("--to");
  const std::string& out = arguments.spec.replay.out;
  if (out.empty()) return {};
  std::map<std::string, std::string> by_name;
  for (const std::string& trace : traces) {
    const auto [first, is_new] = by_name.emplace(folder_name(trace), trace);
    if (is_new) continue;
    return fmt::format("{} and {} would both be written to {}; rename one, or replay them apart",
                       first->second, trace, (fs::path(out) / first->first).string());
  }
  return {};
}

// The session of the i-th recording.
SessionSpec session_of(const ReplayArguments& arguments, std::size_t i) {
  SessionSpec spec = arguments.spec;
  std::string& out = spec.replay.out;
  spec.replay.trace = arguments.traces[i];
  if (arguments.traces.size() > 1 && !out.empty())
    out = (fs::path(out) / folder_name(spec.replay.trace)).string();
  return spec;
}

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

// The results for --json: of one recording its summaries, of several a list that names each.
class JsonResults {
 public:
  void add(const std::string& trace, const RunSummary& run) {
    std::vector<nlohmann::ordered_json> summaries;
    for (std::size_t i = 0; i < run.walkers.size(); ++i) summaries.push_back(summary_json(run, i));
    results_.push_back({{"trace", trace}, {"summary", one_or_list(summaries)}});
  }
  void add(const std::string& trace, const Error& error) {
    results_.push_back({{"trace", trace}, {"error", error.message}});
  }
  void print(bool is_one) const {
    if (!is_one) return print_json(results_);
    // Empty: it was interrupted before its first recording began.
    if (!results_.empty() && results_[0].contains("summary")) print_json(results_[0]["summary"]);
  }

 private:
  nlohmann::ordered_json results_ = nlohmann::ordered_json::array();
};

// Writes the files and the summaries. A recording that cannot be replayed is told and left out.
int run_through(const ReplayArguments& arguments) {
  const std::size_t count = arguments.traces.size();
  RunEnd end;
  Progress progress(kReplayCommand);
  Replayer replayer;
  JsonResults json;
  std::set<std::string> told;
  std::size_t replayed = 0;
  std::int64_t all_ticks = 0;
  for (std::size_t i = 0; i < count && end.cut_off_status() == 0; ++i) {
    const SessionSpec spec = session_of(arguments, i);
    const std::string& trace = spec.replay.trace;
    auto result = replayer.replay(spec, [&](std::int64_t done, std::int64_t ticks) {
      const double share = static_cast<double>(done) / static_cast<double>(ticks);
      progress.show((static_cast<double>(i) + share) / static_cast<double>(count));
      return !end.is_reached();
    });
    progress.clear();
    if (!result) {
      json.add(trace, result.error());
      // A file of all sessions that cannot be read is one mistake.
      const std::string& sentence = result.error().message;
      if (told.insert(sentence).second) fail(kReplayCommand, sentence);
      continue;
    }
    ++replayed;
    all_ticks += result->summary.ticks;
    for (std::string& remark : result->remarks) {
      if (count > 1 && !remark.starts_with(trace)) remark.insert(0, trace + ": ");
    }
    print_remarks(kReplayCommand, result->remarks);
    json.add(trace, result->summary);
    if (arguments.json) continue;
    print_text(spec.replay, result->summary);
    std::fflush(stdout);
  }
  if (const double seconds = progress.seconds(); replayed > 0 && seconds >= kLong_s) {
    const auto ticks = static_cast<double>(all_ticks);
    print_remarks(kReplayCommand, {fmt::format("{:.0f} ticks in {:.1f} s, {:.0f} ticks a second",
                                               ticks, seconds, ticks / seconds)});
  }
  if (arguments.json) json.print(count == 1);
  std::fflush(stdout);
  if (replayed == count) return 0;
  if (count > 1) {
    fail(kReplayCommand,
         fmt::format("{} of {} recordings were not replayed", count - replayed, count));
  }
  return end.cut_off_status() != 0 ? end.cut_off_status() : 1;
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
  if (arguments.traces.size() > 1) {
    if (const std::string problem = problem_of_several(arguments); !problem.empty())
      return fail(kReplayCommand, problem), kWrongUsage;
    return run_through(arguments);
  }
  arguments.spec.replay.trace = arguments.traces.front();
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
  command->add_option("trace", arguments->traces, "recordings (.hid)")->required();
  auto* out = command->add_option("--out", wanted.out,
                                  "folder for pose.bvh, frames.csv and summary.json, of several "
                                  "recordings for a folder NAME of each NAME.hid");
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
