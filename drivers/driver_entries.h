// What each driver file defines for its row in registry.cpp. A driver whose library is missing at
// build time is not compiled; its row then has no functions.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "gaitpad/driver.h"

namespace gaitpad {

std::vector<DeviceListing> find_hidraw_devices();
Result<std::unique_ptr<Device>> open_hidraw_device(const DeviceListing& listing, Detach detach);

std::vector<DeviceListing> find_evdev_devices();
Result<std::unique_ptr<Device>> open_evdev_device(const DeviceListing& listing, Detach detach);

std::vector<DeviceListing> find_usb_devices();
Result<std::unique_ptr<Device>> open_usb_device(const DeviceListing& listing, Detach detach);

std::vector<DeviceListing> find_sdl_devices();
Result<std::unique_ptr<Device>> open_sdl_device(const DeviceListing& listing, Detach detach);
std::string sdl_library_mapping(const DeviceInfo& device);

// A recording is never found, only named: one listing for each device of the file. `node` is the
// file's path, from the second device on with `#2`.
Result<std::vector<DeviceListing>> trace_listings(const std::string& path);
std::vector<DeviceListing> find_trace_devices();  // none
// The calibration that the recording of an open device carries (TOML text), empty where it has
// none.
std::string trace_calibration(const DeviceListing& listing);
// Delivers the device's events at their own times, counted from the first opening of that file;
// `H:` lines as reports of kind added and removed. `gone` where a replay ends: at `Q:`, else one
// second behind the file's last event.
Result<std::unique_ptr<Device>> open_trace_device(const DeviceListing& listing, Detach detach);

}  // namespace gaitpad
