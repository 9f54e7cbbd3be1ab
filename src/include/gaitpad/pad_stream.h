// Live pads: which devices there are, which of them are pads, which driver serves a pad that
// several drivers see, and all chosen pads as one stream of reports.
#pragma once
#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/driver.h"
#include "gaitpad/driver_registry.h"
#include "gaitpad/keyboard.h"
#include "gaitpad/pad_configuration.h"
#include "gaitpad/report.h"
#include "gaitpad/result.h"

namespace gaitpad {

// The pad that a user asks for; empty: any. The caller fills it. The functions below refuse a
// selector that no device or driver can fit.
struct PadSelector {
  // A path (node or recording), a `vid:pid`, a unique id, or a part of a name that only one pad
  // has.
  std::string pad;
  std::string driver;  // the only driver to use: hidraw, evdev, sdl or usb; empty: any
};

// Allows detaching a kernel driver only if the user names usb.
inline Detach detach_asked(const PadSelector& selector) {
  return selector.driver == "usb" ? Detach::allowed : Detach::never;
}

// A device as one driver sees it; pad_sightings() fills it.
struct PadSighting {
  DeviceListing listing;
  const DriverEntry* driver = nullptr;
  bool is_pad = false;  // it has a stick, or its driver knows only after opening it
  std::string problem;  // one sentence that says why it is not usable; empty: it is usable
  // Number of the node's file (inode). It changes when the device is plugged in again, even if the
  // node's name does not. 0: not known.
  std::uint64_t node_file = 0;
};

// A key that all sightings of one pad by different drivers share.
std::string pad_key(const PadSighting& sighting);

enum class Drivers {
  // All drivers, but SDL only if it is asked for, or if no other driver of kernel devices was
  // built: its start takes up to a second.
  preferred,
  all,
};
// Every device that every driver, or the selected one, sees; pads first. If the selector names a
// recording: its devices alone. Blocks while drivers look; call it from one thread. Error: an
// unknown driver, a driver that was not built, a damaged recording. `table`: other drivers, for
// tests.
Result<std::vector<PadSighting>> pad_sightings(
    const PadFiles& files, const PadSelector& selector, Drivers drivers,
    std::span<const DriverEntry> table = gaitpad::drivers());

// The sightings to open, in the order of preference: each pad by the first driver in the order of
// drivers() that can open it. usb counts only if it is asked for or if no kernel driver has the
// pad. What one driver shows as several devices, such as an adapter with an input node for each of
// its plugs, are several pads. Empty if nothing fits. Error: `selector.pad` is a part of the names
// of several pads; the sentence names them.
Result<std::vector<PadSighting>> chosen_pads(const std::vector<PadSighting>& sightings,
                                             const PadSelector& selector);

// The sightings of the pads that `selector.pad` means, usable or not, in the order of preference;
// of all pads if it is empty. Error as for chosen_pads().
Result<std::vector<PadSighting>> matching_pads(const std::vector<PadSighting>& sightings,
                                               const PadSelector& selector);
// True if PAD names a recording: an existing file, or a path that ends in .hid.
bool is_recording(const std::string& pad);

// True if `b` is the device `a` plugged in again: same driver and ids, and the same unique id, or
// the same port if they have none.
bool is_same_device(const DeviceInfo& a, const DeviceInfo& b) noexcept;

inline constexpr std::size_t kMaxPads = kMaxTraceDevices;  // most different pads in one session

// Largest ring, which takes 1 GB.
inline constexpr std::size_t kMostRingReports = std::size_t{1} << 20;

// Options of a stream; the caller fills them.
struct PadStreamOptions {
  PadFiles files;  // files about pads, read by load_pad_files()
  PadSelector selector;
  // The keyboard as a further device. It has index 0 and is there from the start. Null: none.
  std::shared_ptr<KeyboardStick> keyboard = nullptr;
  bool is_raw = false;  // passes on every packet, input or not (Device::hand_on_raw)
  // For tests: other drivers; a file descriptor that replaces udev (readable when something was
  // plugged in or out, silent after one read(); -1: udev); the size of the ring in reports, a power
  // of two up to kMostRingReports.
  std::span<const DriverEntry> drivers = gaitpad::drivers();
  int changes_fd = -1;
  std::size_t ring_reports = 1024;
};

// Errors read `PadStreamOptions: ring_reports is 3, not a power of two in [1, 1048576]`.
std::optional<Error> check(const PadStreamOptions& options);

// Numbers since the beginning.
struct PadStreamCounts {
  std::int64_t reports = 0;  // reports that were written to the ring
  std::int64_t lost = 0;     // reports that a source lost, and reports that found the ring full
  // Pads that were plugged in and out, without the keyboard.
  std::int64_t plugged = 0, unplugged = 0;
  std::int64_t commands_left_out = 0;  // commands that were too long, or too many at once
};

// Pads as one stream of reports: found, opened, and kept through unplugging and plugging in again.
// docs/pads.md draws the way of a report.
//
// Two threads work for the stream. The finder thread waits until udev says that something was
// plugged in, looks at the devices, opens the chosen ones (which may take seconds) and hands each
// to the I/O thread. The I/O thread sleeps in poll() over all open devices, reads them, writes
// their reports into a wait-free ring and sets the motors. The reader of the ring waits for
// neither.
//
// A pad's device, layout and configuration travel as one message with its first `added` report: the
// finder makes it, the I/O thread passes it on, and the reading end owns it from then on.
class PadStream {
 public:
  // Starts both threads. Pads that are plugged in already are announced in the same way as those
  // plugged in later. If no device fits the selector, the stream waits for one. Error: an unknown
  // driver, a damaged recording, a part of a name that fits several pads.
  static Result<std::unique_ptr<PadStream>> start(PadStreamOptions options);
  ~PadStream();  // Closes every device and gives back what was taken from the kernel.

  // The reading end, for one thread; wait-free and without heap. The first report of a device is
  // `added`, also after plugging in again. If the ring was full, the newest report of each device
  // and report id follows as soon as there is room. The time stamps of a device never decrease. A
  // command is never blank, and line breaks in it become blanks.
  const Report* front() noexcept;  // The oldest report, null if there is none; valid until pop().
  void pop() noexcept;
  // Sleeps until there is something to read or the time is over. Do not call it in the loop thread.
  void wait(std::chrono::milliseconds timeout);

  // The description of a device; valid after front() has given its first `added`, and unchanged
  // afterwards. For the reading thread, and for threads that it tells about the device.
  const TraceDevice& device(std::uint16_t index) const noexcept;
  const PadLayout& layout(std::uint16_t index) const noexcept;
  // Moves the configuration out, once. Its pad is not present: `added` follows.
  PadConfig take_config(std::uint16_t index) noexcept;

  // Runs the motors for this time. Call it from the reading thread; it does not wait. Dropped if
  // too many requests wait.
  void rumble(std::uint16_t device, const Rumble& rumble,
              std::chrono::milliseconds duration) noexcept;
  // From any thread: a line such as `style limp_left` becomes a report of kind command.
  void command(std::string_view text);

  // True once every device of a recording has come to its end; never for hardware.
  bool has_ended() const noexcept;
  PadStreamCounts counts() const noexcept;  // Any thread.
  // Remarks for users (an unplugged pad; a pad that cannot be opened, and why). Each is returned
  // once.
  std::vector<std::string> take_remarks();

 private:
  PadStream();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gaitpad
