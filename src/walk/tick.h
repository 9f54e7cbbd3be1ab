// One tick of the walks of a block, in the order of its data.
#pragma once
#include "walk/ankle.h"
#include "walk/asked_steps.h"
#include "walk/ground_plan.h"
#include "walk/paper.h"
#include "walk/pose.h"
#include "walk/rest.h"
#include "walk/walk.h"

namespace gaitpad {
namespace {

// The step frame of the walks that strike goes to the new footprint.
template <int kWidth>
void move_frame(const Landing<Floats<kWidth>>& landing, const Mask<Floats<kWidth>>& strikes,
                Block<kWidth>& block) noexcept {
  using V = Floats<kWidth>;
  State<V>& state = block.state;
  const Way<V> frame = {
      state.frame_sine, state.frame_cosine, 2.0f * state.frame_sine * state.frame_cosine,
      state.frame_cosine * state.frame_cosine - state.frame_sine * state.frame_sine};
  const Vec<V> moved = frame * Vec<V>{landing.x_m, V{}, landing.z_m};
  const V is = chosen<V>(strikes, 1.0f, 0.0f);
  V half_rad{};
  for (int w = 0; w < kWidth; ++w) {
    Origin& origin = block.origin[w];
    if (lane(is, w) != 0.0f) {
      origin.x_m += lane(moved.x, w);
      origin.z_m += lane(moved.z, w);
      origin.y_m += lane(block.footing.landing_y_m, w);
      origin.heading_rad += lane(landing.rad, w);
    }
    set_lane(static_cast<float>(0.5 * wrapped(origin.heading_rad)), w, half_rad);
  }
  V sine, cosine;
  sin_cos(half_rad, sine, cosine);
  state.frame_sine = strikes ? sine : state.frame_sine;
  state.frame_cosine = strikes ? cosine : state.frame_cosine;
}

// A stand that is asked for very little waits whether it is meant: a stick that is touched in
// passing would else cost two slow steps.
template <class V>
Mask<V> is_meant(const Tables& tables, const State<V>& state, const Change<V>& change) noexcept {
  constexpr float kHesitation_s = 0.2f;  // for next to nothing; less for more, none from
  constexpr float kSureRatio = 0.3f, kSureTurn_rad_s = 0.15f;  // this stride or turn on
  const V ratio = asked_ratio(tables, state),
          sure = most(V(ratio * (1.0f / kSureRatio)),
                      V(size(state.asked.turn_rad_s) * (1.0f / kSureTurn_rad_s)));
  return change.asked_ticks * tables.tick_s >=
         kHesitation_s * tables.time_scale * (1.0f - least(sure, all<V>(1.0f)));
}

// Where one that stands is to walk: the foot on the side of the turn goes first.
template <int kWidth>
void begin_walks(const Tables& tables, Block<kWidth>& block) noexcept {
  using V = Floats<kWidth>;
  State<V>& state = block.state;
  Change<V>& change = block.change;
  const auto asked = both(change.stands != V{}, state.asked.walks != V{});
  if (!any(either(asked, change.asked_ticks != V{}))) return;
  change.asked_ticks = asked ? V(change.asked_ticks + 1.0f) : V{};
  const auto begins = both(asked, is_meant(tables, state, change));
  if (!any(begins)) return;
  change.asked_ticks = begins ? V{} : change.asked_ticks;
  // Who has not stood yet begins with the other foot than the one that is still landing.
  const auto right = state.right_swings != V{}, stood = block.told.settle_ticks == V{},
             other = both(both(begins, stood), right != (state.asked.turn_rad_s < V{}));
  if (any(other)) {
    Landing<V> beside{state.print_x_m, state.print_z_m, state.print_rad, way_of(state.print_rad)};
    Feet<V> feet;
    feet.flat_toe_m = sole_of<V>(tables, no(right)).line_m;
    Footing<V>& footing = block.footing;
    if (is_uneven(tables)) {
      feet.flat_toe_m = tilt_of(footing.stand) * feet.flat_toe_m;
      footing.landing = chosen(other, footing.print, footing.landing);
      footing.landing_y_m = other ? footing.print_y_m : footing.landing_y_m;
    }
    move_frame<kWidth>(beside, other, block);
    move_rails(other, footing.landing_y_m, block.styled);
    if (is_uneven(tables)) change_footing(beside, other, feet.flat_toe_m.y, footing);
    change_feet(beside, other, feet, Stride<V>{}, state);
    const LegBones &l = tables.leg[0], &r = tables.leg[1];
    const V wider_m = chosen<V>(right, std::abs(r.stance_m) - std::abs(r.track_m),
                                std::abs(l.stance_m) - std::abs(l.track_m));
    state.wider_m = other ? wider_m : state.wider_m;
    change_weighted_legs(other, block.weighted);
    state.right_swings = other ? V(1.0f - state.right_swings) : state.right_swings;
  }
  const auto set = [&](const V& to, V& number) { number = begins ? to : number; };
  const auto first = state.right_swings != V{};
  const auto& share = tables.stage_share;
  const V begin = chosen<V>(first, share[0] + share[1], 0.0f),
          middle = 0.5f * chosen<V>(first, share[2] + share[3], share[0] + share[1]);
  set(state.asked.backward, state.backward);
  set(V{}, change.stands), set(all<V>(1.0f), change.starting), set(all<V>(1.0f), change.led);
  set(all<V>(1.0f), change.is_new);
  set(V{}, change.was_led), set(V{}, change.off_phase.x), set(V{}, change.off_ticks);
  // The tables' hips are over the foot that stands in the middle of its support.
  set(V(begin + middle), change.phase), set(V{}, change.phase_rate);
  set(begin, state.phase), set(V{}, state.phase_rate), set(V{}, state.strike_rate);
  set(V{}, state.tick), set(V{}, state.flies), set(V{}, state.late_s);
  set(V{}, state.ratio_behind), set(V{}, state.stand_pitch_rad);
  for (V* number : {&block.told.stride_m[0], &block.told.stride_m[1], &block.told.step_ticks[0],
                    &block.told.step_ticks[1]})
    *number = both(begins, stood) ? V{} : *number;
  for (Smoothed<V>& length_m : state.length_m) set(V{}, length_m.x), set(V{}, length_m.v);
  go_on_from_here(tables, begins, state, change);
}

// Where both feet stand no clock runs, and nothing is left of the last step.
template <class V>
void rest(const Tables& tables, const Change<V>& change, State<V>& state) noexcept {
  const auto stands = change.stands != V{};
  const auto set = [&](float to, V& number) { number = stands ? all<V>(to) : number; };
  set(1.0f, state.roll_ticks), set(1.0f, state.flight_ticks), set(0.0f, state.stand_pitch_rad);
  set(0.0f, state.ratio_behind), set(0.0f, state.phase), set(0.0f, state.phase_rate);
  const LegBones& left = tables.leg[0];
  set(std::abs(left.stance_m) - std::abs(left.track_m), state.wider_m);
}

// What is rare is done for one walk after the other.
template <int kWidth, class Work>
void one_by_one(const Mask<Floats<kWidth>>& where, Block<kWidth>& block,
                const Work& work) noexcept {
  if (!any(where)) return;
  if constexpr (kWidth == 1) {
    work(block, 0);
  } else {
    const Floats<kWidth> is = chosen<Floats<kWidth>>(where, 1.0f, 0.0f);
    for (int w = 0; w < kWidth; ++w) {
      if (lane(is, w) == 0.0f) continue;
      Block<1> one;
      copy_walk(block, w, one, 0);
      work(one, w);
      copy_walk(one, 0, block, w);
    }
  }
}

// A foot in flight goes to a new foothold where its way there is as clear of the ground as it was.
template <class Plan>
void change_over_ground(const Tables& tables, Block<1>& block, const Plan& plan) noexcept {
  constexpr float kDeep_m = 0.004f;
  if (block.state.flies == 0.0f) return plan(true, block, block.footing);
  const Block<1> was = block;
  plan(true, block, block.footing);
  if (block.change.gap_begin == was.change.gap_begin) return;  // its landing stays
  if (depth_of_flight(tables, block) <= most(kDeep_m, depth_of_flight(tables, was))) return;
  block = was;
  plan(false, block, block.footing);
}

// Where one that walks is to come to rest, or to go on after all: when the stick, which passes
// through small deflections on its way, is where it is meant to be.
template <int kWidth, bool kUneven>
void change_ends(const Tables& tables, Block<kWidth>& block) noexcept {
  using V = Floats<kWidth>;
  constexpr float kGrows_per_s = 5.0f;
  const Asked<V>& asked = block.state.asked;
  V& asked_m = block.change.asked_m;
  const V way_m = asked.length_m[0] + asked.length_m[1] + size(asked.turn_rad_s);
  const auto comes = size(V(way_m - asked_m)) > kGrows_per_s * tables.tick_s * way_m;
  const auto walks = is_to_walk(block.state), stops = block.change.stops != V{},
             moves = both(block.change.stands == V{}, either(no(walks), no(comes)));
  asked_m = asked.walks != V{} ? way_m : V{};
  const auto ends = [&](bool may_move, Block<1>& one, auto& footing) {
    plan_rest(tables, may_move, one, footing);
  };
  const auto comes_back = [&](bool may_move, Block<1>& one, auto& footing) {
    walk_on(tables, may_move, one, footing);
  };
  const auto change = [&](Block<1>& one, const auto& plan) {
    if constexpr (kUneven) {
      change_over_ground(tables, one, plan);
    } else {
      NoFooting level;
      plan(true, one, level);
    }
  };
  // A landing that was asked for keeps its place; the step after it may end.
  const auto is_open = both(no(stops), block.change.is_aimed == V{});
  one_by_one<kWidth>(both(moves, both(no(walks), is_open)), block,
                     [&](Block<1>& one, int) { change(one, ends); });
  one_by_one<kWidth>(both(moves, both(walks, stops)), block,
                     [&](Block<1>& one, int) { change(one, comes_back); });
}

// Whether a flight is asked to be followed by another pace than was known; from time to time.
template <class V>
Mask<V> is_unforeseen(const Tables& tables, const State<V>& state,
                      const Change<V>& change) noexcept {
  constexpr float kOther = 0.1f;
  const V asked_m = state.asked.length_m[0] + state.asked.length_m[1],
          part = state.tick / static_cast<float>(sink_knot_ticks(tables));
  return both(size(V(asked_m - change.foreseen_m)) > kOther * asked_m,
              both(state.flies != V{}, part == floored(part)));
}

// From time to time: slow steps on stairs last longer than what is known ahead.
template <class V>
Mask<V> is_half_seen(const Tables& tables, const State<V>& state) noexcept {
  const V part = state.tick / static_cast<float>((kSinkKnots - 3) / 2 * sink_knot_ticks(tables));
  return both(state.tick != V{}, part == floored(part));
}

// Where the landing on level ground has moved, the ground is asked for another one.
template <int kWidth>
void choose_footholds(const Tables& tables, const Time<Floats<kWidth>>& time,
                      const AskedStep<Floats<kWidth>>& asked, Block<kWidth>& block) noexcept {
  using V = Floats<kWidth>;
  constexpr float kMoved = 7e-6f;        // metres, radians
  constexpr float kPieceSettles = 0.6f;  // of the roll: until then a step may still go elsewhere
  const State<V>& state = block.state;
  Footing<V>& footing = block.footing;
  const auto begins = both(no(time.flies), state.tick == all<V>(1.0f)),
             settles = both(no(time.flies), state.tick <= kPieceSettles * state.roll_ticks);
  const V moved = most(most(size(V(footing.level_x_m - footing.asked_x_m)),
                            size(V(footing.level_z_m - footing.asked_z_m))),
                       size(V(state.landing_rad - footing.asked_rad)));
  const auto asks = both(block.change.stands == V{}, either(begins, moved > all<V>(kMoved)));
  if (!any(asks)) return;
  footing.asked_x_m = asks ? footing.level_x_m : footing.asked_x_m;
  footing.asked_z_m = asks ? footing.level_z_m : footing.asked_z_m;
  footing.asked_rad = asks ? state.landing_rad : footing.asked_rad;
  const V is_first = chosen<V>(begins, 1.0f, 0.0f),
          is_open = chosen<V>(either(begins, settles), 1.0f, 0.0f);
  one_by_one<kWidth>(asks, block, [&](Block<1>& one, int w) {
    const AskedFoothold step{lane(asked.along.sine, w), lane(asked.along.cosine, w),
                             lane(asked.length_m, w),   lane(is_first, w) != 0.0f,
                             lane(is_open, w) != 0.0f,  goes_on(one.state, one.change)};
    choose_foothold(tables, step, one);
  });
}

// One that is walked ahead asks for no ground. Its running step lands on the plane that was chosen
// for it, and the next ones rise as the last one did.
template <class V>
void assume_foothold(const Time<V>& time, const AskedStep<V>& asked, State<V>& state,
                     Footing<V>& footing) noexcept {
  constexpr float kMostSteeper = 1.5f, kLeast_m = 1e-3f;
  const auto begins = both(no(time.flies), state.tick == all<V>(1.0f));
  const auto move = [&](const V& level_m, V& asked_m, V& landing_m) {
    const V moved_m = level_m - asked_m;
    landing_m = begins ? level_m : V(landing_m + moved_m);
    asked_m = level_m;
    return moved_m;
  };
  const V x_m = move(footing.level_x_m, footing.asked_x_m, state.landing_x_m),
          z_m = move(footing.level_z_m, footing.asked_z_m, state.landing_z_m);
  const auto far = [](const V& x, const V& z) { return root(V(x * x + z * z)); };
  const V longer = far(state.landing_x_m, state.landing_z_m) /
                   most(far(state.print_x_m, state.print_z_m), all<V>(kLeast_m)),
          rise_m = asked.length_m == V{}
                       ? V{}
                       : V(-footing.print_y_m * least(longer, all<V>(kMostSteeper)));
  footing.landing_y_m =
      begins ? rise_m : V(footing.landing_y_m + rise_of(footing.landing, x_m, z_m));
}

// Where a flight begins, or its landing has moved, it is planned how it keeps clear of the ground.
template <int kWidth>
void plan_rooms(const Tables& tables, const Mask<Floats<kWidth>>& lifts,
                Block<kWidth>& block) noexcept {
  using V = Floats<kWidth>;
  const State<V>& state = block.state;
  const Vec<V> off = block.footing.room_for_m -
                     Vec<V>{state.landing_x_m, block.footing.landing_y_m, state.landing_z_m};
  const float most_m = kReplan_m * tables.size;
  const auto moved = both(state.flies != V{}, dot(off, off) > all<V>(most_m * most_m));
  const auto plans = either(lifts, moved);
  if (!any(plans)) return;
  const V begins = chosen<V>(lifts, 1.0f, 0.0f);
  one_by_one<kWidth>(
      plans, block, [&](Block<1>& one, int w) { plan_room(tables, lane(begins, w) != 0.0f, one); });
}

// What was asked of a landing is over; a push goes on in the next step's frame.
template <class V>
void end_aims(const Landing<V>& landing, const Mask<V>& strikes, Change<V>& change) noexcept {
  const Way<V>& way = landing.way;
  const V x = change.push_x_m_s, z = change.push_z_m_s;
  change.is_aimed = strikes ? V{} : change.is_aimed;
  change.push_x_m_s = strikes ? V(way.cosine * x - way.sine * z) : x;
  change.push_z_m_s = strikes ? V(way.cosine * z + way.sine * x) : z;
}

// `footing`: the block's, or none. kPaper: with the paper's own solver, of one walk; the body leans
// into nothing then.
template <int kWidth, bool kPaper, class F>
void advance_on(const Tables& tables, Block<kWidth>& block, F& footing, const Poses& poses,
                bool looks_ahead = true) noexcept;

// Walks ahead, to know when legs will be at their reach: hips sink before that.
template <bool kPaper, bool kUneven>
void look_ahead(const Tables& tables, Block<1>& block) noexcept {
  Change<float>& change = block.change;
  const int knot = sink_knot_ticks(tables), all_ticks = (kSinkKnots - 3) * knot,
            left = static_cast<int>(change.sink_ticks), at = left > 0 ? all_ticks - left : 0,
            first = at / knot, gone = at - first * knot;
  std::array<float, kSinkKnots> wants_m{};  // between knots, the most
  Block<1> ahead = block;
  NoFooting level;
  ahead.change.sink_ticks = 0.0f;
  for (int tick = gone; tick < all_ticks; ++tick) {
    if constexpr (kUneven) {
      advance_on<1, kPaper>(tables, ahead, ahead.footing, Poses{nullptr, nullptr, 0}, false);
    } else {
      advance_on<1, kPaper>(tables, ahead, level, Poses{nullptr, nullptr, 0}, false);
    }
    float& most_m = wants_m[tick / knot];
    most_m = most(most_m, ahead.change.wants_m);
  }
  // Knot k stands at the beginning of part k - 1: it takes the most of the parts before and after
  // that. The four that act now stay.
  std::array<float, kSinkKnots> knots_m{};
  bool sinks = false;
  for (int k = 0; k < kSinkKnots; ++k) {
    if (k < 4 && left > 0)
      knots_m[k] = change.sink_m[first + k];
    else if (k >= 4 && k < kSinkKnots - 3)
      knots_m[k] = most(wants_m[k - 2], wants_m[k - 1]);
    sinks |= knots_m[k] != 0.0f;
  }
  for (int k = 0; k < kSinkKnots; ++k) change.sink_m[k] = knots_m[k];
  change.foreseen_m = block.state.asked.length_m[0] + block.state.asked.length_m[1];
  change.sink_ticks = sinks ? static_cast<float>(all_ticks - gone) : 0.0f;
}

template <class V>
void keep_solves(const Time<V>& time, const Leg<V> (&legs)[2], Told<V>& told) noexcept {
  constexpr float kReached_m = 1e-4f;
  for (int side : {0, 1}) {
    const auto swings = side == 1 ? time.right : no(time.right);
    told.iterations[side] = swings ? legs[0].iterations : legs[1].iterations;
    told.error_m[side] = swings ? legs[0].short_m : legs[1].short_m;
    const auto failed = either(both(swings, legs[0].failed), both(no(swings), legs[1].failed));
    told.failed[side] =
        chosen<V>(either(failed, told.error_m[side] > all<V>(kReached_m)), 1.0f, 0.0f);
  }
}
// The landings, and what the step was, where one ends.
template <class V>
void count_step(const Time<V>& time, const Landing<V>& landing, const Way<V>& to,
                const Mask<V>& strikes, const State<V>& state, const V& overhangs,
                Told<V>& told) noexcept {
  const V length_m = landing.x_m * to.sine + landing.z_m * to.cosine;
  for (int side : {0, 1}) {
    const auto steps = both(strikes, side == 1 ? time.right : no(time.right));
    told.steps[side] = steps ? V(told.steps[side] + 1.0f) : told.steps[side];
    told.stride_m[side] = steps ? length_m : told.stride_m[side];
  }
  told.overhangs = strikes ? V(told.overhangs + overhangs) : told.overhangs;
  told.step_ticks[1] = strikes ? told.step_ticks[0] : told.step_ticks[1];
  told.step_ticks[0] = strikes ? V(state.roll_ticks + state.flight_ticks) : told.step_ticks[0];
}

// The last roll, until both feet count as flat.
template <class V>
void count_last_roll(const Tables& tables, const Mask<V>& strikes, const Change<V>& change,
                     Told<V>& told) noexcept {
  constexpr float kLastRoll_s = 0.17f;
  const V last = all<V>(kLastRoll_s * tables.time_scale / tables.tick_s);
  told.settle_ticks = both(strikes, change.stands != V{}) ? floored(V(last + 0.5f))
                                                          : most(V(told.settle_ticks - 1.0f), V{});
}

// A walk may change its solver: the paper's one starts from whole angles, and weights of the other
// one from their own means.
template <bool kPaper>
void change_solver(const Tables& tables, const Time<float>& time, const Stride<float>& stride,
                   State<float>& state, Change<float>& change, Weighted<float>& weighted) noexcept {
  if ((change.by_paper != 0.0f) == kPaper) return;
  weighted.acts = 0.0f;
  change.by_paper = kPaper ? 1.0f : 0.0f;
  for (int k : {0, 1}) {
    float table_rad[kLegAngles];
    set_table_angles(tables, k == 0 ? time.right : no(time.right), stride, k, table_rad);
    for (int j = 0; j < kLegAngles; ++j) {
      state.leg_rad[k][j] += kPaper ? table_rad[j] : -table_rad[j];
      state.last_leg_rad[k][j] = kPaper ? 0.0f : state.leg_rad[k][j];
    }
  }
}

// Legs and upper body, and the root. `is_new`: the plan has changed in this tick.
template <int kWidth, bool kPaper, class F>
void pose_walks(const Tables& tables, const BodyTick<Floats<kWidth>>& tick,
                const Mask<Floats<kWidth>>& is_new, Block<kWidth>& block, const F& footing,
                Feet<Floats<kWidth>>& feet, const Poses& poses) noexcept {
  using V = Floats<kWidth>;
  constexpr bool kUneven = kIsUneven<F>;
  State<V>& state = block.state;
  const Change<V>& change = block.change;
  const auto& [time, landing, hips, stride, pelvis, idle, phase, shown] = tick;
  if constexpr (kWidth == 1)
    change_solver<kPaper>(tables, time, stride, state, block.change, block.weighted);
  Leg<V> legs[2];
  Mask<V> eases{};
  if constexpr (kPaper) {
    solve_by_paper(tables, time, phase, change, feet, pelvis, state, block.weighted, legs);
  } else {
    V begun_rad[2][kLegAngles];
    solve_legs(tables, time, stride, feet, pelvis, state, legs, kUneven ? begun_rad : nullptr);
    if constexpr (kUneven)
      ease_ankles(tables, time, stride, phase, pelvis, change, footing, state, feet, begun_rad,
                  legs);
    weigh_legs(tables, time, stride, feet, pelvis, phase, change, state, block.weighted, legs);
    eases = advance_poise(tables, hips, is_new, change, state, block.poise);
  }
  const V swing = kPaper ? all<V>(1.0f) : arm_swing(tables, state);
  write_upper_body<kWidth, kPaper>(tables, tick, swing, eases, block, poses);
  write_legs(tables, time, feet, legs, poses);
  write_root<kWidth>(tables, hips, pelvis, block, poses);
  keep_solves(time, legs, block.told);
}

template <int kWidth, bool kPaper, class F>
void advance_on(const Tables& tables, Block<kWidth>& block, F& footing, const Poses& poses,
                bool looks_ahead) noexcept {
  using V = Floats<kWidth>;
  State<V>& state = block.state;
  Change<V>& change = block.change;
  constexpr bool kUneven = kIsUneven<F>;
  const auto follows = change.is_new != V{};  // for a step has begun
  begin_walks(tables, block);
  if (!kUneven || looks_ahead) change_ends<kWidth, kUneven>(tables, block);
  one_by_one<kWidth>(either(change.push_x_m_s != V{}, change.push_z_m_s != V{}), block,
                     [&](Block<1>& one, int) { take_push(tables, one); });
  const auto is_new = both(no(follows), change.is_new != V{}),
             is_short = either(either(change.starting != V{}, change.stops != V{}),
                               change.catch_ticks != V{});
  if constexpr (kUneven && !kPaper) lean_into_slope(tables, state, change, footing);
  if constexpr (kUneven && kPaper) footing.lean_rad = {};
  V left = all<V>(1.0f);
  if constexpr (kUneven) left = footing.left.x;
  smooth_asked(tables, change, left, state);
  if constexpr (kPaper) state.lean_rad = state.chest_ahead_rad = state.head_ahead_rad = {};
  V first_s{};
  if constexpr (kUneven) first_s = first_flight_s(tables, footing);
  const Time<V> time = advance_clock(tables, first_s, change, state);
  const AskedStep<V> asked = plan_landing(tables, time, change, state, footing);
  if constexpr (kUneven) {
    if (looks_ahead) {
      choose_footholds<kWidth>(tables, time, asked, block);
    } else {
      assume_foothold(time, asked, state, footing);
    }
  }
  Landing<V> landing = planned_landing(tables, time, asked.to, change, state);
  if constexpr (kUneven) {
    take_time_to_tread(tables, time, change, footing, state);
    follow_ground(tables, time, asked, change, state, footing, landing);
    move_hips_ground(tables, time, landing, change, state, footing);
    if (looks_ahead) plan_rooms<kWidth>(tables, Mask<V>{}, block);
  }
  const Stride<V> by_clock =
      read_by_clock(tables, time, landing, state.phase, time.share, time.u, change, state);
  Hips<V> hips = move_hips(tables, time, landing, by_clock, change, state);
  Stride<V> stride;
  const V phase = lead_hips(tables, time, landing, by_clock, state, change, hips, stride);
  keep_pelvis(hips, state);
  block.told.pelvis_x_m = stride.pelvis_m.x, block.told.pelvis_z_m = stride.pelvis_m.z;
  Feet<V> feet = plan_feet(tables, time, landing, by_clock, stride, hips, change, state, footing);
  Pelvis<V> pelvis = pelvis_over(tables, time, hips, stride, state, footing);
  Idle<V> idle;
  if constexpr (!kPaper) {
    idle = advance_idle(tables, change, state, block.styled);
    sway(idle, hips.heading, pelvis);
  }
  V asked_rad[2]{};
  keep_heels_low(tables, time, phase, stride, change, state, block.styled, pelvis, feet, asked_rad);
  for (int k : {0, 1}) feet.ankle_m[k] = ankle_of(feet.foot[k], feet.sole[k]);
  sink(tables, time, stride, feet.ankle_m, state, change, pelvis);
  reach_with_toe(tables, time, change, pelvis, feet);
  if (looks_ahead)  // nobody sees a walk that is walked ahead
    pose_walks<kWidth, kPaper>(
        tables, BodyTick<V>{time, landing, hips, stride, pelvis, idle, phase, change.shown}, is_new,
        block, footing, feet, poses);

  take_back(asked_rad, feet);
  const auto lifts = both(no(time.flies), state.tick >= state.roll_ticks),
             strikes = both(time.flies, state.tick >= state.flight_ticks);
  if (any(lifts))
    lift_off(tables, time, lifts, landing, hips, feet, by_clock, change, state, footing);
  keep_swing(feet.foot[0], state);
  if constexpr (kUneven)
    footing.last_rise_m[1] = footing.last_rise_m[0], footing.last_rise_m[0] = footing.rise_m;
  block.told.struck = chosen<V>(strikes, 1.0f, 0.0f);
  if (any(strikes)) {
    V overhangs{};
    if constexpr (kUneven) overhangs = footing.overhangs;
    landing.rad = rounded_to(kFrameTurned_rad, landing.rad);
    count_step(time, landing, asked.to, strikes, state, overhangs, block.told);
    auto is_level = change.slowness == all<V>(1.0f);
    move_frame<kWidth>(landing, strikes, block);
    if constexpr (kUneven) {
      move_rails(strikes, footing.landing_y_m, block.styled);
      change_footing(landing, strikes, feet.flat_toe_m.y, footing);
      const V slow = slowness_of(tables, no(time.right), state, footing);
      change.slowness = strikes ? slow : change.slowness;
      is_level = both(is_level, slow == all<V>(1.0f));
    }
    // A step whose plan changed late has not come over to its own stride yet.
    landing.ratio = change.off_over.x != V{}
                        ? mix(state.ratio_behind, landing.ratio, V(1.0f + change.off_over.x))
                        : landing.ratio;
    change_feet(landing, strikes, feet, stride, state);
    change_weighted_legs(strikes, block.weighted);
    change_styled_feet(strikes, block.styled);
    end_aims(landing, strikes, change);
    const auto keeps = either(change.led != V{}, change.off_phase.x != V{});
    const V rate = keeps ? change.phase_rate : state.phase_rate;
    begin_lead(tables, strikes, phase, rate, is_level, state, change);
    begin_step(tables, time, strikes, change, state);
    one_by_one<kWidth>(both(strikes, change.closing != V{}), block, [&](Block<1>& one, int) {
      if constexpr (kUneven) time_rest(tables, one.state, one.change);
      time_closing_step(tables, one.state, one.change);
    });
    rest(tables, change, state);
    if constexpr (kUneven) footing.next_rise = change.stands != V{} ? V{} : footing.next_rise;
  }
  count_last_roll(tables, strikes, change, block.told);
  if (any(lifts)) {
    plan_limp(tables, time, lifts, state, change);
    begin_flight(tables, time, lifts, change, state);
    if (kUneven && looks_ahead) plan_rooms<kWidth>(tables, lifts, block);
  }
  if (!looks_ahead) return;
  // Over uneven ground any change of pace asks for more than the tables know.
  const auto sinks = either(change.led != V{}, change.sink_ticks != V{}),
             changes = kUneven ? either(is_short, sinks) : is_short,
             again = kUneven ? either(either(lifts, strikes), is_half_seen(tables, state))
                             : either(lifts, strikes),
             looks = either(either(is_new, both(again, changes)),
                            both(is_to_walk(state), is_unforeseen(tables, state, change)));
  one_by_one<kWidth>(looks, block,
                     [&](Block<1>& one, int) { look_ahead<kPaper, kUneven>(tables, one); });
}

template <int kWidth, bool kPaper = false>
void advance_block(const Tables& tables, Block<kWidth>& block, const Poses& poses) noexcept {
  NoFooting level;
  if (is_uneven(tables)) {
    advance_on<kWidth, kPaper>(tables, block, block.footing, poses);
  } else {
    advance_on<kWidth, kPaper>(tables, block, level, poses);
  }
}

}  // namespace
}  // namespace gaitpad
