// The functions that each driver file defines for its row in driver_registry.cpp. A driver whose
// library is missing is not compiled, and its row then has no functions.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "gaitpad/driver.h"

namespace gaitpad {

class EventNode;
class VirtualPad;
struct VirtualPadShape;

std::vector<DeviceListing> find_hidraw_devices();
Result<std::unique_ptr<Device>> open_hidraw_device(const DeviceListing& listing, Detach detach);

std::vector<DeviceListing> find_evdev_devices();
Result<std::unique_ptr<Device>> open_evdev_device(const DeviceListing& listing, Detach detach);
Result<std::unique_ptr<EventNode>> open_event_node(const DeviceListing& listing);
Result<std::unique_ptr<VirtualPad>> make_evdev_virtual_pad(const VirtualPadShape& shape);

std::vector<DeviceListing> find_usb_devices();
Result<std::unique_ptr<Device>> open_usb_device(const DeviceListing& listing, Detach detach);

std::vector<DeviceListing> find_sdl_devices();
Result<std::unique_ptr<Device>> open_sdl_device(const DeviceListing& listing, Detach detach);
// The lines of the data base that was compiled into SDL's library, read as text from the library's
// file without running SDL. Empty: there are none.
std::vector<std::string> sdl_library_lines();

// The listings of a recording, one for each device in it; a recording is used only if it is named.
// `node` is the path of the file, with `#2` and so on from the second device on.
Result<std::vector<DeviceListing>> trace_listings(const std::string& path);
// Finds nothing: a recording is only used if it is named.
std::vector<DeviceListing> find_trace_devices();
// The calibration (TOML text) that the recording has for an open device; empty: none.
std::string trace_calibration(const DeviceListing& listing);
// Opens one of a recording's devices, which delivers its events at their recorded times, counted
// from the first opening of that file, and the `H:` lines as reports of kind added and removed. It
// is `gone` when a replay ends: at the `Q:` line, else one second after the last event.
Result<std::unique_ptr<Device>> open_trace_device(const DeviceListing& listing, Detach detach);

}  // namespace gaitpad
