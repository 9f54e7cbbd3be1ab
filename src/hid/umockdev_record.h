// Recordings of umockdev (umockdev-record(1)): what event nodes answer (`--ioctl`), their events
// (`--evemu-events`) and, as far as it names them, their description in sysfs. The three are files
// of their own; a text may hold one of them or several, one behind the other. Lines of other
// devices and other requests are skipped.
#pragma once
#include <memory>
#include <string_view>

#include "hid/evdev_recording.h"

namespace gaitpad {

bool is_umockdev_record(std::string_view text) noexcept;
std::unique_ptr<EvdevReader> make_umockdev_reader();

}  // namespace gaitpad
