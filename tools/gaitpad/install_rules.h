// Installs udev rules, for doctor and forward.
#pragma once
#include <string>
#include <string_view>

#include "doctor/udev_rules.h"

namespace gaitpad {

// Prints the text, asks unless the user has already agreed, replaces the target atomically and
// makes udev apply it. Returns the exit status. `as_root`: the command for the user to run as root.
int install_rules(std::string_view command, const RulesTarget& target, const std::string& text,
                  bool is_agreed, const std::string& as_root);

}  // namespace gaitpad
