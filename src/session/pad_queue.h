// The reports of all pads on their way from the I/O thread to the one reader: a wait-free ring, and
// behind it what found no room.
//
// A reader that falls behind finds, once it reads again, what was in the ring, then the newest
// state of each device: the last input report of each report id. What was left out is counted.
// Plugging and commands are never left out, and a device's reports stay in their order.
#pragma once
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>

#include "base/spsc_ring.h"
#include "hid/report.h"
#include "hid/trace.h"
#include "session/wake_fd.h"

namespace gaitpad {

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
