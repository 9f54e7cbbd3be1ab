// Fifth, in paper mode: section 3.3.2, steps 1-7 to the letter, for the stage's end-effector alone
// (Table I), from the pose of the tick before and with raw weights. Of one walk.
#pragma once
#include "gaitpad/ik.h"
#include "motion/leg_pose.h"
#include "walk/reach.h"
#include "walk/weights.h"

namespace gaitpad {
namespace {

inline quat wide(const Turn<float>& q) noexcept { return quat(q.w, q.x, q.y, q.z); }
inline Turn<float> narrow(const quat& q) noexcept {
  return {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y),
          static_cast<float>(q.z)};
}

// In paper mode `leg_rad` of the state are the angles themselves, and `last_leg_rad` is how far the
// foot was pitched off its plan when one end alone was held: standing on its toe, and flying.
inline constexpr int kOnToe = 0, kFlying = 1;

// From there it comes over to its plan where the other end becomes a goal: the heel in a first
// flight, the toe in a roll. The heel would else jump by 5 cm at the lift-off, most of that in the
// ankle, which is not back before the leg is stretched: the knee would go past straight.
inline float off_plan_rad(const Time<float>& time, int k, const Change<float>& change,
                          const State<float>& state) noexcept {
  const bool starts = change.starting != 0.0f;
  const float(&off_rad)[kLegAngles] = state.last_leg_rad[k];
  if (k == 0 && time.flies && starts)
    return off_rad[kOnToe] * value_left(least(time.u / kLiftFade, 1.0f));
  if (k == 0 || time.flies || starts || change.stands != 0.0f) return 0.0f;
  // So early that the toe does not go deeper than flat.
  return off_rad[kFlying] * (1.0f - smoother(state.tick / (kRollEnd * state.roll_ticks)));
}

// As far off as the leg reaches: the hips are where the planned foot asks for them.
inline Foot<float> off_plan(const Foot<float>& planned, const Sole<float>& sole,
                            const Vec<float>& hip_m, float reach_m, bool on_toe,
                            float off_rad) noexcept {
  constexpr float kLeastStep = 1.0f / 4096.0f;  // of the share, which is found by halving
  Foot<float> foot = planned;
  float share = off_rad != 0.0f ? 1.0f : 0.0f;
  for (float step = 0.5f; share > 0.0f && step >= kLeastStep; step *= 0.5f) {
    set_pitch(sole, planned.yaw, planned.pitch_rad + share * off_rad, on_toe, foot);
    const Vec<float> way = hip_m - ankle_of(foot, sole);
    const bool reaches = dot(way, way) <= reach_m * reach_m;
    if (reaches && share == 1.0f) break;
    share += reaches ? step : -step;
  }
  return foot;
}

// While heel and toe both stand or land, the other end is a second position goal.
inline void solve_by_paper(const Tables& tables, const Time<float>& time, float phase,
                           const Change<float>& change, const Feet<float>& feet,
                           const Pelvis<float>& pelvis, State<float>& state,
                           Weighted<float>& weighted, Leg<float> (&legs)[2]) noexcept {
  constexpr PaperOptions kPaper = {.tolerance_m = 1e-5};
  const bool weighs = weighted.asked != 0.0f || weighted.acts != 0.0f;
  if (weighs) weighted.acts = smooth_weights(tables, weighted) ? 1.0f : 0.0f;
  for (int k : {0, 1}) {
    const bool right = (k == 0) == time.right, flies = k == 0 && time.flies,
               rolls = k == 1 && !time.flies;
    const LegBones& leg = tables.leg[right];
    const Foot<float>& planned = feet.foot[k];
    const Foot<float> foot = off_plan(planned, feet.sole[k], pelvis.place_m + pelvis.hip_m[k],
                                      kLongestReach * (leg.thigh_m + leg.shank_m), flies,
                                      off_plan_rad(time, k, change, state));
    const vec3 heel_m = wide(leg.heel_m), toe_m = wide(leg.toe_m), along_foot = toe_m - heel_m,
               side_of = wide(leg.side);
    const bool on_toe = !flies && !rolls;
    const bool both_ends =
        rolls || (on_toe && heel_rise(tables, right, phase, k == 1, change) == 0.0f);
    const quat to_pelvis = glm::conjugate(wide(pelvis.turn)), turn = to_pelvis * wide(foot.turn);
    const vec3 hip_m = wide(pelvis.place_m + pelvis.hip_m[k]),
               end_m = to_pelvis * (wide(on_toe ? foot.toe_m : foot.heel_m) - hip_m),
               point_m = on_toe ? toe_m : heel_m, other_m = on_toe ? heel_m : toe_m,
               side = turn * side_of, along = turn * glm::normalize(along_foot),
               across = glm::cross(along, side), far_m = end_m + turn * (other_m - point_m);
    const std::array<IkRow, 5> rows = {IkRow{point_m, side, glm::dot(side, end_m)},
                                       IkRow{point_m, across, glm::dot(across, end_m)},
                                       IkRow{point_m, along, glm::dot(along, end_m)},
                                       IkRow{other_m, side, glm::dot(side, far_m)},
                                       IkRow{other_m, across, glm::dot(across, far_m)}};
    IkChain chain = tables.build.chain[right];
    IkAngles angles_rad{};
    for (int j = 0; j < kLegAngles; ++j) {
      angles_rad[j] = state.leg_rad[k][j];
      if (weighs) chain.dof[j].weight = weighted.weight[right][j].x;
    }
    const IkResult solved =
        solve_paper(chain, {rows.data(), both_ends ? 5u : 3u}, kPaper, angles_rad);
    legs[k].iterations = static_cast<float>(solved.iterations);
    legs[k].short_m = static_cast<float>(solved.error_m);
    legs[k].failed = solved.status != IkStatus::converged;
    for (int j = 0; j < kLegAngles; ++j) state.leg_rad[k][j] = static_cast<float>(angles_rad[j]);
    const auto& a = angles_rad;
    legs[k].hip = narrow(rotation_xzy({a[0], a[1], a[2]}));
    legs[k].knee = narrow(rotation_x(a[3]));
    legs[k].ankle = narrow(rotation_xzy({a[4], a[5], a[6]}));
    const vec3 line = glm::conjugate(wide(foot.yaw)) *
                      (wide(pelvis.turn * legs[k].hip * legs[k].knee * legs[k].ankle) * along_foot);
    const double pitch_rad =
        leg.elevation_rad - gaitpad::atan2(line.y, glm::dot(line, wide(leg.forward)));
    legs[k].more_pitch_rad = static_cast<float>(pitch_rad) - planned.pitch_rad;
    if (!rolls) state.last_leg_rad[k][flies ? kFlying : kOnToe] = legs[k].more_pitch_rad;
  }
}

}  // namespace
}  // namespace gaitpad
