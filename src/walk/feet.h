// Fourth: the places and turns of both feet.
#pragma once
#include "walk/ground.h"

namespace gaitpad {
namespace {

template <class V>
struct Foot {
  Vec<V> heel_m, toe_m;
  V pitch_rad{};  // of the line from heel to toe: 0 flat, toe down positive
  Turn<V> yaw, edge, turn;
};

// A foot's part of LegBones, on the side of each walk's swing or stand.
template <class V>
struct Sole {
  Vec<V> heel_m, line_m, forward, side;  // in the foot's frame; line_m: from heel to toe
  V elevation_rad, foot_m, toe_rest_m, half_width_m;
};
template <class V>
Sole<V> sole_of(const Tables& tables, const Mask<V>& right) noexcept {
  const LegBones &l = tables.leg[0], &r = tables.leg[1];
  const auto of = [&](float LegBones::*number) { return of_leg<V>(tables, right, number); };
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
// Turns a foot by its direction, pitch and edge about its planted point: the toe where it is
// `on_toe`, else the heel. The other point follows.
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

// A low foot's factor on the pitch in the tables: `low` at the lift-off, 1 from mid-flight on.
template <class V>
V low_pitch(const V& low, const V& u) noexcept {
  return mix(low, all<V>(1.0f), smoother(0.0f, 0.5f, u));
}

inline constexpr float kLastLift_m = 0.025f;      // added to a last flight; at the reference leg
inline constexpr float kFirstLift_m = 0.03f;      // to a first one, or one on the spot; the same
inline constexpr float kTurnedPrints_rad = 0.1f;  // sum of both turns that counts fully
inline constexpr float kRollEnd = 0.9f;           // share of the roll after which the toe is down

template <class V>
V flying_yaw(const Time<V>& time, const Landing<V>& landing, const Change<V>& change,
             const State<V>& state) noexcept {
  return state.print_rad + (landing.rad - state.print_rad) * (1.0f - value_left(time.u)) +
         state.lift_turn_rad * slope_left(time.u) + change.gap_rad * edge_left(time.u, change);
}

// The distance by which a flying foot keeps away from the standing one, to the outside of its path,
// while it is beside it: in a turn the feet would touch.
template <class V>
V keeps_apart_m(const Tables& tables, const Time<V>& time, const Landing<V>& landing,
                const Vec<V>& heel_m, const V& twist_rad, const V& u, const Change<V>& change,
                const State<V>& state) noexcept {
  constexpr float kApart = 0.65f, kSoft = 0.12f;  // shares of the distance of both tracks
  // Where tracks are narrow: shoes are 9 cm wide, and their axes must stay 6 cm apart. At the
  // reference leg.
  constexpr float kLeastApart_m = 0.085f;
  constexpr float kBeside_m = 0.15f, kPast_m = 0.4f;  // acts fully until, and ends at; in the way
  const V turned = size(state.print_rad) + size(landing.rad);
  if (!any(turned != V{})) return V{};
  const LegBones &l = tables.leg[0], &r = tables.leg[1];
  const float tracks_m = std::abs(l.track_m) + std::abs(r.track_m),
              apart_m = std::max(kApart * tracks_m, kLeastApart_m * tables.size);
  const V outwards = chosen<V>(time.right, -1.0f, 1.0f);
  // How far out of its heel the toe of the flying foot is, and in of its heel that of the standing
  // one: feet also point in or out in the standing pose, and twist in flight.
  const auto line_m = [&](int k) {
    return chosen<V>(time.right, r.toe_m[k] - r.heel_m[k], l.toe_m[k] - l.heel_m[k]);
  };
  const Way<V> way = way_of(V(flying_yaw(time, landing, change, state) + twist_rad));
  const V toe = outwards * (way.cosine * line_m(0) + way.sine * line_m(2)),
          stands =
              outwards * chosen<V>(time.right, l.toe_m[0] - l.heel_m[0], r.toe_m[0] - r.heel_m[0]),
          heel = outwards * heel_m.x - most(stands, V{}), soft_m = all<V>(kSoft * tracks_m),
          near_m = soft_least(heel, V(heel + toe), soft_m),
          beside = 1.0f - smooth(kBeside_m * tables.size, kPast_m * tables.size, size(heel_m.z)),
          flies = smoother(0.0f, 0.25f, u) * smoother(0.0f, 0.25f, V(1.0f - u));
  return outwards * smooth(0.0f, kTurnedPrints_rad, turned) * beside * flies *
         soft_positive(V(apart_m - near_m), soft_m);
}

// The place of the swinging heel in the tables, moved onto its footprint and its landing. `base_m`:
// the height of the ground line below it.
template <class V, class F>
Vec<V> flight_heel(const Tables& tables, const Time<V>& time, const Landing<V>& landing,
                   const Stride<V>& stride, const Hips<V>& hips, const V& phase, const V& u,
                   const Change<V>& change, const State<V>& state, const F& footing,
                   V& base_m) noexcept {
  const Way<V> left = way_of(state.print_rad);
  const V turns = chosen<V>(time.right, 1.0f, 0.0f);
  // In a walk a foot may swing past the other one closely; turning on the spot it would meet it.
  constexpr float kPastClosely = 0.2f;  // from strides of this ratio on
  const auto seen = [&](const FootprintsIn<V>& prints, const Vec<V>& heel_m, const V& turned,
                        const V& ratio) {
    Vec<V> p = heel_m - prints.swing_m;
    p.x = p.x * smooth(V(ratio * (1.0f / kPastClosely)));
    p.z = p.z + prints.stride_m * (phase - turned);
    return p;
  };
  const Vec<V> from = left *
                      seen(hips.behind, stride.heel_behind_m, V(turns - 1.0f), state.ratio_behind),
               to = landing.way * seen(hips.ahead, stride.heel_ahead_m, turns, landing.ratio);
  const V gone = smoother(u);
  Vec<V> p{mix(V(state.print_x_m + from.x), V(landing.x_m + to.x), gone), V{},
           mix(V(state.print_z_m + from.z), V(landing.z_m + to.z), gone)};
  const auto closes = change.closing != V{}, is_short = either(change.starting != V{}, closes);
  if (any(is_short)) {
    // A first or last step goes evenly along its way; its differences from that are those of
    // strides of its own length, in the foot's direction. From the share kWalksFrom of a first
    // flight on it comes over to the walk's stride, up to the share kLikeAStep.
    constexpr float kLikeAStep = 0.4f, kWalksFrom = 0.3f;
    // Captured feet swing far out in the shortest strides, which were solved from whole steps.
    constexpr float kMostAside_m = 0.04f, kSoftAside_m = 0.03f;  // at the reference leg
    // They also swing back there, by up to 13 cm. A foot that closes would do that in a tenth of a
    // second; it goes no farther behind or ahead of its even way than aside.
    const V most_m = all<V>(kMostAside_m * tables.size),
            soft_m = all<V>(kSoftAside_m * tables.size);
    const V low = closes_low(tables, change, state);
    Vec<V> ahead = seen(hips.own, stride.heel_behind_m, turns, all<V>(kPastClosely));
    const V outwards = chosen<V>(time.right, -1.0f, 1.0f);
    ahead.x = outwards * soft_least(V(outwards * ahead.x), most_m, soft_m);
    const V swings_m = ahead.z + hips.own.stride_m * (1.0f - gone),
            closing_m =
                comes_in(u) * -soft_least(V(-soft_least(swings_m, most_m, soft_m)), most_m, soft_m),
            off_m = mix(swings_m, closing_m, low),
            goes = kLikeAStep * smoother(kWalksFrom, 1.0f, u), walks = closes ? V{} : goes;
    const Vec<V> off = landing.way * Vec<V>{ahead.x, V{}, off_m};
    // A foot that closes flies by this share faster at first. Hips that have not braked yet would
    // leave it behind, and the leg, which gets straight, pull them down by up to 2 cm.
    constexpr float kSooner = 0.3f;  // with 0.6 knees turn back harder
    const V even = mix(gone, smoother(V(u * (1.0f + kSooner * (1.0f - u)))), low),
            x = mix(state.print_x_m, landing.x_m, even) + off.x,
            z = mix(state.print_z_m, landing.z_m, even) + off.z;
    p.x = is_short ? mix(x, V(landing.x_m + to.x), walks) : p.x;
    p.z = is_short ? mix(z, V(landing.z_m + to.z), walks) : p.z;
  }
  // In a turn the foot goes along an arc. The chord would lead through the standing leg, and a mix
  // of both footprints' directions far out.
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
  p.x = p.x + keeps_apart_m(tables, time, landing, p, stride.foot[0].twist_rad, u, change, state);
  // A style's factor above 1 acts while the foot is high, one below 1 from the lift-off on.
  const V factor = lift_of<V>(time.right, state), low = least(factor, all<V>(1.0f));
  V more = 1.0f + (most(factor, all<V>(1.0f)) - 1.0f) * (1.0f - smooth(0.5f, 0.85f, u));
  base_m = V{};
  if constexpr (kIsUneven<F>) {
    V up{};
    base_m = ground_line(tables, landing, p, u, state, footing, up);
    more = more * up;
  }
  p.y = stride.heel_high_m * low * mix(all<V>(1.0f), more, smoother(0.0f, 0.4f, u));
  p.y = closes ? V(p.y * mix(all<V>(1.0f), comes_in(u), closes_low(tables, change, state))) : p.y;
  // In a first or last flight the toe leaves the floor at once.
  const V left_u = 1.0f - u, square_u = u * left_u;
  const V high_m = tables.size * 16.0f * chosen<V>(closes, kLastLift_m, kFirstLift_m);
  p.y = is_short ? V(p.y + high_m * square_u * square_u) : p.y;
  // In a turn on the spot the foot would skim the floor; people lift all of it by 3 to 5 cm. It
  // leaves the floor as without that: some captures have a nearly straight knee there.
  const V walks = smooth(V(most(state.ratio_behind, landing.ratio) * (1.0f / kPastClosely))),
          turned = smooth(0.0f, kTurnedPrints_rad, V(size(state.print_rad) + size(landing.rad))),
          spot = is_short ? V{} : V((1.0f - walks) * turned), power = square_u * square_u;
  p.y = p.y + spot * (tables.size * 256.0f * kFirstLift_m) * (power * power);
  if constexpr (kIsUneven<F>) p.y = p.y + base_m;
  return p;
}

// The share that is over of the time in which a flight's gap fades: the heel's difference from the
// tables at its lift-off, or from a new plan.
template <class V>
V gap_share(const V& u, const Change<V>& change) noexcept {
  return (u - change.gap_begin) / change.gap_lasts;
}
// Adds what is left of the gap to the heel's place in the tables, `heel_m`, and keeps it off the
// floor, whose height is `base_m`.
template <class V, class F>
Vec<V> with_gap(const Tables& tables, const Time<V>& time, const Landing<V>& landing,
                const Stride<V>& stride, const Vec<V>& heel_m, const V& base_m,
                const Change<V>& change, const State<V>& state, const F& footing) noexcept {
  constexpr float kSoftFloor_m = 0.02f;  // rounds the floor's corner after a change of plan
  constexpr float kDips = 0.2f;          // share of a flight by which the line has its whole room
  const V s = gap_share(time.u, change);
  const auto fading = both(time.flies, s < all<V>(1.0f)), changed = change.gap_begin != V{};
  V of_gap = value_left(s), of_slope = slope_left(s), falls = all<V>(1.0f);
  Vec<V> p = heel_m;
  if (any(changed)) {
    // The foot may come down fast, so its gap fades along a quintic, which stays higher. A gap
    // below the new plan shrinks with the plan's height, so that the foot does not come to the
    // ground.
    const V w = 1.0f - s, w3 = w * w * w,
            lift = tables.size * 16.0f * kLastLift_m * change.gap_lasts;
    of_gap = changed ? V(w3 * (1.0f + s * (3.0f + 6.0f * s))) : of_gap;
    of_slope = changed ? V(w3 * s * (1.0f + 3.0f * s)) : of_slope;
    p.y = both(changed, fading) ? V(p.y + lift * (s * s) * (w * w)) : p.y;
    falls = both(changed, state.gap_m.y < V{}) ? V((p.y - base_m) / change.gap_high_m) : falls;
  }
  of_gap = fading ? of_gap : V{};
  of_slope = fading ? V(of_slope * change.gap_lasts) : V{};
  // The floor does not stop the rate of a foot that a new plan finds below its ground, up to
  // kMostBelow legs a flight: beside a cliff it has no bound.
  constexpr float kMostBelow = 3.0f;
  V rate_below{};
  if constexpr (kIsUneven<F>) {
    const float most_m = kMostBelow * tables.leg_m;
    rate_below = both(changed, footing.gap_under_m > V{})
                     ? within(state.gap_slope_m.y, -most_m, most_m)
                     : V{};
  }
  p = p + Vec<V>{state.gap_m.x, V(state.gap_m.y * falls), state.gap_m.z} * of_gap +
      Vec<V>{state.gap_slope_m.x, V(state.gap_slope_m.y - rate_below), state.gap_slope_m.z} *
          of_slope;
  V high_m = most(p.y, base_m);
  // Over a riser the line is above the ground, and a foot that lifts or whose plan changes may dip
  // below it by as much as it is rounded.
  V over_riser{};
  if constexpr (kIsUneven<F>) over_riser = footing.crosses;
  const auto dips = over_riser != V{};
  if (any(dips)) {
    const V dip_m =
        most(V(kSoftFloor_m * tables.size * smoother(0.0f, kDips, time.u)), all<V>(1e-6f));
    high_m = dips ? V(base_m + soft_positive(V(p.y - base_m + dip_m), dip_m) - dip_m) : high_m;
  }
  if (any(changed)) {
    // A foot that went fast to where the standing one was no longer to be goes on beyond.
    constexpr float kComesApart = 0.2f;  // share of the gap's time from which on it keeps apart
    const V apart_m =
        keeps_apart_m(tables, time, landing, p, stride.foot[0].twist_rad, time.u, change, state);
    p.x = both(changed, fading) ? V(p.x + apart_m * smoother(0.0f, kComesApart, s)) : p.x;
    const V ends_m = kSoftFloor_m * tables.size * (1.0f - smoother(0.7f, 1.0f, time.u)),
            comes = smoother(0.0f, 0.3f, s),
            soft_m = most(V(dips ? ends_m : V(ends_m * comes)), all<V>(1e-6f)),
            dip_m = dips ? V(soft_m * (1.0f - comes)) : V{};
    high_m = changed ? V(base_m + soft_positive(V(p.y - base_m + dip_m), soft_m) - dip_m) : high_m;
  }
  p.y = high_m;
  if constexpr (kIsUneven<F>)
    p.y = changed ? V(p.y - footing.gap_under_m * of_gap + rate_below * of_slope) : p.y;
  return p;
}
// The rest of the pitch's difference from the tables, at a tick of the flight.
template <class V>
V pitch_off(const Time<V>& time, const V& tick, const Change<V>& change,
            const State<V>& state) noexcept {
  constexpr float kPitchFade = 0.2f, kShortPitchFade = 0.6f;  // shares of a flight; of a short one
  const auto is_short = either(change.starting != V{}, change.closing != V{}),
             changed = change.pitch_lasts != V{};
  const V own_ticks = state.flight_ticks * chosen<V>(is_short, kShortPitchFade, kPitchFade),
          ticks = changed ? change.pitch_lasts : own_ticks,
          t = (tick - (changed ? change.pitch_begin : V{})) / ticks;
  return both(time.flies, t < all<V>(1.0f)) ? V(state.swing_pitch_rad * value_left(t) +
                                                state.swing_pitch_rate * ticks * slope_left(t))
                                            : V{};
}

// The rest of a height's difference from a new plan, and of its slope per flight.
template <class V>
V gap_left(const V& u, const Gap<V>& gap, const Change<V>& change) noexcept {
  const V s = within(gap_share(u, change), 0.0f, 1.0f);
  return gap.x * (1.0f - smoother(s)) + gap.v * change.gap_lasts * slope_left(s);
}

// The height that a flying foot keeps above. A new plan may begin with a foot below the line that
// clears the ground (`clear_m`), on that of the old plan (`base_m`). It comes over to the higher.
template <class V>
V line_to_keep(const V& base_m, const V& clear_m, const V& u, const Change<V>& change) noexcept {
  constexpr float kComes = 0.18f;  // share of the rest of the flight
  const V high_m = most(base_m, clear_m);
  return change.gap_begin != V{} ? mix(base_m, high_m, smoother(0.0f, kComes, gap_share(u, change)))
                                 : high_m;
}

// The width over which the floor's bound on the pitch is loose: the pitch's difference from the
// tables, once the toe has left the floor.
template <class V>
V loose_pitch(const V& u, const V& off, const Change<V>& change) noexcept {
  return size(off) * smooth(0.0f, 0.1f, V(u - change.gap_begin)) +
         edge_left(u, change) * change.gap_loose_rad;
}

// The ticks of a roll until the toe is down, and the share of them that is over.
template <class V>
V roll_lasts(const Change<V>& change, const State<V>& state) noexcept {
  return kRollEnd * (least(state.roll_ticks, change.led_until) - change.led_from);
}
template <class V>
V roll_over(const Change<V>& change, const State<V>& state) noexcept {
  return (state.tick - change.led_from) / roll_lasts(change, state);
}
// The rest of the pitch with which the standing foot landed.
template <class V>
V landed_pitch(const Change<V>& change, const State<V>& state) noexcept {
  const V s = roll_over(change, state);
  return s < all<V>(1.0f) ? V(state.stand_pitch_rad * value_left(s) +
                              change.led_rate_rad * roll_lasts(change, state) * slope_left(s))
                          : V{};
}

// Lets the standing foot roll down from a pitch and its rate per tick, without the tables, where
// `begins`: evenly until the end of the roll, or sooner where it would go on beyond flat.
template <class V>
void roll_on(const Mask<V>& begins, const V& pitch_rad, const V& rate_rad, Change<V>& change,
             State<V>& state) noexcept {
  constexpr float kMostSlope = 2.5f;  // of a cubic to 0, over its way: from 3 on it goes beyond
  const V pitch = least(pitch_rad, V{}), until = least(state.roll_ticks, change.led_until),
          sooner = state.tick - (kMostSlope / kRollEnd) * pitch / most(rate_rad, all<V>(1e-6f));
  change.led_until = begins ? least(until, sooner) : change.led_until;
  change.led_from = begins ? state.tick : change.led_from;
  change.led_rate_rad = begins ? rate_rad : change.led_rate_rad;
  state.stand_pitch_rad = begins ? pitch : state.stand_pitch_rad;
}

// The share of the tables' pitch that the standing foot has by the plan. If the hips lead, it rolls
// down without the tables (roll_on()): its toe is down when the other foot lifts off, and its heel
// begins to rise only then, for by the tables it may have risen before. In a first step the foot
// has not landed; in a last one it stays flat.
template <class V>
V planned_pitch(const Time<V>& time, const Change<V>& change) noexcept {
  const V rises = smoother(0.0f, 0.5f, time.u);
  const auto starts = change.starting != V{}, later = both(change.led != V{}, time.flies);
  const V share = either(starts, later) ? rises : time.flies ? all<V>(1.0f) : V(1.0f - change.led);
  return both(change.closing != V{}, time.flies) ? V{} : share;
}

// A foot in the air, before its pitch is known.
template <class V>
struct Flight {
  Vec<V> heel_m, table_heel_m;
  V base_m{},
      lifted_m{};  // height of the ground line; by how much the plane that it left is higher
  Way<V> way;      // the foot's direction
  V twist_rad{}, roll_rad{};  // of the edge on which the foot rolls
  Turn<V> tilt = no_turn<V>(), edge;
};

template <class V, class F>
Flight<V> fly(const Tables& tables, const Time<V>& time, const Landing<V>& landing,
              const Stride<V>& by_clock, const Stride<V>& stride, const Hips<V>& hips,
              const V& phase, const Sole<V>& sole, const Change<V>& change, const State<V>& state,
              const F& footing) noexcept {
  Flight<V> flight;
  const V u = time.u;
  // On level ground nothing asks where the heel of a rolling foot will fly, before it lifts off.
  if (kIsUneven<F> || any(either(time.flies, state.tick >= state.roll_ticks))) {
    flight.table_heel_m = flight_heel(tables, time, landing, by_clock, hips, phase, u, change,
                                      state, footing, flight.base_m);
    flight.heel_m = with_gap(tables, time, landing, by_clock, flight.table_heel_m, flight.base_m,
                             change, state, footing);
  }
  // A low foot that hardly leaves the floor does not roll onto an edge.
  const V over = flight_share(u, change);
  const V low = mix(all<V>(1.0f), low_lift<V>(time.right, state),
                    V(smoother(0.0f, 0.5f, over) * (1.0f - smoother(V((over - 0.6f) * 2.5f)))));
  const FootInStride<V>& table = stride.foot[0];
  flight.twist_rad = low * table.twist_rad, flight.roll_rad = low * table.roll_rad;
  flight.edge = edge_of(sole, flight.twist_rad, flight.roll_rad);
  flight.way = way_of(time.flies ? flying_yaw(time, landing, change, state) : state.print_rad);
  if constexpr (kIsUneven<F>) {
    const Turn<V> from = tilt_of(footing.print),
                  to = tilt_of(plane_in_flight(time, change, footing));
    const Vec<V>& p = flight.heel_m;
    flight.lifted_m = footing.print_y_m +
                      rise_of(footing.print, V(p.x - state.print_x_m), V(p.z - state.print_z_m)) -
                      flight.base_m - gap_left(u, footing.gap_line_m, change);
    const V goes = time.flies ? V(1.0f - value_left(u)) : V{};
    flight.tilt = unit(Turn<V>{mix(from.w, to.w, goes), mix(from.x, to.x, goes),
                               mix(from.y, to.y, goes), mix(from.z, to.z, goes)});
  }
  return flight;
}

// A foot that leaves its stand rolls onto its edge only until this is kMostEdge_m in the ground:
// the feet of some captures roll farther. From there to mid-flight it comes over to its own roll.
template <class V>
Turn<V> first_edge(const Sole<V>& sole, const Flight<V>& flight, const V& planned, const V& u,
                   const Change<V>& change) noexcept {
  // Below the 5 mm at which a sole is judged to be in the ground.
  constexpr float kMostEdge_m = 0.0045f, kSoftEdge_m = 0.0003f;
  const auto starts = both(change.starting != V{}, change.turns == V{});
  if (!any(starts)) return flight.edge;
  const V across = (turn_about(sole.side, planned) * flight.edge * sole.side).y,
          edge_m = sole.half_width_m * size(across),
          bound_m = soft_least(edge_m, all<V>(kMostEdge_m), all<V>(kSoftEdge_m)),
          share =
              mix(V(bound_m / most(edge_m, all<V>(1e-6f))), all<V>(1.0f), smoother(0.0f, 0.5f, u));
  return chosen(both(starts, bound_m < edge_m),
                edge_of(sole, V(share * flight.twist_rad), V(share * flight.roll_rad)),
                flight.edge);
}

// The share by which a flight is one in which the hips lead: all of it, or from a change of plan
// on.
template <class V>
V lead_in_flight(const V& u, const Change<V>& change, const State<V>& state) noexcept {
  constexpr float kLeads = 0.25f;  // of a flight
  const V since = u + change.led_from / state.flight_ticks;
  return change.led * (change.led_from < V{} ? smoother(0.0f, kLeads, since) : all<V>(1.0f));
}

// Turns the flying foot to its planned pitch, as far as toe and edges stay off the ground.
template <class V, class F>
void pitch_in_flight(const Time<V>& time, const Sole<V>& sole, const Flight<V>& flight,
                     const V& planned, const V& off, const Change<V>& change, const State<V>& state,
                     const F& footing, Foot<V>& foot) noexcept {
  // The toe may be kMostSink_m lower than in a stand, for in the tables toes only just leave the
  // floor. The limit of the pitch is rounded over kSoftPitch_rad, and over kWiderPitch of
  // loose_pitch().
  constexpr float kMostSink_m = 0.0015f, kSoftPitch_rad = 0.0069813f, kWiderPitch = 0.25f;
  // More where the hips lead, because pitch and limit cross at other rates there than in the
  // tables.
  constexpr float kWideLead_rad = 0.2f;
  const V u = time.u;
  foot.edge = first_edge(sole, flight, planned, u, change);
  const auto turn_to = [&](const V& pitch) {
    foot.heel_m = flight.heel_m;
    const Turn<V> level = flight.way.turn();
    set_pitch(sole, kIsUneven<F> ? flight.tilt * level : level, pitch, no(time.flies), foot);
  };
  if (!any(time.flies)) return turn_to(most(planned, V{}));
  V height_m = flight.heel_m.y;
  if constexpr (kIsUneven<F>) {
    // The plane on which the foot stood bounds the toe at first; it may differ from the ground
    // line.
    const V lifted_m = flight.lifted_m * (1.0f - smoother(0.0f, kLiftFade, u));
    height_m = (height_m - (flight.base_m + lifted_m)) * upright(footing.print);
  }
  const Vec<V> rolled = foot.edge * sole.line_m;
  const V ahead = dot(rolled, sole.forward), flat_ahead = dot(sole.line_m, sole.forward);
  const V steeper = (rolled.y * flat_ahead - sole.line_m.y * ahead) / (sole.foot_m * sole.foot_m);
  const V across = (flight.way.turn() * (turn_about(sole.side, planned) * foot.edge) * sole.side).y;
  V clears = smooth(0.0f, 0.25f, u);
  // Hips that lead from the end of stairs are fast, and the edge of their foot is low.
  if constexpr (kIsUneven<F>) clears = change.led != V{} ? smooth(0.0f, 0.1f, u) : clears;
  const V edge_m = sole.half_width_m * size(across) * clears * (1.0f - smooth(0.9f, 1.0f, u));
  V foot_m = sole.foot_m, wide{};
  if (any(change.led != V{})) {
    // A foot on its edge is shorter. The steady walk's flights are solved without that.
    const V leads = lead_in_flight(u, change, state), over = flight_share(u, change);
    foot_m = mix(foot_m, root(V(rolled.y * rolled.y + ahead * ahead)), leads);
    wide = kWideLead_rad * leads * smoother(0.0f, 0.2f, over) * (1.0f - smoother(0.6f, 0.9f, over));
  }
  const V deep = (sole.toe_rest_m + edge_m - kMostSink_m - height_m) / foot_m;
  // The arc goes on straight beyond kSteep: a heel as high as the foot is long leaves it free.
  constexpr float kSteep = 0.95f;
  const float slope = 1.0f / std::sqrt(1.0f - kSteep * kSteep);  // of the arc at kSteep
  const V arc = arc_sine(within(deep, -kSteep, kSteep)) + slope * least(V(deep + kSteep), V{});
  const V limit = sole.elevation_rad - arc + arc_sine(steeper);
  const V soft =
      kSoftPitch_rad + kWiderPitch * loose_pitch(u, off, change) + edge_m / foot_m + wide;
  turn_to(time.flies ? soft_least(planned, limit, soft) : most(planned, V{}));
}

template <class V>
struct Feet {
  Foot<V> foot[2];  // swing, stand
  Sole<V> sole[2];
  Vec<V> table_heel_m;  // of the swinging foot, in the tables
  V base_m{};           // the line below it that clears the ground
  V floor_m{};          // the same, but at first the plane that it left
  Vec<V> flat_toe_m;    // of the standing foot, if it stands flat
  Vec<V> ankle_m[2];    // of the feet after all moves
};

template <class V, class F>
Feet<V> plan_feet(const Tables& tables, const Time<V>& time, const Landing<V>& landing,
                  const Stride<V>& by_clock, const Stride<V>& stride, const Hips<V>& hips,
                  const Change<V>& change, const State<V>& state, F& footing) noexcept {
  Feet<V> feet;
  const V one = all<V>(1.0f);
  const auto starts = change.starting != V{}, first_roll = both(starts, no(time.flies));
  {  // The foot that stands: on its heel while it rolls, then on its toe.
    Foot<V>& foot = feet.foot[1];
    const auto right = no(time.right);
    const Sole<V>& sole = feet.sole[1] = sole_of<V>(tables, right);
    const FootInStride<V>& table = stride.foot[1];
    const V off = landed_pitch(change, state),
            shows = planned_pitch(time, change) + change.off_pitch.x;
    const V low = time.flies ? low_lift<V>(right, state) : one;
    const V pitch = low * table.pitch_rad * shows + (time.flies ? V{} : off);
    V planted = time.flies ? most(pitch, V{}) : least(pitch, V{});
    Turn<V> tilt = no_turn<V>();
    feet.flat_toe_m = sole.line_m;
    if constexpr (kIsUneven<F>) {
      tilt = tilt_of(footing.stand);
      feet.flat_toe_m = tilt * sole.line_m;
      // The foot rises on its toe as far as the hips have risen over it.
      const V rises_m = rise_with_hips<V>(tables, right, stride.leg_rad[1][3], V{}, V{}, footing),
              begun = smoother(
                  V(time.u * (starts ? all<V>(1.0f / kFirstRise) : all<V>(1.0f / kStandRises))));
      planted = time.flies ? pitch_to_rise<V>(tables, right, V(rises_m * begun), planted) : planted;
    }
    foot.edge = edge_of(sole, table.twist_rad, table.roll_rad);
    foot.toe_m = feet.flat_toe_m;
    foot.heel_m = {};
    set_pitch(sole, tilt, planted, time.flies, foot);
  }
  Foot<V>& foot = feet.foot[0];
  const Sole<V>& sole = feet.sole[0] = sole_of<V>(tables, time.right);
  Flight<V> flight =
      fly(tables, time, landing, by_clock, stride, hips, state.phase, sole, change, state, footing);
  feet.table_heel_m = flight.table_heel_m;
  const V off = pitch_off(time, state.tick, change, state);
  constexpr float kFirstPitch = 0.8f;  // share of the tables' pitch to which a first roll comes
  const V rolled = state.tick / state.roll_ticks, lifts = smoother(0.25f, 1.0f, rolled);
  const V low = low_pitch(low_lift<V>(time.right, state), time.u);
  V planned = first_roll ? V(low * (kFirstPitch * by_clock.foot[0].pitch_rad * lifts))
                         : V(low * stride.foot[0].pitch_rad + off);
  // The phase of hips that lead may be beyond the lift-off, where the pitch in the tables falls.
  const auto stays = both(no(time.flies), both(change.led != V{}, no(first_roll)));
  const V soft = kDegree_rad * smoother(rolled);
  planned = both(stays, soft > V{}) ? soft_positive(planned, most(soft, all<V>(1e-6f))) : planned;
  // Nor does its heel come down again: about the toe it would go back, and on so in the air, where
  // the hips lead away from it.
  if constexpr (!kIsUneven<F>) {
    constexpr float kSoftHold_rad_s = 24.0f * kDegree_rad;  // rounds where the heel stays
    const auto holds = both(both(stays, no(time.back)), state.tick > all<V>(tables.ticks));
    const V last = state.last_pitch_rad[0];
    planned =
        holds ? V(last + soft_positive(V(planned - last),
                                       all<V>(kSoftHold_rad_s * (tables.ticks * tables.tick_s))))
              : planned;
  }
  foot.toe_m = {state.toe_x_m, sole.toe_rest_m, state.toe_z_m};
  V clear_m = flight.base_m;
  if constexpr (kIsUneven<F>) {
    foot.toe_m.y = footing.toe_y_m;
    follow_room(tables, footing);
    const Vec<V> room_m = room_at(time.u, state, footing);
    const V base_m = time.flies ? V(flight.base_m + room_m.y) : footing.print_y_m;
    const V rise_m = rise_in_flight<V>(tables, time, stride.leg_rad[0][3],
                                       climbed_m(tables, time, base_m, footing), footing),
            goes_on_m = 2.0f * footing.last_rise_m[0] - footing.last_rise_m[1],
            left = edge_left(time.u, change);
    const auto begins = both(starts, state.tick == all<V>(1.0f)),
               anew = both(time.flies, either(begins, footing.is_new != V{}));
    footing.gap_rise_m = anew ? V(goes_on_m - rise_m) : footing.gap_rise_m;
    footing.is_new = V{};
    footing.rise_m = first_roll ? V{} : most(V(rise_m + left * footing.gap_rise_m), V{});
    const Vec<V> risen_m{room_m.x, V(room_m.y + footing.rise_m), room_m.z};
    flight.heel_m = flight.heel_m + risen_m;
    clear_m = base_m;
    flight.base_m = base_m + gap_left(time.u, footing.gap_line_m, change) +
                    gap_left(time.u, footing.gap_room_m, change);
    flight.heel_m.y = either(change.gap_begin != V{}, footing.crosses != V{})
                          ? flight.heel_m.y
                          : most(flight.heel_m.y, base_m);
    planned = time.flies ? planned
                         : pitch_to_rise<V>(tables, time.right, footing.rise_m, most(planned, V{}));
  }
  pitch_in_flight(time, sole, flight, planned, off, change, state, footing, foot);
  feet.base_m = most(flight.base_m, clear_m);
  if constexpr (kIsUneven<F>)
    feet.base_m = time.flies ? line_to_keep(flight.base_m, clear_m, time.u, change) : feet.base_m;
  feet.floor_m = feet.base_m;
  if constexpr (kIsUneven<F>) {
    const V left_m = footing.print_y_m + rise_of(footing.print, V(foot.heel_m.x - state.print_x_m),
                                                 V(foot.heel_m.z - state.print_z_m));
    feet.floor_m =
        time.flies ? mix(left_m, feet.base_m, smoother(0.0f, kLiftFade, time.u)) : feet.floor_m;
  }
  return feet;
}

template <class V>
Vec<V> ankle_of(const Foot<V>& foot, const Sole<V>& sole) noexcept {
  return foot.heel_m - foot.turn * sole.heel_m;
}

// A value's slope per tick at its end, from its last three values.
template <class V>
V slope_of(const V& now, const V& last, const V& before) noexcept {
  return 0.5f * (3.0f * now - 4.0f * last + before);
}
// The same half a tick later.
template <class V>
V coming_slope(const V& now, const V& last, const V& before) noexcept {
  return 2.0f * now - 3.0f * last + before;
}

// Keeps the differences of a foot that lifts off, and of its slope, from its flight in the tables,
// which are read a tick ahead for their slope.
template <class V, class F>
void lift_off(const Tables& tables, const Time<V>& time, const Mask<V>& lifts,
              const Landing<V>& landing, const Hips<V>& hips, const Feet<V>& feet,
              const Stride<V>& stride, const Change<V>& change, State<V>& state,
              F& footing) noexcept {
  const V ticks = state.flight_ticks, phase = state.phase + state.phase_rate,
          share = (state.tick + 1.0f) / (state.roll_ticks + ticks);
  const Stride<V> next = read_by_clock(tables, time, landing, phase, share, V(1.0f / ticks),
                                       Reads<V>{lifts, Mask<V>{}}, change, state);
  V base_m{};
  const Vec<V> ahead = flight_heel(tables, time, landing, next, hips, phase, V(1.0f / ticks),
                                   change, state, footing, base_m),
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
  if constexpr (kIsUneven<F>) {
    // The foot's rise with the hips is added apart from this.
    const V rises_m = slope_of(footing.rise_m, footing.last_rise_m[0], footing.last_rise_m[1]);
    state.gap_m.y = lifts ? V(state.gap_m.y - footing.rise_m) : state.gap_m.y;
    state.gap_slope_m.y = lifts ? V(state.gap_slope_m.y - rises_m * ticks) : state.gap_slope_m.y;
    const V lifts_y_m = footing.print_y_m + rise_of(footing.print, V(heel.x - state.print_x_m),
                                                    V(heel.z - state.print_z_m));
    footing.lift_y_m = lifts ? lifts_y_m : footing.lift_y_m;
  }
  state.swing_pitch_rad = lifts ? V(pitch - table_pitch) : state.swing_pitch_rad;
  state.swing_pitch_rate = lifts ? rate : state.swing_pitch_rate;
  // In a turn the foot lifts off turning at the body's rate.
  state.lift_turn_rad = lifts ? V(state.turn_rad_s.x * tables.tick_s * ticks) : state.lift_turn_rad;
}

template <class V>
void keep_swing(const Tables& tables, const Foot<V>& swing, State<V>& state) noexcept {
  const float ticks = tables.ticks;
  Vec<V>(&heel_m)[2] = state.last_heel_m;
  for (V Vec<V>::*part : {&Vec<V>::x, &Vec<V>::y, &Vec<V>::z}) {
    V last_m[2] = {heel_m[0].*part, heel_m[1].*part};
    keep_last(ticks, swing.heel_m.*part, last_m);
    heel_m[0].*part = last_m[0], heel_m[1].*part = last_m[1];
  }
  keep_last(ticks, swing.pitch_rad, state.last_pitch_rad);
}

// Exchanges swing and stand at a strike, and sees places from the new step frame.
template <class V>
void change_feet(const Landing<V>& landing, const Mask<V>& strikes, const Feet<V>& feet,
                 const Stride<V>& stride, State<V>& state) noexcept {
  const auto set = [&](const V& to, V& number) { number = strikes ? to : number; };
  const Way<V> back_turn = back(landing.way);
  const auto moved = [&](const V& x_m, const V& z_m) {
    return back_turn * Vec<V>{x_m - landing.x_m, V{}, z_m - landing.z_m};
  };
  const Vec<V> print = moved(V{}, V{}), toe = moved(feet.flat_toe_m.x, feet.flat_toe_m.z);
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
  set(V(feet.foot[0].pitch_rad - stride.stood_pitch_rad), state.stand_pitch_rad);
  for (int j = 0; j < kLegAngles; ++j) {
    exchange(strikes, state.leg_rad[0][j], state.leg_rad[1][j]);
    exchange(strikes, state.last_leg_rad[0][j], state.last_leg_rad[1][j]);
  }
}

}  // namespace
}  // namespace gaitpad
