// Statistics of a few numbers. Some allocate, so a tick must not call them.
#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

namespace gaitpad {

// The value that `percent` % of the values do not exceed; 0 if there are none.
inline double percentile(std::vector<double> values, std::size_t percent) {
  if (values.empty()) return 0.0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) * percent / 100);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// The middle value; the upper of two for an even count; 0 if there are none.
inline double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The number from first to last with the lowest score; of equal ones the first.
template <class Score>
int lowest(int first, int last, const Score& score) {
  int best = first;
  double least = score(first);
  for (int i = first + 1; i <= last; ++i) {
    const double here = score(i);
    if (here < least) least = here, best = i;
  }
  return best;
}

}  // namespace gaitpad
