// File descriptors, things to wait for in poll(), and time.
#pragma once
#include <sys/eventfd.h>
#include <sys/timerfd.h>
#include <time.h>
#include <unistd.h>

#include <cstdint>
#include <utility>

namespace gaitpad {

// Closes the descriptor that it owns; -1: none.
class OwnedFd {
 public:
  explicit OwnedFd(int fd = -1) noexcept : fd_(fd) {}
  OwnedFd(OwnedFd&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  OwnedFd& operator=(OwnedFd&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~OwnedFd() {
    if (fd_ >= 0) ::close(fd_);
  }
  int get() const noexcept { return fd_; }

 private:
  int fd_;
};

// The time of CLOCK_MONOTONIC, as in Report::time_ns.
inline std::int64_t now_ns() noexcept {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

// Sleeps until that time; returns at once if it is over. A signal may end the sleep early.
inline void sleep_until(std::int64_t time_ns) noexcept {
  const timespec until = {static_cast<time_t>(time_ns / 1'000'000'000),
                          static_cast<long>(time_ns % 1'000'000'000)};
  ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

// Makes an eventfd unreadable.
inline void clear_event(int fd) noexcept {
  std::uint64_t count = 0;
  static_cast<void>(!::read(fd, &count, sizeof count));
}

// One thread rings it, another waits for it.
class Bell {
 public:
  Bell() : fd_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}
  // Readable after ring(); -1: no file descriptors are left.
  int fd() const noexcept { return fd_.get(); }
  // Any thread; never waits.
  void ring() noexcept {
    const std::uint64_t one = 1;
    static_cast<void>(!::write(fd(), &one, sizeof one));
  }
  void clear() noexcept { clear_event(fd()); }

 private:
  OwnedFd fd_;
};

// Becomes readable at a set time.
class Timer {
 public:
  Timer() : fd_(::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC)) {}
  // Readable when the time has come; -1: no file descriptors are left.
  int fd() const noexcept { return fd_.get(); }
  // Makes fd() readable from this time of now_ns() on, and again after each period. 0: never; no
  // period.
  void set(std::int64_t time_ns, std::int64_t period_ns = 0) noexcept {
    const itimerspec moment{time_of(period_ns), time_of(time_ns)};
    ::timerfd_settime(fd(), TFD_TIMER_ABSTIME, &moment, nullptr);
  }
  // True if the time has come since the last call; fd() is then no longer readable.
  bool take() noexcept {
    std::uint64_t count = 0;
    return ::read(fd(), &count, sizeof count) == sizeof count;
  }

 private:
  static timespec time_of(std::int64_t ns) noexcept {
    return {static_cast<time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)};
  }
  OwnedFd fd_;
};

}  // namespace gaitpad
