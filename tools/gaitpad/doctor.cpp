// gaitpad doctor: finds why a pad does not work, and the command that fixes it.
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "doctor/findings.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/install_rules.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"

namespace gaitpad {
namespace {

using nlohmann::ordered_json;

struct DoctorArguments {
  bool as_json = false, installs_rules = false, is_agreed = false;
};

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

void print_findings_json(const std::vector<Finding>& list) {
  ordered_json objects = ordered_json::array();
  for (const Finding& f : list) {
    objects.push_back({{"state", state_name(f.state)},
                       {"node", f.node},
                       {"device", f.device},
                       {"cause", f.cause},
                       {"fix", f.fix}});
  }
  print_json(objects);
}

void print_text(const std::vector<Finding>& list) {
  for (const Finding& f : list) {
    say("{:<8} {}{}{}{}\n", state_name(f.state), f.device.empty() ? "" : printable(f.device) + ": ",
        printable(f.cause), f.fix.empty() ? "" : "; fix: ", printable(f.fix));
  }
}

Result<Machine> look(const RulesFile& shipped) {
  const PadSelector any;
  auto files = pad_files("", "");
  if (!files) return files.error();
  auto sightings = pad_sightings(*files, any, Drivers::preferred);
  if (!sightings) return sightings.error();
  return look_at_machine(std::move(*sightings), files->overrides, shipped.text);
}

int diagnose(const DoctorArguments& arguments, const Machine& machine, const RulesFile& shipped) {
  const std::vector<Finding> list = findings(machine, shipped);
  if (arguments.as_json) {
    print_findings_json(list);
  } else {
    print_text(list);
  }
  const bool is_one_usable =
      std::ranges::any_of(list, [](const Finding& f) { return f.state == Finding::State::usable; });
  return is_one_usable ? 0 : 1;
}

int run(const DoctorArguments& arguments) {
  const auto shipped = shipped_rules(config_folders());
  if (!shipped) return fail("doctor", shipped.error().message);
  const auto machine = look(*shipped);
  if (!machine) return fail("doctor", machine.error().message);
  if (!arguments.installs_rules) return diagnose(arguments, *machine, *shipped);
  return install_rules("doctor", kPadRules, rules_text(*machine, *shipped), arguments.is_agreed,
                       install_command());
}

}  // namespace

void add_doctor(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("doctor", "finds why a pad does not work");
  const auto arguments = std::make_shared<DoctorArguments>();
  auto* json = command->add_flag("--json", arguments->as_json, "print a JSON list of objects");
  auto* install =
      command->add_flag("--install-rules", arguments->installs_rules,
                        "install udev rules that let ordinary users open pads; asks first");
  install->excludes(json);
  command->add_flag("--yes", arguments->is_agreed, "do not ask")->needs(install);
  command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace gaitpad
