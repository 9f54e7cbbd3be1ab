// Writes the parameters of a walk, and its place in the world, into a block.
#pragma once
#include <array>
#include <cstring>

#include "gaitpad/walk.h"
#include "walk/block.h"

namespace gaitpad {

// UpperBodyParams as numbers in the order of BodyNumber, and back.
using BodyNumbers = std::array<double, kBodyNumbers>;
static_assert(sizeof(UpperBodyParams) == sizeof(BodyNumbers));
inline BodyNumbers body_numbers(const UpperBodyParams& params) noexcept {
  BodyNumbers numbers;
  std::memcpy(numbers.data(), &params, sizeof numbers);
  return numbers;
}
inline UpperBodyParams body_params(const BodyNumbers& numbers) noexcept {
  UpperBodyParams params;
  std::memcpy(static_cast<void*>(&params), numbers.data(), sizeof numbers);
  return params;
}
// True if nothing is asked of the upper body. Equal bytes are, and quicker to compare.
inline bool is_plain(const UpperBodyParams& params) noexcept {
  static constexpr UpperBodyParams kPlain;
  // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
  return std::memcmp(&params, &kPlain, sizeof kPlain) == 0 || params == kPlain;
}
// True if all weights of the legs are 1.
inline bool is_even(const decltype(GaitParams::weight)& weight) noexcept {
  static constexpr auto kEven = GaitParams{}.weight;
  // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
  return std::memcmp(&weight, &kEven, sizeof kEven) == 0 || weight == kEven;
}

// Asks a walk for parameters. A walk that is to end keeps the times and lengths of its steps.
template <int kWidth>
void ask(const GaitParams& params, int walk, Block<kWidth>& block) noexcept {
  using V = Floats<kWidth>;
  const auto set = [walk](double number, V& of) { set_lane(static_cast<float>(number), walk, of); };
  Asked<V>& asked = block.state.asked;
  set(params.walking, asked.walks);
  if (params.walking) {
    for (const int side : {0, 1}) {
      set(params.stride[side].length_m, asked.length_m[side]);
      set(params.stride[side].time_s, asked.time_s[side]);
      set(params.stride[side].flight_height, asked.lift[side]);
    }
    set(params.backward, asked.backward);
    set(params.turn_rate_rad_s, asked.turn_rad_s);
    set(params.hip_bounce, asked.bounce);
    set(params.hip_sway, asked.sway);
  }
  // Most walks have no style: goals that were not asked for are not written either.
  const auto asks = [&](bool is_asked, V& of) {
    const bool was_asked = lane(of, walk) != 0.0f;
    set(is_asked, of);
    return is_asked || was_asked;
  };
  Styled<V>& styled = block.styled;
  if (asks(!is_plain(params.body), styled.asked)) {
    const BodyNumbers body = body_numbers(params.body);
    for (int n = 0; n < kBodyNumbers; ++n) set(body[n], styled.goal[n]);
  }
  Weighted<V>& weighted = block.weighted;
  if (asks(!is_even(params.weight), weighted.asked)) {
    for (const int side : {0, 1})
      for (int j = 0; j < kLegAngles; ++j) set(params.weight[side][j], weighted.goal[side][j]);
  }
}
inline void ask(const GaitParams& params, Block<1>& block) noexcept { ask(params, 0, block); }

template <int kWidth>
void set_detail(Detail detail, int walk, Block<kWidth>& block) noexcept {
  set_lane(detail == Detail::tables ? 1.0f : 0.0f, walk, block.change.asks_tables);
}

inline Detail detail_of(const Block<1>& block) noexcept {
  return block.change.asks_tables != 0.0f ? Detail::tables : Detail::full;
}

template <int kWidth>
void place(const Placement& placed, int walk, Block<kWidth>& block) noexcept {
  block.placed[walk] = placed;
  block.is_placed |= !(placed == Placement{});
}

}  // namespace gaitpad
