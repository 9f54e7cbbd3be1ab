// What a driver delivers (a device and its reports) and what a decoder makes of it (the pad's
// state).
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gaitpad {

// The numbers of Linux's input.h. Others occur and are kept as they are.
enum class BusType : std::uint16_t {
  unknown = 0x00,
  usb = 0x03,
  bluetooth = 0x05,
  virtual_bus = 0x06,
  i2c = 0x18,
  host = 0x19,
};

struct DeviceInfo {
  BusType bus = BusType::unknown;
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::uint16_t version = 0;
  std::string driver;  // who opened it: hidraw, usb, evdev, sdl
  std::string name;
  std::string unique_id;      // serial number or Bluetooth address, empty where there is none
  std::string physical_path;  // the port it hangs on
  std::vector<std::uint8_t> descriptor;
  std::string mapping;  // a line of SDL's controller data base (hid/sdl_mapping.h), empty: none
  bool operator==(const DeviceInfo&) const = default;
};

enum class ReportKind : std::uint8_t {
  input,    // bytes as read: the report id first where the descriptor has ids
  command,  // bytes are text, for instance `style limp_left`; belongs to no device
  added,    // no bytes: the device was plugged in
  removed,  // no bytes: it is gone, its pad is neutral until it is added again
};

inline constexpr std::size_t kMaxReportBytes = 1024;
inline constexpr std::uint16_t kNoDevice = 0xffff;

struct Report {
  std::int64_t time_ns = 0;
  std::uint16_t device = kNoDevice;  // index in the session's list of devices
  ReportKind kind = ReportKind::input;
  std::uint16_t size = 0;
  std::array<std::uint8_t, kMaxReportBytes> bytes;  // only the first `size` are set
};
inline std::string_view text_of(const Report& r) noexcept {
  return {reinterpret_cast<const char*>(r.bytes.data()), r.size};
}

// Sticks -1..1, +x right, +y forward (away from the thumb's owner); triggers 0..1.
enum PadAxis : int {
  kLeftX,
  kLeftY,
  kRightX,
  kRightY,
  kLeftTrigger,
  kRightTrigger,
  kAxisCount,
};

// Bit numbers in PadState::buttons. Named by position as in SDL: `a` is the bottom button.
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
                                                                            "touchpad"};

// Clockwise in steps of 45 degrees.
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

// Decoded by the descriptor's logical range, uncalibrated.
struct PadState {
  std::array<float, kAxisCount> axis{};
  std::uint32_t buttons = 0;
  Hat hat = Hat::released;
  bool operator==(const PadState&) const = default;
};
inline bool pressed(const PadState& pad, PadButton button) noexcept {
  return ((pad.buttons >> button) & 1u) != 0;
}

}  // namespace gaitpad
