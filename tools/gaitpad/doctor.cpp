// gaitpad doctor: why a pad does not work, and the command that mends it.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/doctor_findings.h"
#include "tools/gaitpad/pad_options.h"
#include "tools/gaitpad/report_print.h"

namespace gaitpad {
namespace {

using nlohmann::ordered_json;

struct DoctorArguments {
  bool as_json = false, installs_rules = false, is_agreed = false;
};

int fail(const std::string& sentence) {
  fmt::print(stderr, "gaitpad doctor: {}\n", sentence);
  return 1;
}

const char* state_name(Finding::State state) {
  switch (state) {
    case Finding::State::usable:
      return "usable";
    case Finding::State::problem:
      return "problem";
    case Finding::State::note:
      return "note";
  }
  return "";
}

void print_json(const std::vector<Finding>& list) {
  ordered_json objects = ordered_json::array();
  for (const Finding& f : list) {
    objects.push_back({{"state", state_name(f.state)},
                       {"node", f.node},
                       {"device", f.device},
                       {"cause", f.cause},
                       {"fix", f.fix}});
  }
  fmt::print("{}\n", objects.dump(2, ' ', false, ordered_json::error_handler_t::replace));
}

void print_text(const std::vector<Finding>& list) {
  for (const Finding& f : list) {
    fmt::print("{:<8} {}{}{}{}\n", state_name(f.state),
               f.device.empty() ? "" : printable(f.device) + ": ", printable(f.cause),
               f.fix.empty() ? "" : "; fix: ", f.fix);
  }
}

Result<Machine> look(const RulesFile& shipped) {
  const PadWish any;
  auto files = pad_files("", "");
  if (!files) return files.error();
  auto sightings = pad_sightings(*files, any, Drivers::preferred);
  if (!sightings) return sightings.error();
  return look_at_machine(std::move(*sightings), files->overrides, shipped.text);
}

int diagnose(const DoctorArguments& arguments, const Machine& machine, const RulesFile& shipped) {
  const std::vector<Finding> list = findings(machine, shipped);
  if (arguments.as_json) {
    print_json(list);
  } else {
    print_text(list);
  }
  const bool is_one_usable =
      std::ranges::any_of(list, [](const Finding& f) { return f.state == Finding::State::usable; });
  return is_one_usable ? 0 : 1;
}

// The shipped rules, and a line for each plugged pad that they do not know.
std::string rules_text(const Machine& machine, const RulesFile& shipped) {
  std::string text = shipped.text;
  const std::vector<RuleSubject> others = uncovered_pads(machine, shipped);
  if (!others.empty()) text += "\n# Plugged in when this was installed\n";
  for (const RuleSubject& subject : others)
    text += hidraw_rule(subject) + "\n" + usb_rule(subject) + "\n";
  return text;
}

bool is_agreed(const DoctorArguments& arguments) {
  if (arguments.is_agreed) return true;
  fmt::print(stderr, "Write this to {} and let udev apply it? [y/N] ", kRulesTarget);
  std::string answer;
  std::getline(std::cin, answer);
  return answer == "y" || answer == "Y" || answer == "yes";
}

int install(const DoctorArguments& arguments, const Machine& machine, const RulesFile& shipped) {
  const std::string text = rules_text(machine, shipped);
  fmt::print("{}", text);
  std::fflush(stdout);
  if (::geteuid() != 0)
    return fail(fmt::format("{} needs root: {}", kRulesTarget, install_command()));
  if (!is_agreed(arguments)) return fail("nothing was changed");
  if (const auto problem = install_rules(text)) return fail(problem->message);
  fmt::print(stderr, "gaitpad doctor: {} is installed and applied\n", kRulesTarget);
  return 0;
}

int run(const DoctorArguments& arguments) {
  const auto shipped = shipped_rules();
  if (!shipped) return fail(shipped.error().message);
  const auto machine = look(*shipped);
  if (!machine) return fail(machine.error().message);
  return arguments.installs_rules ? install(arguments, *machine, *shipped)
                                  : diagnose(arguments, *machine, *shipped);
}

}  // namespace

void add_doctor(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("doctor", "finds why a pad does not work");
  const auto arguments = std::make_shared<DoctorArguments>();
  auto* json = command->add_flag("--json", arguments->as_json, "a list of objects");
  auto* install = command->add_flag("--install-rules", arguments->installs_rules,
                                    "let ordinary users use pads (udev rules); asks first");
  install->excludes(json);
  command->add_flag("--yes", arguments->is_agreed, "answers yes")->needs(install);
  command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace gaitpad
