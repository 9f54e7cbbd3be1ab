// The driver contract. A driver is two functions: one finds the devices that its source shows, one
// opens such a device. An open device hands on its reports as bytes and never interprets them; what
// its source does not describe it states as a report descriptor that it builds.
//
// Threads  `find` and `open` are called from one thread, the finder's, and may take their time:
//          they may talk to the device for up to two seconds. A Device then belongs to the I/O
//          thread, which makes every further call; the finder's thread, or at the end another one,
//          destroys it. A driver starts no thread that calls back; one that only talks to the pad
//          it may have (hidraw).
// Blocking No call of Device waits for a report: the I/O thread sleeps in poll() over `poll_fds` of
//          all devices. Rare calls take as long as the system takes: mending a stalled endpoint
//          (usb), a joystick that SDL has just found (sdl), closing.
// Memory   All of it may allocate: nothing here runs on the loop thread.
// Owning   A Device owns its handles and closes them in its destructor; what it took from the
//          kernel (a detached driver, a running rumble) it gives back there.
// Unplug   `read` answers `gone`, once all that came before it has been read. A stall, a refused
//          packet or an interrupted call is no unplug: the device recovers or counts it as lost.
//          A device plugged in again is another Device.
// Time     Report::time_ns is CLOCK_MONOTONIC: the kernel's own stamp where the source has one
//          (evdev), else the moment when the report was seen.
#pragma once
#include <poll.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/report.h"
#include "gaitpad/result.h"

namespace gaitpad {

// DeviceInfo::driver of the keyboard as a pad: live and in a recording it counts while no other pad
// is deflected.
inline constexpr std::string_view kKeyboardDriver = "keyboard";

// Motor strengths, 0..65535 as in Linux's ff_rumble_effect: the strong motor is the slow, heavy
// one.
struct Rumble {
  std::uint16_t strong = 0, weak = 0;
};

// What a pad remembers of its own sticks: fractions of half the logical range from its middle, +x
// right, +y forward, as in stick/calibration.h.
struct FactoryAxis {
  double min = -1.0, centre = 0.0, max = 1.0;
};
struct FactorySticks {
  FactoryAxis left_x, left_y, right_x, right_y;
};

class Device {
 public:
  enum class Status {
    report,   // `report` is filled: time_ns, size, bytes, kind input (its device is not); of
              // a recording also kind added or removed
    nothing,  // nothing more for now
    gone,     // unplugged
  };
  virtual ~Device() = default;

  virtual const DeviceInfo& info() const noexcept = 0;
  // What to wait for; `read` until `nothing` when one of them is ready. May change after a read.
  virtual std::span<const pollfd> poll_fds() const noexcept = 0;
  virtual Status read(Report& report) noexcept = 0;

  // Runs until the next call. False where the pad cannot or the packet did not leave.
  virtual bool rumble(const Rumble&) noexcept { return false; }
  virtual std::optional<FactorySticks> factory_sticks() const { return std::nullopt; }
  // Reports that are known to have been lost or refused since the opening (SYN_DROPPED, overruns,
  // a wrong checksum, a stalled endpoint).
  virtual std::int64_t lost() const noexcept { return 0; }
  // Once each: what a user should know though the pad works.
  virtual std::vector<std::string> take_remarks() { return {}; }
};

// A device that a driver sees, open or not.
struct DeviceListing {
  DeviceInfo info;   // the descriptor is empty where it cannot be read without opening
  std::string node;  // /dev/hidraw3, /dev/input/event5, /dev/bus/usb/001/004, walk.hid
  // The same for one pad on every driver: the sysfs folder of its USB interface, else of its HID
  // device, else of its input device.
  std::string pad_path;
  std::string kernel_driver;  // bound to it: usbhid, xpad, playstation; empty: none or unknown
  double poll_rate_hz = 0.0;  // as the endpoint claims; 0: unknown
  bool is_other = false;      // known to be no pad: a keyboard, the motion sensor of a pad
  std::string problem;        // why it cannot be opened or is no pad: one sentence; empty: it can
};

// Whether a kernel driver may be detached while the device is open (usb only).
enum class Detach { never, allowed };

struct DriverEntry {
  const char* name;
  const char* library;  // what it is built on, for sentences
  // Null where the program was built without the library. Never fails: what cannot be looked at is
  // listed with its problem.
  std::vector<DeviceListing> (*find)();
  Result<std::unique_ptr<Device>> (*open)(const DeviceListing& listing, Detach detach);
};

}  // namespace gaitpad
