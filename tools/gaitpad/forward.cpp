// gaitpad forward [PAD]: gives other programs the calibrated pad instead of the real one.
//
// One thread sleeps in poll() on the pad's event node, the virtual pad, udev's monitor and the
// signals. A timer runs only while the calibration filters jumps, or while a present pad cannot be
// grabbed.
#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/text.h"
#include "doctor/user_unit.h"
#include "drivers/system_nodes.h"
#include "gaitpad/config_files.h"
#include "gaitpad/pad_stream.h"
#include "pads/stand_in.h"
#include "system/whole_file.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/install_rules.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"

namespace gaitpad {
namespace {

namespace fs = std::filesystem;

constexpr const char* kForwardCommand = "forward";
constexpr const char* kUnit = "gaitpad-forward.service";
constexpr int kForever_ms = -1, kRetry_ms = 1000;

struct ForwardArguments {
  std::string pad, as, map, calibration;
  bool installs_unit = false, installs_rules = false, is_agreed = false;
};

// --- the pad that is forwarded

class Forward {
 public:
  Forward(const ForwardArguments& arguments, PadFiles files)
      : selector_{arguments.pad, "evdev"},
        files_(files),
        stand_in_({.look = arguments.as.empty() ? StandIn::Look::own : StandIn::Look::xbox_360,
                   .files = std::move(files)}) {}

  // Runs until a signal ends it. Error: the search for pads failed.
  std::optional<Error> run(RunEnd& end, HotplugMonitor& changes);

 private:
  enum class Found { nothing, taken, refused };
  Result<Found> look_for_the_pad();
  // Prints a sentence once, though a retry repeats it.
  void tell(const std::string& sentence) {
    if (told_.insert(sentence).second) print_remarks(kForwardCommand, {sentence});
  }

  const PadSelector selector_;
  const PadFiles files_;
  StandIn stand_in_;
  std::set<std::string> told_;
  bool is_first_look_ = true;  // at the first look a name that fits several pads is an error
};

// Takes the first pad that matches and can be grabbed.
Result<Forward::Found> Forward::look_for_the_pad() {
  const auto sightings = pad_sightings(files_, selector_, Drivers::preferred);
  if (!sightings) return sightings.error();
  auto pads = matching_pads(*sightings, selector_);
  if (!pads && std::exchange(is_first_look_, false)) return pads.error();
  is_first_look_ = false;
  if (!pads) {
    tell(pads.error().message);
    return Found::refused;
  }
  Found found = Found::nothing;
  for (const PadSighting& pad : *pads) {
    if (!pad.is_pad) continue;
    found = Found::refused;
    std::string problem = pad.problem;
    if (problem.empty()) {
      const auto refusal = stand_in_.plug(pad.listing);
      if (!refusal) {
        told_.clear();
        print_remarks(kForwardCommand, stand_in_.take_remarks());
        print_remarks(kForwardCommand,
                      {fmt::format("{} ({}) is {} to other programs", pad.listing.info.name,
                                   pad.listing.node, stand_in_.node())});
        return Found::taken;
      }
      problem = refusal->message;
    }
    for (const std::string& remark : stand_in_.take_remarks()) tell(remark);
    tell(problem);
  }
  if (found == Found::nothing)
    tell(selector_.pad.empty() ? "no pad is there; waiting for one"
                               : in_quotes(selector_.pad) + " is not there; waiting for it");
  return found;
}

std::optional<Error> Forward::run(RunEnd& end, HotplugMonitor& changes) {
  bool looks = true;
  while (true) {
    int patience_ms = kForever_ms;
    if (!stand_in_.has_pad() && std::exchange(looks, false)) {
      const auto found = look_for_the_pad();
      if (!found) return found.error();
      if (*found == Found::refused) patience_ms = kRetry_ms;
    }
    std::vector<pollfd> fds = stand_in_.poll_fds();
    fds.insert(fds.begin(), {end.fd(), {changes.fd(), POLLIN, 0}});
    const bool had_pad = stand_in_.has_pad();
    const int ready = ::poll(fds.data(), fds.size(), patience_ms);
    stand_in_.serve();
    if (ready > 0 && fds[0].revents != 0 && end.is_reached()) return std::nullopt;
    const bool has_changed = ready > 0 && fds[1].revents != 0 && changes.has_changed();
    if (stand_in_.has_pad()) continue;
    looks = has_changed || had_pad || ready == 0;
    if (had_pad) print_remarks(kForwardCommand, stand_in_.take_remarks());
  }
}

// --- as a user's service

// The arguments of `gaitpad` for a unit: they have the same effect in any current folder.
std::vector<std::string> unit_arguments(const ForwardArguments& arguments) {
  std::vector<std::string> words = {kForwardCommand};
  if (!arguments.pad.empty()) words.push_back(arguments.pad);
  if (!arguments.as.empty()) words.insert(words.end(), {"--as", arguments.as});
  if (!arguments.map.empty())
    words.insert(words.end(), {"--map", fs::absolute(arguments.map).string()});
  if (!arguments.calibration.empty())
    words.insert(words.end(), {"--calibration", fs::absolute(arguments.calibration).string()});
  return words;
}

std::string rules_command() { return fmt::format("sudo {} forward --install-rules", program()); }

int install_unit(const ForwardArguments& arguments) {
  const std::string folder = user_config_folder();
  if (folder.empty())
    return fail(kForwardCommand, "neither XDG_CONFIG_HOME nor HOME names a folder for the unit");
  const std::string path = (fs::path(folder).parent_path() / "systemd/user" / kUnit).string();
  if (const auto problem = write_file(path, user_unit_text(unit_arguments(arguments))))
    return fail(kForwardCommand, problem->message);
  say("{} is written. It runs as you, without root. Start it, now and at each login:\n"
      "  systemctl --user daemon-reload && systemctl --user enable --now {}\n",
      printable(path), kUnit);
  if (!access_problem("/dev/uinput").empty())
    say("Before that, let yourself make virtual pads (once, as root):\n  {}\n", rules_command());
  return 0;
}

// --- the command

int run(const ForwardArguments& arguments) {
  if (arguments.installs_rules) {
    const auto shipped = shipped_rules(config_folders(), kUinputRules);
    if (!shipped) return fail(kForwardCommand, shipped.error().message);
    return install_rules(kForwardCommand, kUinputRules, shipped->text, arguments.is_agreed,
                         rules_command());
  }
  if (is_recording(arguments.pad))
    return fail(kForwardCommand, printable(arguments.pad) +
                                     ": is a recording; gaitpad replay --to uinput plays one");
  auto files = pad_files(arguments.map, arguments.calibration);
  if (!files) return fail(kForwardCommand, files.error().message);
  if (arguments.installs_unit) return install_unit(arguments);
  RunEnd end;
  auto changes = HotplugMonitor::create();
  if (!changes) return fail(kForwardCommand, changes.error().message);
  const auto problem = Forward(arguments, std::move(*files)).run(end, *changes);
  return problem ? fail(kForwardCommand, problem->message) : 0;
}

}  // namespace

void add_forward(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "forward", "gives other programs a calibrated pad in place of the real one");
  const auto arguments = std::make_shared<ForwardArguments>();
  command->add_option(
      "PAD", arguments->pad,
      "event node, vid:pid, unique id, or part of the pad's name (default: the first usable pad)");
  command
      ->add_option("--as", arguments->as,
                   "pad that programs see (default: the pad's own name, ids and controls)")
      ->check(CLI::IsMember({"xbox360"}));
  command->add_option("--calibration", arguments->calibration, "calibration file of the stick");
  command->add_option("--map", arguments->map, "pad file that overrides config/pads");
  auto* unit = command->add_flag("--install", arguments->installs_unit,
                                 "write a systemd user unit that runs this command, and end");
  auto* rules = command->add_flag("--install-rules", arguments->installs_rules,
                                  "install a udev rule that lets ordinary users make virtual pads "
                                  "(/dev/uinput), and end; asks first");
  rules->excludes(unit);
  command->add_flag("--yes", arguments->is_agreed, "do not ask")->needs(rules);
  command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace gaitpad
