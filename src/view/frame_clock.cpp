#include "view/frame_clock.h"

#include <time.h>

#include <algorithm>
#include <cerrno>

#include "drivers/posix.h"

namespace gaitpad {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kWarmFrames = 5;
constexpr double kLongest_s = 0.25;  // the machine slept: nothing jumps

}  // namespace

double FrameClock::begin(std::int64_t time_ns) noexcept {
  passed_s_ = now_ns_ == 0 ? 0.0 : static_cast<double>(time_ns - now_ns_) / 1e9;
  passed_s_ = std::clamp(passed_s_, 0.0, kLongest_s);
  now_ns_ = time_ns;
  if (frames_++ == kWarmFrames) warm_ns_ = time_ns;
  ++shown_frames_;
  if (shown_since_ns_ == 0) shown_since_ns_ = time_ns;
  if (const std::int64_t shown_ns = time_ns - shown_since_ns_; shown_ns > kSecond_ns / 2) {
    shown_ = static_cast<double>(shown_frames_) * 1e9 / static_cast<double>(shown_ns);
    shown_since_ns_ = time_ns;
    shown_frames_ = 0;
  }
  return passed_s_;
}

void FrameClock::wait() noexcept {
  if (least_s_ <= 0.0) return;
  const auto least_ns = static_cast<std::int64_t>(least_s_ * 1e9);
  // By the plan, not by the last frame: what one frame is late the next one may catch up.
  due_ns_ = std::max(due_ns_ + least_ns, now_ns_);
  if (due_ns_ <= gaitpad::now_ns()) return;
  const timespec due = {static_cast<time_t>(due_ns_ / kSecond_ns),
                        static_cast<long>(due_ns_ % kSecond_ns)};
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr) == EINTR) {
  }
}

double FrameClock::mean_frames_per_second() const noexcept {
  if (warm_ns_ == 0 || now_ns_ <= warm_ns_) return 0.0;
  return static_cast<double>(frames_ - 1 - kWarmFrames) * 1e9 /
         static_cast<double>(now_ns_ - warm_ns_);
}

double FrameClock::rate_hz(std::uint64_t count) noexcept {
  if (counted_ns_ == 0 || count < counted_) {  // another session counts from 0
    counted_ns_ = now_ns_;
    counted_ = count;
    rate_hz_ = 0.0;
  }
  if (const std::int64_t span_ns = now_ns_ - counted_ns_; span_ns >= kSecond_ns) {
    rate_hz_ = static_cast<double>(count - counted_) * 1e9 / static_cast<double>(span_ns);
    counted_ns_ = now_ns_;
    counted_ = count;
  }
  return rate_hz_;
}

}  // namespace gaitpad
