// Fourth: where both feet are, and how they are turned.
#pragma once
#include "walk/hips.h"

namespace gaitpad::anew {
namespace {

template <class V>
struct Foot {
  Vec<V> heel_m, toe_m;
  V pitch_rad{};  // of the line from heel to toe: 0 flat, toe down positive
  Turn<V> yaw, edge, turn;
};

// The numbers of a foot that the swinging one and the standing one differ in, for they are of
// different sides.
template <class V>
struct Sole {
  Vec<V> heel_m, line_m, forward, side;  // in the foot's frame; from heel to toe
  V elevation_rad, foot_m, toe_rest_m, half_width_m;
};
template <class V>
Sole<V> sole_of(const Tables& tables, const Mask<V>& right) noexcept {
  const LegBones &l = tables.leg[0], &r = tables.leg[1];
  const auto of = [&](float LegBones::*bone) { return chosen<V>(right, r.*bone, l.*bone); };
  const Vec<V> heel_m = by_side<V>(right, l.heel_m, r.heel_m);
  return {heel_m,
          by_side<V>(right, l.toe_m, r.toe_m) - heel_m,
          by_side<V>(right, l.forward, r.forward),
          by_side<V>(right, l.side, r.side),
          of(&LegBones::elevation_rad),
          of(&LegBones::foot_m),
          of(&LegBones::toe_rest_m),
          of(&LegBones::half_width_m)};
}

template <class V>
Turn<V> edge_of(const Sole<V>& sole, const V& twist_rad, const V& roll_rad) noexcept {
  const Vec<V>& f = sole.forward;
  return turn_by(Vec<V>{f.x * roll_rad, twist_rad + f.y * roll_rad, f.z * roll_rad});
}
// Of the foot by its direction, pitch and edge; then the point that is not planted follows.
template <class V>
void set_pitch(const Sole<V>& sole, const Turn<V>& yaw, const V& pitch_rad, const Mask<V>& on_toe,
               Foot<V>& foot) noexcept {
  foot.pitch_rad = pitch_rad;
  foot.yaw = yaw;
  foot.turn = yaw * (turn_about(sole.side, pitch_rad) * foot.edge);
  const Vec<V> line = foot.turn * sole.line_m;
  const Vec<V> heel_m = foot.toe_m - line, toe_m = foot.heel_m + line;
  foot.heel_m = chosen(on_toe, heel_m, foot.heel_m);
  foot.toe_m = chosen(on_toe, foot.toe_m, toe_m);
}

// The style's factor on the height of the flight.
template <class V>
V lift_of(const Time<V>& time, const State<V>& state) noexcept {
  return time.right ? state.lift[1].x : state.lift[0].x;
}
// At most 1: a lame foot stays low.
template <class V>
V low_lift(const Mask<V>& right, const State<V>& state) noexcept {
  return least(right ? state.lift[1].x : state.lift[0].x, all<V>(1.0f));
}
// Of its pitch in the tables, until the middle of its flight.
template <class V>
V low_pitch(const V& low, const V& u) noexcept {
  return mix(low, all<V>(1.0f), smoother(V(2.0f * u)));
}

// Of the flight: until here the lift-off's own motion fades; a style's factor on the height grows
// until here, and goes between the others.
inline constexpr float kLiftFade = 0.5f, kLiftGrown = 0.4f, kLiftFalls = 0.5f, kLiftEnds = 0.85f,
                       kPitchFade = 0.2f;
inline constexpr float kShortPitchFade = 0.6f, kFirstLift_m = 0.03f,
                       kLastLift_m = 0.025f;  // of a first and a last one
// Of the first roll: until then the heel stays down; of the tables' pitch when it lifts off.
inline constexpr float kHeelStays = 0.25f, kFirstPitch = 0.8f;
inline constexpr float kHeelRises = 0.5f;  // of the first flight: of the other foot
inline constexpr float kRollEnd = 0.9f;    // of the roll: the toe is down
// A flying toe may be that far below where it stands: the tables' own, which only just leave the
// floor, are let through.
inline constexpr float kMostSink_m = 0.0015f, kSoftPitch_rad = 0.0069813f, kWiderPitch = 0.25f;

// The tables' place of the swinging heel, from its footprint to the landing.
template <class V>
Vec<V> flight_heel(const Tables& tables, const Time<V>& time, const Landing<V>& landing,
                   const Stride<V>& stride, const Hips<V>& hips, const V& phase, const V& u,
                   const Change<V>& change, const State<V>& state) noexcept {
  const Way<V> left = way_of(state.print_rad);
  const V turns = chosen<V>(time.right, 1.0f, 0.0f);
  const auto seen = [&](const Footprints<V>& prints, const Vec<V>& heel_m, const V& turned) {
    Vec<V> p = heel_m - prints.swing_m;
    p.z = p.z + prints.stride_m * (phase - turned);
    return p;
  };
  const Vec<V> from = left * seen(hips.behind, stride.heel_behind_m, V(turns - 1.0f)),
               to = landing.way * seen(hips.ahead, stride.heel_ahead_m, turns);
  const V gone = smoother(u);
  Vec<V> p{mix(V(state.print_x_m + from.x), V(landing.x_m + to.x), gone), V{},
           mix(V(state.print_z_m + from.z), V(landing.z_m + to.z), gone)};
  const auto closes = change.closing != V{}, is_short = either(change.starting != V{}, closes);
  if (any(is_short)) {
    // As far as strides of its own length have it; before it lands it is one of the walk.
    constexpr float kInPlaceStride_m = 0.02f, kLikeAStep = 0.4f, kWalksFrom = 0.3f;
    const Vec<V> ahead = seen(hips.own, stride.heel_behind_m, turns);
    const auto in_place = size(hips.own.stride_m) < all<V>(kInPlaceStride_m);
    const V far = in_place ? smoother(u)
                           : V(1.0f + ahead.z / (in_place ? all<V>(1.0f) : hips.own.stride_m)),
            goes = kLikeAStep * smoother(V((u - kWalksFrom) * (1.0f / (1.0f - kWalksFrom)))),
            walks = closes ? V{} : goes;
    const V x = state.print_x_m + (landing.x_m - state.print_x_m) * far +
                landing.way.cosine * ahead.x,
            z = state.print_z_m + (landing.z_m - state.print_z_m) * far -
                landing.way.sine * ahead.x;
    p.x = is_short ? mix(x, V(landing.x_m + to.x), walks) : p.x;
    p.z = is_short ? mix(z, V(landing.z_m + to.z), walks) : p.z;
  }
  // On an arc: neither on its chord, which leads through the standing leg, nor on both directions
  // mixed, which lead far out.
  const V turn = landing.rad - state.print_rad;
  if (any(turn != V{})) {
    const V x = landing.x_m - state.print_x_m, z = landing.z_m - state.print_z_m,
            square = x * x + z * z;
    const V share = within(V(((p.x - state.print_x_m) * x + (p.z - state.print_z_m) * z) /
                             most(square, all<V>(1e-6f))),
                           0.0f, 1.0f);
    const Way<V> middle = way_of(V(state.print_rad + 0.5f * turn));
    const V arc = share * (1.0f - share), mixed = (1.0f - gone) * share + gone * (1.0f - share);
    const V out = turn * root(square) * 0.5f * (is_short ? arc : V(arc - mixed));
    p.x = p.x - middle.cosine * out;
    p.z = p.z + middle.sine * out;
  }
  // A greater factor acts while the foot is high, a smaller one from the lift-off on.
  const V factor = lift_of(time, state), low = least(factor, all<V>(1.0f));
  const V more =
      1.0f + (most(factor, all<V>(1.0f)) - 1.0f) * (1.0f - smooth(kLiftFalls, kLiftEnds, u));
  p.y = stride.heel_high_m * low * mix(all<V>(1.0f), more, smoother(V(u * (1.0f / kLiftGrown))));
  // Its toe leaves the floor at once.
  const V left_u = 1.0f - u, square_u = u * left_u;
  const V high_m = tables.size * 16.0f * chosen<V>(closes, kLastLift_m, kFirstLift_m);
  p.y = is_short ? V(p.y + high_m * square_u * square_u) : p.y;
  return p;
}

template <class V>
struct Feet {
  Foot<V> foot[2];  // swing, stand
  Sole<V> sole[2];
  Vec<V> table_heel_m;  // of the swinging one
};

template <class V>
Feet<V> plan_feet(const Tables& tables, const Time<V>& time, const Landing<V>& landing,
                  const Stride<V>& by_clock, const Stride<V>& stride, const Hips<V>& hips,
                  const Change<V>& change, const State<V>& state) noexcept {
  Feet<V> feet;
  const V one = all<V>(1.0f), flight = state.flight_ticks;
  const auto starts = change.starting != V{}, closes = change.closing != V{},
             first_roll = both(starts, no(time.flies));
  {  // The foot that stands: on its heel while it rolls, then on its toe.
    Foot<V>& foot = feet.foot[1];
    const Sole<V>& sole = feet.sole[1] = sole_of<V>(tables, no(time.right));
    const StrideFoot<V>& table = stride.foot[1];
    const V s = state.tick / (kRollEnd * state.roll_ticks);
    const V off = s < one ? V(state.stand_pitch_rad * value_left(s)) : V{};
    // Where the hips lead, its toe is down when the other one lifts off.
    const V stays = 1.0f - change.led * (time.flies ? V{} : smoother(s));
    // In a first step it has not landed: its heel rises only while the other foot flies. In a last
    // one it stays flat.
    const V rises = starts ? smoother(V(time.u * (1.0f / kHeelRises))) : stays,
            shows = both(closes, time.flies) ? V{} : rises;
    const V low = time.flies ? low_lift<V>(no(time.right), state) : one;
    const V pitch = low * table.pitch_rad * shows + (time.flies ? V{} : off),
            planted = time.flies ? most(pitch, V{}) : least(pitch, V{});
    foot.edge = edge_of(sole, table.twist_rad, table.roll_rad);
    foot.toe_m = sole.line_m;  // flat, from the origin
    foot.heel_m = {};
    set_pitch(sole, Turn<V>{one, V{}, V{}, V{}}, planted, time.flies, foot);
  }
  Foot<V>& foot = feet.foot[0];
  const Sole<V>& sole = feet.sole[0] = sole_of<V>(tables, time.right);
  const StrideFoot<V>& table = stride.foot[0];
  const V u = time.u;
  // What lift-off differed by fades.
  const V fade_ticks = flight * chosen<V>(either(starts, closes), kShortPitchFade, kPitchFade),
          t = state.tick / fade_ticks;
  const V off = both(time.flies, t < one) ? V(state.swing_pitch_rad * value_left(t) +
                                              state.swing_pitch_rate * fade_ticks * slope_left(t))
                                          : V{};
  const V lifts =
      smoother(V((state.tick / state.roll_ticks - kHeelStays) * (1.0f / (1.0f - kHeelStays))));
  const V lowest = low_lift<V>(time.right, state), low_part = low_pitch(lowest, u);
  const V planned = first_roll ? V(low_part * (kFirstPitch * by_clock.foot[0].pitch_rad * lifts))
                               : V(low_part * table.pitch_rad + off);
  const Way<V> left = way_of(state.print_rad);
  Vec<V> p = feet.table_heel_m =
      flight_heel(tables, time, landing, stride, hips, state.phase, u, change, state);
  const V s = u * (1.0f / kLiftFade);
  const auto fading = both(time.flies, s < one);
  const V of_gap = fading ? value_left(s) : V{},
          of_slope = fading ? V(slope_left(s) * kLiftFade) : V{};
  p = p + state.gap_m * of_gap + state.gap_slope_m * of_slope;
  p.y = most(p.y, V{});
  // A low foot that hardly leaves the floor does not roll onto an edge.
  const V low =
      mix(one, lowest, V(smoother(V(u * 2.0f)) * (1.0f - smoother(V((u - 0.6f) * 2.5f)))));
  foot.edge = edge_of(sole, V(low * table.twist_rad), V(low * table.roll_rad));
  const V yaw = state.print_rad + (landing.rad - state.print_rad) * (1.0f - value_left(u)) +
                state.lift_turn_rad * slope_left(u);
  const Way<V> flown = way_of(yaw), way = chosen(time.flies, flown, left);
  // Its toe stays off the floor, and the edge onto which it rolls.
  const Vec<V> rolled = foot.edge * sole.line_m;
  const V ahead = dot(rolled, sole.forward), flat_ahead = dot(sole.line_m, sole.forward);
  const V steeper = (rolled.y * flat_ahead - sole.line_m.y * ahead) / (sole.foot_m * sole.foot_m);
  const V across = (way.turn() * (turn_about(sole.side, planned) * foot.edge) * sole.side).y;
  const V edge_m =
      sole.half_width_m * size(across) * smooth(0.0f, 0.25f, u) * (1.0f - smooth(0.9f, 1.0f, u));
  const V deep = (sole.toe_rest_m + edge_m - kMostSink_m - p.y) / sole.foot_m;
  const V limit = sole.elevation_rad - arc_sine(within(deep, -0.95f, 0.95f)) + arc_sine(steeper);
  const V soft =
      kSoftPitch_rad + kWiderPitch * size(off) * smooth(0.0f, 0.1f, u) + edge_m / sole.foot_m;
  const V pitch = time.flies ? soft_least(planned, limit, soft) : most(planned, V{});
  foot.heel_m = p;
  foot.toe_m = {state.toe_x_m, sole.toe_rest_m, state.toe_z_m};
  set_pitch(sole, way.turn(), pitch, no(time.flies), foot);
  return feet;
}

template <class V>
Vec<V> ankle_of(const Foot<V>& foot, const Sole<V>& sole) noexcept {
  return foot.heel_m - foot.turn * sole.heel_m;
}

// A value's slope now, per tick, from its last three.
template <class V>
V slope_of(const V& now, const V& last, const V& before) noexcept {
  return 0.5f * (3.0f * now - 4.0f * last + before);
}

// Where a foot lifts off, what it and its slope differ by from its flight in the tables, which are
// read a tick ahead.
template <class V>
void lift_off(const Tables& tables, const Time<V>& time, const Mask<V>& lifts,
              const Landing<V>& landing, const Hips<V>& hips, const Feet<V>& feet,
              const Stride<V>& stride, const Change<V>& change, State<V>& state) noexcept {
  const V ticks = state.flight_ticks, phase = state.phase + state.phase_rate,
          share = (state.tick + 1.0f) / (state.roll_ticks + ticks);
  const Stride<V> next =
      read_by_clock(tables, time, landing, phase, share, V(1.0f / ticks), change, state);
  const Vec<V> ahead = flight_heel(tables, time, landing, next, hips, phase, V(1.0f / ticks),
                                   change, state),
               &heel = feet.foot[0].heel_m, &table = feet.table_heel_m,
               &last = state.last_heel_m[0], &before = state.last_heel_m[1];
  const auto slope = [&](V Vec<V>::*part) {
    return V((slope_of(heel.*part, last.*part, before.*part) - (ahead.*part - table.*part)) *
             ticks);
  };
  const V low = low_lift<V>(time.right, state);
  const V pitch = feet.foot[0].pitch_rad, table_pitch = low * stride.foot[0].pitch_rad,
          rate = slope_of(pitch, state.last_pitch_rad[0], state.last_pitch_rad[1]) -
                 (low_pitch(low, V(1.0f / ticks)) * next.foot[0].pitch_rad - table_pitch);
  state.gap_m = chosen(lifts, heel - table, state.gap_m);
  state.gap_slope_m = chosen(lifts, Vec<V>{slope(&Vec<V>::x), slope(&Vec<V>::y), slope(&Vec<V>::z)},
                             state.gap_slope_m);
  state.swing_pitch_rad = lifts ? V(pitch - table_pitch) : state.swing_pitch_rad;
  state.swing_pitch_rate = lifts ? rate : state.swing_pitch_rate;
  // In a turn it pivots on its planted toe as its heel rises.
  state.lift_turn_rad = lifts ? V(state.turn_rad_s.x * tables.tick_s * ticks) : state.lift_turn_rad;
}

template <class V>
void keep_swing(const Foot<V>& swing, State<V>& state) noexcept {
  state.last_heel_m[1] = state.last_heel_m[0], state.last_heel_m[0] = swing.heel_m;
  state.last_pitch_rad[1] = state.last_pitch_rad[0], state.last_pitch_rad[0] = swing.pitch_rad;
}

// At a strike the feet change their parts, and the step frame moves to the footprint that is new.
template <class V>
void change_feet(const Landing<V>& landing, const Mask<V>& strikes, const Feet<V>& feet,
                 const Stride<V>& stride, State<V>& state) noexcept {
  const auto set = [&](const V& to, V& number) { number = strikes ? to : number; };
  const Way<V> back_turn{-landing.way.half_sine, landing.way.half_cosine, -landing.way.sine,
                         landing.way.cosine};
  const auto moved = [&](const V& x_m, const V& z_m) {
    return back_turn * Vec<V>{x_m - landing.x_m, V{}, z_m - landing.z_m};
  };
  const Vec<V> print = moved(V{}, V{}), toe = moved(feet.sole[1].line_m.x, feet.sole[1].line_m.z);
  set(print.x, state.print_x_m), set(print.z, state.print_z_m);
  set(V(-landing.rad), state.print_rad);
  set(toe.x, state.toe_x_m), set(toe.z, state.toe_z_m);
  for (int k : {0, 1, 2}) {
    const Vec<V> pelvis = moved(state.pelvis_x_m[k], state.pelvis_z_m[k]);
    set(pelvis.x, state.pelvis_x_m[k]), set(pelvis.z, state.pelvis_z_m[k]);
  }
  set(V(state.heading_rad - landing.rad), state.heading_rad);
  set(V{}, state.landing_x_m), set(V{}, state.landing_z_m), set(V{}, state.landing_rad);
  set(state.next_wider_m, state.wider_m);
  set(landing.ratio, state.ratio_behind);
  set(V(feet.foot[0].pitch_rad - stride.foot[0].pitch_rad), state.stand_pitch_rad);
  for (int j = 0; j < kLegAngles; ++j) {
    const auto swap = [&](V(&of)[2][kLegAngles]) {
      const V swing = of[0][j], stand = of[1][j];
      of[0][j] = strikes ? stand : swing;
      of[1][j] = strikes ? swing : stand;
    };
    swap(state.leg_rad);
    swap(state.last_leg_rad);
  }
}

}  // namespace
}  // namespace gaitpad::anew
