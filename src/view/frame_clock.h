// When frames are drawn, how many there are in a second, how many reports a pad sends meanwhile.
#pragma once
#include <cstdint>

namespace gaitpad {

class FrameClock {
 public:
  // Between two frames at least so long; 0: no limit.
  void set_least(double seconds) noexcept { least_s_ = seconds; }
  // A frame begins: seconds since the last one did, at most a quarter.
  double begin(std::int64_t now_ns) noexcept;
  // Sleeps until the next frame may begin.
  void wait() noexcept;
  std::int64_t now_ns() const noexcept { return now_ns_; }  // when the running frame began
  double passed_s() const noexcept { return passed_s_; }

  double frames_per_second() const noexcept { return shown_; }  // of the last half second
  // Of all frames behind the first ones, in which shaders are made.
  double mean_frames_per_second() const noexcept;

  // Of a count that grows: per second, over the last second.
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
