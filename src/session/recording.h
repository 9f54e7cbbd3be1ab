// Records a session, or pads alone, into a trace while it runs, on a thread of its own.
#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/result.h"
#include "base/spsc_ring.h"
#include "drivers/posix.h"
#include "session/recording_lines.h"

namespace gaitpad {

// Written to FILE.part, which takes FILE's name at the end; what stood there before is kept until
// then. A program that is killed leaves FILE.part behind: it replays as far as it goes.
class Recording {
 public:
  struct Options {
    std::string path;
    std::optional<int> rate_hz;  // of the ticks; none: there is no loop, times alone count
    RecordingLines::Limits limits;
  };
  // `devices` is called on the recording's thread, for devices of reports that were given to add().
  static Result<std::unique_ptr<Recording>> start(const Options& options, RecordedDevices devices);
  ~Recording();

  // All from one thread, wait-free: `tick` used the report; it began at that time and the next ones
  // follow at the rate times the pace (0: they stand still).
  void add(std::int64_t tick, const Report& report) noexcept;
  void clock(std::int64_t tick, std::int64_t time_ns, double pace = 1.0) noexcept;

  // Reports that are missing: found no room here or in the file. It is then no exact recording.
  std::int64_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }
  // One sentence once the file could not be written; what stands in it replays. Any thread.
  std::optional<Error> problem() const;
  // Ends with so many ticks run; sentences that a user should know. Once.
  Result<std::vector<std::string>> finish(std::int64_t ticks, std::int64_t time_ns);

 private:
  struct Item {
    std::int64_t tick = 0;
    std::int64_t clock_ns = kNoClock;  // else there is no report
    double pace = 1.0;
    Report report;
  };
  static constexpr std::int64_t kNoClock = -1;

  Recording(const Options& options, RecordedDevices devices, OwnedFd file);
  void run();
  void take_all();
  void write(std::string_view text);
  void end_thread();
  std::vector<std::string> remarks() const;

  std::string path_, part_;
  OwnedFd file_;
  std::int64_t written_ = 0;     // bytes, whole lines
  std::atomic<int> problem_{0};  // errno of the first write that failed
  RecordingLines lines_;
  SpscRing<Item> ring_;
  std::atomic<std::int64_t> lost_{0};
  std::mutex mutex_;
  std::condition_variable ending_;
  bool is_ending_ = false;
  std::thread thread_;
};

}  // namespace gaitpad
