#include "session/time_histogram.h"

#include <algorithm>
#include <bit>

namespace gaitpad {

// Values below 64 have a class each; above, the highest seven bits make the class.
std::size_t TimeHistogram::class_of(std::uint64_t time_ns) noexcept {
  const int octave = std::max(0, static_cast<int>(std::bit_width(time_ns)) - kStepBits - 1);
  const std::size_t index =
      (static_cast<std::size_t>(octave) << kStepBits) + static_cast<std::size_t>(time_ns >> octave);
  return std::min(index, kClasses - 1);
}

double TimeHistogram::middle_ns(std::size_t index) noexcept {
  const std::size_t steps = std::size_t{1} << kStepBits;
  if (index < 2 * steps) return static_cast<double>(index);
  const std::size_t octave = index / steps - 1;
  const auto width = static_cast<double>(std::uint64_t{1} << octave);
  return (static_cast<double>(index - octave * steps) + 0.5) * width;
}

void TimeHistogram::add(std::int64_t time_ns) noexcept {
  const std::int64_t time = std::max<std::int64_t>(time_ns, 0);
  constexpr auto kRelaxed = std::memory_order_relaxed;
  std::atomic<std::uint64_t>& count = counts_[class_of(static_cast<std::uint64_t>(time))];
  count.store(count.load(kRelaxed) + 1, kRelaxed);  // nobody else writes
  if (time > max_ns_.load(kRelaxed)) max_ns_.store(time, kRelaxed);
}

double TimeHistogram::median_us() const noexcept {
  std::array<std::uint64_t, kClasses> counts;
  std::uint64_t all = 0;
  for (std::size_t i = 0; i < kClasses; ++i) {
    all += counts[i] = counts_[i].load(std::memory_order_relaxed);
  }
  std::uint64_t below = 0;
  for (std::size_t i = 0; i < kClasses; ++i) {
    below += counts[i];
    if (2 * below >= all && below > 0) return std::min(middle_ns(i) / 1000.0, max_us());
  }
  return 0.0;
}

double TimeHistogram::max_us() const noexcept {
  return static_cast<double>(max_ns_.load(std::memory_order_relaxed)) / 1000.0;
}

}  // namespace gaitpad
