// Statistics of a few numbers. They allocate, so a tick must not call them.
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

}  // namespace gaitpad
