// The range of each number of GaitParams that a tick accepts.
#pragma once
#include <cstddef>
#include <span>

#include "gaitpad/gait_params.h"

namespace gaitpad {

struct ParamsRange {
  GaitParams least, most;
};
const ParamsRange& params_range() noexcept;

// Count of the numbers of GaitParams, which are contiguous in the order of its fields.
inline constexpr std::size_t kParamsNumbers =
    (sizeof(GaitParams) - offsetof(GaitParams, stride)) / sizeof(double);
inline std::span<const double, kParamsNumbers> numbers_of(const GaitParams& params) noexcept {
  return std::span<const double, kParamsNumbers>(&params.stride[0].length_m, kParamsNumbers);
}
inline std::span<double, kParamsNumbers> numbers_of(GaitParams& params) noexcept {
  return std::span<double, kParamsNumbers>(&params.stride[0].length_m, kParamsNumbers);
}

}  // namespace gaitpad
