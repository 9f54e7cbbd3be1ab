#include "tools/gaitpad/pad_options.h"

#include <fmt/format.h>

#include <vector>

#include "drivers/system_nodes.h"
#include "gaitpad/config_files.h"
#include "gaitpad/drivers.h"
#include "tools/gaitpad/report_print.h"

namespace gaitpad {
namespace {

// Opening a pad may take two seconds.
constexpr std::int64_t kPatienceNs = 2'500'000'000;

// Recordings are named by PAD, not by a driver.
std::vector<std::string> driver_names() {
  std::vector<std::string> names;
  for (const DriverEntry& entry : drivers()) {
    if (*entry.library != '\0') names.emplace_back(entry.name);
  }
  return names;
}

// Asked of the system, not of the drivers, which another thread is using.
std::vector<std::string> pads_of_system() {
  std::vector<std::string> pads;
  for (const SystemNode& node : system_nodes("input")) {
    if (!node.is_joystick || node.is_motion_sensor) continue;
    const std::string problem = access_problem(node.node);
    pads.push_back(fmt::format("{} ({:04x}:{:04x}, {}) {}", printable(node.name), node.vendor,
                               node.product, node.node,
                               problem.empty() ? "would be usable" : "is there: " + problem));
  }
  return pads;
}

}  // namespace

void add_driver_option(CLI::App& command, PadWish& wish) {
  command
      .add_option("--driver", wish.driver,
                  "only this driver's devices (usb takes a pad from the kernel while it is open)")
      ->check(CLI::IsMember(driver_names()));
}

void add_pad_options(CLI::App& command, PadWish& wish) {
  command.add_option(
      "PAD", wish.pad,
      "a node, a recording (.hid), a vid:pid, a unique id, or a part of one pad's name "
      "(default: the first usable)");
  add_driver_option(command, wish);
}

void add_seconds_option(CLI::App& command, double& seconds) {
  command.add_option("--seconds", seconds, "end after this time (default: at Ctrl-C)")
      ->check(CLI::PositiveNumber);
}

Result<PadFiles> pad_files(const std::string& map, const std::string& calibration) {
  return load_pad_files(config_folders(GAITPAD_CONFIG_DIR), map, calibration);
}

void MissingPad::look(std::int64_t plugged, StatusLine& line) {
  if (now_ns() >= start_ns_ + kPatienceNs) tell(plugged, "not there yet, waiting", line);
}

void MissingPad::finish(std::int64_t plugged, StatusLine& line) {
  tell(plugged, "was not there", line);
}

void MissingPad::tell(std::int64_t plugged, std::string_view what, StatusLine& line) {
  if (is_told_ || plugged > 0) return;
  is_told_ = true;
  std::vector<std::string> remarks = {
      fmt::format("{}: {}", wish_.pad.empty() ? "a pad" : wish_.pad, what)};
  const bool is_choosy = !wish_.pad.empty() || !wish_.driver.empty();
  for (const std::string& other : is_choosy ? pads_of_system() : std::vector<std::string>())
    remarks.push_back(other);
  remarks.push_back("gaitpad doctor finds why a pad does not work");
  print_remarks(command_, remarks, &line);
}

}  // namespace gaitpad
