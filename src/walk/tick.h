// One tick of the walks of a block: advance_on(), at the end, in the order of its data.
#pragma once
#include "walk/ankle.h"
#include "walk/detail.h"
#include "walk/ground_plan.h"
#include "walk/knees.h"
#include "walk/paper.h"
#include "walk/pose.h"
#include "walk/rest.h"
#include "walk/turn_back.h"
#include "walk/walk.h"

namespace gaitpad {
namespace {

// Moves the step frame of the walks that strike to the new footprint.
template <int kWidth>
void move_frame(const Landing<Floats<kWidth>>& landing, const Mask<Floats<kWidth>>& strikes,
                Block<kWidth>& block) noexcept {
  using V = Floats<kWidth>;
  State<V>& state = block.state;
  const Vec<V> moved =
      way_of_half(state.frame_sine, state.frame_cosine) * Vec<V>{landing.x_m, V{}, landing.z_m};
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

// True if a standing walk is to start. It waits longer the smaller the command is; otherwise a
// stick that is touched in passing would cost two slow steps.
template <class V>
Mask<V> is_meant(const Tables& tables, const State<V>& state, const Change<V>& change) noexcept {
  constexpr float kHesitation_s = 0.2f;                         // longest, for a tiny command
  constexpr float kSureRatio = 0.25f, kSureTurn_rad_s = 0.15f;  // step or turn that need not wait
  const V ratio = asked_ratio(tables, state),
          sure = most(V(ratio * (1.0f / kSureRatio)),
                      V(size(state.asked.turn_rad_s) * (1.0f / kSureTurn_rad_s)));
  return change.asked_ticks * tables.tick_s >=
         kHesitation_s * tables.time_scale * (1.0f - least(sure, all<V>(1.0f)));
}

// Starts standing walks that are asked to walk: the foot on the inner side of the turn goes first.
template <int kWidth>
void begin_walks(const Tables& tables, Block<kWidth>& block) noexcept {
  using V = Floats<kWidth>;
  State<V>& state = block.state;
  Change<V>& change = block.change;
  const auto asked = both(change.stands != V{}, state.asked.walks != V{});
  if (!any(either(asked, change.asked_ticks != V{}))) return;
  change.asked_ticks = asked ? V(change.asked_ticks + tables.ticks) : V{};
  const auto begins = both(asked, is_meant(tables, state, change));
  if (!any(begins)) return;
  change.asked_ticks = begins ? V{} : change.asked_ticks;
  // A walk whose last foot is still landing starts with the other foot.
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
    for (V(&knees)[2] : change.knee_rad) exchange(other, knees[0], knees[1]);
    change_weighted_legs(other, block.weighted);
    state.right_swings = other ? V(1.0f - state.right_swings) : state.right_swings;
  }
  const auto set = [&](const V& to, V& number) { number = begins ? to : number; };
  const auto first = state.right_swings != V{};
  const V begin = step_phase_of<V>(tables, first),
          middle = 0.5f * (roll_cycles<V>(tables, first) + flight_cycles<V>(tables, first));
  set(state.asked.backward, state.backward);
  // A turn on the spot that comes to rest keeps these lengths, not those of the last walk.
  for (int side : {0, 1}) set(state.asked.length_m[side], change.length_m[side]);
  for (V* flag : {&change.starting, &change.led, &change.is_new}) set(all<V>(1.0f), *flag);
  // In the tables the hips are over the standing foot in the middle of its support.
  set(V(begin + middle), change.phase), set(begin, state.phase);
  for (V* number :
       {&change.stands, &change.was_led, &change.off_phase.x, &change.off_ticks, &change.phase_rate,
        &state.phase_rate, &state.strike_rate, &state.tick, &state.flies, &state.late_s,
        &state.ratio_behind, &state.stand_pitch_rad, &state.pace.x, &state.pace.v,
        &state.length_m[0].x, &state.length_m[0].v, &state.length_m[1].x, &state.length_m[1].v})
    set(V{}, *number);
  for (V* number : {&block.told.stride_m[0], &block.told.stride_m[1], &block.told.step_ticks[0],
                    &block.told.step_ticks[1]})
    *number = both(begins, stood) ? V{} : *number;
  go_on_from_here(tables, begins, state, change);
}

// Stops the clock of walks that stand and drops what is left of their last step.
template <class V>
void rest(const Tables& tables, const Change<V>& change, State<V>& state) noexcept {
  const auto stands = change.stands != V{};
  const auto set = [&](float to, V& number) { number = stands ? all<V>(to) : number; };
  set(1.0f, state.roll_ticks), set(1.0f, state.flight_ticks), set(0.0f, state.stand_pitch_rad);
  set(0.0f, state.ratio_behind), set(0.0f, state.phase), set(0.0f, state.phase_rate);
  const LegBones& left = tables.leg[0];
  set(std::abs(left.stance_m) - std::abs(left.track_m), state.wider_m);
}

// Does rare work for one walk after the other.
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

// Plans a stop, or its end, on uneven ground. A flying foot goes to a new foothold only if it gets
// no deeper into the ground on its way than before.
template <class Plan>
void change_over_ground(const Tables& tables, Block<1>& block, const Plan& plan) noexcept {
  constexpr float kDeep_m = 0.004f;  // below the 5 mm at which a sole is judged to be in the ground
  if (block.state.flies == 0.0f) return plan(true, block, block.footing);
  const Block<1> was = block;
  plan(true, block, block.footing);
  if (block.change.gap_begin == was.change.gap_begin) return;  // the landing has not moved
  if (depth_of_flight(tables, block) <= most(kDeep_m, depth_of_flight(tables, was))) return;
  block = was;
  plan(false, block, block.footing);
}

// True in a step that began on the spot, or nearly, and is asked to go somewhere, until its hips
// lead; in a first step that turns, in its flight. Hips went by up to 13 m/s^2 to a landing that
// moved away in such a flight. Planned anew in its roll, the foot that lifts off jerked.
template <class V>
Mask<V> is_to_leave_spot(const Tables& tables, const State<V>& state,
                         const Change<V>& change) noexcept {
  constexpr float kOnSpot = 0.3f, kGoes = 0.1f;  // ratios to the data's stride
  constexpr float kTurns_rad_s = 0.7f;           // less hardly moves a landing
  const V begun = longer_ratio(tables, change.length_m, state.backward);
  const auto on_spot =
      begun<all<V>(kOnSpot), goes = asked_ratio(tables, state) - begun> all<V>(kGoes);
  const auto first = both(both(change.starting != V{}, change.turns == V{}),
                          both(change.resumes == V{}, state.flies != V{})),
             turns = both(first, size(state.turn_rad_s.x) > all<V>(kTurns_rad_s));
  return both(both(change.stands == V{}, either(change.led == V{}, turns)), both(on_spot, goes));
}

// Plans stops, and walks that go on after all. A stop for a turn on the spot and a walk that goes
// on wait until the stick has come to rest, because on its way it passes through other deflections.
template <int kWidth, bool kUneven>
void change_ends(const Tables& tables, Block<kWidth>& block) noexcept {
  using V = Floats<kWidth>;
  constexpr float kGrows_per_s = 5.0f;  // share of a command: faster is a stick on its way
  constexpr float kTurn_s = 1.0f;       // a turn of 1 rad/s counts as steps of one leg
  const Asked<V>& asked = block.state.asked;
  V(&asked_legs)[2] = block.change.asked_legs;
  const V length_legs = (asked.length_m[0] + asked.length_m[1]) * (1.0f / tables.leg_m),
          turn_legs = kTurn_s * size(asked.turn_rad_s), longer_legs = length_legs - asked_legs[0],
          turned_legs = turn_legs - asked_legs[1];
  const auto grows = [&](const V& more_legs, const V& of_legs) {
    return size(more_legs) > kGrows_per_s * (tables.ticks * tables.tick_s) * of_legs;
  };
  // On level ground length and turn each count: of their sum alone, a stick that comes back from a
  // turn on the spot would seem to rest. A flight that leaves the spot has no time to wait for more
  // than that, but a first one.
  const V all_legs = length_legs + turn_legs;
  const auto ends = either(block.change.stops != V{}, block.change.starting != V{}),
             waits = kUneven ? Mask<V>{} : either(ends, block.state.flies == V{}),
             each = either(grows(longer_legs, length_legs),
                           grows(V(size(longer_legs) + size(turned_legs)), all_legs)),
             comes = waits ? each : grows(V(longer_legs + turned_legs), all_legs);
  if constexpr (!kUneven)
    one_by_one<kWidth>(is_to_turn_back(block.state, block.change), block,
                       [&](Block<1>& one, int) { turn_back(tables, one); });
  const auto walks = is_to_walk(tables, block.state, block.change),
             stops = block.change.stops != V{}, turns = is_asked_onto_spot(tables, block.state),
             moves =
                 both(block.change.stands == V{}, either(both(no(walks), no(turns)), no(comes)));
  asked_legs[0] = asked.walks != V{} ? length_legs : V{};
  asked_legs[1] = asked.walks != V{} ? turn_legs : V{};
  const auto rests = [&](bool may_move, Block<1>& one, auto& footing) {
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
  // A landing that a program asked for keeps its place, so the stop waits for the next step.
  const auto is_open = both(no(stops), block.change.is_aimed == V{});
  one_by_one<kWidth>(both(moves, both(no(walks), is_open)), block,
                     [&](Block<1>& one, int) { change(one, rests); });
  const auto leaves = is_to_leave_spot(tables, block.state, block.change);
  one_by_one<kWidth>(both(moves, both(walks, either(stops, leaves))), block,
                     [&](Block<1>& one, int) { change(one, comes_back); });
}

// True in a flight whose next step is asked for at another pace than the last look ahead assumed.
// Asks once per knot of the sinking.
template <class V>
Mask<V> is_unforeseen(const Tables& tables, const State<V>& state,
                      const Change<V>& change) noexcept {
  constexpr float kOther = 0.1f;  // of the steps' lengths
  const V asked_m = state.asked.length_m[0] + state.asked.length_m[1],
          part = state.tick / static_cast<float>(sink_knot_ticks(tables));
  return both(size(V(asked_m - change.foreseen_m)) > kOther * asked_m,
              both(state.flies != V{}, part == floored(part)));
}

// True when half of a look ahead is over: slow steps on stairs last longer than one.
template <class V>
Mask<V> is_half_seen(const Tables& tables, const State<V>& state) noexcept {
  const V part = state.tick / static_cast<float>((kSinkKnots - 3) / 2 * sink_knot_ticks(tables));
  return both(state.tick != V{}, part == floored(part));
}

// True if the step after this one does not rise, but for rounding.
template <class V>
Mask<V> next_is_level(const Footing<V>& footing) noexcept {
  constexpr float kLevel = 1e-5f;  // legs
  return footing.next_rise < all<V>(kLevel);
}
// True in a step whose landing is the end of stairs: the hips lead the step from there.
template <class V>
Mask<V> leaves_stairs(const Change<V>& change, const Footing<V>& footing) noexcept {
  return both(change.slowness > all<V>(1.0f), next_is_level(footing));
}

// True in a flight whose step has another length or another rise than the last one. Unforeseen,
// such steps made legs jump by up to 2.1 degrees in walks by chance over the course.
template <class V>
Mask<V> is_other_step(const Tables& tables, const State<V>& state,
                      const Footing<V>& footing) noexcept {
  constexpr float kLonger = 0.05f, kHigher = 0.01f;  // legs
  const auto far = [](const V& x, const V& z) { return root(V(x * x + z * z)); };
  const V longer_m =
              far(state.landing_x_m, state.landing_z_m) - far(state.print_x_m, state.print_z_m),
          higher_m = footing.landing_y_m + footing.print_y_m;
  return both(state.flies != V{}, either(size(longer_m) > all<V>(kLonger * tables.leg_m),
                                         size(higher_m) > all<V>(kHigher * tables.leg_m)));
}

// Chooses a foothold where the landing on level ground has moved.
template <int kWidth>
void choose_footholds(const Tables& tables, const Time<Floats<kWidth>>& time,
                      const AskedStep<Floats<kWidth>>& asked, Block<kWidth>& block) noexcept {
  using V = Floats<kWidth>;
  constexpr float kMoved = 7e-6f;        // metres, radians: more than rounding
  constexpr float kPieceSettles = 0.6f;  // of the roll: then the landing's section is settled
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
                             lane(is_open, w) != 0.0f,  goes_on(tables, one.state, one.change)};
    choose_foothold(tables, step, one);
  });
}

// Stands for choose_footholds() in a look ahead, which does not ask the ground. The running step
// lands on its plane, and the next steps rise like the last one, in proportion to their length;
// none rises where the next one does not.
template <class V>
void assume_foothold(const Time<V>& time, const AskedStep<V>& asked, State<V>& state,
                     Footing<V>& footing) noexcept {
  constexpr float kMostSteeper = 1.5f;  // times the last rise
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
                   most(far(state.print_x_m, state.print_z_m), all<V>(1e-3f)),
          rise_m = either(asked.length_m == V{}, next_is_level(footing))
                       ? V{}
                       : V(-footing.print_y_m * least(longer, all<V>(kMostSteeper)));
  footing.landing_y_m =
      begins ? rise_m : V(footing.landing_y_m + rise_of(footing.landing, x_m, z_m));
}

// Plans how a flight keeps clear of the ground, where it begins or its landing has moved.
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

// At a strike an asked landing is over, and a push is turned to the new step frame.
template <class V>
void end_aims(const Landing<V>& landing, const Mask<V>& strikes, Change<V>& change) noexcept {
  const Way<V>& way = landing.way;
  const V x = change.push_x_m_s, z = change.push_z_m_s;
  change.is_aimed = strikes ? V{} : change.is_aimed;
  change.push_x_m_s = strikes ? V(way.cosine * x - way.sine * z) : x;
  change.push_z_m_s = strikes ? V(way.cosine * z + way.sine * x) : z;
}

// `footing`: the block's, or NoFooting. kPaper: with the paper's own solver and without leans,
// which it does not have. `looks_ahead`: false in a look ahead itself.
template <int kWidth, bool kPaper, class F>
void advance_on(const Tables& tables, Block<kWidth>& block, F& footing, const Poses& poses,
                bool looks_ahead = true) noexcept;

template <bool kUneven>
auto& footing_of(Block<1>& block, NoFooting& level) noexcept {
  if constexpr (kUneven) {
    return block.footing;
  } else {
    return level;
  }
}

// The planned sinking `at` ticks after the plan's beginning, with its rate and acceleration: a
// uniform cubic B-spline and its derivatives.
inline Off<float> sink_from(const Tables& tables, const Change<float>& change, int at) noexcept {
  const int knot = sink_knot_ticks(tables), i = std::min(at / knot, kSinkKnots - 4);
  const float s = 1.0f / static_cast<float>(knot), u = s * static_cast<float>(at - i * knot),
              *m = change.sink_m + i, from = m[1] - m[0], over = m[2] - m[1], to = m[3] - m[2],
              left = 1.0f - u;
  return {planned_sink(tables, change.sink_m, 0, at),
          s * (0.5f * left * left * from + (0.5f + u * left) * over + 0.5f * u * u * to),
          s * s * (left * (over - from) + u * (to - over))};
}

// The ticks by which a look ahead goes at once: fewer where legs ask for a sinking, whose course is
// to be seen. A tick in which a plan is new, the tick after it, and the last two ticks of a roll or
// a flight are gone alone, because rates are measured there.
inline int ticks_at_once(const Tables& tables, const Block<1>& ahead) noexcept {
  // With twice as long ones, needs that legs ask for within a knot are missed: knees jerk by 1.5
  // degrees in four of 200 walks by chance.
  constexpr float kFar_s = 0.025f, kNear_s = 0.0125f;
  constexpr float kAsks_m = 1e-5f;  // less cannot be seen
  const Change<float>& change = ahead.change;
  const State<float>& state = ahead.state;
  if (change.is_new != 0.0f || change.was_new != 0.0f) return 1;
  // A stop within a first step: seen less exactly, legs jerked by up to 2.2 degrees after taps.
  if (change.starting != 0.0f && change.stops != 0.0f) return 1;
  const float goes_s = change.wants_m < kAsks_m ? kFar_s : kNear_s;
  const int most_ticks = std::max(1, static_cast<int>(goes_s / tables.tick_s + 0.5f));
  if (change.stands != 0.0f) return most_ticks;
  return std::clamp(static_cast<int>(ticks_of_stage(state) - state.tick) - 2, 1, most_ticks);
}

// The sinking that legs ask for at a tick of a look ahead, and its slope at the second of three.
struct Need {
  int tick = 0;
  float m = 0.0f;
};
inline float slope_of(const Need& a, const Need& b, const Need& c) noexcept {
  const auto before = static_cast<float>(b.tick - a.tick),
             after = static_cast<float>(c.tick - b.tick);
  return ((b.m - a.m) * (after / before) + (c.m - b.m) * (before / after)) / (before + after);
}
// Raises the most sinking between two knots to what is asked for from the second of four needs to
// the third: a cubic lies through them.
inline void raise_between(const std::array<Need, 4>& needs, int knot,
                          std::array<float, kSinkKnots>& most_m) noexcept {
  const auto& [a, b, c, d] = needs;
  if (b.m == 0.0f && c.m == 0.0f) return;
  const int ticks = c.tick - b.tick;
  const float per_tick = 1.0f / static_cast<float>(ticks), way = c.m - b.m,
              from = slope_of(a, b, c) * static_cast<float>(ticks),
              to = slope_of(b, c, d) * static_cast<float>(ticks);
  const PhaseCubic<float> moves(way, from, to);
  for (int k = 1; k <= ticks; ++k) {
    float& most_of = most_m[(b.tick + k - 1) / knot];
    most_of = most(most_of, b.m + moves.at(static_cast<float>(k) * per_tick));
  }
}

// Walks ahead to find when legs will be at their reach, and plans how the hips sink before that.
template <bool kPaper, bool kUneven>
void look_ahead(const Tables& tables, Block<1>& block) noexcept {
  // From the old plan to the new one, at the reference leg: with 0.1 s legs jump on the course
  // where a need comes late, with 0.06 s hips do.
  constexpr float kComes_s = 0.15f;
  Change<float>& change = block.change;
  const int knot = sink_knot_ticks(tables), all_ticks = all_sink_ticks(tables),
            left = sink_ticks_left(tables, change.sink_ticks), at = left > 0 ? all_ticks - left : 0,
            first = at / knot, gone = at - first * knot;
  std::array<float, kSinkKnots> wants_m{};  // most sinking between two knots
  const int seen = all_ticks - knot;        // no knot asks for what comes later
  Block<1> ahead = block;
  NoFooting level;
  ahead.change.sink_ticks = 0.0f;
  Tables by = tables;  // at the ticks that are gone at once
  // At the last ticks that were looked at.
  std::array<Need, 4> needs;
  needs.fill({gone, change.wants_m});
  needs[2].tick = gone - 1;
  const auto see = [&](int tick, float m) {
    std::move(needs.begin() + 1, needs.end(), needs.begin());
    needs.back() = {tick, m};
    if (needs[1].tick >= gone) raise_between(needs, knot, wants_m);
  };
  for (int tick = gone; tick < seen;) {
    // On uneven ground no tick is left out: of walks by chance 25 of 450 jerked on stairs, not 20.
    const int ticks = kUneven ? 1 : std::min(ticks_at_once(tables, ahead), seen - tick);
    if (by.ticks != static_cast<float>(ticks))
      static_cast<Filters&>(by) = in_several_ticks(tables, static_cast<float>(ticks));
    advance_on<1, kPaper>(by, ahead, footing_of<kUneven>(ahead, level), Poses{}, false);
    tick += ticks;
    see(tick, ahead.change.wants_m);
  }
  see(seen + 1, ahead.change.wants_m);
  // Knot k is at the beginning of interval k - 1 and takes the greatest need of the intervals
  // around it. The four knots that act now stay; on uneven ground, where needs come late, they take
  // them if they are more than what was planned.
  std::array<float, kSinkKnots> knots_m{};
  for (int k = 0; k < kSinkKnots - 3; ++k) {
    if (k < 4 && left > 0) knots_m[k] = change.sink_m[first + k];
    if (k < 4 && !kUneven) continue;
    for (int i : {k - 2, k - 1}) knots_m[k] = most(knots_m[k], wants_m[std::max(i, 0)]);
  }
  Off<float>& off = change.off_sink;
  const Off<float> was = left > 0 ? sink_from(tables, change, at) : Off<float>{};
  for (int k = 0; k < kSinkKnots; ++k) change.sink_m[k] = knots_m[k];
  const Off<float> is = sink_from(tables, change, gone);
  off = {off.x + was.x - is.x, off.v + was.v - is.v, off.a + was.a - is.a};
  change.foreseen_m = block.state.asked.length_m[0] + block.state.asked.length_m[1];
  const bool sinks = off.x != 0.0f ||
                     std::any_of(knots_m.begin(), knots_m.end(), [](float m) { return m != 0.0f; });
  change.sink_ticks = sinks ? static_cast<float>(all_ticks - gone) : 0.0f;
  change.off_sink_ticks = sinks ? kComes_s * tables.time_scale / tables.tick_s : 0.0f;
  if (!sinks) off = {};
}

// Reports the legs' solves.
template <class V>
void keep_solves(const Time<V>& time, const Leg<V> (&legs)[2], Told<V>& told) noexcept {
  constexpr float kReached_m = 1e-4f;  // a larger error counts as failed
  for (int side : {0, 1}) {
    const auto swings = side == 1 ? time.right : no(time.right);
    told.iterations[side] = swings ? legs[0].iterations : legs[1].iterations;
    told.error_m[side] = swings ? legs[0].short_m : legs[1].short_m;
    const auto failed = either(both(swings, legs[0].failed), both(no(swings), legs[1].failed));
    told.failed[side] =
        chosen<V>(either(failed, told.error_m[side] > all<V>(kReached_m)), 1.0f, 0.0f);
  }
}
// Reports the step that ends with a strike.
template <class V>
void count_step(const Time<V>& time, const Landing<V>& landing, const Way<V>& to,
                const Mask<V>& strikes, const State<V>& state, const V& overhangs,
                Told<V>& told) noexcept {
  const V length_m = to.ahead(landing.x_m, landing.z_m);
  for (int side : {0, 1}) {
    const auto steps = both(strikes, side == 1 ? time.right : no(time.right));
    told.steps[side] = steps ? V(told.steps[side] + 1.0f) : told.steps[side];
    told.stride_m[side] = steps ? length_m : told.stride_m[side];
  }
  told.overhangs = strikes ? V(told.overhangs + overhangs) : told.overhangs;
  told.step_ticks[1] = strikes ? told.step_ticks[0] : told.step_ticks[1];
  told.step_ticks[0] = strikes ? V(state.roll_ticks + state.flight_ticks) : told.step_ticks[0];
}

// Counts the ticks of the last roll, until the report says that both feet stand.
template <class V>
void count_last_roll(const Tables& tables, const Mask<V>& strikes, const Change<V>& change,
                     Told<V>& told) noexcept {
  constexpr float kLastRoll_s = 0.17f;  // at the reference leg: until the foot is flat
  const V last = all<V>(kLastRoll_s * tables.time_scale / tables.tick_s);
  told.settle_ticks = both(strikes, change.stands != V{})
                          ? floored(V(last + 0.5f))
                          : most(V(told.settle_ticks - tables.ticks), V{});
}

// Converts the legs' angles where a walk changes its solver: the paper's solver starts from whole
// angles, the other one from differences to the tables; its weights start again.
template <bool kPaper>
void change_solver(const Tables& tables, const Time<float>& time, const Stride<float>& stride,
                   State<float>& state, Change<float>& change, Weighted<float>& weighted) noexcept {
  if ((change.by_paper != 0.0f) == kPaper) return;
  weighted.acts = 0.0f;
  change.by_paper = kPaper ? 1.0f : 0.0f;
  for (int k : {0, 1}) {
    float table_rad[kLegAngles];
    set_table_angles(tables, is_right(time, k), stride, k, table_rad);
    for (int j = 0; j < kLegAngles; ++j) {
      state.leg_rad[k][j] += kPaper ? table_rad[j] : -table_rad[j];
      state.last_leg_rad[k][j] = kPaper ? 0.0f : state.leg_rad[k][j];
    }
  }
}

// Solves the legs and writes the upper body.
template <int kWidth, bool kPaper, class F>
void pose_in_full(const Tables& tables, const BodyTick<Floats<kWidth>>& tick,
                  const Floats<kWidth>& swing, const Mask<Floats<kWidth>>& eases,
                  const Mask<Floats<kWidth>>& is_styled, Block<kWidth>& block, const F& footing,
                  Feet<Floats<kWidth>>& feet, Leg<Floats<kWidth>> (&legs)[2],
                  const Poses& poses) noexcept {
  using V = Floats<kWidth>;
  constexpr bool kUneven = kIsUneven<F>;
  State<V>& state = block.state;
  const Change<V>& change = block.change;
  const auto& [time, landing, hips, stride, pelvis, idle, phase, shown] = tick;
  if constexpr (kWidth == 1)
    change_solver<kPaper>(tables, time, stride, state, block.change, block.weighted);
  if constexpr (kPaper) {
    solve_by_paper(tables, time, phase, change, feet, pelvis, state, block.weighted, legs);
  } else {
    V begun_rad[2][kLegAngles];
    solve_legs(tables, time, stride, feet, pelvis, state, legs, kUneven ? begun_rad : nullptr);
    if constexpr (kUneven)
      ease_ankles(tables, time, stride, phase, pelvis, change, footing, state, feet, begun_rad,
                  legs);
    weigh_legs(tables, time, stride, feet, pelvis, phase, change, state, block.weighted, legs);
  }
  write_upper_body<kWidth, kPaper>(tables, tick, swing, eases, is_styled, block, poses);
}

// Poses legs, upper body and root. `is_new`: the plan has changed in this tick.
template <int kWidth, bool kPaper, class F>
void pose_walks(const Tables& tables, const BodyTick<Floats<kWidth>>& tick,
                const Mask<Floats<kWidth>>& is_new, Block<kWidth>& block, const F& footing,
                Feet<Floats<kWidth>>& feet, const Poses& poses) noexcept {
  using V = Floats<kWidth>;
  const State<V>& state = block.state;
  Change<V>& change = block.change;
  Mask<V> eases{};
  if constexpr (!kPaper)
    eases = advance_poise(tables, tick.hips, is_new, change, state, block.poise);
  const auto is_styled = has_style(block.styled);
  if (any(is_styled)) smooth_body(tables, is_styled, block.styled);
  const V swing = kPaper ? all<V>(1.0f) : arm_swing(tables, state);
  Leg<V> legs[2];
  const auto pose = [&] {
    pose_in_full<kWidth, kPaper>(tables, tick, swing, eases, is_styled, block, footing, feet, legs,
                                 poses);
  };
  const auto has_tables = either(change.asks_tables != V{}, change.to_tables != V{});
  if (any(has_tables)) {
    come_to_tables(tables, change);
    pose_with_tables<kWidth>(tables, tick, swing, block, feet, legs, poses, pose);
  } else {
    pose();
  }
  write_legs(tables, tick.time, state, feet, legs, poses);
  write_root<kWidth>(tables, tick.hips, tick.pelvis, block, poses);
  keep_solves(tick.time, legs, block.told);
}

// Begins walks, plans stops and takes pushes. Returns the walks whose plan has changed within a
// step.
template <int kWidth, bool kUneven>
Mask<Floats<kWidth>> change_plans(const Tables& tables, bool looks_ahead,
                                  Block<kWidth>& block) noexcept {
  using V = Floats<kWidth>;
  const Change<V>& change = block.change;
  const auto follows = change.is_new != V{};  // already new because a step has begun
  begin_walks(tables, block);
  if (!kUneven || looks_ahead) change_ends<kWidth, kUneven>(tables, block);
  one_by_one<kWidth>(either(change.push_x_m_s != V{}, change.push_z_m_s != V{}), block,
                     [&](Block<1>& one, int) { take_push(tables, one); });
  return both(no(follows), change.is_new != V{});
}

// Ends the step of walks that strike: the step frame moves to the landing, swing and stand change
// places, and the next step is planned. `to`: the way of the step; `before_rad`: the flying foot's
// pitch two ticks ago.
template <int kWidth, class F>
void strike(const Tables& tables, const BodyTick<Floats<kWidth>>& tick,
            const Way<Floats<kWidth>>& to, const Mask<Floats<kWidth>>& strikes,
            Landing<Floats<kWidth>>& landing, const Feet<Floats<kWidth>>& feet,
            const Floats<kWidth>& before_rad, Block<kWidth>& block, F& footing) noexcept {
  using V = Floats<kWidth>;
  constexpr bool kUneven = kIsUneven<F>;
  State<V>& state = block.state;
  Change<V>& change = block.change;
  const Time<V>& time = tick.time;
  V overhangs{};
  if constexpr (kUneven) overhangs = footing.overhangs;
  landing.rad = rounded_to(kFrameTurned_rad, landing.rad);
  count_step(time, landing, to, strikes, state, overhangs, block.told);
  auto is_level = change.slowness == all<V>(1.0f);
  move_frame<kWidth>(landing, strikes, block);
  if constexpr (kUneven) {
    move_rails(strikes, footing.landing_y_m, block.styled);
    change_footing(landing, strikes, feet.flat_toe_m.y, footing);
    const V slow = slowness_of(tables, no(time.right), state, footing);
    // Onto stairs, too, hips lead: they would else brake by 10 m/s^2 in the roll.
    constexpr float kGentle = 1.2f, kOnto = 1.5f;  // times a level step's, and the last step's
    const auto was_gentle = change.slowness < all<V>(kGentle);
    is_level = either(slow == all<V>(1.0f), both(was_gentle, slow > kOnto * change.slowness));
    change.slowness = strikes ? slow : change.slowness;
  }
  // After a late change of plan the step has not yet changed over to its own stride.
  landing.ratio = change.off_over.x != V{}
                      ? mix(state.ratio_behind, landing.ratio, V(1.0f + change.off_over.x))
                      : landing.ratio;
  change_feet(landing, strikes, feet, tick.stride, state);
  for (V(&knees)[2] : change.knee_rad) exchange(strikes, knees[0], knees[1]);
  change_weighted_legs(strikes, block.weighted);
  change_styled_feet(strikes, block.styled);
  end_aims(landing, strikes, change);
  const auto keeps = either(change.led != V{}, change.off_phase.x != V{});
  const V rate = keeps ? change.phase_rate : state.phase_rate;
  begin_lead(tables, strikes, tick.phase, rate, is_level, state, change);
  begin_step(tables, time, strikes, change, state);
  // A foot's toe comes down ever faster about its strike: by its rate of now the knee of a stop
  // jerked by 0.84 degrees a tick^2.
  const V& pitch_rad = feet.foot[0].pitch_rad;
  roll_on(both(strikes, change.led != V{}), pitch_rad,
          coming_slope(pitch_rad, state.last_pitch_rad[1], before_rad), change, state);
  one_by_one<kWidth>(both(strikes, change.closing != V{}), block, [&](Block<1>& one, int) {
    if constexpr (kUneven) time_rest(tables, one.state, one.change);
    time_closing_step(tables, one.state, one.change);
  });
  if constexpr (!kUneven) {
    one_by_one<kWidth>(both(strikes, both(change.led != V{}, change.closing == V{})), block,
                       [&](Block<1>& one, int) {
                         (one.change.stops != 0.0f ? time_step_between : time_slower_step)(
                             tables, one.state, one.change);
                       });
  }
  rest(tables, change, state);
  if constexpr (kUneven) footing.next_rise = change.stands != V{} ? V{} : footing.next_rise;
}

// Looks ahead for walks whose next ticks may ask more of a leg than the tables do. `is_unsteady`:
// they started, stopped or caught a push as the tick began.
template <int kWidth, bool kPaper, bool kUneven>
void look_where_needed(const Tables& tables, const Time<Floats<kWidth>>& time,
                       const Mask<Floats<kWidth>>& is_new, const Mask<Floats<kWidth>>& is_unsteady,
                       const Mask<Floats<kWidth>>& lifts, const Mask<Floats<kWidth>>& strikes,
                       Block<kWidth>& block) noexcept {
  using V = Floats<kWidth>;
  const State<V>& state = block.state;
  const Change<V>& change = block.change;
  const auto half = is_half_seen(tables, state);
  auto changes = is_unsteady, again = either(lifts, strikes), paces = Mask<V>{};
  if constexpr (kUneven) {
    // On changing ground a step may ask more of a leg than the one before it did, and on stairs
    // each one does.
    const auto sinks = both(change.sink_ticks != V{}, block.footing.crosses != V{});
    changes = either(
        either(is_unsteady, either(change.led != V{}, sinks)),
        either(leaves_stairs(change, block.footing), is_other_step(tables, state, block.footing)));
    again = either(again, half);
  } else {
    // Hips must have begun to sink when a step of another pace begins.
    paces = either(lifts, half);
    if (any(paces))
      paces =
          both(paces, has_other_pace(tables, time.right,
                                     own_step_m<V>(tables, time.right, time.back), state, change));
  }
  auto unforeseen = is_unforeseen(tables, state, change);
  if (any(unforeseen)) unforeseen = both(unforeseen, is_to_walk(tables, state, change));
  const auto looks = either(either(is_new, either(both(again, changes), paces)), unforeseen);
  one_by_one<kWidth>(looks, block,
                     [&](Block<1>& one, int) { look_ahead<kPaper, kUneven>(tables, one); });
}

template <int kWidth, bool kPaper, class F>
void advance_on(const Tables& tables, Block<kWidth>& block, F& footing, const Poses& poses,
                bool looks_ahead) noexcept {
  using V = Floats<kWidth>;
  State<V>& state = block.state;
  Change<V>& change = block.change;
  constexpr bool kUneven = kIsUneven<F>;
  const auto is_new = change_plans<kWidth, kUneven>(tables, looks_ahead, block),
             is_unsteady = either(either(change.starting != V{}, change.stops != V{}),
                                  change.catch_ticks != V{});
  if constexpr (kUneven && !kPaper) lean_into_slope(tables, state, change, footing);
  if constexpr (kUneven && kPaper) footing.lean_rad = {};
  V left = all<V>(1.0f);
  if constexpr (kUneven) left = footing.left.x;
  smooth_asked(tables, change, left, state);
  if constexpr (kPaper) state.lean_rad = state.chest_ahead_rad = state.head_ahead_rad = {};
  V first_s{};
  if constexpr (kUneven) first_s = least_flight_s(tables, footing);
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
  const auto lifts = both(no(time.flies), state.tick >= state.roll_ticks),
             strikes = both(time.flies, state.tick >= state.flight_ticks);
  // lead_hips() reads the others. Where hips lead or rest on level ground, the clock tells nothing
  // but a foot in flight, and how one lifts off in a first step.
  Reads<V> reads{V{} == V{}, no(has_own_phase(change))};
  if constexpr (!kUneven)
    reads.plan = either(either(either(time.flies, lifts), change.starting != V{}),
                        change.led + change.stands == V{});
  const Stride<V> by_clock =
      read_by_clock(tables, time, landing, state.phase, time.share, time.u, reads, change, state);
  Hips<V> hips = move_hips(tables, time, landing, by_clock, change, state);
  Stride<V> stride = by_clock;
  const V phase = lead_hips(tables, time, landing, by_clock, state, change, hips, stride);
  keep_pelvis(tables, hips, state);
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
  if constexpr (!kPaper)
    if (looks_ahead) ease_knees(tables, time, feet.ankle_m, change, pelvis);
  reach_with_toe(tables, time, change, pelvis, feet);
  const BodyTick<V> tick{time, landing, hips, stride, pelvis, idle, phase, change.shown};
  if (looks_ahead)  // a look ahead needs no pose
    pose_walks<kWidth, kPaper>(tables, tick, is_new, block, footing, feet, poses);

  take_back(asked_rad, feet);
  if (any(lifts))
    lift_off(tables, time, lifts, landing, hips, feet, by_clock, change, state, footing);
  const V before_rad = state.last_pitch_rad[1];
  keep_swing(tables, feet.foot[0], state);
  if constexpr (kUneven)
    footing.last_rise_m[1] = footing.last_rise_m[0], footing.last_rise_m[0] = footing.rise_m;
  block.told.struck = chosen<V>(strikes, 1.0f, 0.0f);
  if (any(strikes))
    strike<kWidth>(tables, tick, asked.to, strikes, landing, feet, before_rad, block, footing);
  count_last_roll(tables, strikes, change, block.told);
  if (any(lifts)) {
    plan_limp(tables, time, lifts, state, change);
    begin_flight(tables, time, lifts, landing.ratio, change, state);
    if (kUneven && looks_ahead) plan_rooms<kWidth>(tables, lifts, block);
  }
  if (looks_ahead)
    look_where_needed<kWidth, kPaper, kUneven>(tables, time, is_new, is_unsteady, lifts, strikes,
                                               block);
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
