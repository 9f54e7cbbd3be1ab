// The data that a driver delivers (a device and its reports) and the state that decode() makes of a
// report. Plain data.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gaitpad {

// Kinds of buses, with the numbers of Linux's linux/input.h. Other numbers occur and are kept.
enum class BusType : std::uint16_t {
  unknown = 0x00,
  usb = 0x03,
  bluetooth = 0x05,
  virtual_bus = 0x06,
  i2c = 0x18,
  host = 0x19,
};

// A device as its driver knows it; the driver fills it. For decoding your own pad `descriptor` is
// enough; the ids let config/pads recognise the model.
struct DeviceInfo {
  BusType bus = BusType::unknown;
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::uint16_t version = 0;
  // Driver that opened it: hidraw, usb, evdev, sdl, keyboard; empty: treated as hidraw.
  std::string driver;
  std::string name;
  std::string unique_id;                 // serial number or Bluetooth address; empty: none
  std::string physical_path;             // the port in the kernel's form
  std::vector<std::uint8_t> descriptor;  // HID report descriptor (HID 1.11, 6.2.2)
  std::string mapping;                   // a line of SDL's controller data base; empty: none
  bool operator==(const DeviceInfo&) const = default;
};

// Rates of turn about a pad's axes, rad/s: pitch (nose up), yaw and roll (to the left).
using TurnRates = std::array<double, 3>;
// The calibration of its gyroscope that a pad stores itself, in the counts of its reports.
struct FactoryGyro {
  std::array<double, 3> zero{};  // counts of each axis at rest
  std::array<double, 3> rad_s_per_count{};
};

enum class ReportKind : std::uint8_t {
  input,    // bytes as they were read; they begin with the report id if the descriptor has ids
  command,  // the bytes are text, for instance `style limp_left`; no device
  added,    // no bytes: the device was plugged in
  removed,  // no bytes: it was unplugged; its pad is neutral until it is added again
};

inline constexpr std::size_t kMaxReportBytes = 1024;
inline constexpr std::uint16_t kNoDevice = 0xffff;

// One report. A driver fills it, or a program that has its own pads.
struct Report {
  std::int64_t time_ns = 0;          // live: CLOCK_MONOTONIC; in a recording: its own clock
  std::uint16_t device = kNoDevice;  // index in the list of devices of a session or trace
  ReportKind kind = ReportKind::input;
  std::uint16_t size = 0;  // at most kMaxReportBytes; a longer one is no report
  // The content, of which the first `size` bytes are set.
  std::array<std::uint8_t, kMaxReportBytes> bytes;
};
// The text of a command.
inline std::string_view text_of(const Report& r) noexcept {
  return {reinterpret_cast<const char*>(r.bytes.data()),
          std::min<std::size_t>(r.size, r.bytes.size())};
}

// Indices into PadState::axis. Sticks -1..1, +x right, +y forward (away from the player); triggers
// 0..1.
enum PadAxis : int {
  kLeftX,
  kLeftY,
  kRightX,
  kRightY,
  kLeftTrigger,
  kRightTrigger,
  kAxisCount,
};
// True for the y of sticks: HID's grows towards the player, ours away from the player.
constexpr bool is_upward(PadAxis axis) { return axis == kLeftY || axis == kRightY; }

// Bit numbers in PadState::buttons, named by position as in SDL: `a` is the bottom one of four.
enum PadButton : int {
  kButtonA,
  kButtonB,
  kButtonX,
  kButtonY,
  kButtonBack,
  kButtonGuide,
  kButtonStart,
  kButtonLeftStick,
  kButtonRightStick,
  kButtonLeftShoulder,
  kButtonRightShoulder,
  kButtonDpadUp,
  kButtonDpadDown,
  kButtonDpadLeft,
  kButtonDpadRight,
  kButtonMisc1,
  kButtonPaddle1,
  kButtonPaddle2,
  kButtonPaddle3,
  kButtonPaddle4,
  kButtonTouchpad,
  kButtonMisc2,
  kButtonMisc3,
  kButtonMisc4,
  kButtonMisc5,
  kButtonMisc6,
  kButtonCount,
};

inline constexpr std::array<std::string_view, kAxisCount> kAxisNames = {
    "left_x", "left_y", "right_x", "right_y", "left_trigger", "right_trigger"};
inline constexpr std::array<std::string_view, kButtonCount> kButtonNames = {"a",
                                                                            "b",
                                                                            "x",
                                                                            "y",
                                                                            "back",
                                                                            "guide",
                                                                            "start",
                                                                            "leftstick",
                                                                            "rightstick",
                                                                            "leftshoulder",
                                                                            "rightshoulder",
                                                                            "dpup",
                                                                            "dpdown",
                                                                            "dpleft",
                                                                            "dpright",
                                                                            "misc1",
                                                                            "paddle1",
                                                                            "paddle2",
                                                                            "paddle3",
                                                                            "paddle4",
                                                                            "touchpad",
                                                                            "misc2",
                                                                            "misc3",
                                                                            "misc4",
                                                                            "misc5",
                                                                            "misc6"};

// Directions of a hat, clockwise from up in steps of 45 degrees.
enum class Hat : std::uint8_t {
  up,
  up_right,
  right,
  down_right,
  down,
  down_left,
  left,
  up_left,
  released,
};

// A decoded pad; decode() fills it. Axes are scaled by the logical range of their fields and not
// calibrated: a stick may rest beside 0 and reach less than 1 (calibration.h corrects that).
struct PadState {
  std::array<float, kAxisCount> axis{};
  std::uint32_t buttons = 0;  // bit k: PadButton k is pressed; the D-pad's buttons are included
  Hat hat = Hat::released;
  bool operator==(const PadState&) const = default;
};
inline bool pressed(const PadState& pad, PadButton button) noexcept {
  return ((pad.buttons >> button) & 1u) != 0;
}

}  // namespace gaitpad
