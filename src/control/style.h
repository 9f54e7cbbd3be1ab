// The stylization state: what makes one motion many (Meredith & Maddock 2005, sections 3.1
// and 3.3.3).
#pragma once
#include <array>
#include <string>

#include "base/result.h"
#include "control/gait_params.h"

namespace gaitpad {

struct StrideFactors {
  double length = 1.0;         // on the stride length
  double speed = 1.0;          // on the pace with which that leg's stride is undertaken
  double flight_height = 1.0;  // on the peak height of the flight
};
struct Style {
  std::string name;
  std::array<StrideFactors, 2> stride;  // left, right
  std::array<LegWeights, 2> weight{kEvenWeights, kEvenWeights};
  double hip_sway = 1.0;
  double hip_bounce = 1.0;
  double fatigue = 0.0;  // 0 fresh .. 1: linear on maximum speed and stride
};
Result<Style> load_style(const std::string& path);

}  // namespace gaitpad
