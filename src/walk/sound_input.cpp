#include "walk/sound_input.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "control/params_range.h"
#include "walk/steer.h"

namespace gaitpad {

bool is_sound(const GaitParams& params) noexcept {
  const ParamsRange& range = params_range();
  const auto numbers = numbers_of(params), least = numbers_of(range.least),
             most = numbers_of(range.most);
  // The numbers of a plain upper body are within their ranges, and the last ones; before them are
  // the weights.
  static_assert(offsetof(GaitParams, body) + sizeof(UpperBodyParams) == sizeof(GaitParams));
  static_assert(offsetof(GaitParams, weight) + sizeof params.weight == offsetof(GaitParams, body));
  std::size_t count = kParamsNumbers;
  if (is_plain(params.body)) {
    count -= kBodyNumbers;
    if (is_even(params.weight)) count -= sizeof params.weight / sizeof(double);
  }
  std::size_t inside = 0;
  for (std::size_t k = 0; k < count; ++k)
    inside += (numbers[k] >= least[k]) & (numbers[k] <= most[k]);
  return inside == count;
}

bool is_finite(const Placement& place) noexcept {
  const vec3& p = place.place_m;
  return std::isfinite(p.x + p.y + p.z + place.heading_rad);
}

GaitParams mended_params(const GaitParams& params, WalkState& state) noexcept {
  const State<float>& walk = state.walk.state;
  GaitParams in_force;
  for (const int side : {0, 1}) {
    in_force.stride[side] = {walk.length_m[side].x, walk.asked.time_s[side], walk.lift[side].x};
    if (state.walk.weighted.acts != 0.0f)
      for (int j = 0; j < kLegDofs; ++j)
        in_force.weight[side][j] = state.walk.weighted.weight[side][j].x;
  }
  in_force.turn_rate_rad_s = walk.turn_goal_rad_s.x;
  in_force.hip_sway = walk.sway.x;
  in_force.hip_bounce = walk.bounce.x;
  if (state.walk.styled.asked != 0.0f) {
    BodyNumbers body;
    std::copy_n(state.walk.styled.goal, body.size(), body.begin());
    in_force.body = body_params(body);
  }
  const ParamsRange& range = params_range();
  GaitParams mended = params;
  if (std::isnan(params.stride[0].length_m + params.stride[1].length_m) &&
      std::isnan(params.turn_rate_rad_s)) {
    // A stick that is not a number does not tell whether to walk, so the walk goes on as before.
    mended.walking = state.walk.state.asked.walks != 0.0f;
    mended.backward = walk.backward != 0.0f;
  }
  const auto numbers = numbers_of(mended);
  for (std::size_t k = 0; k < kParamsNumbers; ++k) {
    const double least = numbers_of(range.least)[k], most = numbers_of(range.most)[k];
    if (numbers[k] >= least && numbers[k] <= most) continue;
    numbers[k] = within(numbers_of(in_force)[k], least, most);
    ++state.bad_inputs;
  }
  return mended;
}

double mended_place(double place_m, WalkState& state) noexcept {
  if (std::abs(place_m) <= kFarthest_m) return place_m;
  ++state.bad_inputs;
  return 0.0;
}

}  // namespace gaitpad
