// The last seconds of a session, one sample a tick.
#pragma once
#include <cstddef>
#include <vector>

#include "gaitpad/session_frame.h"

namespace gaitpad {

// A ring buffer; index 0 is the oldest sample. Adding a sample that does not follow the newest one
// clears the buffer first.
class History {
 public:
  explicit History(std::size_t capacity = 2400) : samples_(capacity > 0 ? capacity : 1) {}
  void add(const TickSample& sample);
  void clear() noexcept { size_ = 0; }
  std::size_t size() const noexcept { return size_; }
  const TickSample& operator[](std::size_t i) const noexcept {
    return samples_[(begin_ + i) % samples_.size()];
  }
  // The newest `cycles` complete gait cycles of a walker without a rest between them, from one
  // landing of the right foot to a later one, as indices [begin, end). If there are fewer, both are
  // size().
  struct Span {
    std::size_t begin = 0, end = 0;
  };
  Span newest_cycles(int walker, int cycles) const noexcept;

 private:
  std::vector<TickSample> samples_;
  std::size_t begin_ = 0, size_ = 0;
};

}  // namespace gaitpad
