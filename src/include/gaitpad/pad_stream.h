// Which devices there are, which of them are pads, and which driver serves a pad that several see.
#pragma once
#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/driver.h"
#include "gaitpad/drivers.h"
#include "gaitpad/keyboard.h"
#include "gaitpad/pad_setup.h"
#include "gaitpad/report.h"
#include "gaitpad/result.h"

namespace gaitpad {

// What a user asks for; empty: any.
struct PadWish {
  std::string pad;  // a path (node or recording), a `vid:pid`, a unique id, a unique part of a name
  std::string driver;  // hidraw, evdev, sdl, usb; forces it
};

struct PadSighting {
  DeviceListing listing;
  const DriverEntry* driver = nullptr;
  bool is_pad = false;  // it has a stick, or its driver must be asked by opening
  std::string problem;  // why it is not usable: one sentence, empty: it is
};

// The same for what several drivers see of one pad.
std::string pad_key(const PadSighting& sighting);

// Every device that every driver (or the one wished for) sees, pads first; where the wish names a
// recording, its devices alone. Finder thread. SDL is asked only where it is wished for, or for
// Drivers::all, or where no other driver of kernel devices was built: its start takes up to a
// second. Error where the wish itself is wrong: an unknown driver, one that was not built, a
// damaged recording. `table` is for tests.
enum class Drivers { preferred, all };
Result<std::vector<PadSighting>> pad_sightings(
    const PadFiles& files, const PadWish& wish, Drivers drivers,
    std::span<const DriverEntry> table = gaitpad::drivers());

// Of the sightings those to open, in the order of preference: each pad (pad_path) by the first
// driver of drivers()'s order that can; usb only where it is wished for or no kernel driver has the
// pad. What one driver shows as several, such as an adapter with an input node for each of its
// plugs, are several pads. Empty where nothing fits. Error where `wish.pad` fits several different
// pads by a part of a name: it names them.
Result<std::vector<PadSighting>> chosen_pads(const std::vector<PadSighting>& sightings,
                                             const PadWish& wish);

// The sightings of pads that `wish.pad` means, usable or not, in the order of preference; all
// pads where it is empty. Error as above.
Result<std::vector<PadSighting>> wished_pads(const std::vector<PadSighting>& sightings,
                                             const PadWish& wish);
// Whether PAD names a recording: an existing file, or a path that ends in .hid.
bool is_recording(const std::string& pad);

// The same device again after unplugging: driver, ids and unique id, else port.
bool is_same_device(const DeviceInfo& a, const DeviceInfo& b) noexcept;

// Pads as one stream of reports: found, opened, kept through unplugging and plugging in again.
// docs/pads.md draws the whole way.
//
// Two threads work here. The finder waits for udev's word that something was plugged in, looks at
// the devices, opens the chosen ones (that may take seconds) and hands them over. The I/O thread
// sleeps in poll() over all open devices, reads them and writes the reports into a wait-free ring;
// motors are set by it, too. Whoever reads the ring waits for neither of them.

inline constexpr std::size_t kMaxPads = kMaxTraceDevices;  // different ones in one session

struct PadStreamOptions {
  PadFiles files;
  PadWish wish;
  std::shared_ptr<KeyboardStick> keyboard =
      nullptr;  // a further device, index 0, there from the start
  // For tests: other drivers; a descriptor that is readable when something was plugged in or out
  // and silent after one read(), in place of udev's word; reports that the ring holds, a power of
  // two.
  std::span<const DriverEntry> drivers = gaitpad::drivers();
  int changes_fd = -1;
  std::size_t ring_reports = 1024;
};

// Since the beginning; may be read by any thread.
struct PadStreamCounts {
  std::int64_t reports = 0;  // written to the ring
  std::int64_t lost = 0;     // reports that a source lost, and those that found the ring full
  std::int64_t plugged = 0, unplugged = 0;  // pads, the keyboard is none
};

class PadStream {
 public:
  // Runs from here on. Pads that are there already are announced like those plugged in later. Error
  // where the wish is wrong: an unknown driver, a damaged recording, a part of a name that fits
  // several pads. A wish that nothing fits is waited for.
  static Result<std::unique_ptr<PadStream>> start(PadStreamOptions options);
  ~PadStream();  // closes every device, what was taken from the kernel is given back

  // The reading end, for one thread. A device's first report is `added`, also after plugging in
  // again. Where the ring was full the newest report of each device (and report id) follows when
  // there is room. The stamps of a device never go back. A blank command never comes, line breaks
  // in one are blanks.
  const Report* front() noexcept;
  void pop() noexcept;
  // Sleeps until there is something to read or the time is over; not for the loop thread.
  void wait(std::chrono::milliseconds timeout);

  // All valid once the device's first `added` has been read, and never changed afterwards.
  const TraceDevice& device(std::uint16_t index) const noexcept;
  const PadLayout& layout(std::uint16_t index) const noexcept;
  // The reader takes it out of here once (no heap: it is moved). Not present: `added` follows.
  PadConfig& config(std::uint16_t index) noexcept;

  // From the reading thread, wait-free: the motors run for that long. Dropped when too many wait.
  void rumble(std::uint16_t device, const Rumble& rumble,
              std::chrono::milliseconds duration) noexcept;
  // From any thread: a line such as `style limp_left`, as a report of kind command.
  void command(std::string_view text);

  // True once every device of a recording has come to its end; never for hardware.
  bool has_ended() const noexcept;
  PadStreamCounts counts() const noexcept;
  // What users should know (a pad that cannot be opened and why, a lost one), each once.
  std::vector<std::string> take_remarks();

 private:
  PadStream();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gaitpad
