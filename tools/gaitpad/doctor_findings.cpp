#include "tools/gaitpad/doctor_findings.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "gaitpad/drivers.h"
#include "tools/gaitpad/doctor_checks.h"

namespace gaitpad {
namespace {

bool exists(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

bool is_open_to_us(const PadSighting& sighting, const PadHardware& pad) {
  return sighting.is_pad && sighting.problem.empty() && sighting.listing.pad_path == pad.path;
}
// usb would have to take the pad from the kernel: play does that only when told.
bool needs_consent(const PadSighting& sighting) {
  return sighting.driver->name == std::string_view("usb") &&
         !sighting.listing.kernel_driver.empty();
}

// `hidraw (/dev/hidraw3), evdev (/dev/input/event5)`: by which play would take it.
std::string ways_to(const PadHardware& pad, const Machine& machine) {
  std::string ways;
  for (const PadSighting& sighting : machine.sightings) {
    const std::string& node = sighting.listing.node;
    if (!is_open_to_us(sighting, pad) || needs_consent(sighting)) continue;
    if (node.starts_with("/dev/input/") && is_grabbed(node)) continue;
    ways += fmt::format("{}{} ({})", ways.empty() ? "" : ", ", sighting.driver->name, node);
  }
  return ways;
}

// The drivers' own words where nothing else explains, and the way that is left.
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
                  pad, "works through " + ways);
  }
  // One way is enough: what closes another one is no problem then.
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

// What lies on no pad of its own.
void check_machine(Diagnosis& diagnosis) {
  const Machine& machine = diagnosis.machine;
  const PadHardware none;
  if (!machine.has_udev) {
    diagnosis.add(
        Finding::State::problem, "udev", none,
        "udev does not run: nodes keep the kernel's permissions, and what a node is stands "
        "nowhere",
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
  if (!machine.pads.empty() && ::geteuid() == 0) {
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

}  // namespace

std::vector<Finding> findings(const Machine& machine, const RulesFile& shipped) {
  Diagnosis diagnosis{machine, shipped, {}};
  for (const PadHardware& pad : machine.pads) check_pad(pad, diagnosis);
  check_machine(diagnosis);
  check_absence(diagnosis);
  std::ranges::stable_sort(diagnosis.list, {}, &Finding::state);
  return std::move(diagnosis.list);
}

std::vector<RuleSubject> uncovered_pads(const Machine& machine, const RulesFile& shipped) {
  std::vector<RuleSubject> subjects;
  for (const PadHardware& pad : machine.pads) {
    const RuleSubject subject = subject_of(pad);
    const bool needs_rule =
        !pad.hidraw.empty() || (pad.interface && pad.interface->ids.interface_class == kHidClass);
    if (!needs_rule || opens_hidraw(shipped.text, subject)) continue;
    if (std::ranges::find(subjects, subject) == subjects.end()) subjects.push_back(subject);
  }
  return subjects;
}

}  // namespace gaitpad
