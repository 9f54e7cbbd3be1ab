#include "tools/gaitpad/doctor_machine.h"

#include <errno.h>
#include <fmt/format.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>

#include "base/files.h"
#include "base/text.h"
#include "gaitpad/config_files.h"
#include "gaitpad/decode.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"

namespace gaitpad {
namespace fs = std::filesystem;

// --- what the machine shows

namespace {

using PadsByPath = std::map<std::string, PadHardware>;

constexpr std::uint8_t kHubClass = 9;

PadHardware& pad_at(PadsByPath& pads, const std::string& path, const SystemNode& node) {
  PadHardware& pad = pads[path];
  pad.path = path;
  if (pad.vendor != 0 || pad.product != 0) return pad;
  pad.name = node.name;
  pad.bus = node.bus;
  pad.vendor = node.vendor;
  pad.product = node.product;
  return pad;
}

RuleSubject subject_of(const SystemNode& node) {
  return {static_cast<std::uint16_t>(node.bus), node.vendor, node.product, std::nullopt};
}

// By its descriptor, or by what config/pads says about it.
bool describes_pad(const SystemNode& node, const PadOverrides& overrides) {
  DeviceInfo info;
  info.bus = node.bus;
  info.vendor = node.vendor;
  info.product = node.product;
  info.driver = "hidraw";
  info.name = node.name;
  info.descriptor = node.descriptor;
  const auto layout = pad_layout(info, overrides);
  return layout && layout->is_pad;
}

// Whether a driver could read that the node is a pad. Without udev nothing else says so.
bool is_sighted(const std::vector<PadSighting>& sightings, const std::string& node) {
  return std::ranges::any_of(sightings, [&](const PadSighting& sighting) {
    return sighting.is_pad && sighting.listing.node == node &&
           !sighting.listing.info.descriptor.empty();
  });
}

void add_hidraw(const Machine& machine, const PadOverrides& overrides, PadsByPath& pads) {
  for (const SystemNode& node : system_nodes("hidraw")) {
    if (describes_pad(node, overrides) || is_sighted(machine.sightings, node.node))
      pad_at(pads, node.pad_path, node).hidraw.push_back(node);
  }
}

// Motion sensors and touchpads belong to their pad.
void add_events(const Machine& machine, PadsByPath& pads) {
  const std::vector<SystemNode> nodes = system_nodes("input");
  for (const SystemNode& node : nodes) {
    const bool is_part = node.is_motion_sensor || node.is_touchpad;
    if (!is_part && (node.is_joystick || is_sighted(machine.sightings, node.node)))
      pad_at(pads, node.pad_path, node);
  }
  for (const SystemNode& node : nodes) {
    if (auto pad = pads.find(node.pad_path); pad != pads.end()) pad->second.events.push_back(node);
  }
}

bool is_hub(const SystemNode& device) {
  return sysfs_hex(device.sysfs_path + "/bDeviceClass") == kHubClass;
}

bool has_pad_name(std::string_view device_name) {
  const std::string name = lower_case(device_name);
  return std::ranges::any_of(
      std::initializer_list<const char*>{"gamepad", "game pad", "joystick", "joypad"},
      [&](const char* word) { return name.find(word) != std::string::npos; });
}

// Pads of a vendor class by that class. A HID device that no HID driver serves by its name or ids,
// and any that is not even bound to usbhid: the kernel binds all but what a program took away.
bool looks_like_pad(const SystemNode& device, const UsbInterface& interface,
                    const std::string& rules) {
  if (interface.ids.interface_class != kHidClass) return may_be_pad(interface);
  if (!interface.hid_driver.empty() || !boot_device(interface).empty()) return false;
  std::error_code ignored;
  const bool was_taken =
      interface.kernel_driver.empty() && fs::exists("/sys/bus/usb/drivers/usbhid", ignored);
  return was_taken || has_pad_name(device.name) || opens_hidraw(rules, subject_of(device));
}

void add_usb(Machine& machine, const std::string& rules, PadsByPath& pads) {
  for (const SystemNode& device : system_nodes("usb")) {
    if (is_hub(device)) continue;
    machine.usb_devices.push_back(device);
    for (UsbInterface& interface : usb_interfaces(device.sysfs_path)) {
      if (!pads.contains(interface.path) && !looks_like_pad(device, interface, rules)) continue;
      PadHardware& pad = pad_at(pads, interface.path, device);
      pad.usb_node = device.node;
      pad.interface = std::move(interface);
    }
  }
}

bool is_in_container() {
  std::error_code ignored;
  return fs::exists("/.dockerenv", ignored) || fs::exists("/run/.containerenv", ignored) ||
         fs::exists("/run/systemd/container", ignored);
}

}  // namespace

Machine look_at_machine(std::vector<PadSighting> sightings, const PadOverrides& overrides,
                        const std::string& rules) {
  Machine machine;
  machine.sightings = std::move(sightings);
  std::error_code ignored;
  machine.has_udev = fs::exists("/run/udev/control", ignored);
  machine.is_container = is_in_container();
  PadsByPath pads;
  add_hidraw(machine, overrides, pads);
  add_events(machine, pads);
  add_usb(machine, rules, pads);
  for (auto& [path, pad] : pads) machine.pads.push_back(std::move(pad));
  return machine;
}

std::string users_of(const std::string& node) {
  std::string users;
  std::error_code error;
  for (const fs::directory_entry& process : fs::directory_iterator("/proc", error)) {
    const std::string id = process.path().filename().string();
    if (id.find_first_not_of("0123456789") != std::string::npos) continue;
    if (id == std::to_string(::getpid())) continue;
    std::error_code closed;  // it belongs to another user, or is gone
    fs::directory_iterator file(process.path() / "fd", closed);
    for (; !closed && file != fs::directory_iterator(); file.increment(closed)) {
      std::error_code gone;
      if (fs::read_symlink(file->path(), gone) != node) continue;
      std::ifstream in(process.path() / "comm");
      std::string name;
      std::getline(in, name);
      users += fmt::format("{}{} ({})", users.empty() ? "" : ", ", name, id);
      break;
    }
  }
  return users;
}

std::string own_user_name() {
  const passwd* user = ::getpwuid(::geteuid());
  return user ? user->pw_name : fmt::format("user {}", ::geteuid());
}

// --- udev rules

namespace {

constexpr const char* kGrant = R"(MODE="0660", GROUP="input", TAG+="uaccess")";

std::optional<std::string> text_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(in), {});
}

// Like udev's glob, of which the rules use only `*`.
bool fits(std::string_view pattern, std::string_view text) {
  const std::size_t star = pattern.find('*');
  if (star == std::string_view::npos) return pattern == text;
  if (!text.starts_with(pattern.substr(0, star))) return false;
  text.remove_prefix(star);
  pattern.remove_prefix(star + 1);
  for (; !fits(pattern, text); text.remove_prefix(1)) {
    if (text.empty()) return false;
  }
  return true;
}

bool fits_one_of(std::string_view patterns, std::string_view text) {
  for (;;) {
    const std::size_t bar = patterns.find('|');
    if (fits(patterns.substr(0, bar), text)) return true;
    if (bar == std::string_view::npos) return false;
    patterns.remove_prefix(bar + 1);
  }
}

// Whether every KERNELS=="..." of the line fits; false if it has none.
bool line_fits(std::string_view line, std::string_view hid_device) {
  constexpr std::string_view kKey = "KERNELS==\"";
  bool has_key = false;
  for (std::size_t at; (at = line.find(kKey)) != std::string_view::npos;) {
    line.remove_prefix(at + kKey.size());
    if (!fits_one_of(line.substr(0, line.find('"')), hid_device)) return false;
    has_key = true;
  }
  return has_key;
}

}  // namespace

std::string program() {
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  const char* variable = std::getenv("PATH");
  std::string_view folders = variable ? variable : "";
  while (!folders.empty()) {
    const std::size_t colon = folders.find(':');
    if (fs::equivalent(fs::path(folders.substr(0, colon)) / "gaitpad", self, error))
      return "gaitpad";
    folders.remove_prefix(colon == std::string_view::npos ? folders.size() : colon + 1);
  }
  return self.empty() ? "gaitpad" : self.string();
}

Result<RulesFile> shipped_rules(const RulesTarget& target) {
  const std::string name = fs::path(target.path).filename().string();
  for (const std::string& folder : config_folders()) {
    const fs::path path = fs::path(folder) / "udev" / name;
    if (auto text = text_of(path)) return RulesFile{path.string(), std::move(*text)};
  }
  return Error{fmt::format("config/udev/{}: no such file in the folders of configuration", name)};
}

std::optional<RulesFile> installed_rules() {
  for (const char* folder : {"/etc", "/run", "/usr/local/lib", "/usr/lib", "/lib"}) {
    const fs::path path = fs::path(folder) / "udev/rules.d" / fs::path(kPadRules.path).filename();
    if (auto text = text_of(path)) return RulesFile{path.string(), std::move(*text)};
  }
  return std::nullopt;
}

bool opens_hidraw(std::string_view rules, const RuleSubject& subject) {
  const std::string hid_device =
      fmt::format("{:04X}:{:04X}:{:04X}.0001", subject.bus, subject.vendor, subject.product);
  while (!rules.empty()) {
    const std::string_view line = rules.substr(0, rules.find('\n'));
    if (line.starts_with("SUBSYSTEM==\"hidraw\"") && line_fits(line, hid_device)) return true;
    rules.remove_prefix(std::min(line.size() + 1, rules.size()));
  }
  return false;
}

std::string hidraw_rule(const RuleSubject& subject) {
  const std::string interface =
      subject.interface ? fmt::format(" DEVPATH==\"*.{}/0003:*\",", *subject.interface) : "";
  return fmt::format("SUBSYSTEM==\"hidraw\", KERNELS==\"*:{:04X}:{:04X}.*\",{} {}", subject.vendor,
                     subject.product, interface, kGrant);
}

std::string usb_rule(const RuleSubject& subject) {
  return fmt::format(
      "SUBSYSTEM==\"usb\", ATTR{{idVendor}}==\"{:04x}\", ATTR{{idProduct}}==\"{:04x}\", {}",
      subject.vendor, subject.product, kGrant);
}

std::string install_command() { return fmt::format("sudo {} doctor --install-rules", program()); }

std::string manual_install_command(const RulesFile& rules) {
  return fmt::format("sudo cp {} {} && sudo sh -c '{}'", rules.path, kPadRules.path,
                     kPadRules.apply);
}

namespace {

bool asks_to_install(const RulesTarget& target) {
  fmt::print(stderr, "Write this to {} and let udev apply it? [y/N] ", target.path);
  std::string answer;
  std::getline(std::cin, answer);
  return answer == "y" || answer == "Y" || answer == "yes";
}

std::optional<Error> write_rules(const RulesTarget& target, const std::string& text) {
  if (auto problem = write_file(target.path, text)) return problem;
  if (::chmod(target.path, 0644) != 0) return write_error(target.path, errno);
  if (std::system(target.apply) == 0) return std::nullopt;
  return Error{fmt::format("{}: is written, but udev was not told; do: sudo sh -c '{}'",
                           target.path, target.apply)};
}

}  // namespace

int install_rules(std::string_view command, const RulesTarget& target, const std::string& text,
                  bool is_agreed, const std::string& as_root) {
  fmt::print("{}", text);
  std::fflush(stdout);
  if (::geteuid() != 0)
    return fail(command, fmt::format("{} needs root: {}", target.path, as_root));
  if (!is_agreed && !asks_to_install(target)) return fail(command, "nothing was changed");
  if (const auto problem = write_rules(target, text)) return fail(command, problem->message);
  fmt::print(stderr, "gaitpad {}: {} is installed and applied\n", command, target.path);
  return 0;
}

}  // namespace gaitpad
