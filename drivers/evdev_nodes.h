// Input nodes as libevdev opens them, for the evdev driver: what a node can tell and how that is
// stated as a HID device.
#pragma once
#include <libevdev/libevdev.h>

#include <memory>
#include <string>

#include "drivers/posix.h"
#include "gaitpad/result.h"
#include "hid/evdev_layout.h"

namespace gaitpad {

struct FreeLibevdev {
  void operator()(libevdev* device) const noexcept { libevdev_free(device); }
};
struct InputNode {
  OwnedFd fd;
  std::unique_ptr<libevdev, FreeLibevdev> device;
  bool may_write = false;
};

// `mode` is O_RDONLY or O_RDWR; reading never waits, stamps are of CLOCK_MONOTONIC.
Result<InputNode> open_input_node(const std::string& node, int mode);
EvdevLayout input_node_layout(const InputNode& opened, const std::string& node);

}  // namespace gaitpad
