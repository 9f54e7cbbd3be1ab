// File descriptors, and two of them to wait for in poll(): a bell and a timer.
#pragma once
#include <sys/eventfd.h>
#include <sys/timerfd.h>
#include <time.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
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

// Writes all bytes. Returns 0, or the errno of the write that failed.
int write_all(int fd, std::string_view bytes) noexcept;

// Reads what can be read without waiting. Returns the number of bytes, 0 at the end of the input
// or on an error; nothing if there is no input at present.
std::optional<std::size_t> read_ready(int fd, std::span<char> bytes) noexcept;

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
