// The driving pad of a live session for other programs: its calibrated state goes to a virtual pad.
//
// A thread of its own sends what a tick has changed; the loop wakes it only then. A stick reaches
// other programs at most a tick late. `gaitpad forward` has no ticks: pads/stand_in.h.
#pragma once
#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "base/latest.h"
#include "drivers/posix.h"
#include "drivers/virtual_pad.h"
#include "gaitpad/pads.h"
#include "gaitpad/result.h"

namespace gaitpad {

// The driving pad after a tick. At rest if no pad is plugged in.
struct ForwardedTick {
  VirtualPadState state;
  PressCounts presses{};
};
bool is_same(const ForwardedTick& a, const ForwardedTick& b) noexcept;
// `stick`: of that tick.
ForwardedTick forwarded_tick(const Pads& pads, const Stick& stick) noexcept;
// The state to send between two ticks so that no press is missed: a button that is as it was, but
// was pressed in between, is turned over. `after` itself if there is none.
VirtualPadState between(const ForwardedTick& before, const ForwardedTick& after) noexcept;

// The newest tick on its way from the loop to the thread that sends it.
class ForwardMail {
 public:
  // From the loop, after each tick. Without heap or lock; a system call where something has
  // changed.
  void put(const ForwardedTick& tick) noexcept;
  // Waits for a change, or for wake().
  void wait() noexcept;
  void wake() noexcept { bell_.ring(); }
  const ForwardedTick& read(bool& is_new) noexcept { return newest_.read(is_new); }

 private:
  ForwardedTick put_;  // the loop's
  Latest<ForwardedTick> newest_;
  Bell bell_;
};

class PadForward {
 public:
  // The errors of XboxPad::create().
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
