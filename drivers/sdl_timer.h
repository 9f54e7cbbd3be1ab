// When to look at SDL's joysticks: it has nothing to wait for.
#pragma once
#include <sys/timerfd.h>

#include <cstdint>
#include <memory>
#include <mutex>

#include "drivers/posix.h"

namespace gaitpad {

// All open devices share it: whoever finds it expired updates SDL for all of them.
class MillisecondTimer {
 public:
  MillisecondTimer() : fd_(::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC)) {
    constexpr timespec kMillisecond{0, 1'000'000};
    const itimerspec times{kMillisecond, kMillisecond};
    ::timerfd_settime(fd(), 0, &times, nullptr);
  }
  int fd() const noexcept { return fd_.get(); }  // below 0: there is none
  bool take_tick() const noexcept {
    std::uint64_t count = 0;
    return ::read(fd(), &count, sizeof count) == sizeof count;
  }
  static std::shared_ptr<MillisecondTimer> shared() {
    static std::mutex mutex;
    static std::weak_ptr<MillisecondTimer> running;
    const std::lock_guard lock(mutex);
    auto timer = running.lock();
    if (!timer) running = timer = std::make_shared<MillisecondTimer>();
    return timer;
  }

 private:
  OwnedFd fd_;
};

}  // namespace gaitpad
