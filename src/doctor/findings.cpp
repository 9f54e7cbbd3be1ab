#include "doctor/findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "drivers/system_users.h"
#include "gaitpad/driver_registry.h"
#include "pads/unseen_pad.h"

namespace gaitpad {
namespace fs = std::filesystem;
namespace {

bool exists(const std::string& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

// The findings so far, and their input.
struct Diagnosis {
  const Machine& machine;
  const RulesFile& shipped;
  std::vector<Finding> list;

  void add(Finding::State state, std::string node, const PadHardware& pad, std::string cause,
           std::string fix = "") {
    list.push_back({state, std::move(node), pad.name, std::move(cause), std::move(fix)});
  }
};

RuleSubject subject_of(const PadHardware& pad) {
  return {static_cast<std::uint16_t>(pad.bus), pad.vendor, pad.product,
          pad.interface ? std::optional<int>(pad.interface->number) : std::nullopt};
}
// True if another interface of the same USB device is a keyboard or a mouse: a rule for the device
// would open that one as well.
bool is_beside_a_keyboard(const PadHardware& pad) {
  if (!pad.interface) return false;
  const fs::path device = fs::path(pad.interface->path).parent_path();
  return std::ranges::any_of(usb_interfaces(device.string()),
                             [](const UsbInterface& i) { return !boot_device(i).empty(); });
}
// True if the event node has the pad's sticks. One pad makes several nodes; the others are motion
// sensors and touchpads.
bool is_pad_event(const SystemNode& node) { return !node.is_motion_sensor && !node.is_touchpad; }

// In the checks below `state` is the state of their findings: problem, or note if another driver
// can use the pad.

// --- access

constexpr unsigned kGroupMayUse = 0060;

std::string permission_cause(const std::string& node, const NodeRights& rights) {
  return fmt::format("{}: permission denied for {} (owner {}, group {}, mode {:04o})", node,
                     own_user_name(), rights.owner, rights.group, rights.mode);
}

bool knows_seats() { return exists("/run/systemd/seats"); }

std::string permission_fix(const RulesFile& shipped, const PadHardware& pad,
                           const NodeRights& rights) {
  const auto installed = installed_rules();
  const bool group_may = (rights.mode & kGroupMayUse) == kGroupMayUse && rights.group_id != 0;
  if (group_may) {
    return fmt::format("sudo usermod -aG {} {}, then log in again{}", rights.group, own_user_name(),
                       !installed && knows_seats() ? ", or: " + install_command() : "");
  }
  const std::string& rules = installed ? installed->text : shipped.text;
  const bool is_known = opens_hidraw(rules, subject_of(pad));
  const std::string line =
      is_known ? "" : fmt::format(", with the line {}", hidraw_rule(subject_of(pad)));
  if (!installed) {
    return fmt::format("{} (no rule opens it yet; by hand: {}{})", install_command(),
                       manual_install_command(shipped), line);
  }
  if (!is_known)
    return fmt::format("{} (no rule for this pad in {}{})", install_command(), installed->path,
                       line);
  return fmt::format("sudo sh -c '{}', or plug it in again ({} is there, but was not applied)",
                     kPadRules.apply, installed->path);
}

// Returns true if the node can be used.
bool check_access(const std::string& node, const PadHardware& pad, Finding::State state,
                  Diagnosis& diagnosis) {
  const auto rights = node_rights(node);
  if (!rights) {
    diagnosis.add(
        state, node, pad, node + ": the kernel has it, but it is not in /dev",
        diagnosis.machine.is_container
            ? fmt::format("start the container with --device {} and -v /run/udev:/run/udev:ro",
                          node)
            : "sudo udevadm trigger");
    return false;
  }
  if (access_problem(node).empty()) return true;
  diagnosis.add(state, node, pad, permission_cause(node, *rights),
                permission_fix(diagnosis.shipped, pad, *rights));
  return false;
}

void check_events(const PadHardware& pad, Finding::State state, Diagnosis& diagnosis) {
  for (const SystemNode& node : pad.events) {
    if (!is_pad_event(node)) {
      diagnosis.add(Finding::State::note, node.node, pad,
                    fmt::format("{}: the pad's {}, not its sticks", node.node,
                                node.is_touchpad ? "touchpad" : "motion sensors"));
    } else if (check_access(node.node, pad, state, diagnosis)) {
      // Only the program that grabs a node knows it, so a second program would receive no events.
      const std::string users = users_of(node.node);
      if (users.empty()) continue;
      diagnosis.add(
          Finding::State::note, node.node, pad,
          fmt::format("{}: also open in {}, which may have it for itself", node.node, users),
          pad.hidraw.empty()
              ? "if the pad is silent, end that program"
              : "if the pad is silent, end that program, or: gaitpad play --driver hidraw");
    }
  }
}

// --- the kernel's drivers

constexpr std::uint16_t kNintendo = 0x057e, kSwitchPro = 0x2009, kValve = 0x28de,
                        kSteamVirtual = 0x11ff;

std::string module_fix(const std::string& module) {
  const std::string folder = "/lib/modules/" + kernel_name().release;
  if (exists(folder)) return "sudo modprobe " + module;
  return fmt::format("sudo modprobe {} (on the host: {} is not here)", module, folder);
}

// Checks that a kernel driver serves the USB interface.
void check_binding(const UsbInterface& interface, const PadHardware& pad, Finding::State state,
                   Diagnosis& diagnosis) {
  const std::string name = fs::path(interface.path).filename().string();
  const bool is_hid = interface.ids.interface_class == kHidClass;
  const std::string module = is_hid ? "usbhid" : "xpad";
  if (interface.kernel_driver.empty()) {
    const bool is_loaded = exists("/sys/bus/usb/drivers/" + module);
    diagnosis.add(
        state, name, pad,
        fmt::format("USB interface {}: no kernel driver is bound{}", name,
                    is_loaded ? " until it is plugged in again: a program that had taken the pad "
                                "from the kernel was killed"
                              : ""),
        is_loaded ? fmt::format("echo {} | sudo tee /sys/bus/usb/drivers_probe, or plug it in "
                                "again, or use it once: gaitpad play --driver usb gives it back "
                                "at its end",
                                name)
                  : module_fix(module));
  } else if (interface.kernel_driver == "usbfs") {
    const std::string users = users_of(pad.usb_node);
    diagnosis.add(state, pad.usb_node, pad,
                  fmt::format("USB interface {}: another program has taken it{}", name,
                              users.empty() ? "" : ": " + users),
                  "end that program");
  } else if (is_hid && interface.hid_driver.empty()) {
    const std::string load =
        interface.descriptor.empty()
            ? ""
            : fmt::format("sudo modprobe \"$(cat {}/0003:*/modalias)\", or ", interface.path);
    diagnosis.add(state, name, pad,
                  fmt::format("USB interface {}: its HID driver is not loaded, or gave the pad up "
                              "while starting it (sudo dmesg says why)",
                              name),
                  load + "plug it in again, or: gaitpad play --driver usb");
  }
}

void check_missing_nodes(const PadHardware& pad, Finding::State state, Diagnosis& diagnosis) {
  const bool is_bound = !pad.interface || (!pad.interface->kernel_driver.empty() &&
                                           pad.interface->kernel_driver != "usbfs");
  if (!is_bound) return;
  if (std::ranges::any_of(pad.events, is_pad_event)) return;
  if (!pad.hidraw.empty() || (pad.interface && !pad.interface->hid_driver.empty()) ||
      (pad.interface && pad.interface->kernel_driver == "xpad")) {
    diagnosis.add(state, pad.path, pad, "its kernel driver is bound, but it has no event node",
                  exists("/sys/module/evdev") ? "plug it in again" : module_fix("evdev"));
  }
}

void check_model(const PadHardware& pad, Diagnosis& diagnosis) {
  const std::string driver = pad.hidraw.empty() ? "" : pad.hidraw.front().kernel_driver;
  if (pad.vendor == kNintendo && pad.product == kSwitchPro && driver == "hid-generic") {
    diagnosis.add(
        Finding::State::note, pad.hidraw.front().node, pad,
        "without hid-nintendo it is silent until a program starts it; the drivers hidraw and "
        "usb do that, evdev and sdl do not",
        module_fix("hid-nintendo"));
  }
  if (pad.vendor == kValve && pad.product == kSteamVirtual) {
    diagnosis.add(Finding::State::note, pad.path, pad,
                  "this is Steam's copy of a pad, not the pad itself", "end Steam to have the pad");
  }
}

// --- all checks

bool is_open_to_us(const PadSighting& sighting, const PadHardware& pad) {
  return sighting.is_pad && sighting.problem.empty() && sighting.listing.pad_path == pad.path;
}
// usb would have to detach the kernel's driver, which play does only if it is asked to.
bool needs_consent(const PadSighting& sighting) {
  return sighting.driver->name == std::string_view("usb") &&
         !sighting.listing.kernel_driver.empty();
}

// The drivers with which play could open it: `hidraw (/dev/hidraw3), evdev (/dev/input/event5)`.
std::string ways_to(const PadHardware& pad, const Machine& machine) {
  std::string ways;
  for (const PadSighting& sighting : machine.sightings) {
    const std::string& node = sighting.listing.node;
    if (!is_open_to_us(sighting, pad) || needs_consent(sighting)) continue;
    ways += fmt::format("{}{} ({})", ways.empty() ? "" : ", ", sighting.driver->name, node);
  }
  return ways;
}

// Adds the drivers' errors, with a possible fix, if nothing else explains why the pad does not
// work.
void check_sightings(const PadHardware& pad, bool is_explained, Diagnosis& diagnosis) {
  for (const PadSighting& sighting : diagnosis.machine.sightings) {
    const std::string& node = sighting.listing.node;
    const bool is_taken = sighting.listing.kernel_driver == "usbfs";
    if (is_open_to_us(sighting, pad) && needs_consent(sighting) && !is_taken) {
      diagnosis.add(Finding::State::note, node, pad,
                    fmt::format("{}: it can be taken from the kernel", node),
                    "gaitpad play --driver usb");
    } else if (!is_explained && sighting.listing.pad_path == pad.path &&
               !sighting.problem.empty()) {
      diagnosis.add(Finding::State::problem, node, pad, sighting.problem);
    }
  }
}

void check_pad(const PadHardware& pad, Diagnosis& diagnosis) {
  const std::string ways = ways_to(pad, diagnosis.machine);
  const bool is_usable = !ways.empty();
  if (is_usable) {
    diagnosis.add(Finding::State::usable, pad.hidraw.empty() ? pad.path : pad.hidraw.front().node,
                  pad, fmt::format("works through {}; {}", ways, kHatDrives));
  }
  // One usable driver is enough; then problems of the others are notes.
  const auto state = is_usable ? Finding::State::note : Finding::State::problem;
  const std::size_t before = diagnosis.list.size();
  if (pad.interface) check_binding(*pad.interface, pad, state, diagnosis);
  for (const SystemNode& node : pad.hidraw) check_access(node.node, pad, state, diagnosis);
  check_events(pad, state, diagnosis);
  check_missing_nodes(pad, state, diagnosis);
  check_model(pad, diagnosis);
  const bool is_explained = std::any_of(
      diagnosis.list.begin() + static_cast<std::ptrdiff_t>(before), diagnosis.list.end(),
      [](const Finding& f) { return f.state == Finding::State::problem; });
  if (!is_usable) check_sightings(pad, is_explained, diagnosis);
}

// Problems of the machine that do not concern a single pad.
void check_machine(Diagnosis& diagnosis) {
  const Machine& machine = diagnosis.machine;
  const PadHardware none;
  if (!machine.has_udev) {
    diagnosis.add(Finding::State::problem, "udev", none, kNoUdev,
                  machine.is_container ? "start the container with -v /run/udev:/run/udev:ro"
                                       : "sudo systemctl start systemd-udevd");
  }
  if (machine.is_container && !exists("/dev/input")) {
    diagnosis.add(
        Finding::State::problem, "/dev/input", none,
        "/dev/input: this is a container without input devices",
        "start the container with --device /dev/input and one --device for each /dev/hidraw*");
  }
  for (const DriverEntry& entry : drivers()) {
    if (entry.find) continue;
    diagnosis.add(Finding::State::note, entry.name, none,
                  fmt::format("{}: built without {}", entry.name, entry.library));
  }
  if (!machine.pads.empty() && is_root()) {
    diagnosis.add(Finding::State::note, "root", none,
                  "all nodes were tried as root, who may use everything",
                  "ask again as the user who plays");
  }
}

void check_absence(Diagnosis& diagnosis) {
  const Machine& machine = diagnosis.machine;
  if (!machine.pads.empty()) return;
  std::string names;
  for (const SystemNode& device : machine.usb_devices)
    names += fmt::format("{}{:04x}:{:04x} {}", names.empty() ? ": " : ", ", device.vendor,
                         device.product, device.name);
  diagnosis.add(
      Finding::State::problem, "usb", PadHardware(),
      fmt::format("no pad is plugged in: none of the {} USB devices is one{}",
                  machine.usb_devices.size(), names),
      "plug one in (a cable for charging alone carries no data), or pair it by Bluetooth");
}

// Pads that are plugged in and not named by the shipped rules, without parts of a keyboard.
std::vector<RuleSubject> uncovered_pads(const Machine& machine, const RulesFile& shipped) {
  std::vector<RuleSubject> subjects;
  for (const PadHardware& pad : machine.pads) {
    const RuleSubject subject = subject_of(pad);
    const bool needs_rule =
        !pad.hidraw.empty() || (pad.interface && pad.interface->ids.interface_class == kHidClass);
    if (!needs_rule || is_beside_a_keyboard(pad) || opens_hidraw(shipped.text, subject)) continue;
    if (std::ranges::find(subjects, subject) == subjects.end()) subjects.push_back(subject);
  }
  return subjects;
}

}  // namespace

std::vector<Finding> findings(const Machine& machine, const RulesFile& shipped) {
  Diagnosis diagnosis{machine, shipped, {}};
  for (const PadHardware& pad : machine.pads) check_pad(pad, diagnosis);
  check_machine(diagnosis);
  check_absence(diagnosis);
  std::ranges::stable_sort(diagnosis.list, {}, &Finding::state);
  return std::move(diagnosis.list);
}

std::string rules_text(const Machine& machine, const RulesFile& shipped) {
  std::string text = shipped.text;
  const std::vector<RuleSubject> others = uncovered_pads(machine, shipped);
  if (!others.empty()) text += "\n# Plugged in when this was installed\n";
  for (const RuleSubject& subject : others)
    text += hidraw_rule(subject) + "\n" + usb_rule(subject) + "\n";
  return text;
}

}  // namespace gaitpad
