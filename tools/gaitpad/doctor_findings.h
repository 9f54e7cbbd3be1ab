// What is wrong with which pad, why, and the command that mends it.
#pragma once
#include <string>
#include <vector>

#include "tools/gaitpad/doctor_look.h"
#include "tools/gaitpad/udev_rules.h"

namespace gaitpad {

struct Finding {
  enum class State { usable, problem, note };
  State state = State::note;
  std::string node;    // or what stands for it: a sysfs device, udev
  std::string device;  // the pad's name, empty: none
  std::string cause;
  std::string fix;  // a command or what to do; empty: nothing
};

// Usable pads first, then problems, then notes. `shipped`: the rules file.
std::vector<Finding> findings(const Machine& machine, const RulesFile& shipped);

// Pads that are plugged in and that the shipped rules do not know.
std::vector<RuleSubject> uncovered_pads(const Machine& machine, const RulesFile& shipped);

}  // namespace gaitpad
