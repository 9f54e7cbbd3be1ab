// Hands what a stick and a style ask for over to a walk, as whoever steers does.
#pragma once
#include "gaitpad/control.h"
#include "walk/walk.h"

namespace gaitpad::anew {

inline void ask(const GaitParams& params, Asked<float>& asked) {
  asked.walks = params.walking ? 1.0f : 0.0f;
  if (!params.walking) return;  // a walk that is to end keeps its times
  for (int side : {0, 1}) {
    asked.length_m[side] = static_cast<float>(params.stride[side].length_m);
    asked.time_s[side] = static_cast<float>(params.stride[side].time_s);
    asked.lift[side] = static_cast<float>(params.stride[side].flight_height);
  }
  asked.backward = params.backward ? 1.0f : 0.0f;
  asked.turn_rad_s = static_cast<float>(params.turn_rate_rad_s);
  asked.bounce = static_cast<float>(params.hip_bounce);
  asked.sway = static_cast<float>(params.hip_sway);
}

}  // namespace gaitpad::anew
