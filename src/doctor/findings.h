// Why a pad does not work, and the command that mends it.
#pragma once
#include <string>
#include <vector>

#include "doctor/machine.h"
#include "doctor/udev_rules.h"

namespace gaitpad {

struct Finding {
  enum class State { usable, problem, note };
  State state = State::note;
  std::string node;    // or another name for it: a sysfs device, udev
  std::string device;  // the name of the pad; empty: none
  std::string cause;
  std::string fix;  // a command, or what to do; empty: nothing
};

// Usable pads first, then problems, then notes. `shipped`: the rules file of config/.
std::vector<Finding> findings(const Machine& machine, const RulesFile& shipped);

// The shipped rules, and lines for each pad that is plugged in and that they do not name, none of a
// keyboard.
std::string rules_text(const Machine& machine, const RulesFile& shipped);

}  // namespace gaitpad
