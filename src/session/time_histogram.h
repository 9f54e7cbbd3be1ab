// How long something took, many times: median and greatest, in a fixed space.
#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace gaitpad {

// Counts by size in classes no wider than 1/64 of the value. One thread adds, any reads: both
// wait-free, no heap.
class TimeHistogram {
 public:
  void add(std::int64_t time_ns) noexcept;  // what is negative counts as 0
  double median_us() const noexcept;        // within 1 % of the true one; 0 where there is none
  double max_us() const noexcept;

 private:
  static constexpr int kStepBits = 6;              // classes in an octave: 64
  static constexpr int kOctaves = 40 - kStepBits;  // up to 2^40 ns, 18 minutes
  static constexpr std::size_t kClasses = static_cast<std::size_t>(kOctaves + 2) << kStepBits;
  static std::size_t class_of(std::uint64_t time_ns) noexcept;
  static double middle_ns(std::size_t index) noexcept;

  std::array<std::atomic<std::uint64_t>, kClasses> counts_{};
  std::atomic<std::int64_t> max_ns_{0};
};

}  // namespace gaitpad
