// Third part of a tick: moves the hips, and finds the phase at which the tables are read.
#pragma once
#include <cstdint>
#include <type_traits>

#include "walk/strides.h"

namespace gaitpad {
namespace {

// The path to the next landing. `turns`: whole cycles at the end of the step.
template <class V>
Path<V> path_to(const Landing<V>& landing, const FootprintsIn<V>& prints, const V& turns) noexcept {
  const Vec<V> seen =
      landing.way * Vec<V>{prints.swing_m.x, V{}, prints.swing_m.z + prints.stride_m * turns};
  return {landing.x_m - seen.x, landing.z_m - seen.z, landing.way.sine * prints.stride_m,
          landing.way.cosine * prints.stride_m};
}

// True if there is no difference in any walk, by its bits: a zero with a sign is one.
template <class V>
bool is_nothing(const Off<V>& off) noexcept {
  using Bits = std::conditional_t<kLanes<V> == 1, std::uint32_t, Mask<V>>;
  static_assert(sizeof(Bits) == sizeof(V));
  const auto bits = [](const V& number) {
    Bits of;
    std::memcpy(&of, &number, sizeof of);
    return of;
  };
  const Bits parts = bits(off.x) | bits(off.v) | bits(off.a);
  if constexpr (kLanes<V> == 1) {
    return parts == 0;
  } else {
    return !any(parts);
  }
}
// Moves a difference by one tick, or by `goes` ticks, along the quintic that brings it, its rate
// and its acceleration to 0 in `ticks`.
template <class V>
void fade(const V& ticks, Off<V>& off, float goes = 1.0f) noexcept {
  if (is_nothing(off)) return;
  const V n = most(ticks, all<V>(1.0f)), per_tick = 1.0f / n, s = goes * per_tick, p = off.v * n,
          q = off.a * (0.5f * n * n);
  const V c3 = -10.0f * off.x - 6.0f * p - 3.0f * q, c4 = 15.0f * off.x + 8.0f * p + 3.0f * q,
          c5 = -6.0f * off.x - 3.0f * p - q;
  const auto lasts = ticks > all<V>(goes);
  off.x = lasts ? V(off.x + (p + (q + (c3 + (c4 + c5 * s) * s) * s) * s) * s) : V{};
  off.v =
      lasts ? V((p + (2.0f * q + (3.0f * c3 + (4.0f * c4 + 5.0f * c5 * s) * s) * s) * s) * per_tick)
            : V{};
  off.a = lasts ? V((2.0f * q + (6.0f * c3 + (12.0f * c4 + 20.0f * c5 * s) * s) * s) *
                    (per_tick * per_tick))
                : V{};
}

template <class V>
struct Hips {
  V x_m{}, z_m{};                 // of the pelvis, on the ground
  Way<V> heading;                 // of the body
  FootprintsIn<V> behind, ahead;  // of the last step's stride and of this step's
  FootprintsIn<V> own;            // in a first or a last step: of short_ratio()
};

// Ticks between the three moments at which the tables' rate and acceleration at a strike are read.
// At the reference leg they are 1/60 s apart, two knots of the tables: closer together the
// acceleration would be that of one piece of the spline.
inline float aim_ticks(const Tables& tables) noexcept {
  constexpr float kAim_s = 1.0f / 60.0f;
  return kAim_s * tables.time_scale / tables.tick_s;
}

// The hips follow this step's stride to the landing. Their difference from that path fades until
// the strike; it begins where the last step had another stride, or the landing moves.
template <class V>
Hips<V> move_hips(const Tables& tables, const Time<V>& time, const Landing<V>& landing,
                  const Stride<V>& stride, const Change<V>& change, State<V>& state) noexcept {
  Hips<V> hips;
  hips.heading = way_of(state.heading_rad);
  hips.behind = footprints_of(tables, time, state.ratio_behind);
  hips.ahead = footprints_of(tables, time, landing.ratio);
  if (any(either(change.starting != V{}, change.closing != V{})))
    hips.own = footprints_of(tables, time, short_ratio(tables, landing, change, state));
  const V turns = chosen<V>(time.right, 1.0f, 0.0f);
  const Path<V> to = path_to(landing, hips.ahead, turns);
  const V x_m = to.x_m + to.per_cycle_x_m * state.phase,
          z_m = to.z_m + to.per_cycle_z_m * state.phase;
  const auto strikes = both(no(time.flies), state.tick == all<V>(tables.ticks));
  if (any(strikes)) {
    // The difference from the path of the last step's stride at this strike, its rate and its
    // acceleration.
    const V from_x_m = -hips.behind.stand_m.x - to.x_m, from_z_m = -hips.behind.stand_m.z - to.z_m,
            per_x_m = -to.per_cycle_x_m, per_z_m = hips.behind.stride_m - to.per_cycle_z_m;
    const V ticks = state.roll_ticks;
    const PhaseCubic<V> moves(roll_cycles<V>(tables, time.right), state.strike_rate * ticks,
                              state.end_rate * ticks);
    const float aim = aim_ticks(tables);
    const auto phase_at = [&](float n) { return V(time.step_phase + moves.at(V(n / ticks))); };
    const V p0 = time.step_phase, rate = state.strike_rate,
            bend = 2.0f * moves.c2 / (ticks * ticks);
    const auto begin = [&](const V& from_m, const V& per_m, Off<V>& off) {
      off = chosen(strikes, {V(from_m + per_m * p0), V(per_m * rate), V(per_m * bend)}, off);
    };
    begin(from_x_m, per_x_m, state.hips_x_m);
    begin(from_z_m, per_z_m, state.hips_z_m);
    // After a step in which the hips led, they go on from their place.
    const auto was_led = both(strikes, change.was_led != V{});
    if (any(was_led)) {
      V x_m[3], z_m[3];
      const StrideMix<V> mix = mix_of_strides(tables, time, state.ratio_behind, was_led);
      const V phases[3] = {phase_at(0.0f), phase_at(aim), phase_at(2.0f * aim)};
      Vec<V> pelvis_m[3];
      read_pelvis(mix, phases, pelvis_m);
      for (int n : {0, 1, 2}) {
        const float k = static_cast<float>(n) * aim;
        const V at = phases[n];
        const Vec<V> pelvis = hips.heading * pelvis_m[n];
        const auto goes = [&](const Off<V>& of) { return V(of.x + k * (of.v + 0.5f * k * of.a)); };
        x_m[n] = goes(change.pelvis_x_m) - pelvis.x - (to.x_m + to.per_cycle_x_m * at);
        z_m[n] = goes(change.pelvis_z_m) - pelvis.z - (to.z_m + to.per_cycle_z_m * at);
      }
      const auto go_on = [&](const V(&m)[3], Off<V>& off) {
        off = chosen(was_led,
                     {m[0], V((0.5f / aim) * (4.0f * m[1] - 3.0f * m[0] - m[2])),
                      V((1.0f / (aim * aim)) * (m[0] - 2.0f * m[1] + m[2]))},
                     off);
      };
      go_on(x_m, state.hips_x_m);
      go_on(z_m, state.hips_z_m);
    }
  }
  // The hips do not jump when the path moves.
  const Path<V>& was = state.path;
  const V was_x_m = was.x_m + was.per_cycle_x_m * state.phase,
          was_z_m = was.z_m + was.per_cycle_z_m * state.phase;
  state.hips_x_m.x = state.hips_x_m.x + (strikes ? V{} : V(was_x_m - x_m));
  state.hips_z_m.x = state.hips_z_m.x + (strikes ? V{} : V(was_z_m - z_m));
  state.path = to;
  const V ticks = time.to_strike + tables.ticks;
  fade(ticks, state.hips_x_m, tables.ticks);
  fade(ticks, state.hips_z_m, tables.ticks);
  const Vec<V> off = hips.heading * stride.pelvis_m;
  hips.x_m = x_m + state.hips_x_m.x + off.x;
  hips.z_m = z_m + state.hips_z_m.x + off.z;
  return hips;
}

// --- A change of pace: the hips lead, the phase follows ------------------------------------------

// Of the flight: until then the lift-off's motion fades, and the plane that is left.
inline constexpr float kLiftFade = 0.5f;
// At the reference leg: in which hips that would rest follow a landing that still moves.
inline constexpr float kComesAfter_s = 0.1f;
inline constexpr float kCarry_s = 0.15f;  // at the reference leg: a phase of a new plan fades in

// Place and rate of a path at the middle of three places, `apart` ticks apart, and half of its
// acceleration: with all of it a start at a full stick speeds up by 12 % more than the walk itself.
template <class V>
Off<V> middle_of(const V (&m)[3], float apart) noexcept {
  return {m[1], V((m[2] - m[0]) * (0.5f / apart)),
          V((m[2] - 2.0f * m[1] + m[0]) * (0.5f / (apart * apart)))};
}

// Moves the pelvis by one tick to its place in the tables at the coming strike, with their rate and
// acceleration there. `ratios`: of the step's own stride.
template <class V>
void move_pelvis(const Tables& tables, const Time<V>& time, const Landing<V>& landing,
                 Knots<V> ratios, const V& strike_phase, const V& strike_rate,
                 const State<V>& state, Change<V>& change) noexcept {
  const float aim = aim_ticks(tables);
  Path<V> path = state.path;
  if (any(change.off_ratio.x != V{})) {  // at the strike no difference of the ratio is left
    const V ratio = landing.ratio - change.off_ratio.x;
    ratios = ratios_at(ratio, last_ratio<V>(time.back));
    path = path_to(landing, footprints_of(tables, time, ratio), chosen<V>(time.right, 1.0f, 0.0f));
  }
  const auto led = change.led != V{}, closes = change.closing != V{}, stops = change.stops != V{};
  const StrideMix<V> mix = mix_of_ratios(tables, time, ratios, ratios, V{}, both(led, no(stops)));
  V x_m[3], z_m[3], phases[3];
  for (int k : {0, 1, 2})
    phases[k] = strike_phase + (static_cast<float>(k - 1) * aim) * strike_rate;
  Vec<V> pelvis_m[3];
  read_pelvis(mix, phases, pelvis_m);
  for (int k : {0, 1, 2}) {
    const V at = phases[k];
    const Vec<V> pelvis = landing.way * pelvis_m[k];
    x_m[k] = path.x_m + path.per_cycle_x_m * at + pelvis.x;
    z_m[k] = path.z_m + path.per_cycle_z_m * at + pelvis.z;
  }
  const V left = stops ? change.rest_ticks : time.to_strike, ticks = left + tables.ticks;
  // In a stop it comes to rest between the feet as the last step leaves them.
  if (any(stops)) {
    const V swings_m = of_leg<V>(tables, time.right, &LegBones::stance_m),
            stands_m = of_leg<V>(tables, no(time.right), &LegBones::stance_m),
            next_m = time.right ? change.length_m[0] : change.length_m[1];
    const V further_m = change.further * (time.back ? -next_m : next_m);
    const Vec<V> rest = landing.way * Vec<V>{-swings_m, V{}, tables.rest_lead_m + further_m};
    for (int k : {0, 1, 2}) {
      x_m[k] = closes ? -stands_m : stops ? landing.x_m + rest.x : x_m[k];
      z_m[k] = closes ? all<V>(tables.rest_lead_m) : stops ? landing.z_m + rest.z : z_m[k];
    }
  }
  // A first step takes up the tables' mean speed alone: to be as fast as a steady walk at a strike,
  // hips that come from rest would speed up by a quarter more, in a short way before it.
  // It takes up no more than its flight gives time for: hips that come from rest would else push
  // harder than people's do.
  constexpr float kPush_m_s2 = 4.2f;      // speed over the flight's time
  constexpr float kSoftPush_m_s = 0.15f;  // rounds that bound; both at the reference leg
  const auto starts = both(change.starting != V{}, no(stops));
  V takes_up = all<V>(1.0f);
  if (tables.terrain == nullptr && any(starts)) {
    const float per_s = tables.tick_s / tables.time_scale, m_per_tick = tables.size * per_s;
    const V x = path.per_cycle_x_m, z = path.per_cycle_z_m,
            goes_m = root(V(x * x + z * z)) * strike_rate,
            bound_m = soft_least(goes_m, V(kPush_m_s2 * per_s * m_per_tick * state.flight_ticks),
                                 all<V>(kSoftPush_m_s * m_per_tick));
    takes_up = goes_m > V{} ? V(bound_m / goes_m) : takes_up;
  }
  const auto move = [&](const V(&m)[3], const V& per_cycle_m, Off<V>& pelvis) {
    const Off<V> own = middle_of(m, aim),
                 at = chosen(starts, {own.x, V(takes_up * per_cycle_m * strike_rate), V{}}, own);
    const auto goal = [&](const V& n) {  // n ticks before the strike
      return Off<V>{V(at.x - n * (at.v - 0.5f * n * at.a)), V(at.v - at.a * n), at.a};
    };
    const Off<V> was = goal(ticks), is = goal(left);
    Off<V> off{V(pelvis.x - was.x), V(pelvis.v - was.v), V(pelvis.a - was.a)};
    fade(stops ? ticks : most(ticks, change.catch_ticks), off, tables.ticks);
    pelvis = chosen(led, {V(is.x + off.x), V(is.v + off.v), V(is.a + off.a)}, pelvis);
  };
  move(x_m, path.per_cycle_x_m, change.pelvis_x_m);
  move(z_m, path.per_cycle_z_m, change.pelvis_z_m);
}

inline constexpr float kFastestPhase = 2.5f;  // of hips that lead, over the clock's rate

// The phase at which the tables have the pelvis at its place, by Newton's method on a sum of
// squares: distance of the hips from their place, and of the phase from the clock's. `strides`: the
// tables as this tick shows them; `share`: of the path to the landing, from the last step's. `rate`
// becomes the phase's rate.
template <class V>
V phase_of_pelvis(const Tables& tables, const Time<V>& time, const Landing<V>& landing,
                  const Hips<V>& hips, StrideMix<V> strides, const V& strike_phase,
                  const V& strike_rate, const V& share, const State<V>& state,
                  const Change<V>& change, V& rate) noexcept {
  // A phase that is a cycle off the clock counts as much as hips that are kInTime_m off their
  // place. That keeps the hips' height in time with the landing. In first and last steps that go
  // farther than kGoesSomewhere of the data's stride the hips alone tell the phase; kLeastWay_m2
  // bounds the Newton step there.
  constexpr float kInTime_m = 1.2f, kLeastWay_m2 = 0.02f, kGoesSomewhere = 0.2f;
  constexpr float kPhaseStep = 1e-3f;                      // cycles, of the slope
  constexpr float kBeforeStep = 0.1f, kAfterStep = 0.14f;  // cycles around the step's own
  constexpr float kFastestStop = 1.5f;                     // of the clock's rate
  constexpr float kComesUp_s = 0.06f;  // at the reference leg: to the fastest rate, and back
  constexpr int kFewTries = 2, kPhaseTries = 6;  // iterations: usually, and where a plan is new
  const Way<V>& way = landing.way;
  const Path<V>& path = state.path;
  const V at_zero = mix(way.ahead(V(-hips.behind.stand_m.x), V(-hips.behind.stand_m.z)),
                        way.ahead(path.x_m, path.z_m), share),
          per_cycle = mix(way.ahead(V{}, hips.behind.stride_m),
                          way.ahead(path.per_cycle_x_m, path.per_cycle_z_m), share);
  const auto led = change.led != V{},
             carries = both(led, either(change.is_new != V{}, change.was_new != V{}));
  strides.keep(led);
  const V wanted = way.ahead(change.pelvis_x_m.x, change.pelvis_z_m.x),
          goes = way.ahead(change.pelvis_x_m.v, change.pelvis_z_m.v);
  const float square = tables.size * tables.size, in_time_m2 = kInTime_m * kInTime_m * square,
              least_m2 = kLeastWay_m2 * square;
  const V in_time = in_time_m2 * (1.0f - most(change.starting, change.closing) *
                                             smooth(0.0f, kGoesSomewhere, landing.ratio));
  const V low = time.step_phase - kBeforeStep, high = strike_phase + kAfterStep;
  V phase = change.phase - change.off_phase.x;
  phase = phase - floored(V(phase - 0.5f * (low + high) + 0.5f));
  phase = least(most(phase, low), high);
  const V last = phase;
  for (int n = 0; n < (any(carries) ? kPhaseTries : kFewTries); ++n) {
    if (n == kFewTries) strides.keep(carries);
    const V phases[2] = {phase, V(phase + kPhaseStep)};
    Vec<V> pelvis_m[2];
    read_pelvis(strides, phases, pelvis_m);
    const auto goes_m = [&](int k) { return V(at_zero + per_cycle * phases[k] + pelvis_m[k].z); };
    const V here = goes_m(0), slope = (goes_m(1) - here) * (1.0f / kPhaseStep),
            weight = 1.0f / (slope * slope + (in_time + least_m2));
    const V step = ((here - wanted) * slope + in_time * (phase - state.phase)) * weight,
            next = least(most(V(phase - step), low), high),
            moves = (goes * slope + in_time * state.phase_rate) * weight;
    const auto tries = either(carries, all<V>(static_cast<float>(n)) < all<V>(kFewTries));
    phase = tries ? next : phase;
    rate = tries ? moves : rate;
  }
  const auto stops = tables.terrain != nullptr ? change.stops != V{} : Mask<V>{};
  const V fastest = tables.ticks * (chosen<V>(stops, kFastestStop, kFastestPhase) * strike_rate);
  V next = least(most(phase, V(last - fastest)), V(last + fastest));
  // A phase that lags behind comes up in time: its rate goes over to the hips'. On level ground
  // that is needed in first steps alone, where a stick that crosses the heading or is let go moves
  // the landing fast; the phase also goes ahead of the hips' rate as evenly there. Before a stop
  // the phase falls back at once: almost none of it is shown yet.
  const auto level = tables.terrain == nullptr ? V{} == V{} : Mask<V>{},
             starts = both(level, both(change.starting != V{}, change.turns == V{})),
             comes_up = either(no(level), starts), falls = both(starts, change.stops == V{});
  if (any(comes_up)) {
    const V bend = (kFastestPhase - 1.0f) * strike_rate *
                   (tables.tick_s / (kComesUp_s * tables.time_scale)),
            goes = tables.ticks * rate, lags = phase - last - goes,
            comes = tables.ticks * root(V(2.0f * bend * size(lags))),
            was = change.phase_rate - change.off_phase.v;
    next = both(comes_up, size(lags) > comes)
               ? least(falls ? next : most(next, V(last + goes - comes)), V(last + goes + comes))
               : next;
    const float ticks = tables.ticks;
    next = starts ? least(next, V(last + ticks * most(was, rate) + ticks * ticks * bend)) : next;
  }
  return carries ? phase : next;
}

// Scales a stride towards standing: `shown` is the share of it that is left.
template <class V>
void show(const V& shown, Stride<V>& stride) noexcept {
  for (FootInStride<V>& foot : stride.foot) {
    foot.pitch_rad = shown * foot.pitch_rad;
    foot.twist_rad = shown * foot.twist_rad;
    foot.roll_rad = shown * foot.roll_rad;
  }
  stride.stood_pitch_rad = shown * stride.stood_pitch_rad;
  stride.pelvis_m = stride.pelvis_m * shown;
  stride.pelvis_tilt_rad = stride.pelvis_tilt_rad * shown;
  stride.pelvis_yaw_rad = shown * stride.pelvis_yaw_rad;
  stride.pelvis_low_m = shown * stride.pelvis_low_m;
  stride.pelvis_high_m = shown * stride.pelvis_high_m;
  for (auto& leg : stride.leg_rad)
    for (V& angle_rad : leg) angle_rad = shown * angle_rad;
}

// Share of a last step that is left, from its plan on.
template <class V>
V closing_left(const Time<V>& time, const Change<V>& change) noexcept {
  return smoother(V(time.to_strike / most(change.closing_ticks, all<V>(1.0f))));
}
// Shares by the plan: of the tables that is shown; by which the step has changed from the last
// step's stride into its own. A step between of a stop keeps the last step's stride until its
// lift-off: its own one, which is shorter, has higher hips, and the leg behind, nearly straight,
// would pull them down and let go of them with a jerk.
template <class V>
V planned_shown(const Time<V>& time, const Change<V>& change) noexcept {
  constexpr float kShownAfter = 0.55f;  // of a first step: from then on all of it
  const V begins = smoother(0.0f, kShownAfter, time.share),
          walks = change.closing != V{} ? closing_left(time, change) : all<V>(1.0f);
  const auto starts = both(change.starting != V{}, change.turns == V{});
  return change.stands != V{} ? V{} : starts ? begins : walks;
}
template <class V>
V planned_over(const Time<V>& time, const Change<V>& change) noexcept {
  const V goes = change.stops != V{} ? time.u : time.share,
          walks = change.starting != V{} ? all<V>(1.0f) : smoother(goes);
  return change.closing != V{} ? V{} : walks;
}

// Share by which the flying foot's edges follow the phase of the clock, by the plan. Before
// lift-off and after the strike they follow the phase of the hips.
template <class V>
V planned_edge(const Time<V>& time, const Change<V>& change) noexcept {
  constexpr float kEdgeGoes = 0.4f;  // of the flight
  const V lands =
      change.closing != V{} ? V{} : smoother(V((time.u - (1.0f - kEdgeGoes)) * (1.0f / kEdgeGoes)));
  return smoother(0.0f, kEdgeGoes, time.u) * (1.0f - lands);
}
// The same, with its difference from the plan. After a step in which the hips have led, the phase
// still comes up to the clock's, so the edges come over to it as well: where they lift off turned
// by the clock at once, feet of four captures jumped by up to 3 degrees.
template <class V>
V edge_by_clock(const Time<V>& time, const Change<V>& change) noexcept {
  return either(change.led != V{}, change.was_led != V{})
             ? V(planned_edge(time, change) + change.off_edge.x)
             : all<V>(1.0f);
}

// Moves the differences that a change of plan has left by one tick, or by `goes` ticks. `time`,
// `state`: after them.
template <class V>
void fade_differences(const Time<V>& time, const State<V>& state, Change<V>& change,
                      float goes = 1.0f) noexcept {
  for (Off<V>* off : {&change.off_phase, &change.off_shown}) fade(change.off_ticks, *off, goes);
  // Differences of the step end with it, and that of the standing foot's pitch with its stage.
  const V step_ticks = least(change.off_ticks, V(time.to_strike + goes));
  for (Off<V>* off : {&change.off_over, &change.off_ratio, &change.off_edge})
    fade(step_ticks, *off, goes);
  fade(least(change.off_ticks, V(ticks_of_stage(state) - state.tick + goes)), change.off_pitch,
       goes);
  if (any(change.turns != V{}))
    for (Off<V>& off : change.off_turned) fade(step_ticks, off, goes);
}

// The numbers of a stride that Change::off_turned changes, in its order.
template <class V>
std::array<V*, kTurnedNumbers> turned_numbers(Stride<V>& stride) noexcept {
  FootInStride<V>&swing = stride.foot[0], &stand = stride.foot[1];
  return {&stride.pelvis_m.y,        &stride.pelvis_yaw_rad,    &stride.pelvis_tilt_rad.x,
          &stride.pelvis_tilt_rad.y, &stride.pelvis_tilt_rad.z, &stand.twist_rad,
          &stand.roll_rad,           &swing.twist_rad,          &swing.roll_rad,
          &stride.leg_rad[0][3],     &stride.leg_rad[1][3],     &stand.pitch_rad,
          &stride.stood_pitch_rad};
}

// True where the hips lead, have just led, or stand: the pose then shows a phase of its own, not
// the clock's.
template <class V>
Mask<V> has_own_phase(const Change<V>& change) noexcept {
  return either(either(either(change.led != V{}, change.was_led != V{}), change.off_ticks != V{}),
                change.stands != V{});
}

// Smooths the pitch of the foot that lifts off next where the hips lead: the tables' pitch turns a
// corner at its lift-off, which a phase that runs ahead of the clock goes around fast. The pitch is
// a mean over phases, the wider the farther the phase is from the clock's. `mix`: of the stride.
template <class V>
void round_lift_off(const Tables& tables, const Time<V>& time, const V& phase, StrideMix<V> mix,
                    const State<V>& state, const Change<V>& change, Stride<V>& stride) noexcept {
  constexpr float kWide = 0.6f;     // of the distance from the clock's phase, to either side
  constexpr float kWidest = 0.03f;  // cycles
  constexpr float kOfMean[] = {0.375f, 0.25f, 0.0625f};  // in the middle, half-way, at the ends
  const V wide = least(V(kWide * size(V(phase - state.phase))), all<V>(kWidest));
  const auto leads = both(change.led != V{}, change.stands == V{});
  if (!any(leads)) return;
  mix.keep(leads);
  V mean_rad{};
  const auto right = time.flies ? no(time.right) : time.right;
  V phases[5], n[5][4];
  for (int k = 0; k < 5; ++k) phases[k] = phase + (0.5f * static_cast<float>(k - 2)) * wide;
  read_fours(mix, kPitchAt, phases, n);
  for (int k = 0; k < 5; ++k)
    mean_rad = mean_rad + kOfMean[std::abs(k - 2)] * (right ? n[k][1] : n[k][0]);
  // A foot that is to close keeps the pitch of its step until it lifts off: with less of it the leg
  // behind would be straight, and pull the hips down. So does one whose walk goes on after all.
  const V pitch_rad = both(goes_level(tables, state), change.starting == V{})
                          ? mean_rad
                          : V(change.shown * mean_rad);
  const auto stands = both(leads, time.flies), rolls = both(leads, no(time.flies));
  stride.foot[0].pitch_rad = rolls ? pitch_rad : stride.foot[0].pitch_rad;
  stride.foot[1].pitch_rad = stands ? pitch_rad : stride.foot[1].pitch_rad;
}

// If the hips lead or have just led: moves them to their place, and reads the stride at their
// phase; the flying foot keeps to the clock. Returns that phase, else the clock's. `stride`: a copy
// of `by_clock`.
template <class V>
V lead_hips(const Tables& tables, const Time<V>& time, const Landing<V>& landing,
            const Stride<V>& by_clock, State<V>& state, Change<V>& change, Hips<V>& hips,
            Stride<V>& stride) noexcept {
  const auto led = change.led != V{}, stands = change.stands != V{}, runs = has_own_phase(change);
  if (!any(runs)) return state.phase;
  const auto is_new = change.is_new != V{}, was_new = both(no(is_new), change.was_new != V{});
  const V last_found = change.phase - change.off_phase.x;
  const float gone = tables.ticks;
  fade_differences(time, state, change, gone);
  change.off_ticks = most(V(change.off_ticks - gone), V{});
  // Hips do not rest before the last step, because the landing before it may still move.
  const V lasts = both(change.stops != V{}, change.closing == V{})
                      ? all<V>(kComesAfter_s * tables.time_scale / tables.tick_s)
                      : V{};
  change.rest_ticks = most(V(change.rest_ticks - gone), lasts);
  change.catch_ticks = most(V(change.catch_ticks - gone), V{});
  const V over = planned_over(time, change) + change.off_over.x;
  const V last = last_ratio<V>(time.back);
  const Knots<V> ahead = ratios_at(landing.ratio, last);
  const StrideMix<V> strides =
      mix_of_ratios(tables, time, ratios_at(state.ratio_behind, last), ahead, over, runs);
  V phase = state.phase, rate = state.phase_rate;
  if (any(led)) {
    const Stages<V> next = stages_of(tables, change, state, no(time.right));
    const V flight = flight_cycles<V>(tables, time.right),
            strike_phase = time.stage_end + (time.flies ? V{} : flight),
            strike_rate = time.flies ? state.end_rate
                                     : V(0.5f * (flight / state.flight_ticks +
                                                 next.roll / ticks_of(next.roll_s, tables.tick_s)));
    move_pelvis(tables, time, landing, ahead, strike_phase, strike_rate, state, change);
    V moves{};
    // Hips that are to close stay on the last step's path. Its landing comes back at once: on a
    // path to there they would be far ahead in the tables.
    const V share = change.closing != V{} ? V{} : over,
            found = phase_of_pelvis(tables, time, landing, hips, strides, strike_phase, strike_rate,
                                    share, state, change, moves);
    // A new plan's rate is measured a tick later, because its path moves as well. Hips that hardly
    // move yet leave the phase open: there it may leap.
    const V leaps = found - last_found, most_rate = kFastestPhase * strike_rate,
            leapt = (1.0f / gone) * (leaps - floored(V(leaps + 0.5f))),
            goes = least(most(leapt, V(-most_rate)), most_rate);
    moves = was_new ? goes : moves;
    phase = led ? found : phase;
    rate = led ? moves : rate;
  }
  // The last phase that was shown, less whole cycles, where it is nearest.
  const auto last_near = [&](const V& at) {
    return V(change.phase - floored(V(change.phase - at + 0.5f)));
  };
  const V was = last_near(phase);
  const auto carries = either(is_new, was_new);
  change.off_phase =
      chosen(carries, {V(was + gone * change.phase_rate - phase), V(change.phase_rate - rate), V{}},
             change.off_phase);
  const float carry = kCarry_s * tables.time_scale / tables.tick_s;
  change.off_ticks =
      is_new ? most(floored(all<V>(carry + 0.5f)), change.off_ticks) : change.off_ticks;
  change.was_new = change.is_new, change.is_new = V{};
  change.shown = runs ? V(planned_shown(time, change) + change.off_shown.x) : change.shown;
  phase = phase + change.off_phase.x;
  const V goes = (1.0f / gone) * (phase - last_near(phase));
  change.phase = runs ? phase : change.phase;
  change.phase_rate = runs ? goes : change.phase_rate;
  phase = runs ? phase : state.phase;
  stride = read_stride(strides, time, phase);
  if (any(change.shown != all<V>(1.0f))) show(change.shown, stride);
  if (any(no(runs))) put_where<V>(no(runs), by_clock, stride);
  round_lift_off(tables, time, phase, strides, state, change, stride);
  const auto turns = change.turns != V{};
  if (any(turns)) {
    const auto numbers = turned_numbers(stride);
    for (std::size_t k = 0; k < numbers.size(); ++k)
      *numbers[k] = turns ? V(*numbers[k] + change.off_turned[k].x) : *numbers[k];
  }
  stride.heel_behind_m = by_clock.heel_behind_m, stride.heel_ahead_m = by_clock.heel_ahead_m;
  stride.heel_high_m = by_clock.heel_high_m;
  const V share = edge_by_clock(time, change);
  const FootInStride<V> stood = stride.foot[0];
  FootInStride<V> flying = by_clock.foot[0];
  const V edge = edge_left(time.u, change);
  flying.twist_rad = flying.twist_rad + edge * change.gap_twist_rad;
  flying.roll_rad = flying.roll_rad + edge * change.gap_roll_rad;
  FootInStride<V>& swing = stride.foot[0];
  swing.pitch_rad = time.flies ? flying.pitch_rad : stood.pitch_rad;
  swing.twist_rad = time.flies ? mix(stood.twist_rad, flying.twist_rad, share) : stood.twist_rad;
  swing.roll_rad = time.flies ? mix(stood.roll_rad, flying.roll_rad, share) : stood.roll_rad;
  // Hips that do not lead stay on the path of the clock's phase: move_hips() has kept their
  // difference from the tables at that phase, not at the one that is shown.
  hips.x_m = stands ? state.pelvis_x_m[0] : led ? change.pelvis_x_m.x : hips.x_m;
  hips.z_m = stands ? state.pelvis_z_m[0] : led ? change.pelvis_z_m.x : hips.z_m;
  return phase;
}

// Keeps a number beside those of the last ticks. After several ticks at once those in between lie
// on a line.
template <class V, std::size_t kKept>
void keep_last(float ticks, const V& now, V (&last)[kKept]) noexcept {
  const V went = ticks == 1.0f ? V{} : V((1.0f / ticks) * (now - last[0]));
  for (std::size_t k = kKept - 1; k > 0; --k)
    last[k] = ticks == 1.0f ? last[k - 1] : V(now - static_cast<float>(k) * went);
  last[0] = now;
}
template <class V>
void keep_pelvis(const Tables& tables, const Hips<V>& hips, State<V>& state) noexcept {
  keep_last(tables.ticks, hips.x_m, state.pelvis_x_m);
  keep_last(tables.ticks, hips.z_m, state.pelvis_z_m);
}

// Where `begins`: the leading pelvis starts with the place, rate and acceleration of the last
// ticks.
template <class V>
void go_on_from_here(const Tables& tables, const Mask<V>& begins, const State<V>& state,
                     Change<V>& change) noexcept {
  const V m_x = state.pelvis_x_m[0] - state.pelvis_x_m[1],
          m_z = state.pelvis_z_m[0] - state.pelvis_z_m[1],
          b_x = state.pelvis_x_m[1] - state.pelvis_x_m[2],
          b_z = state.pelvis_z_m[1] - state.pelvis_z_m[2];
  const V bend_x = m_x - b_x, bend_z = m_z - b_z, bend = root(V(bend_x * bend_x + bend_z * bend_z));
  constexpr float kMostBend_m_s2 = 6.0f;  // people's: more is rounding or lasts a moment
  const float most_bend = kMostBend_m_s2 * tables.tick_s * tables.tick_s;
  const V within_most = most_bend / most(bend, all<V>(most_bend));
  const auto begin = [&](const V& place, const V& m, const V& b, const V& bends, Off<V>& pelvis) {
    pelvis = chosen(begins, {place, V(1.5f * m - 0.5f * b), V(bends * within_most)}, pelvis);
  };
  begin(state.pelvis_x_m[0], m_x, b_x, bend_x, change.pelvis_x_m);
  begin(state.pelvis_z_m[0], m_z, b_z, bend_z, change.pelvis_z_m);
}

// Differences that make the hips lead: of a step's length over the data's, and of its flight's
// time.
inline constexpr float kOtherPace = 0.02f, kOtherTime = 0.06f;

// True if a step is asked for with another length, or with another time of its flight, than the
// last one of the same foot, `right`.
template <class V>
Mask<V> has_other_pace(const Tables& tables, const Mask<V>& right, const V& own_m,
                       const State<V>& state, const Change<V>& change) noexcept {
  // A led step takes time from its roll for its flight. That alone does not lead another step.
  const Stages<V> own = stages_of(tables, change, state, right);
  const V rolls = change.led != V{} ? V(own.roll_s - state.roll_ticks * tables.tick_s) : V{},
          flight_ticks = (own.flight_s + rolls) * (1.0f / tables.tick_s);
  return either(
      size(V(by_side<V>(right, state.asked.length_m) - change.stepped_m)) > kOtherPace * own_m,
      size(V(state.flight_ticks - flight_ticks)) > kOtherTime * state.flight_ticks);
}

// At a strike: decides whether the hips lead the step that begins, which they do if its length or
// its time is another than the last one's. In it, and in the step after it, the pelvis goes on from
// its place, in the new step frame. `phase`, `rate`: as shown at the strike.
template <class V>
void begin_lead(const Tables& tables, const Mask<V>& strikes, const V& phase, const V& rate,
                const Mask<V>& is_level, const State<V>& state, Change<V>& change) noexcept {
  const auto right = state.right_swings == V{};  // it swings in the step that begins
  const V own_m = own_step_m<V>(tables, right, state.backward != V{}),
          asked_m = by_side<V>(right, state.asked.length_m),
          smoothed_m = right ? state.length_m[1].x : state.length_m[0].x;
  // In the last step of a stop the foot closes beside the other one.
  const auto stops = change.stops != V{}, rests = both(strikes, change.closing != V{}),
             closes = both(both(strikes, no(rests)), both(stops, change.further == V{}));
  change.stands = rests ? all<V>(1.0f) : change.stands;
  change.stops = rests ? V{} : change.stops;
  change.further = strikes ? V{} : change.further;
  change.closing = closes ? all<V>(1.0f) : strikes ? V{} : change.closing;
  auto changes = size(V(asked_m - smoothed_m)) > kOtherPace * own_m;
  if (any(is_level)) {  // on slopes and stairs the ground itself makes steps shorter and slower
    const auto paces = has_other_pace(tables, no(right), own_m, state, change);
    changes = either(changes, both(is_level, paces));
  }
  const auto leads = both(no(rests), either(either(stops, changes), change.catch_ticks != V{}));
  // A walk that is yet to stop for a turn on the spot does not begin it with this step.
  const auto goes = both(strikes, both(no(stops), is_to_walk(tables, state, change)));
  for (int side : {0, 1})
    change.length_m[side] = goes ? state.asked.length_m[side] : change.length_m[side];
  change.was_led = rests ? V{} : strikes ? change.led : change.was_led;
  change.off_ticks = rests ? V{} : change.off_ticks;
  for (Off<V>* off : {&change.off_phase, &change.off_shown}) off->x = rests ? V{} : off->x;
  for (Off<V>* off : {&change.off_over, &change.off_ratio, &change.off_pitch, &change.off_edge})
    *off = chosen(strikes, {}, *off);
  const auto turned = both(strikes, change.turns != V{});
  if (any(turned))
    for (Off<V>& off : change.off_turned) off = chosen(turned, {}, off);
  change.led = strikes ? chosen<V>(leads, 1.0f, 0.0f) : change.led;
  const auto begins = both(strikes, either(change.led != V{}, change.was_led != V{}));
  go_on_from_here(tables, begins, state, change);
  change.is_new = begins ? all<V>(1.0f) : change.is_new;
  for (V* ends :
       {&change.starting, &change.turns, &change.resumes, &change.gap_begin, &change.gap_rad,
        &change.gap_twist_rad, &change.gap_roll_rad, &change.gap_loose_rad, &change.pitch_lasts,
        &change.led_from, &change.led_rate_rad})
    *ends = strikes ? V{} : *ends;
  change.gap_lasts = strikes ? all<V>(kLiftFade) : change.gap_lasts;
  change.led_until = strikes ? all<V>(kNever) : change.led_until;
  change.phase = begins ? phase : change.phase;
  change.phase_rate = begins ? rate : change.phase_rate;
}

// The pelvis in the step frame.
template <class V>
struct Pelvis {
  Vec<V> place_m;
  Turn<V> turn;
  Vec<V> hip_m[2];  // hip joints relative to `place_m`; swing and stand
};

// On a slope the trunk leans about the middle of the hip joints, and the hips follow the ground.
template <class V>
void lean_pelvis(const Tables& tables, const Turn<V>& upright, const Turn<V>& turned,
                 const Footing<V>& footing, Pelvis<V>& pelvis) noexcept {
  const auto &l = tables.leg[0].hip_m, &r = tables.leg[1].hip_m;
  const Vec<V> middle_m{all<V>(0.5f * (l[0] + r[0])), all<V>(0.5f * (l[1] + r[1])),
                        all<V>(0.5f * (l[2] + r[2]))};
  const Turn<V> leans =
      upright * (turn_about(Vec<V>{all<V>(1.0f), V{}, V{}}, footing.lean_rad.x) * turned);
  pelvis.place_m = pelvis.place_m + pelvis.turn * middle_m - leans * middle_m;
  pelvis.place_m.y = pelvis.place_m.y + footing.hips_m.x;
  pelvis.turn = leans;
}

// Rotation of the pelvis in the upright body.
template <class V>
[[gnu::always_inline]] inline Turn<V> tilted(const Tables& tables, const Stride<V>& stride,
                                             const State<V>& state) noexcept {
  Vec<V> tilt = stride.pelvis_tilt_rad;
  tilt.z = tilt.z + tables.stand_roll_rad;
  V sine, cosine;
  sin_cos_small(V(0.5f * state.sway.x * stride.pelvis_yaw_rad), sine, cosine);
  return Turn<V>{cosine, V{}, sine, V{}} * turn_by(tilt);
}

template <class V, class F>
Pelvis<V> pelvis_over(const Tables& tables, const Time<V>& time, const Hips<V>& hips,
                      const Stride<V>& stride, const State<V>& state, const F& footing) noexcept {
  // More bounce scales about the highest place, less about the lowest, so that no leg gets longer.
  const V more = state.bounce.x - 1.0f, y = stride.pelvis_m.y,
          stays = more > V{} ? stride.pelvis_high_m : stride.pelvis_low_m;
  const V height_m = tables.stand_m + y + more * (y - stays);
  // In a turn the body leans as a whole, about the ground below the hips.
  V half_sine, half_cosine;
  sin_cos_small(V(0.5f * state.lean_rad.x), half_sine, half_cosine);
  const V left_m = height_m * 2.0f * half_sine * half_cosine;
  Pelvis<V> pelvis;
  pelvis.place_m = {hips.x_m + hips.heading.cosine * left_m,
                    height_m * (1.0f - 2.0f * half_sine * half_sine),
                    hips.z_m - hips.heading.sine * left_m};
  const Turn<V> lean{half_cosine, V{}, V{}, -half_sine};
  const Turn<V> upright = hips.heading.turn() * lean, turned = tilted(tables, stride, state);
  pelvis.turn = upright * turned;
  if constexpr (kIsUneven<F>) lean_pelvis(tables, upright, turned, footing, pelvis);
  pelvis.hip_m[0] = pelvis.turn * by_side<V>(time.right, tables.leg[0].hip_m, tables.leg[1].hip_m);
  pelvis.hip_m[1] =
      pelvis.turn * by_side<V>(no(time.right), tables.leg[0].hip_m, tables.leg[1].hip_m);
  return pelvis;
}

template <class V>
V leg_m(const Tables& tables, const Mask<V>& right) noexcept {
  return of_leg<V>(tables, right, &LegBones::thigh_m) +
         of_leg<V>(tables, right, &LegBones::shank_m);
}
// The distance from hip to ankle of a leg whose knee is bent by `knee_rad`.
template <class V>
V span_of_knee_m(const V& thigh_m, const V& shank_m, const V& knee_rad) noexcept {
  V sine, cosine;
  sin_cos(knee_rad, sine, cosine);
  return root(V(thigh_m * thigh_m + shank_m * shank_m + 2.0f * thigh_m * shank_m * cosine));
}
// The same in the tables, where the knee is bent by `knee_rad` more than when standing.
template <class V>
V span_in_tables_m(const Tables& tables, const Mask<V>& right, const V& knee_rad) noexcept {
  return span_of_knee_m(of_leg<V>(tables, right, &LegBones::thigh_m),
                        of_leg<V>(tables, right, &LegBones::shank_m),
                        V(knee_rad + stand_rad<V>(tables, right, 3)));
}
// Of a leg's way, how far the ankle is below the hip at least.
inline constexpr float kLeastBelow = 0.3f;

// Reach of a foot whose heel a style keeps low, over the leg's length.
inline constexpr float kLowReach = 0.985f;

// Ticks between two knots of Change::sink_m, and from its beginning to its end.
inline int sink_knot_ticks(const Tables& tables) noexcept {
  constexpr float kSinkKnot_s = 0.06f;  // at the reference leg
  return std::max(1, static_cast<int>(kSinkKnot_s * tables.time_scale / tables.tick_s + 0.5f));
}
inline int all_sink_ticks(const Tables& tables) noexcept {
  return (kSinkKnots - 3) * sink_knot_ticks(tables);
}
// The ticks of a planned sinking that are left: not more than there can be, should the caller have
// changed the length of the tick since.
inline int sink_ticks_left(const Tables& tables, float ticks) noexcept {
  return std::min(static_cast<int>(ticks), all_sink_ticks(tables));
}
// The planned sinking `at` ticks after the plan's beginning, in metres; `w`: the walk's lane.
template <class V>
float planned_sink(const Tables& tables, const V (&sink_m)[kSinkKnots], int w, int at) noexcept {
  const int knot = sink_knot_ticks(tables), i = std::min(at / knot, kSinkKnots - 4);
  const Knots<float> knots =
      spline_knots(0.0f, static_cast<float>(at - i * knot) / static_cast<float>(knot));
  float sum_m = knots.weight[0] * lane(sink_m[i], w);
  for (int k : {1, 2, 3}) sum_m += knots.weight[k] * lane(sink_m[i + k], w);
  return sum_m;
}
// The same in this tick, and what is left of the plan before it.
template <class V>
V known_sink(const Tables& tables, const Change<V>& change) noexcept {
  V sink_m{};
  for (int w = 0; w < kLanes<V>; ++w) {
    const int left = sink_ticks_left(tables, lane(change.sink_ticks, w));
    if (left == 0) continue;
    set_lane(planned_sink(tables, change.sink_m, w, all_sink_ticks(tables) - left), w, sink_m);
  }
  return sink_m + change.off_sink.x;
}

// Lowers the pelvis where a leg would have to be longer than in the tables. `ankle_m`: swing and
// stand.
template <class V>
void sink(const Tables& tables, const Time<V>& time, const Stride<V>& stride,
          const Vec<V> (&ankle_m)[2], const State<V>& state, Change<V>& change,
          Pelvis<V>& pelvis) noexcept {
  // Reach of a leg over its length, with a knee bent by 4 degrees. The bound is rounded: by
  // kSoftReach_m, and by kWiderReach of what a turn or the ground asks beyond the tables, up to
  // kWidestReach_m of that. Below kKnown_m beyond the tables it hardly acts. At most kMostSunk_m.
  // Metres are at the reference leg.
  constexpr float kReach = 0.9994f, kSoftReach_m = 0.006f, kWiderReach = 0.6f,
                  kWidestReach_m = 0.06f, kKnown_m = 0.0015f, kMostSunk_m = 0.34f,
                  kSoftSunk_m = 0.12f;
  // From kLittle_m to kFar_m of excess the sinking comes over from the first order to its whole
  // length.
  constexpr float kLittle_m = 0.01f, kFar_m = 0.02f;
  constexpr float kSoftSink_m = 0.007f, kSoftSinkOnGround_m = 0.012f;  // of the planned sinking
  const float grown = tables.size;
  V squares{};
  for (int k : {0, 1}) {
    const auto right = is_right(time, k);
    const V stretched = leg_m<V>(tables, right),
            table = span_in_tables_m<V>(tables, right, stride.leg_rad[k][3]),
            low = low_lift<V>(right, state),
            known = low < all<V>(1.0f) ? mix(V(kLowReach * stretched), table, low) : table;
    const Vec<V> way = ankle_m[k] - (pelvis.place_m + pelvis.hip_m[k]);
    const V span = root(dot(way, way)), beyond = (span - known) * (1.0f / grown);
    const V soft = grown * (kSoftReach_m + kWiderReach * least(beyond, all<V>(kWidestReach_m)));
    const V times = beyond * (1.0f / kKnown_m), shows = times * times,
            excess = soft_positive(V(span - kReach * stretched), soft) * shows / (1.0f + shows),
            upright = most(V(kLeastBelow * span), V(-way.y)) / span, little = excess / upright;
    // As far down as the ankle's way gets shorter by the excess. A little way is in proportion.
    const V reach = span - excess, aside = span * span - way.y * way.y,
            below =
                root(most(V(reach * reach - aside), V(kLeastBelow * kLeastBelow * span * span))),
            far =
                tables.terrain != nullptr ? smooth(kLittle_m * grown, kFar_m * grown, excess) : V{},
            down = far > V{} ? mix(little, V(-way.y - below), far) : little;
    squares = squares + (beyond > V{} ? V(down * down) : V{});
  }
  const V down_m = root(squares);
  V sunk_m = soft_least(down_m, all<V>(kMostSunk_m * grown), all<V>(kSoftSunk_m * grown));
  change.wants_m = sunk_m;
  const auto ahead = change.sink_ticks != V{};
  if (any(ahead)) {
    // The planned sinking, or more if a leg needs more.
    const float soft_m = tables.terrain != nullptr ? kSoftSinkOnGround_m : kSoftSink_m;
    const V known_m = known_sink(tables, change),
            width_m = most(least(known_m, all<V>(soft_m * grown)), all<V>(1e-6f)),
            more_m = known_m + soft_positive(V(sunk_m - known_m), width_m);
    sunk_m = both(ahead, known_m > all<V>(1e-6f)) ? more_m : sunk_m;
    change.sink_ticks = ahead ? V(change.sink_ticks - 1.0f) : V{};
    fade(change.off_sink_ticks, change.off_sink);
    change.off_sink_ticks = most(V(change.off_sink_ticks - 1.0f), V{});
  }
  pelvis.place_m.y = pelvis.place_m.y - sunk_m;
}

}  // namespace
}  // namespace gaitpad
