// Rows of numbers blended and summed, several numbers side by side. The bodies are compiled once
// for each set of instructions (rows_lanes.h) and never where they are called: the linker keeps one
// copy of each, and it must be the one that was compiled for its width.
#pragma once

namespace gaitpad {

// Four samples of a cycle, their weights, the standing pose and how much of the blend shows beside
// it, and the place for the blend: w, x, y and z of every joint in turn, `stride` numbers each.
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
void blend_rows(const BlendedRows& rows) noexcept;  // as wide as lanes_in_use()
// Fades the blend to the standing pose: nlerp() of gaitpad/math.h.
template <int kWidth>
void fade_rows(const BlendedRows& rows) noexcept;
void fade_rows(const BlendedRows& rows) noexcept;  // as wide as lanes_in_use()

// Rows of `numbers` each, at least kWidth, times their weights, added up in their order.
struct SummedRows {
  const double* const* row;
  const double* weight;
  int rows, numbers;
  double* sum;
};
template <int kWidth>
void sum_rows(const SummedRows& rows) noexcept;
void sum_rows(const SummedRows& rows) noexcept;  // as wide as lanes_in_use(); at least 4 numbers

}  // namespace gaitpad
