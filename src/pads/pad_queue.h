// A bell that one thread rings and another waits for in poll().
#pragma once
#include <sys/eventfd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/spsc_ring.h"
#include "drivers/posix.h"
#include "gaitpad/report.h"
#include "gaitpad/trace.h"

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

// Sentences for the user from any thread, until somebody takes them.

class Remarks {
 public:
  void add(std::string sentence) {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() < kMaxWaiting) waiting_.push_back(std::move(sentence));
  }
  void add_once(const std::string& sentence) {
    const std::lock_guard lock(mutex_);
    if (said_.size() >= kMaxSaid || waiting_.size() >= kMaxWaiting) return;
    if (said_.insert(sentence).second) waiting_.push_back(sentence);
  }
  std::vector<std::string> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(waiting_, {});
  }

 private:
  static constexpr std::size_t kMaxWaiting = 256, kMaxSaid = 4096;
  std::mutex mutex_;
  std::vector<std::string> waiting_;
  std::set<std::string> said_;
};

// The reports of all pads on their way from the I/O thread to the one reader: a wait-free ring, and
// behind it what found no room.
//
// A reader that falls behind finds, once it reads again, what was in the ring, then the newest
// state of each device: the last input report of each report id. What was left out is counted.
// Plugging and commands are never left out, and a device's reports stay in their order.

class PadQueue {
 public:
  explicit PadQueue(std::size_t capacity) : ring_(capacity) {}  // a power of two
  bool is_open() const noexcept { return bell_.fd() >= 0; }

  // The I/O thread. `report_id` is 0 where the device has none; device < kMaxTraceDevices or
  // kNoDevice.
  void push(const Report& report, std::uint8_t report_id);
  // Moves what waits into the ring. True: nothing waits any more.
  bool flush();
  bool is_waiting() const noexcept { return !waiting_.empty(); }
  // So much waits that no more can be taken: sources are to be left alone until flush().
  bool is_blocked() const noexcept { return waiting_.size() >= kMaxWaiting; }
  // Wakes the reader if it sleeps in wait(); once for many reports.
  void wake_reader() noexcept;

  // The reader.
  const Report* front() noexcept { return ring_.front(); }
  void pop() noexcept { ring_.pop(); }
  void wait(std::chrono::milliseconds timeout);

  // Any thread. Reports written to the ring; input reports left out.
  std::int64_t written() const noexcept { return written_.load(std::memory_order_relaxed); }
  std::int64_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }

 private:
  static constexpr std::size_t kMaxWaiting = 8192;
  using HeldReports = std::array<Report*, 256>;  // in waiting_, by report id

  bool put(const Report& report) noexcept;
  void hold(const Report& report, std::uint8_t report_id);

  SpscRing<Report> ring_;
  struct Waiting {
    Report report;
    std::uint8_t report_id;
  };
  std::deque<Waiting> waiting_;  // its elements stay where they are
  std::array<HeldReports, kMaxTraceDevices> held_{};
  std::atomic<std::int64_t> written_{0}, lost_{0};
  std::atomic<bool> reader_sleeps_{false};
  WakeFd bell_;
};

}  // namespace gaitpad
