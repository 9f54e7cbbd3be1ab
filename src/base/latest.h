// Passes the latest value from one writing to one reading thread: three buffers, wait-free on both
// sides. The reader never sees a half-written value or one older than the last. To avoid heap use
// while writing, size all three values beforehand with each().
#pragma once
#include <array>
#include <atomic>
#include <cstdint>

namespace gaitpad {

template <class T>
class Latest {
 public:
  // Before either thread begins: calls `set` with each of the three values.
  template <class Set>
  void each(const Set& set) {
    for (T& value : values_) set(value);
  }
  // Writer: fill this, then publish().
  T& writable() noexcept { return values_[writing_]; }
  void publish() noexcept {
    writing_ =
        middle_.exchange(static_cast<std::uint8_t>(writing_ | kFresh), std::memory_order_acq_rel) &
        kIndex;
  }

  // Reader: the newest published value. `is_new`: it was published after the last call.
  const T& read(bool& is_new) noexcept {
    is_new = (middle_.load(std::memory_order_relaxed) & kFresh) != 0;
    if (is_new) reading_ = middle_.exchange(reading_, std::memory_order_acq_rel) & kIndex;
    return values_[reading_];
  }

 private:
  static constexpr std::uint8_t kIndex = 3, kFresh = 4;
  std::array<T, 3> values_{};
  std::uint8_t writing_ = 0;
  std::uint8_t reading_ = 1;
  std::atomic<std::uint8_t> middle_{2};
};

}  // namespace gaitpad
