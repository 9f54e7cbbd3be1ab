// config/udev/60-gaitpad.rules: what it opens, whether it is installed, installing it.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/result.h"

namespace gaitpad {

inline constexpr const char* kRulesTarget = "/etc/udev/rules.d/60-gaitpad.rules";
// Lets udev read its rules again and apply them to what is plugged in.
inline constexpr const char* kApplyRules =
    "udevadm control --reload && udevadm trigger --subsystem-match=hidraw --subsystem-match=input "
    "--subsystem-match=usb";

// A device of the system as a rule sees it.
struct RuleSubject {
  std::uint16_t bus = 0, vendor = 0, product = 0;
  bool operator==(const RuleSubject&) const = default;
};

struct RulesFile {
  std::string path, text;
};
Result<RulesFile> shipped_rules();
// The file of that name that udev reads: the first of its folders that has one.
std::optional<RulesFile> installed_rules();

// Whether a line for hidraw nodes fits the device.
bool opens_hidraw(std::string_view rules, const RuleSubject& subject);
// The lines for exactly this model: its hidraw node, its USB device.
std::string hidraw_rule(const RuleSubject& subject);
std::string usb_rule(const RuleSubject& subject);

// The commands that do what `--install-rules` does.
std::string install_command();                               // by this program
std::string manual_install_command(const RulesFile& rules);  // without it

// Writes the text to kRulesTarget, at once or not at all, and lets udev apply it.
std::optional<Error> install_rules(const std::string& text);

}  // namespace gaitpad
