// Fifth, in paper mode: section 3.3.2, steps 1-7 to the letter, for the stage's end-effector alone
// (Table I), from the pose of the tick before and with raw weights. Of one walk.
#pragma once
#include "gaitpad/ik.h"
#include "motion/leg_pose.h"
#include "walk/weights.h"

namespace gaitpad {
namespace {

inline vec3 wide(const Vec<float>& v) noexcept { return {v.x, v.y, v.z}; }
inline vec3 wide(const std::array<float, 3>& v) noexcept { return {v[0], v[1], v[2]}; }
inline quat wide(const Turn<float>& q) noexcept { return quat(q.w, q.x, q.y, q.z); }
inline Turn<float> narrow(const quat& q) noexcept {
  return {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y),
          static_cast<float>(q.z)};
}

// In paper mode `leg_rad` of the state are the angles themselves. While heel and toe both stand or
// land, the other end is a second position goal.
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
    const Foot<float>& foot = feet.foot[k];
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
    IkChain chain = tables.chain[right];
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
    legs[k].more_pitch_rad = static_cast<float>(pitch_rad) - foot.pitch_rad;
  }
}

}  // namespace
}  // namespace gaitpad
