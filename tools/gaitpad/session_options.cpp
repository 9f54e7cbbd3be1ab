#include "tools/gaitpad/session_options.h"

#include <fmt/format.h>

#include "gaitpad/config_files.h"

namespace gaitpad {

void add_session_options(CLI::App& command, SessionArguments& arguments,
                         const std::string& default_rate) {
  SessionOptions& session = arguments.options;
  command.add_option("--motion", session.motion,
                     "motion, FILE|NAME (.bvh, .amc, .toml); without it the built-in walk");
  command
      .add_option("--character", session.characters, "a build, FILE|NAME; once for each character")
      ->allow_extra_args(false)  // what follows the next word may be PAD
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      .add_option("--style", session.styles,
                  "a way to walk, FILE|NAME; the n-th for the n-th character")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command.add_option("--terrain", session.terrain, "the ground, FILE|NAME; without it flat");
  command.add_option("--script", session.script, "commands at given times, FILE");
  command.add_option("--ik", arguments.ik, "paper or robust")
      ->check(CLI::IsMember({"paper", "robust"}))
      ->capture_default_str();
  command.add_option("--calibration", session.calibration, "calibration file of the stick");
  command.add_option("--map", session.map, "pad file that overrides config/pads");
  command
      .add_option("--rate", arguments.rate_hz,
                  fmt::format("ticks a second (default: {})", default_rate))
      ->check(CLI::Range(1, kMaxRateHz));
}

SessionOptions session_options(const SessionArguments& arguments) {
  SessionOptions options = arguments.options;
  options.ik = arguments.ik == "paper" ? IkMode::paper : IkMode::robust;
  options.config_folders = config_folders(GAITPAD_CONFIG_DIR);
  return options;
}

void print_summaries_json(const std::vector<nlohmann::ordered_json>& summaries) {
  const nlohmann::ordered_json shown =
      summaries.size() == 1 ? summaries[0] : nlohmann::ordered_json(summaries);
  fmt::print("{}\n", shown.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void print_session(const std::string& source, const nlohmann::ordered_json& first) {
  const double ticks = first["ticks"].get<double>();
  fmt::print("{}: {} reports, {} ticks at {} Hz ({:.1f} s), pose hash {}\n", source,
             first["reports"].get<long>(), first["ticks"].get<long>(), first["rate_hz"].get<int>(),
             ticks / first["rate_hz"].get<double>(), first["pose_hash"].get<std::string>());
}

void print_character(std::size_t index, const nlohmann::ordered_json& summary, double distance_m) {
  const auto& s = summary;
  const std::string way = distance_m < 0.0 ? "" : fmt::format("{:.1f} m in ", distance_m);
  fmt::print("character {}: {}, style {} at the end, leg {:.3f} m: {}{} steps, {} IK failures\n",
             index + 1, s["motion"].get<std::string>(), s["style"].get<std::string>(),
             s["leg_length_m"].get<double>(), way,
             s["steps_left"].get<int>() + s["steps_right"].get<int>(),
             s["ik_failures"].get<long>());
}

}  // namespace gaitpad
