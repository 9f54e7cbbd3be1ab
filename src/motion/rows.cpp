#include "motion/rows.h"

#include <algorithm>

#include "base/lanes.h"

namespace gaitpad {

void blend_rows(const BlendedRows& rows) noexcept {
  const int lanes = lanes_in_use();
  (lanes >= 8 ? blend_rows<8> : lanes >= 4 ? blend_rows<4> : blend_rows<2>)(rows);
}

void fade_rows(const BlendedRows& rows) noexcept {
  const int lanes = lanes_in_use();
  (lanes >= 8 ? fade_rows<8> : lanes >= 4 ? fade_rows<4> : fade_rows<2>)(rows);
}

void sum_rows(const SummedRows& rows) noexcept {
  const int lanes = std::min(lanes_in_use(), rows.numbers);
  (lanes >= 8 ? sum_rows<8> : lanes >= 4 ? sum_rows<4> : sum_rows<2>)(rows);
}

}  // namespace gaitpad
