// The driving pad of a live session for other programs: its calibrated state goes to a virtual pad.
//
// A thread of its own looks at what the loop has published a thousand times a second and sends what
// has changed, so a stick reaches other programs at most a tick and a millisecond late.
#pragma once
#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "base/latest.h"
#include "drivers/virtual_pad.h"
#include "gaitpad/pads.h"
#include "gaitpad/result.h"

namespace gaitpad {

// The driving pad after a tick. At rest if no pad is plugged in.
struct ForwardedTick {
  VirtualPadState state;
  PressCounts presses{};
};
// `stick`: of that tick.
ForwardedTick forwarded_tick(const Pads& pads, const Stick& stick) noexcept;
// The state to send between two ticks so that no press is missed: a button that is as it was, but
// was pressed in between, is turned over. `after` itself if there is none.
VirtualPadState between(const ForwardedTick& before, const ForwardedTick& after) noexcept;

class PadForward {
 public:
  // The errors of VirtualPad::create().
  static Result<std::unique_ptr<PadForward>> open();
  ~PadForward() { stop(); }

  void start();
  void stop();
  std::string node() const { return pad_->node(); }
  // Where the loop writes.
  Latest<ForwardedTick>& newest() noexcept { return newest_; }

 private:
  explicit PadForward(std::unique_ptr<VirtualPad> pad) : pad_(std::move(pad)) {}
  void run();

  std::unique_ptr<VirtualPad> pad_;
  Latest<ForwardedTick> newest_;
  std::atomic<bool> is_ending_{false};
  std::thread thread_;
};

}  // namespace gaitpad
