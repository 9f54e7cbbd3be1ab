// Blends and sums rows of numbers in vector registers. The bodies are compiled once for each
// instruction set (rows_lanes.h) and never in a caller: the linker keeps one copy of each, which
// must be the one compiled for its width.
#pragma once

namespace gaitpad {

// Four samples of a cycle and their weights, the standing pose and the blend's share beside it, and
// the output. A row holds w of all joints, then x, y and z, `stride` numbers each.
struct BlendedRows {
  const double* sample[4];
  double weight[4];
  const double* standing;
  double shown;
  double* blend;
  int stride;
};
template <int kWidth>
void blend_rows(const BlendedRows& rows) noexcept;
void blend_rows(const BlendedRows& rows) noexcept;  // Uses registers as wide as lanes_in_use().
// Fades the blend to the standing pose: nlerp() of gaitpad/math.h.
template <int kWidth>
void fade_rows(const BlendedRows& rows) noexcept;
void fade_rows(const BlendedRows& rows) noexcept;  // Uses registers as wide as lanes_in_use().

// Sum of weight[i] * row[i], added in the order of i. Rows have `numbers` numbers, at least kWidth.
struct SummedRows {
  const double* const* row;
  const double* weight;
  int rows, numbers;
  double* sum;
};
template <int kWidth>
void sum_rows(const SummedRows& rows) noexcept;
// Uses registers as wide as lanes_in_use(), of at least 4 numbers.
void sum_rows(const SummedRows& rows) noexcept;

}  // namespace gaitpad
