// Uneven ground, for walks side by side: how the planes below the feet move feet, hips and stride.
// ground_plan.h chooses landings, and plans how flights keep clear of risers, for one walk at a
// time.
#pragma once
#include "walk/hips.h"

namespace gaitpad {
namespace {

inline bool is_uneven(const Tables& tables) noexcept { return tables.terrain != nullptr; }

// The rise of a usual riser, 17 cm for an adult, and the highest one that a step can climb; in
// legs.
inline constexpr float kStairRise = 0.2f;
inline constexpr double kMostRise = 0.345;

// --- Planes --------------------------------------------------------------------------------------

// The length of a plane's normal whose upward part is 1.
template <class V>
V steepness(const Slope<V>& slope) noexcept {
  return root(V(1.0f + (slope.x * slope.x + slope.z * slope.z)));
}
// The upward part of the unit normal.
template <class V>
V upright(const Slope<V>& slope) noexcept {
  return 1.0f / steepness(slope);
}
// The turn from level ground to a plane.
template <class V>
Turn<V> tilt_of(const Slope<V>& slope) noexcept {
  return unit(Turn<V>{V(steepness(slope) + 1.0f), -slope.z, V{}, slope.x});
}
template <class V>
V rise_of(const Slope<V>& slope, const V& x_m, const V& z_m) noexcept {
  return slope.x * x_m + slope.z * z_m;
}
template <class V>
Slope<V> chosen(const Mask<V>& mask, const Slope<V>& a, const Slope<V>& b) noexcept {
  return {mask ? a.x : b.x, mask ? a.z : b.z};
}

// The cubic B-spline with these inner knots from 0 at u = 0 to `end` at u = 1, where it is level.
template <class V>
V spline_at(const V* knots, const V& end, const V& u) noexcept {
  constexpr int n = kRoomKnots + 1;
  const V x = within(u, 0.0f, 1.0f) * float(n);
  V sum{};
  for (int k = -1; k <= n + 1; ++k) {
    const V control = k < 0    ? knots[0]
                      : k == 0 ? V(-0.5f * knots[0])
                      : k < n  ? knots[k - 1]
                      : k == n ? V(1.5f * end - 0.5f * knots[n - 2])
                               : knots[n - 2];
    const V d = size(V(x - float(k))), left = 2.0f - d, near = 4.0f + d * d * (3.0f * d - 6.0f),
            far = left * left * left;
    const V weight = d < V{} + 1.0f ? near : far;
    sum = sum + (left > V{} ? V(control * weight) : V{});
  }
  return sum / 6.0f;
}

// --- The stride ----------------------------------------------------------------------------------

// Trunks lean by 5 to 6 degrees up a grade of 15 %, by 7 to 8 up stairs, and back by 2 downhill
// (Leroux, Fung and Barbeau 2002; Nadeau, McFadyen and Malouin 2003).
template <class V>
void lean_into_slope(const Tables& tables, const State<V>& state, const Change<V>& change,
                     Footing<V>& footing) noexcept {
  // Leans on the steepest grades, and the grade of half of them.
  constexpr float kUphillLean_rad = 0.14835299f, kDownhillLean_rad = 0.05235988f,
                  kHalfLeanGrade = 0.09f;
  constexpr float kShortestRun = 0.2f;  // in legs: shorter steps count as this long
  const V run_m = most(size(footing.step_m), all<V>(kShortestRun * tables.leg_m)),
          rise_m = state.backward != V{} ? -footing.landing_y_m : footing.landing_y_m,
          grade = change.stands != V{} ? V{} : V(rise_m / run_m),
          most_rad = chosen<V>(grade > V{}, kUphillLean_rad, kDownhillLean_rad);
  follow(V(most_rad * grade / (size(grade) + kHalfLeanGrade)), tables.slope_lean, footing.lean_rad);
}

template <class V>
void set_ratio_on_ground(const Change<V>& change, const State<V>& state, const Footing<V>& footing,
                         Landing<V>& landing) noexcept {
  landing.ratio = change.closing != V{}
                      ? V(state.ratio_behind + change.off_ratio.x)
                      : most(V(footing.step_ratio + footing.off_ratio.x + change.off_ratio.x), V{});
  landing.off_ratio = change.starting != V{} ? V(footing.off_ratio.x + change.off_ratio.x) : V{};
}

// The landing as it is planned, on level or on uneven ground.
template <class V, class F>
Landing<V> landing_over(const Tables& tables, const Time<V>& time, const Way<V>& to,
                        const Change<V>& change, const State<V>& state, const F& footing) noexcept {
  Landing<V> landing = planned_landing(tables, time, to, change, state);
  if constexpr (kIsUneven<F>) set_ratio_on_ground(change, state, footing, landing);
  return landing;
}
// Whether another step follows.
template <class V>
Mask<V> goes_on(const Tables& tables, const State<V>& state, const Change<V>& change) noexcept {
  return both(change.closing == V{},
              either(is_to_walk(tables, state, change), change.further != V{}));
}

// The ratio to the data's of a step on uneven ground that goes `step_m` ahead. A foot that lands
// behind the other one, as a turn may lead it, makes a step on the spot: the ratio has no kink.
template <class V>
V ratio_of_step(const Tables& tables, const Time<V>& time, const V& step_m) noexcept {
  constexpr float kSoft_m = 0.03f;  // at the reference leg
  return soft_positive(time.back ? V(-step_m) : step_m, all<V>(kSoft_m * tables.size)) /
         own_step_m<V>(tables, time.right, time.back);
}

// Updates the share of the step's length that the ground leaves, and the ratio for which the tables
// are read. A step that is planned to another tread has another ratio at once; the tables come to
// it until the flight begins.
template <class V>
void follow_ground(const Tables& tables, const Time<V>& time, const AskedStep<V>& asked,
                   Change<V>& change, const State<V>& state, Footing<V>& footing,
                   Landing<V>& landing) noexcept {
  // The share that the ground leaves is at least kLeastLeft. It is 1 for steps that are asked to be
  // shorter than kShortStep of the data's.
  constexpr float kShortStep = 0.1f, kLeastLeft = 0.3f;
  // A stick changes the ratio at most so fast; a faster change comes from the ground.
  constexpr float kRatioJump_1_s = 2.4f, kFirstRatioJump_1_s = 14.4f;
  const auto stands = change.stands != V{};
  footing.step_m = asked.to.ahead(landing.x_m, landing.z_m);
  const V wanted_m = size(asked.length_m), step_m = size(footing.step_m),
          least_m = all<V>(kShortStep * tables.source_step_m),
          left = wanted_m < least_m ? all<V>(1.0f)
                                    : within(V(step_m / most(wanted_m, least_m)), kLeastLeft, 1.0f);
  follow(left, tables.ground, footing.left);
  const V ratio = stands ? V{} : ratio_of_step(tables, time, footing.step_m),
          jump = ratio - footing.step_ratio,
          most_jump = tables.tick_s *
                      chosen<V>(change.starting != V{}, kFirstRatioJump_1_s, kRatioJump_1_s);
  footing.step_ratio = ratio;
  // A landing that has just changed may move at once; the ratio begins to follow it gently.
  const auto anew = both(time.flies, both(change.is_new != V{}, change.gap_begin != V{}));
  change.off_ratio.x = anew ? V(change.off_ratio.x - jump) : change.off_ratio.x;
  change.off_ratio.v = anew ? V(-jump) : change.off_ratio.v;
  const auto strikes = both(no(time.flies), state.tick == all<V>(1.0f));
  Off<V>& off = footing.off_ratio;
  off.x = off.x - (size(jump) > most_jump ? jump : V{});
  off = chosen(strikes, Off<V>{}, off);
  fade(time.flies ? all<V>(1.0f) : V(state.roll_ticks - state.tick + 1.0f), off);
  set_ratio_on_ground(change, state, footing, landing);
}

// The factor on a step's times for the next rise, in legs. On stairs both feet take equally long: a
// riser of kStairRise legs takes at least kStairStep_s, and kSlowerBack times as long backwards.
// Times of gentler rises grow with the rise.
template <class V>
V slowness_of(const Tables& tables, const Mask<V>& right, const State<V>& state,
              const Footing<V>& footing) noexcept {
  constexpr float kSlowerByRise = 1.2f, kStairStep_s = 0.84f, kSlowerBack = 2.05f;
  const V rise = least(footing.next_rise, all<V>(static_cast<float>(kMostRise))),
          times = smoothed_times(state), own_s = times * by_side<V>(right, state.asked.time_s),
          other_s = times * by_side<V>(no(right), state.asked.time_s),
          level_s = mix(own_s, most(own_s, other_s), smooth(0.0f, 0.15f, rise)),
          stair_s = rise * (kStairStep_s * tables.time_scale / kStairRise) *
                    chosen<V>(state.backward != V{}, kSlowerBack, 1.0f),
          slow_s = most(V(level_s * (1.0f + kSlowerByRise * rise)), stair_s);
  return rise == V{} ? all<V>(1.0f) : V(slow_s / own_s);
}

// The time of a flight to a tread that is `rise_m` higher or lower: in proportion to the rise, as
// on steady stairs.
template <class V>
V flight_to_tread_s(const Tables& tables, const V& rise_m) noexcept {
  constexpr float kFlight_s = 0.5f;  // over a usual riser, at the reference leg
  return size(rise_m) * (kFlight_s * tables.time_scale / (kStairRise * tables.leg_m));
}
// The least time of the running step's flight, by the rise between both feet or the rest of the
// flying foot's rise, whichever is greater. Never 0.
template <class V>
V least_flight_s(const Tables& tables, const Footing<V>& footing) noexcept {
  const V step_m = size(footing.landing_y_m),
          foot_m = size(V(footing.landing_y_m - footing.print_y_m));
  return flight_to_tread_s(tables, most(most(step_m, V(foot_m - step_m)), all<V>(1e-6f)));
}

// Lengthens the flight of a step that turns out, in its roll, to lead to another tread.
template <class V>
void take_time_to_tread(const Tables& tables, const Time<V>& time, Change<V>& change,
                        const Footing<V>& footing, State<V>& state) noexcept {
  const auto closes = change.closing != V{},
             walks = both(both(change.stands == V{}, change.starting == V{}),
                          either(closes, change.stops == V{})),
             may = both(no(time.flies), walks);
  const V least_ticks = floored(V(least_flight_s(tables, footing) * (1.0f / tables.tick_s))),
          more = within(V(least_ticks - state.flight_ticks), 0.0f, kLonger_ticks);
  state.flight_ticks = state.flight_ticks + (may ? more : V{});
  change.closing_ticks = change.closing_ticks + (both(may, closes) ? more : V{});
}

// --- The ground that the hips go over ------------------------------------------------------------

// Up, the knee that lands bent straightens until late single support; down, the standing knee
// holds, and yields from the middle of single support until the landed foot has taken the weight
// (McFadyen & Winter 1988). Hips sink from the share kSinkBegin of the flight to the share kSinkEnd
// of the next roll.
inline constexpr float kSinkBegin = 0.5f, kSinkEnd = 0.25f;
// The last step sinks to its landing, where both feet stand with straight knees, so it begins
// early, at this share.
inline constexpr float kSinkBeginClosing = 0.15f;
inline constexpr float kSinkBeginBack = 0.35f;  // share: people feel for the ground behind them

template <class V>
struct Sinking {
  V ticks, share;  // that it lasts; that is over
};
template <class V>
Sinking<V> sinking(const Change<V>& change, const State<V>& state, const Footing<V>& footing,
                   const V& tick) noexcept {
  const auto closes = change.closing != V{};
  const V begin = most(V(state.flight_ticks *
                         (closes ? all<V>(kSinkBeginClosing)
                                 : chosen<V>(state.backward != V{}, kSinkBeginBack, kSinkBegin))),
                       footing.sink_from),
          ticks = state.flight_ticks - begin + (closes ? V{} : V(kSinkEnd * state.roll_ticks));
  return {ticks, V(most(V(tick - begin), V{}) / ticks)};
}

// The ticks in which hips come to their place along a quintic without going farther beyond it than
// kBeyond_m.
template <class V>
V settles_within(const Tables& tables, const Off<V>& off) noexcept {
  constexpr float kBeyond_m = 0.03f, kLeast_s = 0.2f;  // at the reference leg
  const V far_m = size(off.x) + kBeyond_m * tables.size,
          by_rate = 2.0f * far_m / most(size(off.v), all<V>(1e-9f)),
          by_bend = root(V(4.0f * far_m / most(size(off.a), all<V>(1e-12f))));
  return floored(
      most(least(by_rate, by_bend), all<V>(kLeast_s * tables.time_scale / tables.tick_s)));
}

// Moves the ground that the hips go over: along a quintic to its height at the landed foot, and
// from there down to a lower next landing.
template <class V>
void move_hips_ground(const Tables& tables, const Time<V>& time, const Landing<V>& landing,
                      const Change<V>& change, const State<V>& state,
                      Footing<V>& footing) noexcept {
  // The knee of a foot that lands from a height gives way by up to kYield legs, and by half of that
  // at a fall of kHalfYield legs. Chosen so that the knee is bent by 20 to 35 degrees on house
  // stairs. The standing knee bends by kBentBefore of it, for a straight knee cannot yield
  // smoothly.
  constexpr float kYield = 0.0255f, kHalfYield = 0.01f, kBentBefore = 0.65f;
  constexpr float kRiseLasts = 0.9f;  // share of the step
  const auto stands = change.stands != V{}, closes = change.closing != V{},
             strikes = both(no(stands), both(no(time.flies), state.tick == all<V>(1.0f))),
             rests = both(closes, both(time.flies, footing.level_m != V{})),
             anew = either(both(time.flies, footing.is_new != V{}), rests),
             begins = either(strikes, anew);
  const V begun = state.tick + (time.flies ? state.roll_ticks : V{});
  // The height by which heel or toe of the next foot lands below that of the standing one.
  const float leg_m = tables.leg_m;
  const V toe_m = of_leg<V>(tables, time.right, &LegBones::foot_m),
          stood_m = footing.stand.z * of_leg<V>(tables, no(time.right), &LegBones::foot_m),
          lands_m = footing.landing_y_m + rise_of(footing.landing, V(landing.way.sine * toe_m),
                                                  V(landing.way.cosine * toe_m)),
          fall_m = most(V(-footing.landing_y_m), V(stood_m - lands_m));
  const auto falls = fall_m > V{};
  const V early_m =
      both(falls, no(closes)) ? V(kYield * leg_m * fall_m / (fall_m + kHalfYield * leg_m)) : V{};
  Off<V>&hips = footing.hips_m, &off = footing.off_m;
  const auto set = [&](const V& to, V& number) { number = begins ? to : number; };
  const V bent_m = kBentBefore * early_m,
          level_m = anew ? (closes ? V{} : V(-bent_m)) : V(-most(footing.yield_m, bent_m));
  const auto yields = both(footing.yield_m > bent_m, hips.x > level_m);
  const V step_ticks = state.roll_ticks + state.flight_ticks;
  const auto takes_all = either(either(closes, change.starting != V{}), time.back);
  const V settles = takes_all ? step_ticks : V(kRiseLasts * step_ticks),
          later = most(settles, V(begun + kSinkEnd * state.roll_ticks));
  set(floored(V(both(strikes, yields) ? V(kSinkEnd * state.roll_ticks)
                : anew                ? later
                                      : settles)),
      footing.settle_ticks);
  // A plan that has changed lets the hips sink from now on.
  set(anew ? state.tick : V{}, footing.sink_from);
  // Hips that still move settle early enough not to go far beyond their place.
  const Off<V> moves{V(hips.x - level_m), hips.v, hips.a};
  footing.settle_ticks =
      begins ? V(least(footing.settle_ticks, V(begun + settles_within(tables, moves))))
             : footing.settle_ticks;
  // A last step may have become shorter: the hips settle at its end.
  footing.settle_ticks = closes ? least(footing.settle_ticks, step_ticks) : footing.settle_ticks;
  set(level_m, footing.level_m);
  set(V(hips.x - level_m), off.x), set(hips.v, off.v), set(hips.a, off.a);
  set(V{}, footing.drop_m), set(V{}, footing.yield_m), set(V{}, footing.early_m);
  // Upwards, the rear leg of a first or last step or of a walk backward would be too short, for it
  // does not roll far over its toe: hips that rest wait for its flight.
  const auto still = both(off.x < V{}, both(off.v == V{}, off.a == V{})),
             waits = either(stands, both(no(time.flies), both(takes_all, still)));
  footing.settle_ticks = waits ? step_ticks : footing.settle_ticks;
  Off<V> faded = off;
  fade(V(footing.settle_ticks - begun + 1.0f), faded);
  const Sinking<V> now = sinking(change, state, footing, V(time.flies ? state.tick : V{})),
                   end = sinking(change, state, footing, state.flight_ticks);
  const auto plans = both(no(waits), now.share == V{});
  const V end_share = smoother(end.share),
          drop_m =
              falls ? V(most(V(footing.level_m - footing.landing_y_m + early_m), V{}) / end_share)
                    : V{};
  footing.early_m = plans ? early_m : footing.early_m;
  footing.drop_m = plans ? drop_m : footing.drop_m;
  footing.yield_m =
      plans ? (falls ? V(early_m + (1.0f - end_share) * drop_m) : V{}) : footing.yield_m;
  const V s = now.share, left = 1.0f - s, per_tick = s > V{} ? V(1.0f / now.ticks) : V{},
          down_m = footing.drop_m * per_tick;
  off = chosen(waits, off, faded);
  hips.x = waits ? hips.x : V(footing.level_m + off.x - footing.drop_m * smoother(s));
  hips.v = waits ? V{} : V(off.v - down_m * 30.0f * s * s * left * left);
  hips.a = waits ? V{} : V(off.a - down_m * per_tick * 60.0f * s * left * (1.0f - 2.0f * s));
}

// --- Feet that rise with the hips ----------------------------------------------------------------

inline constexpr float kFirstRise = 0.4f;   // share of the first flight after which this fully acts
inline constexpr float kStandRises = 0.2f;  // the same of other flights, for the standing foot
// The steepest pitch of a foot on its toe, as a sine, and the width over which it is approached.
inline constexpr float kMostUpright = 0.99f, kSoftUpright = 0.12f;

template <class V>
V toe_length_m(const Tables& tables, const Mask<V>& right) noexcept {
  const auto of = [](const LegBones& leg) {
    const auto& toe = leg.toe_m;
    return std::sqrt(toe[0] * toe[0] + toe[1] * toe[1] + toe[2] * toe[2]);
  };
  return chosen<V>(right, of(tables.leg[1]), of(tables.leg[0]));
}
// The ankle's height over the toe of a flat foot.
template <class V>
V ankle_height_m(const Tables& tables, const Mask<V>& right) noexcept {
  return chosen<V>(right, -tables.leg[1].toe_m[1], -tables.leg[0].toe_m[1]);
}

// The height by which a foot over ground at `base_m` has to rise with the hips. `knee_rad`: the
// knee's bend in the tables. A foot that flies down follows the hips softly: its rise begins with
// hips that are lower than its ground by twice `hover_m`.
template <class V>
V rise_with_hips(const Tables& tables, const Mask<V>& right, const V& knee_rad, const V& base_m,
                 const V& hover_m, const Footing<V>& footing) noexcept {
  // A leg stretches to the share kStretch of its length before its foot has to rise. The foot rises
  // by up to the share kMostOnToe of the ankle's rise from a flat to an upright foot.
  constexpr float kStretch = 0.998f, kSoftStretch_m = 0.02f, kMostOnToe = 0.5f, kSoftOnToe = 0.3f;
  const V known_m = span_in_tables_m<V>(tables, right, knee_rad),
          room_m = most(V(kStretch * leg_m<V>(tables, right) - known_m), V{}),
          higher_m = footing.hips_m.x - base_m, up_m = most(higher_m, V{}),
          soft_m = all<V>(kSoftStretch_m * tables.size),
          rise_m = soft_positive(V(higher_m + hover_m - room_m),
                                 V(hover_m + up_m * soft_m / (up_m + soft_m))),
          most_m = toe_length_m<V>(tables, right) - ankle_height_m<V>(tables, right);
  const V bounded_m = soft_least(rise_m, V(kMostOnToe * most_m), V(kSoftOnToe * most_m));
  return higher_m <= -2.0f * hover_m ? V{} : bounded_m;
}

// The height from which a flying foot's rise counts, over a line at `base_m`. A line that leads up
// over a riser is steep; a foot that stopped rising as fast would be thrown up.
template <class V>
V climbed_m(const Tables& tables, const Time<V>& time, const V& base_m,
            const Footing<V>& footing) noexcept {
  constexpr float kClimbs = 0.6f;  // share of the flight, for a usual riser or a lower one
  const V rise_m = footing.landing_y_m - footing.print_y_m;
  const auto climbs = both(time.flies, rise_m > V{});
  const V risers = most(V(rise_m * (1.0f / (kStairRise * tables.leg_m))), all<V>(1.0f)),
          share = time.u * root(risers),
          even_m = footing.print_y_m + rise_m * smoother(0.0f, kClimbs, share);
  return climbs ? least(base_m, even_m) : base_m;
}

// The same for the swinging foot.
template <class V>
V rise_in_flight(const Tables& tables, const Time<V>& time, const V& knee_rad, const V& base_m,
                 const Footing<V>& footing) noexcept {
  // A foot that does not land from a height comes to its ground from this share of the flight on.
  constexpr float kComesDown = 0.6f;
  const V hover_m = time.flies ? V(0.5f * footing.early_m * smooth(0.0f, 0.5f, time.u)) : V{},
          rise_m = rise_with_hips<V>(tables, time.right, knee_rad, base_m, hover_m, footing);
  return footing.early_m > V{} ? rise_m : V(rise_m * (1.0f - smoother(kComesDown, 1.0f, time.u)));
}

// The pitch of a foot on its toe that lifts the ankle by another `rise_m`.
template <class V>
V pitch_to_rise(const Tables& tables, const Mask<V>& right, const V& rise_m,
                const V& pitch_rad) noexcept {
  const V length_m = toe_length_m<V>(tables, right),
          flat_rad = arc_sine(V(ankle_height_m<V>(tables, right) / length_m));
  V sine, cosine;
  sin_cos(least(V(flat_rad + pitch_rad), all<V>(kRightAngle_rad)), sine, cosine);
  const V higher =
              soft_least(V(sine + rise_m / length_m), all<V>(kMostUpright), all<V>(kSoftUpright)),
          risen_rad = most(pitch_rad, V(arc_sine(higher) - flat_rad));
  return rise_m == V{} ? pitch_rad : risen_rad;
}

// --- Flights -------------------------------------------------------------------------------------

inline constexpr float kReplan_m = 0.002f;  // a landing that moves farther is planned for anew

// The plane to which the foot flies, mixed with the plane before a change of plan.
template <class V>
Slope<V> plane_in_flight(const Time<V>& time, const Change<V>& change,
                         const Footing<V>& footing) noexcept {
  const V left = edge_left(time.u, change);
  return {V(footing.landing.x + left * footing.gap_plane.x),
          V(footing.landing.z + left * footing.gap_plane.z)};
}

// The height of the ground line below a flying heel, and the factor on the foot's lift. The line
// climbs with the foot's way from footprint to landing. It stays level in a flight over a riser,
// for there the splines raise the foot.
template <class V>
V ground_line(const Tables& tables, const Landing<V>& landing, const Vec<V>& heel_m, const V& u,
              const State<V>& state, const Footing<V>& footing, V& lift) noexcept {
  // A shorter flight climbs by its time, a longer one by its place; at the reference leg.
  constexpr float kClimbsInPlace_m = 0.1f;
  // A foot that goes up by more than a usual riser is lifted less, down to this share: its way over
  // the riser is lift enough, and the knee folds only so far.
  constexpr float kLiftUp = 0.5f;
  const V way_x = landing.x_m - state.print_x_m, way_z = landing.z_m - state.print_z_m,
          gone_x = heel_m.x - state.print_x_m, gone_z = heel_m.z - state.print_z_m,
          in_place = all<V>(kClimbsInPlace_m * kClimbsInPlace_m * tables.size * tables.size),
          square = way_x * way_x + way_z * way_z,
          gone = (gone_x * way_x + gone_z * way_z + in_place * (1.0f - value_left(u))) /
                 (square + in_place),
          rise_m = footing.landing_y_m - footing.print_y_m;
  lift = mix(all<V>(1.0f), all<V>(kLiftUp),
             smooth(kStairRise, static_cast<float>(kMostRise), V(rise_m * (1.0f / tables.leg_m))));
  return footing.print_y_m + (footing.crosses != V{} ? V{} : V(rise_m * gone));
}

// The climb that the splines have to make: 0 in a flight that crosses no riser.
template <class V>
V climb_over_risers(const Footing<V>& footing) noexcept {
  return footing.crosses != V{} ? V(footing.landing_y_m - footing.lift_y_m) : V{};
}

// Brings the splines in force nearer to those planned.
template <class V>
void follow_room(const Tables& tables, Footing<V>& footing) noexcept {
  for (int k = 0; k < kRoomKnots; ++k) {
    follow(footing.raise_m[k], tables.room, footing.raise[k]);
    follow(footing.shift_m[k], tables.room, footing.shift[k]);
  }
}
// The move of a place that costs least and leads a metre along z of the walk's coordinates.
// `frame`: the step frame's direction.
inline constexpr float kMoveAhead = 0.25f;  // cost of a move ahead, where one aside costs 1
template <class V>
Vec<V> move_along_z(const Way<V>& frame) noexcept {
  const V aside = kMoveAhead * frame.sine,
          square = frame.cosine * frame.cosine + frame.sine * aside;
  return {-aside / square, V{}, frame.cosine / square};
}
// The way by which the splines in force move a flying heel: mostly along the standing foot, so that
// it comes no nearer to that.
template <class V>
Vec<V> room_at(const V& u, const State<V>& state, const Footing<V>& footing) noexcept {
  V raise[kRoomKnots], shift[kRoomKnots];
  for (int k = 0; k < kRoomKnots; ++k) raise[k] = footing.raise[k].x, shift[k] = footing.shift[k].x;
  const V away_m = spline_at(shift, V{}, u);
  const Vec<V> move = move_along_z(way_of_half(state.frame_sine, state.frame_cosine));
  return {move.x * away_m, spline_at(raise, climb_over_risers(footing), u), move.z * away_m};
}

// Moves the step frame at a strike to the landing, on which the foot then stands.
template <class V>
void change_footing(const Landing<V>& landing, const Mask<V>& strikes, const V& flat_toe_y_m,
                    Footing<V>& footing) noexcept {
  const auto set = [&](const V& to, V& number) { number = strikes ? to : number; };
  const auto seen = [&](const Slope<V>& slope) {
    const Vec<V> turned = back(landing.way) * Vec<V>{slope.x, V{}, slope.z};
    return Slope<V>{turned.x, turned.z};
  };
  const V y_m = footing.landing_y_m;
  footing.print = chosen(strikes, seen(footing.stand), footing.print);
  footing.stand = chosen(strikes, seen(footing.landing), footing.stand);
  footing.landing = chosen(strikes, footing.stand, footing.landing);
  set(V(-y_m), footing.print_y_m), set(V(flat_toe_y_m - y_m), footing.toe_y_m);
  set(V(footing.hips_m.x - y_m), footing.hips_m.x), set(V{}, footing.landing_y_m);
  set(V{}, footing.level_x_m), set(V{}, footing.level_z_m);
  set(V{}, footing.gap_plane.x), set(V{}, footing.gap_plane.z), set(V{}, footing.gap_rise_m);
  for (Gap<V>* gap : {&footing.gap_line_m, &footing.gap_room_m}) set(V{}, gap->x), set(V{}, gap->v);
  set(V{}, footing.gap_under_m);
}

}  // namespace
}  // namespace gaitpad
