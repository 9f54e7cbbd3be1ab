// The udev rules that let ordinary users open pads: their lines, the devices that they open, and
// the commands that install them.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/result.h"

namespace gaitpad {

struct RulesTarget {
  const char* path;
  // Makes udev read its rules again and apply them to the devices that are plugged in.
  const char* apply;
};
// Rules for access to pads (60-gaitpad.rules) and for virtual pads (60-gaitpad-uinput.rules).
inline constexpr RulesTarget kPadRules = {
    "/etc/udev/rules.d/60-gaitpad.rules",
    "udevadm control --reload && udevadm trigger --subsystem-match=hidraw --subsystem-match=input "
    "--subsystem-match=usb"};
inline constexpr RulesTarget kUinputRules = {
    "/etc/udev/rules.d/60-gaitpad-uinput.rules",
    "udevadm control --reload && udevadm trigger --subsystem-match=misc --sysname-match=uinput"};

// A device as a rule sees it.
struct RuleSubject {
  std::uint16_t bus = 0, vendor = 0, product = 0;
  std::optional<int> interface;  // number of the USB interface; none: not on USB
  bool operator==(const RuleSubject&) const = default;
};

struct RulesFile {
  std::string path, text;
};
// Reads udev/60-gaitpad.rules, or the target's file, from the first of the folders that has it.
Result<RulesFile> shipped_rules(const std::vector<std::string>& config_folders,
                                const RulesTarget& target = kPadRules);
// The rules file for pads in the first of udev's folders that has it.
std::optional<RulesFile> installed_rules();

// True if a line for hidraw nodes matches the device.
bool opens_hidraw(std::string_view rules, const RuleSubject& subject);
// Lines for this model: for the hidraw node of its interface, for its USB device.
std::string hidraw_rule(const RuleSubject& subject);
std::string usb_rule(const RuleSubject& subject);

// Command that starts this program: its name if the shell finds it, else its path.
std::string program();
// Commands with the effect of `doctor --install-rules`.
std::string install_command();                               // Runs this program.
std::string manual_install_command(const RulesFile& rules);  // Works without this program.

}  // namespace gaitpad
