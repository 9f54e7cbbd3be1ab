// gaitpad replay TRACE: a recorded stick walks characters; files and a summary come out.
#include "session/replay.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>

#include "session/config_files.h"
#include "session/walk_export.h"
#include "tools/gaitpad/commands.h"

namespace gaitpad {
namespace {

struct ReplayArguments {
  ReplayOptions options;
  std::string ik = "robust";
  bool json = false, lenient = false, view = false;
  int rate_hz = 0, fps = 0;  // 0: not given
};

int fail(const std::string& sentence) {
  fmt::print(stderr, "gaitpad replay: {}\n", sentence);
  return 1;
}

void print_json(const ReplayResult& result) {
  const auto& list = result.summaries;
  fmt::print("{}\n", (list.size() == 1 ? list[0] : nlohmann::ordered_json(list)).dump(2));
}

void print_text(const ReplayArguments& arguments, const ReplayResult& result) {
  const auto& first = result.summaries.front();
  const double ticks = first["ticks"].get<double>();
  fmt::print("{}: {} reports, {} ticks at {} Hz ({:.1f} s), pose hash {}\n",
             arguments.options.trace, first["reports"].get<long>(), first["ticks"].get<long>(),
             first["rate_hz"].get<int>(), ticks / first["rate_hz"].get<double>(),
             first["pose_hash"].get<std::string>());
  for (std::size_t i = 0; i < result.summaries.size(); ++i) {
    const auto& s = result.summaries[i];
    fmt::print(
        "character {}: {}, style {} at the end, leg {:.3f} m: {:.1f} m in {} steps, {} IK "
        "failures\n",
        i + 1, s["motion"].get<std::string>(), s["style"].get<std::string>(),
        s["leg_length_m"].get<double>(), result.distance_m[i],
        s["steps_left"].get<int>() + s["steps_right"].get<int>(), s["ik_failures"].get<long>());
    if (arguments.options.out.empty()) continue;
    fmt::print("  {0}/{1}  {0}/{2}  {0}/{3}\n", arguments.options.out,
               numbered_name("pose", ".bvh", i), numbered_name("frames", ".csv", i),
               numbered_name("summary", ".json", i));
  }
}

int run(ReplayArguments& arguments) {
  if (arguments.view) return fail("--view: the window comes with a later version");
  ReplayOptions& options = arguments.options;
  options.session.ik = arguments.ik == "paper" ? IkMode::paper : IkMode::robust;
  options.session.config_folders = config_folders(GAITPAD_CONFIG_DIR);
  options.damage = arguments.lenient ? Damage::skip : Damage::refuse;
  if (arguments.rate_hz > 0) options.rate_hz = arguments.rate_hz;
  if (arguments.fps > 0) options.fps = arguments.fps;
  const auto result = replay(options);
  if (!result) return fail(result.error().message);
  for (const std::string& remark : result->remarks)
    fmt::print(stderr, "gaitpad replay: {}\n", remark);
  if (arguments.json) {
    print_json(*result);
  } else {
    print_text(arguments, *result);
  }
  return 0;
}

}  // namespace

void add_replay(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("replay", "walks characters along a recorded stick");
  const auto arguments = std::make_shared<ReplayArguments>();
  ReplayOptions& options = arguments->options;
  SessionOptions& session = options.session;
  command->add_option("trace", options.trace, "the recording (.hid)")->required();
  command->add_option("--out", options.out, "folder for pose.bvh, frames.csv and summary.json");
  command->add_option("--motion", session.motion, "motion file; without it the built-in walk");
  command->add_option("--character", session.characters, "FILE|NAME, once for each")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("--style", session.styles, "FILE|NAME, the n-th for the n-th character")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("--terrain", session.terrain, "FILE|NAME; only flat so far");
  command->add_option("--ik", arguments->ik, "paper or robust")
      ->check(CLI::IsMember({"paper", "robust"}))
      ->capture_default_str();
  command->add_option("--calibration", session.calibration, "calibration file of the stick");
  command->add_option("--map", session.map, "pad file that overrides config/pads");
  command
      ->add_option("--rate", arguments->rate_hz, "ticks a second (default: the trace's, else 240)")
      ->check(CLI::Range(1, kMaxRateHz));
  command->add_option("--fps", arguments->fps, "poses a second in pose.bvh (default: every tick)")
      ->check(CLI::Range(1, kMaxRateHz));
  command->add_flag("--lenient", arguments->lenient, "skip damaged lines and count them");
  command->add_flag("--view", arguments->view, "open the window (comes later)");
  command->add_flag("--json", arguments->json, "the summary, for machines");
  command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace gaitpad
