#include "view/frame_clock.h"

#include <algorithm>

#include "system/clock.h"

namespace gaitpad {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kWarmFrames = 5;
// Longest time of a frame; longer after a suspended machine wakes up.
constexpr double kLongest_s = 0.25;

}  // namespace

// --- FramePacer

void FramePacer::measure(std::int64_t free_ns) noexcept {
  if (frame_ < kMeasured) distances_ns_[static_cast<std::size_t>(frame_)] = free_ns - last_free_ns_;
  if (frame_ == kMeasured) {
    const auto middle = distances_ns_.begin() + kMeasured / 2;
    std::nth_element(distances_ns_.begin(), middle, distances_ns_.end());
    const bool is_limited = *middle >= kShortest_ns && *middle <= kLongest_ns;
    period_ns_ = is_limited ? *middle : 0;
  }
}

std::int64_t FramePacer::begin_ns(std::int64_t free_ns) noexcept {
  const bool is_first = last_free_ns_ == 0, was_paced = frame_ > kMeasured && period_ns_ > 0;
  // A frame missed its refresh: begin the next ones earlier at once, and later again only slowly.
  if (was_paced && free_ns - last_free_ns_ > period_ns_ + period_ns_ / 2)
    margin_ns_ = std::min(margin_ns_ + kMargin_ns, period_ns_);
  margin_ns_ = std::max(kMargin_ns, margin_ns_ - kMargin_ns / kCycle);
  if (!is_first) {
    measure(free_ns);
    frame_ = frame_ + 1 == kCycle ? 0 : frame_ + 1;
  }
  last_free_ns_ = free_ns;
  if (frame_ <= kMeasured || period_ns_ == 0) return free_ns;
  return std::max(free_ns, free_ns + period_ns_ - work_ns_ - margin_ns_);
}

void FramePacer::note_work(std::int64_t work_ns) noexcept {
  work_ns_ = std::max(work_ns, work_ns_ - work_ns_ / 64);
}

// --- FrameClock

double FrameClock::begin_frame(std::int64_t time_ns) noexcept {
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

void FrameClock::wait_for_next() noexcept {
  if (least_s_ <= 0.0) return;
  const auto least_ns = static_cast<std::int64_t>(least_s_ * 1e9);
  // Counted from the planned time, so that the frame after a late one catches up.
  due_ns_ = std::max(due_ns_ + least_ns, now_ns_);
  while (gaitpad::now_ns() < due_ns_) sleep_until(due_ns_);  // a signal may end it early
}

double FrameClock::mean_frames_per_second() const noexcept {
  if (warm_ns_ == 0 || now_ns_ <= warm_ns_) return 0.0;
  return static_cast<double>(frames_ - 1 - kWarmFrames) * 1e9 /
         static_cast<double>(now_ns_ - warm_ns_);
}

double FrameClock::rate_hz(std::uint64_t count) noexcept {
  if (counted_ns_ == 0 || count < counted_) {  // a new session counts reports from 0
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
