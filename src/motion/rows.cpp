#include "motion/rows.h"

#include "base/lanes.h"

namespace gaitpad {

void blend_rows(const BlendedRows& rows) noexcept {
  const int lanes = lanes_in_use();
  if (lanes >= 8) {
    blend_rows<8>(rows);
  } else if (lanes >= 4) {
    blend_rows<4>(rows);
  } else {
    blend_rows<2>(rows);
  }
}

void fade_rows(const BlendedRows& rows) noexcept {
  const int lanes = lanes_in_use();
  if (lanes >= 8) {
    fade_rows<8>(rows);
  } else if (lanes >= 4) {
    fade_rows<4>(rows);
  } else {
    fade_rows<2>(rows);
  }
}

void sum_rows(const SummedRows& rows) noexcept {
  const int lanes = lanes_in_use();
  if (lanes >= 8 && rows.numbers >= 8) {
    sum_rows<8>(rows);
  } else if (lanes >= 4) {
    sum_rows<4>(rows);
  } else {
    sum_rows<2>(rows);
  }
}

}  // namespace gaitpad
