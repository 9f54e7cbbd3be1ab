// Estimates how many reports a pad sent in vain to a source that keeps a few of them for a slow
// reader and drops further ones without notice.
#pragma once
#include <algorithm>
#include <cstdint>

namespace gaitpad {

// The source was full once so many reports were read without finding it empty. How many were
// dropped then is told by the time: the pad's fastest rate so far times the time since the source
// was last empty, less those that came. So the estimate is no less than the truth for a pad that
// does not become faster, and at least 1 each time.
class MissedReports {
 public:
  explicit MissedReports(std::int64_t capacity) : capacity_(capacity) {}

  void note_report(std::int64_t now_ns) noexcept {
    // What waited when the reader came first is not counted: it was sent while the pad was opened.
    if (empty_ns_ == 0) {
      empty_ns_ = now_ns;
      waiting_ = -capacity_;
    }
    ++in_a_row_;
    if (++waiting_ < capacity_) return;
    pending_ = std::max({pending_, std::int64_t{1}, expected(now_ns) - waiting_});
  }

  // The reader has found the source empty. True: it may have been full before, also while the pad
  // was opened.
  bool note_empty(std::int64_t now_ns) noexcept {
    const bool was_full = in_a_row_ >= capacity_;
    if (was_full) {
      window_ns_ = 0;
    } else {
      learn(now_ns);
    }
    missed_ += pending_;
    pending_ = waiting_ = in_a_row_ = 0;
    empty_ns_ = now_ns;
    return was_full;
  }

  bool is_full() const noexcept { return pending_ > 0; }
  std::int64_t missed() const noexcept { return missed_ + pending_; }

 private:
  // Until the pad's rate is known: that of most pads at their fastest.
  static constexpr double kUsualRate_hz = 1000.0;
  static constexpr std::int64_t kWindow_ns = 100'000'000;

  std::int64_t expected(std::int64_t now_ns) const noexcept {
    const double rate_hz = rate_hz_ > 0.0 ? rate_hz_ : kUsualRate_hz;
    return static_cast<std::int64_t>(rate_hz * static_cast<double>(now_ns - empty_ns_) * 1e-9) + 1;
  }

  // All that was sent between two looks that found the source empty has been read, however late.
  // Short windows, so that a pad's pauses hide its rate in few of them.
  void learn(std::int64_t now_ns) noexcept {
    window_reports_ += waiting_;
    if (window_ns_ == 0) {
      window_ns_ = now_ns;
      window_reports_ = 0;
    }
    if (now_ns - window_ns_ < kWindow_ns) return;
    const double seconds = static_cast<double>(now_ns - window_ns_) * 1e-9;
    rate_hz_ = std::max(rate_hz_, static_cast<double>(window_reports_) / seconds);
    window_ns_ = now_ns;
    window_reports_ = 0;
  }

  std::int64_t capacity_;
  std::int64_t empty_ns_ = 0;  // when the source was last found empty; 0: not read so far
  std::int64_t in_a_row_ = 0;  // reports since then
  std::int64_t waiting_ = 0;   // of these, those that count
  std::int64_t pending_ = 0, missed_ = 0;
  std::int64_t window_ns_ = 0, window_reports_ = 0;
  double rate_hz_ = 0.0;
};

}  // namespace gaitpad
