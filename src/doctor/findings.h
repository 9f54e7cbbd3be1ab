// Finds the reasons why a pad does not work, and the commands that fix them.
#pragma once
#include <string>
#include <vector>

#include "doctor/machine.h"
#include "doctor/udev_rules.h"

namespace gaitpad {

struct Finding {
  enum class State { usable, problem, note };
  State state = State::note;
  std::string node;    // what the finding is about: a node, a sysfs device, or udev
  std::string device;  // the name of the pad; empty: none
  std::string cause;
  std::string fix;  // a command or advice; empty: none
};

// Usable pads first, then problems, then notes. `shipped`: the rules file of config/.
std::vector<Finding> findings(const Machine& machine, const RulesFile& shipped);

// The shipped rules, with lines for each plugged-in pad that they do not name, without parts of a
// keyboard.
std::string rules_text(const Machine& machine, const RulesFile& shipped);

}  // namespace gaitpad
