#include "session/pad_forward.h"

#include <poll.h>

#include <utility>

#include "system/threads.h"

namespace gaitpad {

bool is_same(const ForwardedTick& a, const ForwardedTick& b) noexcept {
  return a.state.stick.left == b.state.stick.left && a.state.stick.right == b.state.stick.right &&
         a.state.trigger == b.state.trigger && a.state.buttons == b.state.buttons &&
         a.presses == b.presses;
}

ForwardedTick forwarded_tick(const Pads& pads, const Stick& stick) noexcept {
  ForwardedTick tick;
  tick.state.stick = stick;
  tick.presses = pads.presses();
  const PadConfig* pad = pads.driving_pad();
  if (pad == nullptr || !pad->is_present) return tick;
  const PadState& state = pads.driving_state();
  const Calibration& calibration = pad->calibration;
  tick.state.trigger = {trigger_position(calibration.left_trigger, state.axis[kLeftTrigger]),
                        trigger_position(calibration.right_trigger, state.axis[kRightTrigger])};
  tick.state.buttons = state.buttons;
  return tick;
}

VirtualPadState between(const ForwardedTick& before, const ForwardedTick& after) noexcept {
  VirtualPadState state = after.state;
  for (int b = 0; b < kButtonCount; ++b) {
    const std::uint32_t bit = std::uint32_t{1} << b;
    const bool is_as_it_was = ((before.state.buttons ^ after.state.buttons) & bit) == 0;
    if (is_as_it_was && after.presses[b] != before.presses[b]) state.buttons ^= bit;
  }
  return state;
}

Result<std::unique_ptr<PadForward>> PadForward::open() {
  auto pad = XboxPad::create();
  if (!pad) return pad.error();
  return std::unique_ptr<PadForward>(new PadForward(std::move(*pad)));
}

void PadForward::start() {
  thread_ = std::thread([this] { run(); });
}

void PadForward::stop() {
  is_ending_ = true;
  mail_.wake();
  if (thread_.joinable()) thread_.join();
}

void ForwardMail::put(const ForwardedTick& tick) noexcept {
  if (is_same(tick, put_)) return;
  put_ = tick;
  newest_.writable() = tick;
  newest_.publish();
  bell_.ring();
}

void ForwardMail::wait() noexcept {
  pollfd ready = {bell_.fd(), POLLIN, 0};
  ::poll(&ready, 1, -1);
  bell_.clear();
}

void PadForward::run() {
  name_thread("gaitpad-forward");
  ForwardedTick sent;
  while (!is_ending_) {
    mail_.wait();
    bool is_new = false;
    const ForwardedTick& tick = mail_.read(is_new);
    if (!is_new) continue;
    // An event that the kernel refuses is lost; the next change sends the next event.
    static_cast<void>(pad_.set(between(sent, tick)));
    static_cast<void>(pad_.set(tick.state));
    sent = tick;
  }
}

}  // namespace gaitpad
