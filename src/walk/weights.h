// Fifth, for styles whose joints have different weights: equation (5) around the stride's mean
// pose. The legs are solved with even weights first. A joint of weight w is then pulled by 1 - w
// from that pose to its running mean, and weighted steps bring the sole's planted point back: the
// toe in support, the heel in roll and in late flight, a point that moves along the sole in
// between. The foot gives way where it may turn: its pitch with the heel's rise and in flight, its
// yaw and roll in flight. The walk itself reads the even legs alone, so weights change no footprint
// and cannot drift.
#pragma once
#include <cstddef>

#include "animation/robust_solver.h"
#include "walk/leg_solve.h"
#include "walk/reach.h"

namespace gaitpad {
namespace {

inline constexpr float kEvenWeights = 1e-6f;  // weights that differ by less are even
inline constexpr float kStill_per_s = 1e-4f;  // a smoothed number that changes slower has settled
inline constexpr float kFootLever_m = 0.2f;   // makes lengths of the foot's angles, for their rows

// A leg whose movement its joints share by weight: input, then the result. All of its members are
// numbers V, of legs side by side.
template <class V>
struct LegToShare {
  V thigh_m{}, shank_m{};                               // 0: there is no leg in this lane
  V weight[kLegAngles]{}, reference_rad[kLegAngles]{};  // W, and the pose that it pulls to
  V give_aside{}, give_pitch{};                         // how far the foot gives way, rad^2
  V room_down_rad{}, room_up_rad{};                     // how far it may pitch away from its plan
  V knee_rad{};                // a knee that is straighter than this is bent
  Vec<V> point_m, goal_m;      // the planted point, in the foot from the ankle; its goal
  Vec<V> line, side;           // the foot's directions to the toe and to the left, in its own frame
  Turn<V> planned;             // the foot's turn by the plan, in the pelvis' frame
  V angles_rad[kLegAngles]{};  // in: the even pose and what the weights added last; out: the answer
  V more_pitch_rad{};          // the foot's pitch beyond its plan
};
inline constexpr int kShareTakes = offsetof(LegToShare<float>, more_pitch_rad) / sizeof(float),
                     kShareGives = offsetof(LegToShare<float>, angles_rad) / sizeof(float);

// One leg in one pose, seen from its hip joint in the pelvis' frame.
template <class V>
struct LegPlace {
  Vec<V> axis[kLegAngles], knee_m, ankle_m, point_m, line, side;
  Vec<V> goal_side, goal_across, goal_along;  // axes of the planned foot; directions of the rows
  V error[6];
};

template <class V>
void place_leg(const LegToShare<V>& leg, float lever_m, LegPlace<V>& place) noexcept {
  V s[kLegAngles], c[kLegAngles];
  for (int j = 0; j < kLegAngles; ++j) {
    V hs, hc;
    sin_cos_small(V(0.5f * leg.angles_rad[j]), hs, hc);
    s[j] = 2.0f * hs * hc;
    c[j] = 1.0f - 2.0f * hs * hs;
  }
  Axes<V> f = axes_xz(s, c);
  place.axis[0] = {all<V>(1.0f), V{}, V{}};
  place.axis[1] = f.z;
  place.axis[2] = f.y;
  turn_axes(f.z, f.x, s[2], c[2]);
  place.knee_m = f.y * -leg.thigh_m;
  place.axis[3] = f.x;
  turn_axes(f.y, f.z, s[3], c[3]);
  place.ankle_m = place.knee_m - f.y * leg.shank_m;
  place.axis[4] = f.x;
  turn_axes(f.y, f.z, s[4], c[4]);
  place.axis[5] = f.z;
  turn_axes(f.x, f.y, s[5], c[5]);
  place.axis[6] = f.y;
  turn_axes(f.z, f.x, s[6], c[6]);
  place.point_m = place.ankle_m + f * leg.point_m;
  place.line = f * leg.line, place.side = f * leg.side;
  const Vec<V> off_m = leg.goal_m - place.point_m;
  const Vec<V>&side = place.goal_side, &across = place.goal_across, &along = place.goal_along;
  place.error[0] = dot(side, off_m);
  place.error[1] = dot(across, off_m);
  place.error[2] = dot(along, off_m);
  place.error[3] = lever_m * (dot(leg.side, leg.line) - dot(side, place.line));
  place.error[4] = -lever_m * dot(across, place.line);
  place.error[5] = -lever_m * dot(across, place.side);
}

// The Jacobian of the rows, a column for each angle.
template <class V>
void set_columns(float lever_m, const LegPlace<V>& place, V (&column)[kLegAngles][6]) noexcept {
  const Vec<V>* const rows[3] = {&place.goal_side, &place.goal_across, &place.goal_along};
  const Vec<V> of_knee = place.point_m - place.knee_m, of_ankle = place.point_m - place.ankle_m;
  Vec<V> moment[3][3], turns[3];
  for (int r = 0; r < 3; ++r) {
    moment[0][r] = cross(place.point_m, *rows[r]);
    moment[1][r] = cross(of_knee, *rows[r]);
    moment[2][r] = cross(of_ankle, *rows[r]);
  }
  turns[0] = cross(place.line, place.goal_side) * lever_m;
  turns[1] = cross(place.line, place.goal_across) * lever_m;
  turns[2] = cross(place.side, place.goal_across) * lever_m;
  for (int j = 0; j < kLegAngles; ++j) {
    const int through = j < 3 ? 0 : j == 3 ? 1 : 2;
    for (int r = 0; r < 3; ++r) {
      column[j][r] = dot(place.axis[j], moment[through][r]);
      column[j][3 + r] = dot(place.axis[j], turns[r]);
    }
  }
}

// A step that meets the exact rows and reduces the sum of (angle - reference)^2 / W over the angles
// and of error^2 / give over the rows that give way.
template <class V>
void step_of(const LegToShare<V>& leg, float lever_m, const LegPlace<V>& place,
             V (&step_rad)[kLegAngles]) noexcept {
  // A step closes its exact rows and this share of the others: if it closes all of them, some walks
  // swing between two poses.
  constexpr float kShareStep = 0.5f;
  constexpr float kExactRow_m2 = 1e-10f;  // a pivot above the rounding of floats
  constexpr float kRoomUsed = 0.8f;       // of the room: the cost of a turn is linear beyond it
  // Bends a straight knee: its stiffness where that of a free joint is 1, and the least angle over
  // which it begins softly.
  constexpr float kKneeSpring = 100.0f, kLeastSoft_rad = 0.0017453293f;
  V column[kLegAngles][6], weight[kLegAngles], first_rad[kLegAngles], b[6], give[6];
  set_columns(lever_m, place, column);
  // The foot's pitch beyond its plan, down positive. The nearer it brings toe or heel to the floor,
  // the more it costs.
  const V down = place.error[4] * (1.0f / lever_m);
  const auto goes_down = down > V{};
  const V room = goes_down ? leg.room_down_rad : leg.room_up_rad, far = size(down),
          t = least(V(far / room), all<V>(kRoomUsed)), left = 1.0f / (1.0f - t),
          steep = left * left, bent = t * room * left + steep * (far - t * room);
  for (auto& of_angle : column) of_angle[4] = steep * of_angle[4];
  for (int r : {0, 1, 2}) {
    b[r] = place.error[r];
    give[r] = all<V>(kExactRow_m2);
  }
  const float lever2 = lever_m * lever_m;
  give[3] = give[5] = kExactRow_m2 + lever2 * leg.give_aside;
  give[4] = kExactRow_m2 + lever2 * leg.give_pitch;
  b[3] = kShareStep * place.error[3];
  b[4] = (kShareStep * lever_m) * (goes_down ? bent : V(-bent));
  b[5] = kShareStep * place.error[5];
  for (int j = 0; j < kLegAngles; ++j) {
    weight[j] = leg.weight[j];
    first_rad[j] = leg.reference_rad[j] - leg.angles_rad[j];
  }
  // A straight knee is bent by a spring, which leaves the knee of the even pose alone.
  const V knee = leg.angles_rad[3],
          soft = most(V(leg.knee_rad - kLeastKnee_rad), all<V>(kLeastSoft_rad)),
          bend = most(V(leg.knee_rad - knee), V{}), q = bend + soft,
          push = kKneeSpring * bend * bend / q,
          stiff = kKneeSpring * bend * (bend + 2.0f * soft) / (q * q),
          free = weight[3] / (1.0f + weight[3] * stiff);
  first_rad[3] = free * (leg.reference_rad[3] / weight[3] + push + stiff * knee) - knee;
  weight[3] = free;
  for (int j = 0; j < kLegAngles; ++j) {
    first_rad[j] = kShareStep * first_rad[j];
    for (int r = 0; r < 6; ++r) b[r] = b[r] - column[j][r] * first_rad[j];
  }
  solve_rows<6>(column, kLegAngles, weight, give, b);
  for (int j = 0; j < kLegAngles; ++j)
    step_rad[j] = first_rad[j] + weight[j] * product<6>(column[j], b);
}

template <class V>
void share_leg(float lever_m, LegToShare<V>& leg) noexcept {
  constexpr int kMostShareSteps = 8;                // of a solve
  constexpr float kSharedNear_rad = 8.7266463e-4f;  // a solve ends after a smaller step
  LegPlace<V> place;
  place.goal_side = leg.planned * leg.side;
  place.goal_along = leg.planned * leg.line;
  place.goal_across = cross(place.goal_along, place.goal_side);
  V step_rad[kLegAngles];
  auto open = leg.thigh_m != V{};
  for (int steps = 0; steps < kMostShareSteps && any(open); ++steps) {
    place_leg(leg, lever_m, place);
    step_of(leg, lever_m, place, step_rad);
    V greatest{};
    for (const V& turn : step_rad) greatest = most(greatest, size(turn));
    const Vec<V> pitches = cross(place.line, place.goal_across);
    V pitched = arc_sine(V(-dot(place.goal_across, place.line)));
    for (int j = 0; j < kLegAngles; ++j) {
      leg.angles_rad[j] = open ? V(leg.angles_rad[j] + step_rad[j]) : leg.angles_rad[j];
      pitched = pitched - step_rad[j] * dot(place.axis[j], pitches);
    }
    leg.more_pitch_rad = open ? pitched : leg.more_pitch_rad;
    open = both(open, greatest >= all<V>(kSharedNear_rad));
  }
}

// Starts the running means with their values in a steady walk of the present strides: the filters
// pass the mean of an angle, and damp its harmonics by 1 / (1 + i w T).
template <class V>
void begin_weights(const Tables& tables, const Mask<V>& begins, const Time<V>& time, const V& phase,
                   const V (&even_rad)[2][kLegAngles], const Change<V>& change,
                   const State<V>& state, Weighted<V>& weighted) noexcept {
  // Each harmonic at this phase, as cosine and sine, filtered once and twice.
  V once[kHarmonics][2], twice[kHarmonics][2];
  const V lag = state.phase_rate * (kTurn_rad * (1.0f / tables.mean_pull - 1.0f));
  for (int h = 0; h < kHarmonics; ++h) {
    const float n = static_cast<float>(h + 1);
    V sine, cosine;
    sin_cos(V((n * kTurn_rad) * phase), sine, cosine);
    const V wt = n * lag, q = 1.0f / (1.0f + wt * wt);
    once[h][0] = (cosine + wt * sine) * q, once[h][1] = (sine - wt * cosine) * q;
    twice[h][0] = (once[h][0] + wt * once[h][1]) * q;
    twice[h][1] = (once[h][1] - wt * once[h][0]) * q;
  }
  const V last = all<V>(kStrideRatios - 1.0f),
          y = least(most(V(state.ratio_behind * float(1.0 / kRatioStep)), V{}), last),
          first = least(floored(y), V(last - 1.0f)), share = y - first;
  for (int k : {0, 1}) {
    const auto right = is_right(time, k);
    const V side = chosen<V>(right, 1.0f, 0.0f);
    for (int j = 0; j < kLegAngles; ++j) {
      V of[1 + 2 * kHarmonics];
      for (int w = 0; w < kLanes<V>; ++w) {
        const int r = static_cast<int>(lane(first, w)), s = static_cast<int>(lane(side, w));
        const auto &a = tables.build.leg_harmonics[r][s][j],
                   &b = tables.build.leg_harmonics[r + 1][s][j];
        for (int n = 0; n < 1 + 2 * kHarmonics; ++n)
          set_lane(a[n] + (b[n] - a[n]) * lane(share, w), w, of[n]);
      }
      V lagging = of[0], mean = of[0];
      for (int h = 0; h < kHarmonics; ++h) {
        lagging = lagging + (of[1 + 2 * h] * once[h][0] + of[2 + 2 * h] * once[h][1]);
        mean = mean + (of[1 + 2 * h] * twice[h][0] + of[2 + 2 * h] * twice[h][1]);
      }
      const V stands = stand_rad<V>(tables, right, j);
      const auto rests = change.stands != V{};
      const auto begin = [&](const V& of_walk, V& number) {
        const V goal = rests ? even_rad[k][j] : V(stands + change.shown * of_walk);
        number = begins ? goal : number;
      };
      begin(lagging, weighted.lagging_rad[k][j]), begin(mean, weighted.mean_rad[k][j]);
      weighted.shift_rad[k][j] = begins ? V{} : weighted.shift_rad[k][j];
      weighted.last_shift_rad[k][j] = begins ? V{} : weighted.last_shift_rad[k][j];
    }
  }
}

// Brings numbers of a style in force nearer to those asked for, and without a style to `none_of`.
// `there`: where a number has settled. Returns the walks with a number that is not that of none.
template <class V, class NoneOf, class There>
Mask<V> follow_style(const Filter& filter, const Mask<V>& asked, const Mask<V>& acted,
                     const Mask<V>& where, int count, const V* goals, const NoneOf& none_of,
                     const There& there, Smoothed<V>* numbers) noexcept {
  auto acts = asked;
  for (int n = 0; n < count; ++n) {
    Smoothed<V>& in_force = numbers[n];
    const V none = none_of(n), goal = asked ? goals[n] : none;
    const auto settled = both(in_force.x == goal, in_force.v == V{}),
               moves = both(where, no(both(settled, either(acted, goal == none))));
    if (!any(moves)) continue;  // as for nearly every number in nearly every tick
    Smoothed<V> number{acted ? in_force.x : none, acted ? in_force.v : V{}};
    follow(goal, filter, number);
    const auto is_there = there(goal, number);
    const V x = is_there ? goal : number.x, v = is_there ? V{} : number.v;
    in_force = {moves ? x : in_force.x, moves ? v : in_force.v};
    acts = either(acts, both(moves, x != none));
  }
  return either(both(where, acts), both(no(where), acted));
}
template <class V>
Mask<V> smooth_weights(const Tables& tables, Weighted<V>& weighted) noexcept {
  const V one = all<V>(1.0f);
  const auto asked = weighted.asked != V{}, acted = weighted.acts != V{};
  const auto there = [&](const V& goal, const Smoothed<V>& weight) {
    const auto even = both(goal == one, size(V(weight.x - one)) < all<V>(kSettled));
    return either(even, both(size(V(weight.x - goal)) < all<V>(kEvenWeights),
                             size(weight.v) < all<V>(kStill_per_s)));
  };
  return follow_style(
      tables.weights, asked, acted, either(asked, acted), 2 * kLegAngles, &weighted.goal[0][0],
      [&](int) { return one; }, there, &weighted.weight[0][0]);
}

// How freely a leg follows its weights: its joints in general, and its foot by pitch and aside.
// `on_heel`: the planted point on the sole, 0 the toe and 1 the heel.
template <class V>
struct Freedom {
  V joints, pitch, aside, on_heel;
};
// `u`, `rolled`: shares of flight and roll that are over. `loose`: 0 after a flat stand, 1 later.
// `risen`: the share by which a standing foot may raise its heel.
template <class V>
Freedom<V> freedom_of(const Mask<V>& flies, const Mask<V>& rolls, const V& u, const V& rolled,
                      const V& loose, const V& risen) noexcept {
  constexpr float kToLand = 0.4f;  // share of the flight: from then on the foot turns to its plan
  // The foot's give, rad^2: the weight of its angle, where that of a free joint is 1.
  constexpr float kGiveAside = 0.15f, kGiveFlying = 0.5f, kGiveRolling = 0.05f;
  const V none{}, one = all<V>(1.0f), rise = loose * risen, lands = smoother(kToLand, 0.95f, u);
  const auto by_stage = [&](const V& flying, const V& rolling, const V& standing) {
    const V planted = rolls ? rolling : standing;
    return V(flies ? flying : planted);
  };
  const V aside = smoother(0.0f, 0.35f, u) * (1.0f - smoother(0.6f, 1.0f, u));
  return {by_stage(V(loose * (1.0f - lands)), none, rise),
          by_stage(V(loose * (1.0f - (1.0f - kGiveFlying) * smoother(0.0f, kToLand, u) -
                              (kGiveFlying - kGiveRolling) * lands)),
                   V(kGiveRolling * (1.0f - smoother(0.0f, kRollEnd, rolled))), rise),
          flies ? V(kGiveAside * aside) : none, by_stage(smoother(0.15f, 0.6f, u), one, none)};
}

template <class V>
void weigh_legs(const Tables& tables, const Time<V>& time, const Stride<V>& stride,
                const Feet<V>& feet, const Pelvis<V>& pelvis, const V& phase,
                const Change<V>& change, const State<V>& state, Weighted<V>& weighted,
                Leg<V> (&legs)[2]) noexcept {
  constexpr float kLeastW = 0.09f;  // the weight of a locked joint in the solve
  // The pull of one joint approaches this; the share kHeldPull of it acts while the foot may not
  // turn.
  constexpr float kMostPull_rad = 0.31415927f, kHeldPull = 0.3f;
  constexpr float kBentKnee = 0.65f;  // a knee straighter than this share of the even one is bent
  constexpr float kTight_rad = 0.05235988f;  // 3 degrees of room: half of it gives way
  constexpr float kFloorRoom_m = 0.0003f;    // keeps the room above 0
  constexpr float kMostShift_rad = 1.0f;     // what weights add is far below it, or no answer
  if (!any(either(weighted.asked != V{}, weighted.acts != V{}))) return;
  const V one = all<V>(1.0f), zero{};
  V even_rad[2][kLegAngles];
  for (int k : {0, 1}) {
    set_table_angles(tables, is_right(time, k), stride, k, even_rad[k]);
    for (int j = 0; j < kLegAngles; ++j) even_rad[k][j] = even_rad[k][j] + state.leg_rad[k][j];
  }
  const auto acted = weighted.acts != zero, acts = smooth_weights(tables, weighted),
             begins = both(acts, no(acted));
  if (any(begins)) begin_weights(tables, begins, time, phase, even_rad, change, state, weighted);
  weighted.acts = chosen<V>(acts, 1.0f, 0.0f);
  const auto keep = [&](const V& to, V& number) { number = acts ? to : number; };

  const Turn<V> to_pelvis = back(pelvis.turn);
  const Mask<V> none{};
  Mask<V> uneven[2];
  LegToShare<V> shared[2];
  for (int k : {0, 1}) {
    const auto right = is_right(time, k), flies = k == 0 ? time.flies : none,
               rolls = k == 1 ? no(time.flies) : none;
    const Foot<V>& foot = feet.foot[k];
    const Sole<V>& sole = feet.sole[k];
    LegToShare<V>& leg = shared[k];
    const V risen = heel_rise(tables, right, phase, k == 1 ? no(none) : none, change);
    const auto may_turn = either(flies, both(no(rolls), risen != zero));
    const V turns = chosen<V>(may_turn, 1.0f, 0.0f);
    Smoothed<V> loose{begins ? turns : weighted.loose[k].x, begins ? zero : weighted.loose[k].v};
    follow(turns, tables.loosens, loose);
    keep(loose.x, weighted.loose[k].x), keep(loose.v, weighted.loose[k].v);
    const Freedom<V> may = freedom_of<V>(flies, rolls, flies ? flight_share(time.u, change) : zero,
                                         V(state.tick / state.roll_ticks), loose.x, risen);
    V largest = all<V>(1e-9f), smallest = one, in_force[kLegAngles];
    for (int j = 0; j < kLegAngles; ++j) {
      in_force[j] = right ? weighted.weight[1][j].x : weighted.weight[0][j].x;
      largest = most(largest, in_force[j]);
    }
    const V bent = kBentKnee * (even_rad[k][3] - kLeastKnee_rad), over = 1.0f / largest;
    leg.knee_rad = kLeastKnee_rad + bent;
    const V pull = change.shown * (kHeldPull + (1.0f - kHeldPull) * may.joints);
    for (int j = 0; j < kLegAngles; ++j) {
      const V even = even_rad[k][j], w = least(V(in_force[j] * over), one),
              shift = weighted.shift_rad[k][j];
      smallest = least(smallest, w);
      const V lagging = mix(weighted.lagging_rad[k][j], even, all<V>(tables.mean_pull)),
              mean = mix(weighted.mean_rad[k][j], lagging, all<V>(tables.mean_pull));
      const V way = (1.0f - w) * (mean - even), share = way * (1.0f / kMostPull_rad);
      leg.reference_rad[j] = even + pull * way / root(V(1.0f + share * share));
      leg.weight[j] = kLeastW + (1.0f - kLeastW) * w;
      // The solve starts where the weights' last change of the even pose leads on evenly.
      leg.angles_rad[j] = even + shift + (shift - weighted.last_shift_rad[k][j]);
      keep(lagging, weighted.lagging_rad[k][j]), keep(mean, weighted.mean_rad[k][j]);
      keep(shift, weighted.last_shift_rad[k][j]);
    }
    // The angle by which the foot may turn about the planted point until toe or heel is on the
    // floor.
    const auto room = [](const V& over_m, const V& arm_m) {
      return V((most(over_m, V{}) + kFloorRoom_m) / (arm_m + kFloorRoom_m));
    };
    const V base_m = k == 0 ? feet.floor_m : zero;
    leg.room_down_rad =
        room(V(foot.toe_m.y - base_m - sole.toe_rest_m), V(sole.foot_m * may.on_heel));
    leg.room_up_rad = room(V(foot.heel_m.y - base_m), V(sole.foot_m * (1.0f - may.on_heel)));
    const V down2 = leg.room_down_rad * leg.room_down_rad;
    leg.give_aside = may.aside;
    leg.give_pitch = change.shown * may.pitch * (down2 / (down2 + kTight_rad * kTight_rad));
    leg.line = sole.line_m * V(1.0f / sole.foot_m);
    leg.side = sole.side;
    leg.point_m = sole.heel_m + sole.line_m * V(1.0f - may.on_heel);
    leg.planned = to_pelvis * foot.turn;
    const Vec<V> planted_m = foot.toe_m + (foot.heel_m - foot.toe_m) * may.on_heel;
    leg.goal_m = to_pelvis * (planted_m - pelvis.place_m - pelvis.hip_m[k]);
    leg.thigh_m = of_leg<V>(tables, right, &LegBones::thigh_m);
    leg.shank_m = of_leg<V>(tables, right, &LegBones::shank_m);
    const auto is_short = legs[k].short_m != zero;
    if (any(is_short)) {  // the goal comes as near as the even leg, stretched or folded, gets to it
      const Vec<V> ankle_m = to_pelvis * (feet.ankle_m[k] - pelvis.place_m - pelvis.hip_m[k]);
      const V way_m = most(root(dot(ankle_m, ankle_m)), all<V>(kFloorRoom_m)),
              off_m = way_m > leg.thigh_m ? legs[k].short_m : V(-legs[k].short_m);
      leg.goal_m = chosen(is_short, leg.goal_m - ankle_m * V(off_m / way_m), leg.goal_m);
    }
    uneven[k] = both(acts, smallest < all<V>(1.0f - kEvenWeights));
  }
  const float lever_m = kFootLever_m * tables.size;
  work_packed<kShareTakes, kShareGives>(uneven, shared,
                                        [lever_m](auto& legs) { share_leg(lever_m, legs); });
  for (int k : {0, 1}) {
    const LegToShare<V>& leg = shared[k];
    for (int j = 0; j < kLegAngles; ++j)
      uneven[k] =
          both(uneven[k], size(V(leg.angles_rad[j] - even_rad[k][j])) < all<V>(kMostShift_rad));
    pose_leg(uneven[k], leg_at(leg.angles_rad), legs[k]);
    legs[k].more_pitch_rad = uneven[k] ? leg.more_pitch_rad : zero;
    for (int j = 0; j < kLegAngles; ++j)
      keep(uneven[k] ? V(leg.angles_rad[j] - even_rad[k][j]) : zero, weighted.shift_rad[k][j]);
  }
}

// Exchanges what is kept of swing and stand at a strike.
template <class V>
void change_weighted_legs(const Mask<V>& strikes, Weighted<V>& weighted) noexcept {
  const auto changes = both(strikes, weighted.acts != V{});
  if (!any(changes)) return;
  for (auto* of :
       {&weighted.lagging_rad, &weighted.mean_rad, &weighted.shift_rad, &weighted.last_shift_rad})
    for (int j = 0; j < kLegAngles; ++j) exchange(changes, (*of)[0][j], (*of)[1][j]);
  exchange(changes, weighted.loose[0].x, weighted.loose[1].x);
  exchange(changes, weighted.loose[0].v, weighted.loose[1].v);
}

}  // namespace
}  // namespace gaitpad
