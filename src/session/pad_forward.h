// Forwards the calibrated state of a live session's driving pad to a virtual pad for other
// programs.
//
// A thread of its own sends the changes; the loop wakes it only if a tick has changed something. A
// stick's motion arrives at most one tick late. `gaitpad forward` has no ticks: pads/stand_in.h.
#pragma once
#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "base/latest.h"
#include "drivers/virtual_pad.h"
#include "gaitpad/pads.h"
#include "gaitpad/result.h"
#include "system/descriptors.h"

namespace gaitpad {

// State of the driving pad after a tick; a pad at rest if none is plugged in.
struct ForwardedTick {
  VirtualPadState state;
  PressCounts presses{};
};
bool is_same(const ForwardedTick& a, const ForwardedTick& b) noexcept;
// `stick`: the stick of that tick.
ForwardedTick forwarded_tick(const Pads& pads, const Stick& stick) noexcept;
// If a button was pressed and released between two ticks, the state to send first, with that button
// inverted, so that the press is not lost. Otherwise returns `after`.
VirtualPadState between(const ForwardedTick& before, const ForwardedTick& after) noexcept;

// Hands the newest tick from the loop to the sending thread.
class ForwardMail {
 public:
  // Called by the loop after each tick. No heap, no lock; a system call only if the state has
  // changed.
  void put(const ForwardedTick& tick) noexcept;
  // Waits for a change, or for wake().
  void wait() noexcept;
  void wake() noexcept { bell_.ring(); }
  const ForwardedTick& read(bool& is_new) noexcept { return newest_.read(is_new); }

 private:
  ForwardedTick put_;  // used by the loop only
  Latest<ForwardedTick> newest_;
  Bell bell_;
};

class PadForward {
 public:
  // Fails with the errors of XboxPad::create().
  static Result<std::unique_ptr<PadForward>> open();
  ~PadForward() { stop(); }

  void start();
  void stop();
  std::string node() const { return pad_.node(); }
  ForwardMail& mail() noexcept { return mail_; }

 private:
  explicit PadForward(XboxPad pad) : pad_(std::move(pad)) {}
  void run();

  XboxPad pad_;
  ForwardMail mail_;
  std::atomic<bool> is_ending_{false};
  std::thread thread_;
};

}  // namespace gaitpad
