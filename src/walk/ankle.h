// Uneven ground bends some ankles up too far. After the legs are solved, such an ankle is eased: in
// flight the foot points down, in late support the heel rises. A foot that has to stand still keeps
// its angle.
#pragma once
#include "walk/leg_solve.h"
#include "walk/reach.h"

namespace gaitpad {
namespace {

// Ankles bend up to 38 degrees, for people's reach 35 to 40 with a bent knee. The limit is rounded
// over 6 degrees, and over 12 in flight.
inline constexpr float kMostBent_rad = 0.66322512f, kSoftBent_rad = 0.10471976f,
                       kSoftFlying_rad = 0.20943951f;
// Eased by at most 40 degrees: beyond that a leg that cannot reach its foot turned it ever farther.
inline constexpr float kMostEased_rad = 0.69813170f;

// Points a flying foot down: by its pitch alone as far as the ground allows, then about its toe,
// which keeps its height.
template <class V>
void point_down(const Time<V>& time, const Sole<V>& sole, const Turn<V>& yaw, const V& heel_m,
                const V& more_rad, Foot<V>& foot) noexcept {
  const Mask<V> on_toe{};  // none
  const V u = time.u, open = smooth(0.0f, 0.2f, u) * (1.0f - smooth(0.7f, 0.95f, u)),
          low = within(V((sole.toe_rest_m - heel_m) / sole.foot_m), -1.0f, 1.0f),
          room = sole.elevation_rad - arc_sine(low) - foot.pitch_rad,
          allowed = least(more_rad, most(room, V{}));
  set_pitch(sole, yaw, V(foot.pitch_rad + allowed), on_toe, foot);
  const V toe_y_m = foot.toe_m.y;
  set_pitch(sole, yaw, V(foot.pitch_rad + open * (more_rad - allowed)), on_toe, foot);
  const V lift_m = toe_y_m - foot.toe_m.y;
  foot.heel_m.y = foot.heel_m.y + lift_m;
  foot.toe_m.y = foot.toe_m.y + lift_m;
}

// Eases the ankle of foot k, which is bent too far by `bent`. `phase`: the phase that shows.
template <class V>
void ease_ankle(const Tables& tables, const Time<V>& time, const Stride<V>& stride, const V& phase,
                const V& bent, int k, const Pelvis<V>& pelvis, const Change<V>& change,
                const Footing<V>& footing, State<V>& state, Feet<V>& feet,
                const V (&begun_rad)[kLegAngles], Leg<V>& leg) noexcept {
  const auto starts = change.starting != V{};
  const auto right = is_right(time, k);
  const auto flies = k == 0 ? time.flies : Mask<V>{}, stands = k == 0 ? no(time.flies) : time.flies;
  // The easing begins gradually in a first step: an ankle that stairs bend in a stand would jump.
  const V first = time.flies ? V(time.u * (1.0f / kFirstRise)) : V(state.tick / state.roll_ticks),
          begun = starts ? smooth(first) : all<V>(1.0f), since = phase - time.step_phase;
  // Hips that lead may be before the strike of the foot that has landed: its heel stays down.
  constexpr float kBeforeStrike = 0.3f;  // cycles
  const V cycles = floored(V(since + kBeforeStrike));
  const auto too_early = k == 1 ? since < cycles : Mask<V>{};
  // They may be beyond the next strike of the foot that lifts off: its heel stays up.
  constexpr float kUntilStrike = 0.45f;  // cycles
  const V beyond = k == 0 ? most(V(since - cycles - kUntilStrike), V{}) : V{},
          rises = heel_rise(tables, right, V(phase - beyond), no(Mask<V>{}), change),
          may = too_early ? V{} : V(begun * rises);
  const V soft = chosen<V>(flies, kSoftFlying_rad, kSoftBent_rad),
          excess = least(soft_positive(bent, soft), all<V>(kMostEased_rad)) * (flies ? all<V>(1.0f)
                                                                               : stands ? may
                                                                                        : V{});
  const auto eases = excess != V{};
  if (!any(eases)) return;
  Foot<V>& foot = feet.foot[k];
  const Sole<V>& sole = feet.sole[k];
  const Turn<V> yaw = foot.yaw;
  Foot<V> risen = foot;
  set_pitch(sole, yaw, V(foot.pitch_rad + excess), no(flies), risen);
  if (any(flies)) {
    const V heel_m =
        (foot.heel_m.y - feet.base_m) * (is_uneven(tables) ? upright(footing.print) : all<V>(1.0f));
    Foot<V> down = foot;
    point_down(time, sole, yaw, heel_m, excess, down);
    put_where<V>(flies, down, risen);
  }
  // Solve the leg again from its first start, so that its knee does not swivel away.
  LegGoal<V> goal;
  set_goal(tables, time, stride, k, pelvis, ankle_of(risen, sole), risen.turn, begun_rad, goal);
  const Leg<V> again = solve_leg(goal);
  put_where<V>(eases, risen, foot);
  pose_leg(eases, again, leg);
  put_where<V>(eases, goal.off_rad, state.leg_rad[k]);
}

template <class V>
void ease_ankles(const Tables& tables, const Time<V>& time, const Stride<V>& stride, const V& phase,
                 const Pelvis<V>& pelvis, const Change<V>& change, const Footing<V>& footing,
                 State<V>& state, Feet<V>& feet, const V (&begun_rad)[2][kLegAngles],
                 Leg<V> (&legs)[2]) noexcept {
  for (int k : {0, 1}) {
    const V bent =
        -(stride.leg_rad[k][4] + stand_rad<V>(tables, is_right(time, k), 4) + state.leg_rad[k][4]) -
        kMostBent_rad;
    if (!any(bent > all<V>(-kSoftFlying_rad))) continue;
    ease_ankle(tables, time, stride, phase, bent, k, pelvis, change, footing, state, feet,
               begun_rad[k], legs[k]);
  }
}

}  // namespace
}  // namespace gaitpad
