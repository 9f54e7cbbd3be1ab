// A bell that one thread rings and another waits for in poll().
#pragma once
#include <sys/eventfd.h>

#include <cstdint>

#include "drivers/posix.h"

namespace gaitpad {

class WakeFd {
 public:
  WakeFd() : fd_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}
  int fd() const noexcept { return fd_.get(); }  // -1: no file descriptors are left
  // Any thread; never waits.
  void ring() noexcept {
    const std::uint64_t one = 1;
    static_cast<void>(!::write(fd(), &one, sizeof(one)));
  }
  void clear() noexcept {
    std::uint64_t count = 0;
    static_cast<void>(!::read(fd(), &count, sizeof(count)));
  }

 private:
  const OwnedFd fd_;
};

}  // namespace gaitpad
