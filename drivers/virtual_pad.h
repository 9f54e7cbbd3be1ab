// A pad that the kernel shows to every program, made by uinput: its state comes from a real or
// recorded pad. XboxPad states the layout of Linux's gamepads (Documentation/input/gamepad.rst in
// the kernel) with the codes of the Xbox pads' driver, which games and SDL know without a mapping.
#pragma once
#include <poll.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "drivers/effect_table.h"
#include "gaitpad/report.h"
#include "gaitpad/result.h"
#include "gaitpad/stick.h"

namespace gaitpad {

// An event of Linux's evdev.
struct VirtualPadEvent {
  std::uint16_t type = 0, code = 0;
  std::int32_t value = 0;
  bool operator==(const VirtualPadEvent&) const = default;
};
struct VirtualPadAxis {
  std::uint16_t code = 0;
  std::int32_t min = 0, max = 0;
  bool operator==(const VirtualPadAxis&) const = default;
};

// The properties of a virtual pad that programs see. Its axes begin at 0 and its keys released.
struct VirtualPadShape {
  std::string name;
  BusType bus = BusType::virtual_bus;
  std::uint16_t vendor = 0, product = 0, version = 0;
  std::string port;  // the kernel's `phys`; VirtualPad::create() puts kVirtualPort before it
  std::vector<VirtualPadAxis> axes;
  std::vector<std::uint16_t> keys;
  std::vector<std::uint16_t> effects;  // codes of EV_FF: kinds of effects, and the gain
  bool operator==(const VirtualPadShape&) const = default;
};

// True if the device is such a pad, whatever its ids: gaitpad must not read its own output.
bool is_virtual_pad(const DeviceInfo& info) noexcept;
// Beginning of a virtual pad's port.
inline constexpr std::string_view kVirtualPort = "gaitpad/";

// A pad that the kernel has made; destroying the object unplugs it.
class VirtualPad {
 public:
  // Error: there is no /dev/uinput or no permission, or gaitpad was built without libevdev.
  static Result<std::unique_ptr<VirtualPad>> create(const VirtualPadShape& shape);
  virtual ~VirtualPad() = default;

  virtual std::string node() const = 0;  // Path of its node: /dev/input/event7.
  // Sends a packet and its SYN_REPORT; sends nothing if it is empty. False: the kernel has refused
  // it.
  virtual bool write(std::span<const VirtualPadEvent> events) noexcept = 0;
  // Readable when a program asks for an effect: the program waits until serve_effects() has
  // answered.
  virtual pollfd fd() const noexcept = 0;
  virtual void serve_effects(EffectTable& effects) noexcept = 0;
};

// ---- The Xbox pads' layout

struct VirtualPadState {
  Stick stick{};                    // the calibrated sticks
  std::array<double, 2> trigger{};  // left and right trigger; 0 released .. 1 pressed
  std::uint32_t buttons = 0;        // bits as in PadState::buttons
};

enum class XboxKind {
  calibrated,  // gaitpad's own name and ids, every button; triggers are 0..1023
  xbox_360,    // the pad that the kernel shows for an Xbox 360 pad; triggers are 0..255
};
VirtualPadShape shape_of(XboxKind kind);
// An axis's value at a stick's full deflection.
inline constexpr int kFullStick = 32767;

// The events that change one state into the other, without the SYN_REPORT at the end. y grows
// backwards; the D-pad is a hat.
std::vector<VirtualPadEvent> events_between(const VirtualPadState& from, const VirtualPadState& to,
                                            XboxKind kind = XboxKind::calibrated);

// A virtual pad of the kind XboxKind::calibrated.
class XboxPad {
 public:
  // Makes the pad in the kernel; errors are those of VirtualPad::create().
  static Result<XboxPad> create();
  std::string node() const { return pad_->node(); }
  // Sends the changes. False: the kernel has refused them.
  bool set(const VirtualPadState& state) noexcept;

 private:
  explicit XboxPad(std::unique_ptr<VirtualPad> pad) : pad_(std::move(pad)) {}
  std::unique_ptr<VirtualPad> pad_;
  VirtualPadState state_;
};

}  // namespace gaitpad
