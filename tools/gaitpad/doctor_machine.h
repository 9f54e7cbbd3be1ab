// What doctor looks at: what the machine shows of pads, whether or not a driver can open them, and
// the udev rules that let ordinary users open them. Looking reads sysfs, /dev and /proc and changes
// nothing.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/system_nodes.h"
#include "drivers/usb_interfaces.h"
#include "gaitpad/pad_overrides.h"
#include "gaitpad/pad_stream.h"
#include "gaitpad/result.h"

namespace gaitpad {

// One pad with all its nodes.
struct PadHardware {
  std::string path;  // DeviceListing::pad_path
  std::string name;
  BusType bus = BusType::unknown;
  std::uint16_t vendor = 0, product = 0;
  std::vector<SystemNode> hidraw, events;
  std::optional<UsbInterface> interface;  // of a pad on USB
  std::string usb_node;                   // of its USB device
};

struct Machine {
  std::vector<PadHardware> pads;
  std::vector<SystemNode> usb_devices;  // all but hubs
  std::vector<PadSighting> sightings;   // of the drivers
  bool has_udev = false;                // udevd runs
  bool is_container = false;
};

// `rules`: the shipped ones. A device that they name is a pad even if nothing could be read of it.
Machine look_at_machine(std::vector<PadSighting> sightings, const PadOverrides& overrides,
                        const std::string& rules);

// The other programs that have the node open, as far as this user may see: `steam (1234), ...`.
std::string users_of(const std::string& node);
std::string own_user_name();

// --- the rules of config/udev

struct RulesTarget {
  const char* path;
  // Makes udev read its rules again and apply them to the devices that are plugged in.
  const char* apply;
};
// Who may use pads (60-gaitpad.rules), and who may make virtual ones (60-gaitpad-uinput.rules).
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
  std::optional<int> interface;  // of a USB device: its number
  bool operator==(const RuleSubject&) const = default;
};

struct RulesFile {
  std::string path, text;
};
Result<RulesFile> shipped_rules(const RulesTarget& target = kPadRules);
// The rules file for pads that udev reads: the one in the first of its folders that has it.
std::optional<RulesFile> installed_rules();

// Whether a line for hidraw nodes fits the device.
bool opens_hidraw(std::string_view rules, const RuleSubject& subject);
// The lines for this model: for the hidraw node of its interface, for its USB device.
std::string hidraw_rule(const RuleSubject& subject);
std::string usb_rule(const RuleSubject& subject);

// How a user starts this program: by its name if the shell finds it, else by its path.
std::string program();
// Commands that do what `doctor --install-rules` does.
std::string install_command();                               // by this program
std::string manual_install_command(const RulesFile& rules);  // without it

// Prints the text, asks unless the user has agreed already, replaces the target in one step and
// makes udev apply it. The exit status. `as_root`: the command that the user has to give as root.
int install_rules(std::string_view command, const RulesTarget& target, const std::string& text,
                  bool is_agreed, const std::string& as_root);

}  // namespace gaitpad
