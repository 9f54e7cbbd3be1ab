#include "tools/gaitpad/options.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "drivers/system_nodes.h"
#include "gaitpad/config_files.h"
#include "gaitpad/driver_registry.h"
#include "tools/gaitpad/print.h"

namespace gaitpad {
namespace {

constexpr double kLeastSeconds = 0.001, kMostSeconds = 1e6;
// Wait until a missing pad is reported; opening a pad may take two seconds.
constexpr std::int64_t kPatienceNs = 2'500'000'000;

// The names of the drivers for --driver. A driver without its library is left out, as is the driver
// of recordings, which are chosen by PAD.
std::vector<std::string> driver_names() {
  std::vector<std::string> names;
  for (const DriverEntry& entry : drivers()) {
    if (*entry.library != '\0') names.emplace_back(entry.name);
  }
  return names;
}

// The names of the pads that the system knows. The drivers are not asked, because another thread
// uses them.
std::vector<std::string> pads_of_system() {
  std::vector<std::string> pads;
  for (const SystemNode& node : system_nodes("input")) {
    if (!node.is_joystick || node.is_motion_sensor) continue;
    const std::string problem = access_problem(node.node);
    pads.push_back(fmt::format("{} ({:04x}:{:04x}, {}) {}", printable(node.name), node.vendor,
                               node.product, node.node,
                               problem.empty() ? "would be usable" : "is there: " + problem));
  }
  return pads;
}

}  // namespace

std::vector<std::string> config_folders() { return config_folders(GAITPAD_CONFIG_DIR); }

std::string config_problem() {
  const char* folder = std::getenv("GAITPAD_CONFIG");
  std::error_code ignored;
  if (folder == nullptr || *folder == '\0' || std::filesystem::is_directory(folder, ignored))
    return {};
  return fmt::format("GAITPAD_CONFIG is {}, which is no folder", in_quotes(folder));
}

bool is_choosy(const PadSelector& selector) {
  return !selector.pad.empty() || !selector.driver.empty();
}

void add_driver_option(CLI::App& command, PadSelector& selector) {
  command
      .add_option("--driver", selector.driver,
                  "use only this driver (usb takes the pad from the kernel while it is open)")
      ->check(CLI::IsMember(driver_names()));
}

void add_pad_options(CLI::App& command, PadSelector& selector) {
  command.add_option("PAD", selector.pad,
                     "device node, recording (.hid), vid:pid, unique id, or part of the pad's name "
                     "(default: the first usable pad)");
  add_driver_option(command, selector);
}

void add_seconds_option(CLI::App& command, double& seconds) {
  command.add_option("--seconds", seconds, "end after this time (default: at Ctrl-C)")
      ->check(CLI::Range(kLeastSeconds, kMostSeconds));
}

void add_max_hours_option(CLI::App& command, std::optional<double>& hours) {
  command
      .add_option("--max-hours", hours,
                  "refuse a recording that lasts longer (default: 12; 1 if damaged lines were "
                  "skipped)")
      ->check(CLI::PositiveNumber);
}

void add_user_styles_option(CLI::App& command, bool& user_styles) {
  command.add_flag(
      "--user-styles", user_styles,
      "let commands also name styles of your own folder, which other machines do not have");
}

Result<PadFiles> pad_files(const std::string& map, const std::string& calibration) {
  return load_pad_files(config_folders(), map, calibration);
}

void MissingPad::look(std::int64_t plugged, StatusLine& line) {
  if (now_ns() >= start_ns_ + kPatienceNs) tell(plugged, "is not there yet; waiting for it", line);
}

void MissingPad::finish(std::int64_t plugged, StatusLine& line) {
  tell(plugged, "was not there", line);
}

void MissingPad::tell(std::int64_t plugged, std::string_view what, StatusLine& line) {
  if (is_told_ || plugged > 0) return;
  is_told_ = true;
  std::vector<std::string> remarks = {
      fmt::format("{} {}", selector_.pad.empty() ? "the pad" : in_quotes(selector_.pad), what)};
  for (const std::string& other :
       is_choosy(selector_) ? pads_of_system() : std::vector<std::string>())
    remarks.push_back(other);
  remarks.emplace_back("gaitpad doctor finds why a pad does not work");
  print_remarks(command_, remarks, &line);
}

void add_pace_option(CLI::App& command, std::optional<Pace>& pace) {
  command
      .add_option_function<std::string>(
          "--pace", [&pace](const std::string& name) { pace = pace_named(name); },
          "scale speed and step length to the motion (own: reached at 0.8 forward) or to an adult "
          "(default: as the recording or the motion's description says, else own)")
      ->check(CLI::IsMember(kPaceNames));
}

void add_session_options(CLI::App& command, SessionSpec& spec, const std::string& default_rate) {
  SessionSpec::Walk& walk = spec.walk;
  spec.config_folders = config_folders();
  command.add_option("--motion", walk.motion,
                     "motion, FILE|NAME (.bvh, .amc, .toml; default: the built-in walk)");
  add_pace_option(command, walk.pace);
  command
      .add_option("--character", walk.characters,
                  "body of a character, FILE|NAME; repeat it for more characters")
      ->allow_extra_args(false)  // one value for each --character: the word after it may be PAD
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      .add_option("--style", walk.styles,
                  "style of walking, FILE|NAME; the n-th is for the n-th character")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      .add_option(
          "--crowd", walk.crowd,
          "number of further characters behind the first, each with its own build and style")
      ->check(CLI::Range(0, kMaxFollowers));
  command.add_option("--terrain", walk.terrain, "ground, FILE|NAME (default: flat)");
  command.add_option("--script", walk.script, "FILE with commands and their times");
  command
      .add_option_function<std::string>(
          "--ik",
          [&walk](const std::string& mode) {
            walk.ik = mode == "paper" ? IkMode::paper : IkMode::robust;
          },
          "paper or robust")
      ->check(CLI::IsMember({"paper", "robust"}))
      ->default_str("robust");
  command
      .add_option_function<std::string>(
          "--stick",
          [&walk](const std::string& means) {
            walk.stick = means == "points" ? StickMeans::points : StickMeans::steers;
          },
          "meaning of the stick: steers (sideways turns the character) or points (walk in the "
          "stick's direction)")
      ->check(CLI::IsMember({"steers", "points"}))
      ->default_str("steers");
  command.add_option("--calibration", spec.pad.calibration, "calibration file of the stick");
  command.add_option("--map", spec.pad.map, "pad file that overrides config/pads");
  command
      .add_option("--rate", spec.rate_hz, fmt::format("ticks a second (default: {})", default_rate))
      ->check(CLI::Range(kLeastRateHz, kMaxRateHz));
}

std::string missing_window() {
  return "this program was built without its window and its pictures; build it with "
         "-DGAITPAD_WINDOW=ON";
}

std::string missing_bench() {
  return "this program was built without its benchmark; build it with -DGAITPAD_BENCH=ON";
}

void add_missing_command(CLI::App& app, int& status, const std::string& name,
                         const std::string& description, const std::string& sentence) {
  CLI::App* command = app.add_subcommand(name, description);
  command->allow_extras();
  command->callback([&status, name, sentence] { status = fail(name, sentence); });
}

}  // namespace gaitpad
