// The keyboard as a pad with one stick: keys say where the stick is to go, it moves there smoothly
// and reports like any pad. It is no driver: nothing finds it, whoever reads keys opens it.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <string_view>

#include "drivers/posix.h"
#include "gaitpad/driver.h"
#include "gaitpad/math.h"
#include "gaitpad/result.h"

namespace gaitpad {

// What is shared by the thread that reads the keys and the device.
class KeyboardStick {
 public:
  KeyboardStick();

  // Any thread, never waits: where the stick is to go, +x right, +y forward. What is longer than 1
  // is shortened; not-a-number is the centre.
  void steer(const vec2& wanted) noexcept;

  // The device's: as asked for, in counts over kFull.
  static constexpr int kFull = 32767;
  vec2 wanted() const noexcept;
  int fd() const noexcept { return fd_.get(); }  // readable after a change while it slept; -1: none
  void sleep() noexcept;                         // the next change makes fd() readable

 private:
  const OwnedFd fd_;
  std::atomic<std::uint32_t> wanted_{0};  // two 16-bit counts
  std::atomic<bool> is_awake_{false};
};

// A stick reaches its end in 0.15 s and its centre in 0.1 s; while it moves there are 250 reports a
// second, else none but a first one. At rest it stands in the exact middle.
Result<std::unique_ptr<Device>> open_keyboard(std::shared_ptr<KeyboardStick> stick);

}  // namespace gaitpad
