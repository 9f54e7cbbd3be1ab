#include "animation/sound_input.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/lanes.h"
#include "control/params_range.h"

namespace gaitpad {

bool is_same(const UpperBodyParams& a, const UpperBodyParams& b) noexcept {
  // Doubles alone, without padding: equal bytes are equal numbers.
  // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
  return std::memcmp(&a, &b, sizeof a) == 0 || a == b;
}

bool is_sound(const GaitParams& params, const WalkState& state) noexcept {
  using Some = Lanes<kLeastLanes>;
  const ParamsRange& range = params_range();
  const auto some = [](const GaitParams& of, std::size_t k) {
    Some numbers;
    std::memcpy(&numbers, numbers_of(of).data() + k, sizeof numbers);
    return numbers;
  };
  // The body's numbers come last; they are many and seldom change, so they are checked only after a
  // change.
  constexpr std::size_t kBody = sizeof(UpperBodyParams) / sizeof(double);
  const bool same = is_same(params.body, state.body.goal);
  const std::size_t count = same ? kParamsNumbers - kBody : kParamsNumbers;
  MaskOf<Some> outside{};
  for (std::size_t k = 0; k < count; k += kLeastLanes) {
    // The last pair of an odd count overlaps the one before.
    const std::size_t at = std::min(k, count - kLeastLanes);
    const Some x = some(params, at);
    outside |= not_of((x >= some(range.least, at)) & (x <= some(range.most, at)));
  }
  return !any(outside);
}

GaitParams mended_params(const GaitParams& params, WalkState& state) noexcept {
  GaitParams in_force;
  for (const int side : {0, 1}) {
    in_force.stride[side] = {state.gait.length_m[side].x, state.gait.time_s[side],
                             state.gait.flight_height[side].x};
    for (int j = 0; j < kLegDofs; ++j) in_force.weight[side][j] = state.gait.weight[side][j].x;
  }
  in_force.turn_rate_rad_s = state.gait.turn_goal.x;
  in_force.hip_sway = state.gait.sway.x;
  in_force.hip_bounce = state.gait.bounce.x;
  in_force.body = state.body.goal;
  const ParamsRange& range = params_range();
  GaitParams mended = params;
  if (std::isnan(params.stride[0].length_m + params.stride[1].length_m) &&
      std::isnan(params.turn_rate_rad_s)) {
    // A stick that is not a number does not tell whether to walk, so the walk goes on as before.
    mended.walking = state.clock.started && !state.clock.stopping;
    mended.backward = state.clock.backward;
  }
  const auto numbers = numbers_of(mended);
  for (std::size_t k = 0; k < kParamsNumbers; ++k) {
    const double least = numbers_of(range.least)[k], most = numbers_of(range.most)[k];
    if (numbers[k] >= least && numbers[k] <= most) continue;
    numbers[k] = within(numbers_of(in_force)[k], least, most);
    ++state.frame.bad_inputs;
  }
  return mended;
}

double mended_tick(WalkState& state) noexcept {
  ++state.frame.bad_inputs;
  return state.clock.tick_s;
}

double mended_place(double place_m, WalkState& state) noexcept {
  if (std::abs(place_m) <= kFarthest_m) return place_m;
  ++state.frame.bad_inputs;
  return 0.0;
}

}  // namespace gaitpad
