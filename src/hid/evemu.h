// Recordings of evemu (`# EVEMU 1.x`, written by evemu-record and played by evemu-play): an evdev
// node and its events. Reading one makes it a trace of the evdev driver; writing one gives the
// events that the kernel makes of a pad's reports. The format: evemu's README and evemu-record(1).
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "gaitpad/result.h"
#include "gaitpad/trace.h"
#include "hid/evdev_recording.h"
#include "hid/trace_lines.h"

namespace gaitpad {

bool is_evemu(std::string_view text) noexcept;

std::unique_ptr<EvdevReader> make_evemu_reader();
// Reads the content of an `E:` line, which umockdev writes as well. Returns why it is damaged.
std::optional<std::string> add_evemu_event(Words words, EvdevRecording& node);

// The first pad of the trace. Fields whose usages the kernel gives no code are left out, and so are
// commands. An unplugged pad goes back to where its first report had it. Error: none of the devices
// is a pad.
Result<std::string> evemu_text(const Trace& trace);

}  // namespace gaitpad
