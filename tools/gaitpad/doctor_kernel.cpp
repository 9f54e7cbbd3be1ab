// Whether the kernel's drivers have made of a pad what they can.
#include <fmt/format.h>
#include <sys/utsname.h>

#include <algorithm>
#include <filesystem>

#include "tools/gaitpad/doctor_checks.h"

namespace gaitpad {
namespace fs = std::filesystem;
namespace {

constexpr std::uint16_t kNintendo = 0x057e, kSwitchPro = 0x2009, kValve = 0x28de,
                        kSteamVirtual = 0x11ff;

bool exists(const std::string& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

std::string module_fix(const std::string& module) {
  utsname system = {};
  ::uname(&system);
  const std::string folder = fmt::format("/lib/modules/{}", system.release);
  if (exists(folder)) return "sudo modprobe " + module;
  return fmt::format("sudo modprobe {} (on the host: {} is not here)", module, folder);
}

}  // namespace

// Nothing serves the interface: its kernel driver is not loaded, or let it go.
void check_binding(const UsbInterface& interface, const PadHardware& pad, Finding::State state,
                   Diagnosis& diagnosis) {
  const std::string name = fs::path(interface.path).filename().string();
  const bool is_hid = interface.ids.interface_class == kHidClass;
  const std::string module = is_hid ? "usbhid" : "xpad";
  if (interface.kernel_driver.empty()) {
    const bool is_loaded = exists("/sys/bus/usb/drivers/" + module);
    diagnosis.add(state, name, pad,
                  fmt::format("USB interface {}: no kernel driver is bound", name),
                  is_loaded ? fmt::format("echo {} | sudo tee /sys/bus/usb/drivers_probe", name)
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

}  // namespace gaitpad
