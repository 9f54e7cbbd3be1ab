// A standing character breathes, sways over its feet and now and then glances aside. All of it
// follows from the ticks of the stand, so a replay stands alike. It begins some time after the feet
// are at rest and ends while a walk begins. The hips move over planted feet.
#pragma once
#include <cstdint>

#include "walk/hips.h"

namespace gaitpad {
namespace {

template <class V>
struct Idle {
  V breath_rad{}, glance_rad{}, nod_rad{};
  V ahead_m{}, left_m{};  // sway of the hips
};

// Random number from 0 to 1, the draw `which` of a glance: splitmix64, whose neighbours are unlike.
inline float drawn(std::uint64_t glance, std::uint64_t which) noexcept {
  std::uint64_t bits = (4 * glance + which + 1) * 0x9e3779b97f4a7c15u;
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
  return static_cast<float>(static_cast<double>((bits ^ (bits >> 31)) >> 11) * 0x1p-53);
}

template <class V>
V sine_of_cycles(const V& cycles, float begin_rad) noexcept {
  V sine, cosine;
  sin_cos(V(kTurn_rad * (cycles - floored(cycles)) + begin_rad), sine, cosine);
  return sine;
}

// Glances aside every few seconds. `amount`: share that is shown.
template <class V>
void glance(const V& time_s, const V& amount, const V& outwards, Idle<V>& idle) noexcept {
  constexpr float kEvery_s = 7.0f, kFirst_s = 1.0f,
                  kLast_s = 3.5f;  // begins 1 to 3.5 s into every 7
  constexpr float kTurns_s = 0.6f, kHeldLeast_s = 0.6f, kHeldMost_s = 1.6f, kBack_s = 0.7f;
  constexpr float kLeast_rad = 8.0f * kDegree_rad, kMost_rad = 26.0f * kDegree_rad;
  constexpr float kMostNod_rad = 6.0f * kDegree_rad;  // a nod is from -0.3 to 0.7 of it
  const V number = floored(V(time_s * (1.0f / kEvery_s)));
  V draw[4];
  for (int w = 0; w < kLanes<V>; ++w) {
    const auto n = static_cast<std::uint64_t>(lane(number, w));
    for (int k = 0; k < 4; ++k) set_lane(drawn(n, static_cast<std::uint64_t>(k)), w, draw[k]);
  }
  const V begins_s = kFirst_s + (kLast_s - kFirst_s) * draw[0],
          held_s = kHeldLeast_s + (kHeldMost_s - kHeldLeast_s) * draw[1],
          since_s = time_s - number * kEvery_s - begins_s;
  const V turned = smoother(0.0f, kTurns_s, since_s) *
                   (1.0f - smoother(0.0f, kBack_s, V(since_s - kTurns_s - held_s)));
  const V to = 2.0f * draw[2] - 1.0f, far = kLeast_rad + (kMost_rad - kLeast_rad) * size(to);
  idle.glance_rad = amount * turned * outwards * (to < V{} ? V(-far) : far);
  idle.nod_rad = amount * turned * kMostNod_rad * (draw[3] - 0.3f);
}

// Breath, glance and sway after `ticks` of the stand.
template <class V>
Idle<V> idle_at(const Tables& tables, const V& ticks, const Styled<V>& styled) noexcept {
  // 14 breaths a minute (people at rest: 12 to 18) raise the trunk by 0.6 degrees.
  constexpr float kBreath_Hz = 0.235f, kBreath_rad = 0.010471976f;
  Idle<V> idle;
  const V time_s = ticks * tables.tick_s,
          asked = styled.acts != V{} ? styled.body[kIdle].x : all<V>(1.0f),
          amount = smoother(size(styled.idle_share)) * asked;
  if (!any(amount != V{})) return idle;
  idle.breath_rad = amount * kBreath_rad *
                    (0.5f - 0.5f * sine_of_cycles(V(kBreath_Hz * time_s), kRightAngle_rad));
  const V outwards = styled.idle_share < V{} ? all<V>(-1.0f) : all<V>(1.0f);
  glance(time_s, amount, outwards, idle);
  // Quiet stance sways by 3 to 5 mm (standard deviation of the centre of pressure, Winter 1995),
  // below 0.5 Hz.
  const V size_m = amount * tables.size;
  const auto swings = [&](float size, float rate_Hz, float begin_rad) {
    return V(size * sine_of_cycles(V(rate_Hz * time_s), begin_rad));
  };
  idle.ahead_m = size_m * (swings(0.0030f, 0.19f, 2.0f) + swings(0.0015f, 0.43f, 0.5f));
  idle.left_m = size_m * outwards * (swings(0.0035f, 0.13f, 0.0f) + swings(0.0020f, 0.31f, 1.0f));
  return idle;
}

template <class V>
Idle<V> advance_idle(const Tables& tables, const Change<V>& change, const State<V>& state,
                     Styled<V>& styled) noexcept {
  constexpr float kBeginsAfter_s = 1.0f;             // of standing
  constexpr float kBegins_s = 2.0f, kEnds_s = 0.8f;  // fading in and out
  const auto stands = change.stands != V{}, acts = either(stands, styled.idle_share != V{});
  if (!any(either(acts, styled.idle_ticks != V{}))) return {};
  const float dt = tables.ticks * tables.tick_s;
  const V ticks = styled.idle_ticks,
          begins = ticks * tables.tick_s >= all<V>(kBeginsAfter_s) ? all<V>(dt / kBegins_s) : V{};
  // Mirrored walks have mirrored stands: the foot that landed last decides the side, until all of
  // it has faded. A walk that begins may change its feet before.
  const auto right = styled.idle_share == V{} ? state.right_swings != V{} : styled.idle_share > V{};
  const V share =
      within(V(size(styled.idle_share) + (stands ? begins : all<V>(-dt / kEnds_s))), 0.0f, 1.0f);
  styled.idle_share = right ? share : V(0.0f - share);  // no negative zero
  const auto goes_on = either(stands, share > V{});
  styled.idle_ticks = goes_on ? V(ticks + tables.ticks) : V{};
  return idle_at(tables, ticks, styled);
}

// Moves the hips over the feet.
template <class V>
void sway(const Idle<V>& idle, const Way<V>& heading, Pelvis<V>& pelvis) noexcept {
  pelvis.place_m.x =
      pelvis.place_m.x + (heading.sine * idle.ahead_m + heading.cosine * idle.left_m);
  pelvis.place_m.z =
      pelvis.place_m.z + (heading.cosine * idle.ahead_m - heading.sine * idle.left_m);
}

}  // namespace
}  // namespace gaitpad
