// The I/O thread: reads all open devices, stamps and orders their reports, sets motors, lets go of
// what is gone.
#pragma once
#include <poll.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "base/spsc_ring.h"
#include "gaitpad/driver.h"
#include "pads/pad_queue.h"

namespace gaitpad {

// A device that has just been opened.
struct OpenedPad {
  std::unique_ptr<Device> device;
  std::uint16_t index = 0;      // of its reports, < kMaxTraceDevices
  std::uint64_t id = 0;         // of this opening
  bool has_report_ids = false;  // the first byte of a report is its id
  bool is_recording = false;    // its end is no unplugging that needs a word
  bool is_keyboard = false;     // no pad: it is not counted as one that was plugged in
  std::string name;             // for sentences
};

struct PadCounters {
  std::atomic<std::int64_t> lost{0};  // by the sources
  std::atomic<std::int64_t> plugged{0}, unplugged{0};
};

class PadIo {
 public:
  // `gone` is called on the I/O thread and closes the device on another one: giving a pad back to
  // the kernel takes up to half a second, in which the other pads are read.
  using Gone = std::function<void(std::uint64_t id, std::unique_ptr<Device> device)>;
  PadIo(PadQueue& queue, PadCounters& counters, Remarks& remarks, Gone gone);
  ~PadIo() { stop(); }
  bool is_open() const noexcept { return bell_.fd() >= 0; }
  void start();
  void stop();  // ends the thread and closes what is still open

  void take_over(OpenedPad pad);        // the finder
  void command(std::string_view text);  // any thread
  void rumble(std::uint16_t device, const Rumble& rumble,
              std::chrono::milliseconds duration) noexcept;  // one thread, wait-free

 private:
  using Clock = std::chrono::steady_clock;
  struct Pad {
    OpenedPad opened;
    bool is_ready = true;      // it may have something to read
    bool is_present = false;   // as announced
    std::int64_t last_ns = 0;  // stamps of one device never go back
    std::int64_t lost = 0;     // as last asked for
    bool is_running = false;   // the motors
    Clock::time_point motor_end;
    // Ready, but nothing to read: within the running window, and with an error since the last
    // report.
    int idle_wakes = 0, error_wakes = 0;
    bool has_error = false;  // as the last poll() says
    Clock::time_point window_end;
  };
  struct MotorWish {
    std::uint16_t device;
    Rumble rumble;
    std::int32_t duration_ms;
  };

  void run();
  int timeout_ms(Clock::time_point now) const;
  void wait_for_fds();
  void take_pads();
  void take_commands();
  void take_motor_wishes();
  void stop_motors(Clock::time_point now);
  enum class Reading { goes_on, unplugged, failed };
  Reading read(Pad& pad);
  Reading count_idle_wake(Pad& pad);
  void deliver(Pad& pad, Report& report);
  void announce(Pad& pad, ReportKind kind, std::int64_t time_ns);
  void count_lost(Pad& pad);
  void end(Pad& pad, Reading how);
  void read_all();
  void take_remarks(Pad& pad);
  void look_after(Clock::time_point now);

  PadQueue& queue_;
  PadCounters& counters_;
  Remarks& remarks_;
  const Gone gone_;

  WakeFd bell_;
  std::atomic<bool> is_ending_{false};
  std::mutex mutex_;  // of the two below
  std::vector<OpenedPad> handed_;
  std::deque<std::string> commands_;
  SpscRing<MotorWish> motor_wishes_{64};

  // The I/O thread's own.
  std::vector<std::unique_ptr<Pad>> pads_;
  std::vector<pollfd> fds_;
  std::vector<Pad*> fd_owners_;  // of fds_ from the second on
  std::int64_t now_ns_ = 0;      // after the last wait
  Clock::time_point looked_after_;
  std::chrono::nanoseconds busy_{0};  // processor time until then
  std::thread thread_;
};

}  // namespace gaitpad
