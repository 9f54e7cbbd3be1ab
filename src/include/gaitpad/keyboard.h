// The keyboard as a pad with one stick: the keys set the stick's goal, the stick moves there
// smoothly and reports like any pad. It belongs to no driver: the code that reads the keys opens
// it.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>

#include "gaitpad/driver.h"
#include "gaitpad/math.h"
#include "gaitpad/result.h"

namespace gaitpad {

class Bell;

// The stick's goal, shared by the thread that reads the keys and the device.
class KeyboardStick {
 public:
  KeyboardStick();
  ~KeyboardStick();
  KeyboardStick(const KeyboardStick&) = delete;
  KeyboardStick& operator=(const KeyboardStick&) = delete;

  // Sets the stick's goal, +x right, +y forward; any thread, never waits. Shortened to length 1;
  // not-a-number is the centre.
  void steer(const vec2& wanted) noexcept;

  // For the device: the goal in steps of 1 / kFull.
  static constexpr int kFull = 32767;
  vec2 wanted() const noexcept;
  Bell& bell() noexcept { return *bell_; }  // Rings when the goal changes during sleep.
  void sleep() noexcept;                    // From now on a change rings the bell.

 private:
  const std::unique_ptr<Bell> bell_;
  std::atomic<std::uint32_t> wanted_{0};  // the goal as two 16-bit counts
  std::atomic<bool> is_awake_{false};
};

// The stick reaches its end in 0.15 s and its centre in 0.1 s. It sends a first report, then 250
// reports a second while it moves, and none while it stands. At rest it is exactly in the middle.
// Error: no file descriptors are left.
Result<std::unique_ptr<Device>> open_keyboard(std::shared_ptr<KeyboardStick> stick);

}  // namespace gaitpad
