// A bell that one thread rings and another waits for in poll().
#pragma once
#include <sys/eventfd.h>
#include <unistd.h>

#include <cstdint>

namespace gaitpad {

class WakeFd {
 public:
  WakeFd() : fd_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}
  WakeFd(const WakeFd&) = delete;
  WakeFd& operator=(const WakeFd&) = delete;
  ~WakeFd() {
    if (fd_ >= 0) ::close(fd_);
  }
  int fd() const noexcept { return fd_; }  // -1: no file descriptors are left
  // Any thread; never waits.
  void ring() noexcept {
    const std::uint64_t one = 1;
    static_cast<void>(!::write(fd_, &one, sizeof(one)));
  }
  void clear() noexcept {
    std::uint64_t count = 0;
    static_cast<void>(!::read(fd_, &count, sizeof(count)));
  }

 private:
  const int fd_;
};

}  // namespace gaitpad
