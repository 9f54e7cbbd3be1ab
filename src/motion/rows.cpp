#include "motion/rows.h"

#include <algorithm>

#include "base/lanes.h"

namespace gaitpad {

void blend_rows(const BlendedRows& rows) noexcept {
  with_width(lanes_in_use(), [&](auto width) { blend_rows<width>(rows); });
}

void fade_rows(const BlendedRows& rows) noexcept {
  with_width(lanes_in_use(), [&](auto width) { fade_rows<width>(rows); });
}

void sum_rows(const SummedRows& rows) noexcept {
  with_width(std::min(lanes_in_use(), rows.numbers), [&](auto width) { sum_rows<width>(rows); });
}

}  // namespace gaitpad
