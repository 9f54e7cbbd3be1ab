// Times frames: when each begins, how many there are per second, and how late one may begin for the
// display.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

namespace gaitpad {

// Begins a frame as late as the display allows, so that it shows the newest reports. A frame that
// is drawn right after a refresh would wait until the next one, and its state would grow old.
//
// The display's period is measured: of every kCycle frames the first kMeasured begin at once, and
// the median distance between their refreshes is the period.
class FramePacer {
 public:
  static constexpr int kCycle = 1024, kMeasured = 16;
  static constexpr std::int64_t kShortest_ns = 2'000'000, kLongest_ns = 50'000'000;
  // Planned time between a picture's end and the refresh that shows it.
  static constexpr std::int64_t kMargin_ns = 2'000'000;

  // Time at which the next frame should begin, not before `free_ns`, the time at which the display
  // took the last one.
  std::int64_t begin_ns(std::int64_t free_ns) noexcept;
  // Reports the time from a frame's begin until it was ready for the display.
  void note_work(std::int64_t work_ns) noexcept;
  void start_again() noexcept { *this = {}; }

 private:
  void measure(std::int64_t free_ns) noexcept;

  std::array<std::int64_t, kMeasured> distances_ns_{};
  int frame_ = 0;  // number of the frame in its cycle
  std::int64_t last_free_ns_ = 0;
  // Display's period; 0: unknown, or the display does not limit the frames.
  std::int64_t period_ns_ = 0;
  std::int64_t work_ns_ = 0;  // longest time that one of the last frames took
  std::int64_t margin_ns_ = kMargin_ns;
};

// Times the frames, counts them, and measures the rate of a pad's reports.
class FrameClock {
 public:
  // Least time between two frames; 0: no limit.
  void set_least(double seconds) noexcept { least_s_ = seconds; }
  // Returns the seconds since the last frame began, at most 0.25.
  double begin_frame(std::int64_t now_ns) noexcept;
  // Sleeps until the next frame may begin.
  void wait_for_next() noexcept;
  std::int64_t now_ns() const noexcept { return now_ns_; }  // The time at which this frame began.
  double passed_s() const noexcept { return passed_s_; }

  double frames_per_second() const noexcept { return shown_; }  // Mean over the last half second.
  // Mean over all frames except the first few, which compile shaders.
  double mean_frames_per_second() const noexcept;

  // Growth of a count per second, over the last second.
  double rate_hz(std::uint64_t count) noexcept;

 private:
  double least_s_ = 0.0, passed_s_ = 0.0, shown_ = 0.0;
  std::int64_t now_ns_ = 0, due_ns_ = 0, shown_since_ns_ = 0, warm_ns_ = 0;
  std::int64_t frames_ = 0, shown_frames_ = 0;
  std::int64_t counted_ns_ = 0;
  std::uint64_t counted_ = 0;
  double rate_hz_ = 0.0;
};

}  // namespace gaitpad
