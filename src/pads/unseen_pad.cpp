#include "pads/unseen_pad.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "drivers/system_nodes.h"

namespace gaitpad {

std::string unseen_pad() {
  std::error_code ignored;
  if (!std::filesystem::exists("/run/udev", ignored))
    return fmt::format("{}: gaitpad doctor", kNoUdev);
  for (const SystemNode& node : system_nodes("input")) {
    if (!node.is_joystick || node.is_motion_sensor || access_problem(node.node).empty()) continue;
    return fmt::format(
        "{} is plugged in, but you may not read it: sudo gaitpad doctor --install-rules",
        node.name);
  }
  return {};
}

}  // namespace gaitpad
