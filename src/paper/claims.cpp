#include "paper/claims.h"

#include <algorithm>
#include <cstdlib>

namespace gaitpad {
namespace {

constexpr double kSteady_s = 3.5, kLong_s = 250.0;
using Claims = std::vector<Claim>;

const Walk& even(Study& s, IkMode mode) { return s.walk(styles_of_5a().red, mode); }

Claims cycle_group(Study& s, IkMode mode) {
  Claims all = table_1_claims(even(s, mode), 0.0, mode);
  const Claims more = continuity_claims(even(s, mode), foot_build(s.model()), kSteady_s, mode);
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

Claims weight_group(Study& s, IkMode mode) {
  const FigureStyles& names = styles_of_5a();
  const WeightWalks walks = {&even(s, mode), &s.walk(names.green, mode), &s.walk(names.blue, mode)};
  return weight_claims(walks, s.figure_stride(*walks.even), mode);
}

Claims monotone_group(Study& s, IkMode mode) {
  const Walk& red = even(s, mode);
  const Ticks stride = s.figure_stride(red);
  std::vector<double> rms_deg;
  for (const double weight : {0.9, 0.8, 0.5, 0.2}) {
    WalkCase what;
    what.model = &s.model();
    set_value(what.style, "legs.weight.hip", weight);
    what.ik = mode;
    what.end_s = kFigureEnd_s;
    rms_deg.push_back(joint_rms(red, walked(what), stride, kRightSide, LegJoint::hip));
  }
  return monotone_claims(rms_deg, mode);
}

Claims limp_group(Study& s, IkMode mode) {
  const FigureStyles& names = styles_of_5b();
  const LimpWalks walks = {&even(s, mode), &s.walk(names.red, mode), &s.walk(names.green, mode),
                           &s.walk(names.blue, mode)};
  Claims all = limp_claims(walks, mode);
  const Claims more = limp_weight_claims(walks, s.figure_stride(*walks.limp), mode);
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

Claims endurance_group(Study& s, IkMode mode) {
  WalkCase what;
  what.model = &s.model();
  what.ik = mode;
  what.end_s = kLong_s;
  return endurance_claims(walked(what), mode);
}

// Of one mode alone: what the solver has no part in stands under robust, the mode of a session.
template <Claims (*group)(const Study&)>
Claims robust_only(Study& s, IkMode mode) {
  return mode == IkMode::robust ? group(s) : Claims{};
}
template <Claims (*group)(const Study&, IkMode)>
Claims in_mode(Study& s, IkMode mode) {
  return group(s, mode);
}
Claims flight_group(Study& s, IkMode mode) { return flight_claims(s.source(), mode); }
Claims jacobian_group(Study& s, IkMode mode) {
  return mode == IkMode::paper ? jacobian_claims(s.model(), mode) : Claims{};
}
Claims chain_group(Study&, IkMode mode) { return chain_claims(mode); }
Claims reach_group(Study& s, IkMode mode) { return reach_claims(s.model(), mode); }
Claims cost_group(Study& s, IkMode mode) {
  return mode == IkMode::robust ? cost_claims(s) : Claims{};
}

using Group = Claims (*)(Study&, IkMode);
constexpr Group kGroups[] = {
    &flight_group,                 // 1-5
    &robust_only<scaling_claims>,  // 6
    &cycle_group,                  // 7, 8
    &jacobian_group,               // 9
    &chain_group,                  // 10-12
    &weight_group,                 // 13-16
    &monotone_group,               // 17
    &limp_group,                   // 18-20
    &cost_group,                   // 21
    &in_mode<terrain_claims>,      // 22
    &reach_group,                  // 23
    &in_mode<turn_claims>,         // 24
    &robust_only<pad_claims>,      // 25
    &robust_only<fatigue_claims>,  // 26
    &in_mode<hip_claims>,          // 27
    &robust_only<body_claims>,     // 28
    &in_mode<sliding_claims>,      // 29
    &endurance_group,              // 30
};

int number_of(const Claim& claim) { return std::atoi(claim.name.c_str()); }

}  // namespace

std::vector<Claim> all_claims(Study& study) {
  Claims all;
  for (const Group group : kGroups) {
    for (const IkMode mode : {IkMode::paper, IkMode::robust}) {
      for (Claim& claim : group(study, mode)) all.push_back(std::move(claim));
    }
  }
  std::ranges::stable_sort(all, {}, number_of);
  return all;
}

}  // namespace gaitpad
