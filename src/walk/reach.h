// Lets a foot rise on its toe if its leg would be too short, or if a style keeps its heel low.
#pragma once
#include "walk/feet.h"

namespace gaitpad {
namespace {

// Share by which a standing foot may raise its heel: 0 flat, 1 freely. `right`: the foot's side.
template <class V>
V heel_rise(const Tables& tables, const Mask<V>& right, const V& phase, const Mask<V>& is_stand,
            const Change<V>& change) noexcept {
  constexpr float kRiseBegin = 0.20f, kRiseLasts = 0.18f;  // cycles from the foot's strike
  const auto other = no(right);
  const V p = phase - step_phase_of<V>(tables, other), own = p - floored(p),
          begin = most(roll_cycles<V>(tables, other), all<V>(kRiseBegin)),
          rises = smooth(V((own - begin) * (1.0f / kRiseLasts)));
  // In a last step the heel stays down; if the walk goes on, it rises again with the tables.
  const auto shows = both(is_stand, change.starting == V{});
  return change.stands != V{} ? V{} : shows ? V(rises * change.shown) : rises;
}

// The angle with this sine and cosine, to 1e-6 below a right angle.
template <class V>
V angle_of(const V& sine, const V& cosine) noexcept {
  // Tangents of a half and a quarter of the angle.
  const V half = sine / most(V(1.0f + cosine), all<V>(1e-6f)),
          quarter = half / (1.0f + root(V(1.0f + half * half)));
  return 4.0f * arc_tangent_small(quarter);
}

// Pitch at which the ankle, which turns about the planted toe, is `reach_m` from the hip: the
// solution of P cos + Q sin = K in the foot's own vertical plane.
template <class V>
V pitch_in_reach(const Foot<V>& foot, const Sole<V>& sole, const Vec<V>& hip_m,
                 const V& reach_m) noexcept {
  constexpr float kMostPitch_rad = 1.4835299f, kSoftPitch_rad = 25.0f * kDegree_rad;  // 85 degrees
  const Vec<V> d = back(foot.yaw) * (hip_m - foot.toe_m), c = (sole.heel_m + sole.line_m) * -1.0f;
  const V cf = dot(c, sole.forward), df = dot(d, sole.forward);
  const V p = df * cf + d.y * c.y, q = df * c.y - d.y * cf,
          k = 0.5f * (dot(d, d) + dot(c, c) - reach_m * reach_m) -
              dot(d, sole.side) * dot(c, sole.side),
          over = 1.0f / most(V(root(V(p * p + q * q))), all<V>(1e-6f));
  const V cosine =
      most(soft_least(V(k * over), all<V>(kMostUpright), all<V>(kSoftUpright)), all<V>(-1.0f));
  const V sine = root(V(1.0f - cosine * cosine));
  return soft_least(angle_of(V((q * cosine - p * sine) * over), V((p * cosine + q * sine) * over)),
                    all<V>(kMostPitch_rad), all<V>(kSoftPitch_rad));
}

// Pitches a foot about its toe where `rises`.
template <class V>
void rise_on_toe(const Sole<V>& sole, const V& pitch_rad, const Mask<V>& rises,
                 Foot<V>& foot) noexcept {
  Foot<V> risen = foot;
  set_pitch(sole, foot.yaw, pitch_rad, rises, risen);
  put_where<V>(rises, risen, foot);
}

// A smoothed number this near to its goal is there, as a share of the number or of 1 if it is less:
// by rounding, a float of 10 comes to rest 2e-5 off its goal. One this near to 0 is 0.
inline constexpr float kSettled = 1e-5f, kNothing = 1e-6f;
// Greatest reach of a leg, over its length: a straight leg has no derivative.
inline constexpr float kLongestReach = 0.99995f;

// If a style keeps a heel low, the hips sink while the foot would rise, and the foot rises as far
// as its leg asks. `asked_rad`: pitch that this adds to swing and stand.
template <class V>
void keep_heels_low(const Tables& tables, const Time<V>& time, const V& phase,
                    const Stride<V>& stride, const Change<V>& change, const State<V>& state,
                    Styled<V>& styled, Pelvis<V>& pelvis, Feet<V>& feet,
                    V (&asked_rad)[2]) noexcept {
  constexpr float kLowHips_m = 0.045f;                  // most sinking, at the reference leg
  constexpr float kLowRisen_rad = 45.0f * kDegree_rad;  // pitch of the foot at which it is whole
  constexpr float kLowUntil = 0.25f;                    // of the flight: the hips have risen again
  constexpr float kSoftRise_rad = 12.0f * kDegree_rad;
  const auto is_low = least(state.lift[0].x, state.lift[1].x) < all<V>(1.0f - kSettled),
             acts = either(is_low, either(styled.low[0].x != V{}, styled.low[1].x != V{}));
  if (!any(acts)) return;
  const Mask<V> none{};
  const V presence = change.shown * within(state.posture.x, 0.0f, 1.0f);
  Mask<V> rolls[2] = {none, no(time.flies)};
  V low[2];
  for (int k : {0, 1}) {
    const auto right = is_right(time, k), flies = k == 0 ? time.flies : none;
    const V rises = flies ? V(1.0f - smoother(0.0f, kLowUntil, time.u))
                          : heel_rise(tables, right, phase, k == 1 ? no(none) : none, change);
    const V goal = rolls[k] ? V{} : V(presence * rises * (1.0f - low_lift<V>(right, state)));
    Smoothed<V> next = styled.low[k];
    follow(goal, tables.lowers, next);
    const auto over = both(goal == V{}, next.x < all<V>(kNothing));
    styled.low[k].x = acts ? (over ? V{} : next.x) : V{};
    styled.low[k].v = acts ? (over ? V{} : next.v) : V{};
    low[k] = styled.low[k].x;
    // The pitch at the phase of the hips; a foot that flies by the clock may have another one.
    const V risen_rad = k == 0 ? stride.stood_pitch_rad : stride.foot[1].pitch_rad;
    const V down_m = (kLowHips_m * tables.size) * low[k] * smooth(0.0f, kLowRisen_rad, risen_rad);
    pelvis.place_m.y = acts ? V(pelvis.place_m.y - down_m) : pelvis.place_m.y;
  }
  for (int k : {0, 1}) {
    const auto right = is_right(time, k), rises = both(no(rolls[k]), low[k] > V{});
    asked_rad[k] = V{};
    if (!any(rises)) continue;
    Foot<V>& foot = feet.foot[k];
    const V pitch_rad = pitch_in_reach<V>(foot, feet.sole[k], pelvis.place_m + pelvis.hip_m[k],
                                          V(kLowReach * leg_m<V>(tables, right)));
    const V more = least(all<V>(1.0f), V(2.0f * low[k])) *
                   soft_positive(V(pitch_rad - foot.pitch_rad), all<V>(kSoftRise_rad));
    asked_rad[k] = rises ? more : V{};
    rise_on_toe(feet.sole[k], V(foot.pitch_rad + more), rises, foot);
  }
}

// Lets a standing foot rise on its toe if its leg would be too short.
template <class V>
void reach_with_toe(const Tables& tables, const Time<V>& time, const Change<V>& change,
                    const Pelvis<V>& pelvis, Feet<V>& feet) noexcept {
  for (int k : {0, 1}) {
    const auto right = is_right(time, k),
               stands = both(change.stands == V{}, k == 0 ? no(time.flies) : time.flies);
    Foot<V>& foot = feet.foot[k];
    const V reach_m = kLongestReach * leg_m<V>(tables, right);
    const Vec<V> hip_m = pelvis.place_m + pelvis.hip_m[k], way = hip_m - feet.ankle_m[k];
    const auto short_of = both(stands, dot(way, way) > reach_m * reach_m);
    if (!any(short_of)) continue;
    const V pitch_rad = most(foot.pitch_rad, pitch_in_reach<V>(foot, feet.sole[k], hip_m, reach_m));
    rise_on_toe(feet.sole[k], pitch_rad, short_of, foot);
    feet.ankle_m[k] = chosen(short_of, ankle_of(foot, feet.sole[k]), feet.ankle_m[k]);
  }
}

// Takes the pitch away again that keep_heels_low() added: plans do not count it.
template <class V>
void take_back(const V (&asked_rad)[2], Feet<V>& feet) noexcept {
  for (int k : {0, 1}) {
    const auto asked = asked_rad[k] != V{};
    if (!any(asked)) continue;
    Foot<V>& foot = feet.foot[k];
    rise_on_toe(feet.sole[k], V(foot.pitch_rad - asked_rad[k]), asked, foot);
  }
}

// At a strike the feet change their parts.
template <class V>
void change_styled_feet(const Mask<V>& strikes, Styled<V>& styled) noexcept {
  exchange(strikes, styled.low[0].x, styled.low[1].x);
  exchange(strikes, styled.low[0].v, styled.low[1].v);
}

}  // namespace
}  // namespace gaitpad
