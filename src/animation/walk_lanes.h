// The body of advance_lanes(), for one width and one set of instructions at a time.
#pragma once
#include "animation/leg_ik_lanes.h"
#include "animation/walk_figure.h"

namespace gaitpad {
namespace {

template <class V>
void set_lanes(const Moment& one, int lane, MomentOf<V>& at) noexcept {
  const auto mask = [&](bool Moment::*of, MaskOf<V> MomentOf<V>::*to) {
    set_lane(one.*of, lane, at.*to);
  };
  using One = Moment;
  using All = MomentOf<V>;
  mask(&One::idle, &All::idle);
  mask(&One::flies, &All::flies);
  mask(&One::rolls, &All::rolls);
  mask(&One::started, &All::started);
  mask(&One::starting, &All::starting);
  mask(&One::stopping, &All::stopping);
  mask(&One::closing, &All::closing);
  mask(&One::led, &All::led);
  mask(&One::replanned, &All::replanned);
  mask(&One::was_led, &All::was_led);
  mask(&One::backward, &All::backward);
  mask(&One::right_steps, &All::right_steps);
  mask(&One::walking, &All::walking);
  mask(&One::finishes, &All::finishes);
  for (int side : {0, 1}) {
    set_lane(one.in_flight[side], lane, at.in_flight[side]);
    set_lane(one.in_roll[side], lane, at.in_roll[side]);
  }
  set_lanes(static_cast<const CountsOf<double>&>(one), lane, static_cast<CountsOf<V>&>(at));
}

// Copies the numbers of all walks into their lanes, and back. `of` selects which of a walk's
// numbers.
template <class V>
using Walks = std::array<WalkState*, kWidthOf<V>>;
template <class V, class Of, class Numbers>
void load(const Walks<V>& walks, const Of& of, Numbers& numbers) noexcept {
  std::array<const double*, kWidthOf<V>> from;
  for (int lane = 0; lane < kWidthOf<V>; ++lane)
    from[lane] = reinterpret_cast<const double*>(&of(*walks[lane]));
  load_lanes<V>(from, sizeof(Numbers) / sizeof(V), reinterpret_cast<V*>(&numbers));
}
template <class V, class Of, class Numbers>
void store(const Numbers& numbers, int lanes, const Walks<V>& walks, const Of& of) noexcept {
  std::array<double*, kWidthOf<V>> to;
  for (int lane = 0; lane < kWidthOf<V>; ++lane)
    to[lane] = reinterpret_cast<double*>(&of(*walks[lane]));
  store_lanes<V>(reinterpret_cast<const V*>(&numbers), sizeof(Numbers) / sizeof(V), lanes, to);
}
inline GaitFlow<double>& gait_of(WalkState& walk) noexcept { return walk.gait; }
inline PathFlow<double>& path_of(WalkState& walk) noexcept { return walk.path; }
inline LegFlow<double>& legs_of(WalkState& walk) noexcept { return walk.legs; }
template <int kSide>
FootFlow<double>& foot_of(WalkState& walk) noexcept {
  return walk.foot[kSide];
}
template <int kSide>
FootPoseOf<double>& pose_of(WalkState& walk) noexcept {
  return walk.foot[kSide].pose;
}

template <class V>
void load_walks(const Walks<V>& walks, StateLanes<V>& state) noexcept {
  load<V>(walks, gait_of, state.gait);
  load<V>(walks, path_of, state.path);
  load<V>(walks, foot_of<0>, static_cast<FootFlow<V>&>(state.foot[0]));
  load<V>(walks, foot_of<1>, static_cast<FootFlow<V>&>(state.foot[1]));
  load<V>(walks, pose_of<0>, state.foot[0].pose);
  load<V>(walks, pose_of<1>, state.foot[1].pose);
  load<V>(walks, legs_of, state.legs);
}

template <class V>
Pelvis pelvis_of(const PelvisOf<V>& pelvis, int lane) noexcept {
  Pelvis one;
  get_lane(pelvis, lane, one);
  return one;
}

// Solves the legs of one side, first with even weights. Legs that need another solve get it one by
// one.
template <class V>
PosedLegOf<V> pose_side(const Tick& tick, std::span<const Walking> walks, const MomentOf<V>& at,
                        const PlanOf<V>& plan, const PelvisOf<V>& pelvis, Side side,
                        StateLanes<V>& state) noexcept {
  advance_weighted_leg<V>(tick, at, side, state);
  const LegBuild& leg = tick.model.leg[side];
  LegGoals<V> goals;
  std::array<V, kLegDofs>& even = state.legs.even_rad[side];
  set_start<V>(tick, plan, side, state, even);
  PlannedLeg<V> planned;
  set_planned_leg<V>(leg, state.foot[side].pose, pelvis, planned);
  PosedLegOf<V> posed = closed_leg<V>(state.foot[side].pose);
  const MaskOf<V> missed = not_of(close_lanes<V>(planned, even));
  if (any(missed)) {
    std::array<V, kLegDofs> solved = even;
    set_even_goals<V>(leg, state, pelvis, side, goals);
    const LegSolution<V> solution = solve_lanes<V, false>(goals, LegShares<V>{}, solved);
    for (int j = 0; j < kLegDofs; ++j) even[j] = missed ? solved[j] : even[j];
    keep_solved<V>(leg, missed, solution, pelvis, posed);
  }
  const MaskOf<V> mends = needs_mending<V>(tick.model, at, side, even[kAnkleX], posed.failed);
  PosedLeg one;
  const int count = static_cast<int>(walks.size());
  for (int lane = 0; any(mends) && lane < kWidthOf<V>; ++lane) {
    if (!is_set(mends, lane)) continue;
    WalkState& walk = *walks[std::min(lane, count - 1)].state;
    // Lanes beyond `count` repeat the last walk and get its leg, which is mended already.
    if (lane < count) {
      get_lane(even, lane, walk.legs.even_rad[side]);
      get_lane(posed, lane, one);
      one = mended_leg(tick, walk, pelvis_of(pelvis, lane), side, one);
    }
    set_lanes(one, lane, posed);
    set_lanes(walk.legs.even_rad[side], lane, even);
    set_lanes(static_cast<const FootPoseOf<double>&>(walk.foot[side].pose), lane,
              state.foot[side].pose);
  }
  if (!any(has_weights(state.gait, side))) {
    state.legs.angles_rad[side] = even;
    return posed;
  }
  set_limits<V>(leg, goals);
  set_leg<V>(leg, state.foot[side].pose, pelvis, goals);
  LegShares<V> shares;
  std::array<V, kLegDofs> angles;
  set_shares<V>(tick, at, plan, pelvis, side, state, goals, shares, angles);
  const LegSolution<V> shared = solve_lanes<V, true>(goals, shares, angles);
  keep_shared<V>(leg, side, goals, shares, angles, shared, pelvis, state.legs, posed);
  return posed;
}

}  // namespace

template <int kWidth>
void advance_lanes(const WalkModel& model, double dt_s, std::span<const Walking> walks) noexcept {
  using V = Lanes<kWidth>;
  // The tick's own parameters are the first walk's; those of all walks are in `params`.
  const Tick tick = {model, *walks[0].params, IkMode::robust, dt_s, true};
  const int count = static_cast<int>(walks.size());
  MomentOf<V> at;
  ParamsOf<V> params;
  StateLanes<V> state;
  Locals<kWidth> local;
  std::array<WalkFrame*, kWidth> frames;
  Walks<V> states;
  Moment one;
  for (int lane = 0; lane < kWidth; ++lane) {
    // Lanes beyond `count` compute the last walk again.
    const Walking& walk = walks[std::min(lane, count - 1)];
    if (lane < count)
      begin_tick({model, *walk.params, IkMode::robust, dt_s, true}, *walk.state, one);
    set_lanes(one, lane, at);
    set_lanes(params_of(*walk.params, walk.state->body.now.arm_swing), lane, params);
    states[lane] = walk.state;
    local[lane] = walk.local;
    frames[lane] = &walk.state->frame;
  }
  load_walks<V>(states, state);
  PlanOf<V> plan;
  PelvisOf<V> pelvis;
  plan_walks<V>(tick, at, params, state, plan, pelvis);
  store<V>(state.gait, count, states, gait_of);
  store<V>(state.path, count, states, path_of);
  store<V>(static_cast<const FootFlow<V>&>(state.foot[0]), count, states, foot_of<0>);
  store<V>(static_cast<const FootFlow<V>&>(state.foot[1]), count, states, foot_of<1>);
  store<V>(state.foot[0].pose, count, states, pose_of<0>);
  store<V>(state.foot[1].pose, count, states, pose_of<1>);
  for (const Side side : {kLeftSide, kRightSide}) {
    const PosedLegOf<V> posed = pose_side<V>(tick, walks, at, plan, pelvis, side, state);
    report_leg<V>(at, side, posed, state, {frames.data(), static_cast<std::size_t>(count)});
  }
  store<V>(state.legs, count, states, legs_of);
  write_pose<V>(tick.model, at, state, pelvis, local);
  for (int lane = 0; lane < count; ++lane) {
    const Walking& walk = walks[lane];
    WalkState& to = *walk.state;
    for (int side : {0, 1})
      to.foot[side].pose.toe_rad = lane_of(state.foot[side].pose.toe_rad, lane);
    *walk.root_m = vec3(lane_of(pelvis.position_m.x, lane), lane_of(pelvis.position_m.y, lane),
                        lane_of(pelvis.position_m.z, lane));
    const Tick own = {model, *walk.params, IkMode::robust, dt_s, true};
    pose_upper_body(own, to, {*walk.root_m, {walk.local, walk.joints}});
    end_tick(own, *walk.root_m, to);
  }
}

}  // namespace gaitpad
