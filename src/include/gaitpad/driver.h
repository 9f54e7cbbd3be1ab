// The driver contract. A driver is two functions: one finds the devices of its source, one opens
// such a device. An open device delivers its reports as bytes and never interprets them. If its
// source has no report descriptor, the driver builds one that states the layout of its reports.
//
// Threads  `find` is called by one thread (the finder's), `open` by a thread for each pad: never
//          twice at once for one pad, at any time for several. It may take long: two seconds to
//          start a pad, three more until the kernel's driver has started it, five for a request
//          that the pad does not answer. An open Device belongs to the I/O thread, which makes all
//          further calls; another thread may destroy it. A driver never calls back from a thread
//          of its own; a thread that only talks to the pad is allowed (hidraw).
// Blocking No call of Device waits for a report: the I/O thread sleeps in poll() over the
//          `poll_fds` of all devices. A few calls take as long as the system takes: clearing a
//          stalled endpoint (usb), a joystick that SDL has just found (sdl), closing.
// Memory   Everything may allocate: nothing here runs on the loop thread.
// Owning   A Device owns its handles and closes them in its destructor. There it also gives back
//          what it took from the kernel: a detached driver, running motors.
// Unplug   `read` returns `gone` after everything that came before it was read. A stall, a refused
//          packet or an interrupted call is no unplugging: the device recovers or counts it as
//          lost. A device that is plugged in again is a new Device.
// Time     Report::time_ns is CLOCK_MONOTONIC: the kernel's stamp if the source has one (evdev),
//          else the time at which the report was seen.
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

// DeviceInfo::driver of the keyboard as a pad (keyboard.h). It drives while no other pad is
// deflected, live and in a recording.
inline constexpr std::string_view kKeyboardDriver = "keyboard";

// Strengths of both motors, 0..65535 as in Linux's ff_rumble_effect. The strong motor is the slow,
// heavy one. The caller fills it.
struct Rumble {
  std::uint16_t strong = 0, weak = 0;
};

// The calibration of an axis that a pad stores itself, as its driver reads it; nonsense is not
// used. Raw positions as in calibration.h: fractions of half the logical range from its middle, +x
// right, +y forward.
struct FactoryAxis {
  double min = -1.0, centre = 0.0, max = 1.0;
};
struct FactorySticks {
  FactoryAxis left_x, left_y, right_x, right_y;
};

class Device {
 public:
  enum class Status {
    report,   // `report` is filled: time_ns, size, bytes, kind (not its device). kind is input;
              // of a recording also added or removed
    nothing,  // there is no report now
    gone,     // the device is unplugged
  };
  virtual ~Device() = default;

  virtual const DeviceInfo& info() const noexcept = 0;
  // The file descriptors to poll. When one of them is ready, call `read` until it returns
  // `nothing`. They may change after a read.
  virtual std::span<const pollfd> poll_fds() const noexcept = 0;
  virtual Status read(Report& report) noexcept = 0;
  // From now on `read` returns every packet that the source gives, even packets that are no input.
  // For recordings; it has no effect if the source has only reports.
  virtual void hand_on_raw() noexcept {}

  // Sets the motors until the next call. False: the pad has none, or the packet was not sent.
  virtual bool rumble(const Rumble&) noexcept { return false; }
  // The sticks' stored calibration. None: the pad stores none, or it was not read.
  virtual std::optional<FactorySticks> factory_sticks() const { return std::nullopt; }
  virtual std::optional<FactoryGyro> factory_gyro() const { return std::nullopt; }
  // Number of reports that are known to be lost or refused since the device was opened
  // (SYN_DROPPED, overruns, a wrong checksum, a stalled endpoint).
  virtual std::int64_t lost() const noexcept { return 0; }
  // Remarks for the user about a pad that works, one sentence each. Each is returned once.
  virtual std::vector<std::string> take_remarks() { return {}; }
};

// A device that a driver sees, open or not. The driver fills it.
struct DeviceListing {
  DeviceInfo info;   // without a descriptor if reading that needs opening the device
  std::string node;  // path: /dev/hidraw3, /dev/input/event5, /dev/bus/usb/001/004, walk.hid
  // Equal for one pad on all drivers: the sysfs folder of its USB interface, else of its HID
  // device, else of its input device.
  std::string pad_path;
  std::vector<std::string> parts;  // pad paths of the devices that this one joins; empty: none
  // Kernel driver bound to the device: hid-generic, xpad, playstation; empty: none or unknown.
  std::string kernel_driver;
  double poll_rate_hz = 0.0;  // polling rate that the endpoint's descriptor states; 0: unknown
  bool is_other = false;      // it is known to be no pad: a keyboard, the motion sensor of a pad
  // One sentence: why it cannot be opened, or what other device it is; empty: usable.
  std::string problem;
};

// Whether a kernel driver may be detached while the device is open (usb only).
enum class Detach { never, allowed };

struct DriverEntry {
  const char* name;
  const char* library;  // name of the library that the driver needs, for messages
  // `find` and `open` are null if gaitpad was built without the library. `find` never fails: a
  // device that it cannot look at is listed with its problem. The error of `open` is one sentence
  // that names the node.
  std::vector<DeviceListing> (*find)();
  Result<std::unique_ptr<Device>> (*open)(const DeviceListing& listing, Detach detach);
};

}  // namespace gaitpad
