// The range of each number of GaitParams: what a tick takes.
#pragma once
#include <cstddef>
#include <span>

#include "gaitpad/gait_params.h"

namespace gaitpad {

struct ParamsRange {
  GaitParams least, most;
};
const ParamsRange& params_range() noexcept;

// All numbers of GaitParams, in the order of its fields: they stand behind one another.
inline constexpr std::size_t kParamsNumbers =
    (sizeof(GaitParams) - offsetof(GaitParams, stride)) / sizeof(double);
inline std::span<const double, kParamsNumbers> numbers_of(const GaitParams& params) noexcept {
  return std::span<const double, kParamsNumbers>(&params.stride[0].length_m, kParamsNumbers);
}
inline std::span<double, kParamsNumbers> numbers_of(GaitParams& params) noexcept {
  return std::span<double, kParamsNumbers>(&params.stride[0].length_m, kParamsNumbers);
}

}  // namespace gaitpad
