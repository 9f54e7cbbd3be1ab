// Installs udev rules: doctor and forward.
#pragma once
#include <string>
#include <string_view>

#include "doctor/udev_rules.h"

namespace gaitpad {

// Prints the text, asks unless the user has agreed already, replaces the target in one step and
// makes udev apply it. The exit status. `as_root`: the command that the user has to give as root.
int install_rules(std::string_view command, const RulesTarget& target, const std::string& text,
                  bool is_agreed, const std::string& as_root);

}  // namespace gaitpad
