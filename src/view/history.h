// The last seconds of a session, tick by tick, for graphs and trails.
#pragma once
#include <cstddef>
#include <vector>

#include "session/session_frame.h"

namespace gaitpad {

// A ring; 0 is the oldest. A sample that does not follow the newest one begins it anew.
class History {
 public:
  explicit History(std::size_t capacity = 2400) : samples_(capacity) {}
  void add(const TickSample& sample);
  void clear() noexcept { size_ = 0; }
  std::size_t size() const noexcept { return size_; }
  const TickSample& operator[](std::size_t i) const noexcept {
    return samples_[(begin_ + i) % samples_.size()];
  }
  // Begin of the newest `cycles` complete cycles of a walker (from its right foot's landings), as
  // an index; size() where it has not walked so many.
  std::size_t cycle_begin(int walker, int cycles) const noexcept;

 private:
  std::vector<TickSample> samples_;
  std::size_t begin_ = 0, size_ = 0;
};

}  // namespace gaitpad
