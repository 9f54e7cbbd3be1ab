// From the plan of a tick to its pose, of one walk or of several side by side (walk_flow.h): the
// legs' angles by inverse kinematics (section 3.3.2), and the local rotations of all joints.
//
// Robust mode starts from the tables' angles, which know of stiff joints already. Six rows hold the
// whole foot; the knee's swivel, which they leave free, is pulled to the data's. Little is left to
// solve for, and the weights of equation (5) distribute it.
#pragma once
#include "animation/leg_ik.h"
#include "animation/walk_flow.h"

namespace gaitpad {
namespace {

// --- Legs ----------------------------------------------------------------------------------------

inline constexpr double kLeastKnee =
    1.0 * kDegree;  // knee at which the solver starts, so that it bends forward
inline constexpr double kMostDorsiflexion = -38.0 * kDegree, kSoftAnkle = 6.0 * kDegree,
                        kSoftFlying = 12.0 * kDegree;
// Angles of the ankle near its limit at which it is held increasingly, while the leg turns outwards
// instead; with one step it would do so in a jerk.
inline constexpr double kHeldDorsiflexion = -57.0 * kDegree, kSoftHeld = 4.0 * kDegree;
inline constexpr double kSoftToe = 15.0 * kDegree;
// Rate at which the correction of the data's angles decays.
inline constexpr double kLeak_per_s = 4.0;
inline constexpr double kSoftElbow = 0.1;
// Distance of the foot's third point from the end-effector.
inline constexpr double kSideLever_m = 0.1;

// The angle at which a leg's solver starts: the data's, plus the correction of a tick ago (`off`),
// which decays, plus most of its change in the tick before. The share of the change is the largest
// with which the swivel, which no row holds, still returns to the data's without oscillation: the
// double root of z^2 - (keep + ahead) z + ahead.
class StartAngle {
 public:
  explicit StartAngle(double dt_s) noexcept : keep_(1.0 - std::min(1.0, kLeak_per_s * dt_s)) {
    const double root = 1.0 - std::sqrt(1.0 - keep_);
    ahead_ = root * root;
  }
  template <class V>
  V operator()(const V& data, const V& off, const V& last_off) const noexcept {
    return data + keep_ * off + ahead_ * (off - last_off);
  }

 private:
  double keep_, ahead_;
};

template <class V>
void set_vector(const Vec<V>& from, Vec3Of<V>& to) noexcept {
  to = {from.x, from.y, from.z};
}

// The leg's bones, and the planned foot's own axes in the pelvis' frame.
template <class V>
void set_leg(const LegBuild& leg, const PoseOf<V>& foot, const PelvisOf<V>& pelvis,
             LegGoals<V>& goals) noexcept {
  const Quat<V> rotation = conjugate_of(pelvis.rotation) * foot.rotation;
  const Vec<V> side = rotation * all_of<V>(leg.side), along = rotation * all_of<V>(leg.line);
  set_vector<V>(side, goals.side);
  set_vector<V>(cross_of(along, side), goals.across);
  set_vector<V>(along, goals.along);
}

// The goals of the rows: the first point, a point `ahead_m` in front of it in the foot, and a point
// beside it. In the foot's own axes the differences of these points are constant.
template <class V>
void set_rows(const LegBuild& leg, const Vec<V>& first_m, const vec3& ahead_m,
              LegGoals<V>& goals) noexcept {
  Vec3Of<V> first;
  set_vector<V>(first_m, first);
  const V sideways = dot_of(goals.side, first), up = dot_of(goals.across, first);
  goals.goal_m = {sideways,
                  up,
                  dot_of(goals.along, first),
                  sideways + glm::dot(leg.side, ahead_m),
                  up + glm::dot(glm::cross(leg.line, leg.side), ahead_m),
                  up};
}

// The start of one leg's solve, which is close to its result.
template <class V>
void set_start(const Tick& tick, const PlanOf<V>& plan, Side side, StateOf<V>& state,
               std::array<V, kLegDofs>& angles_rad) noexcept {
  const StartAngle start(tick.dt_s);
  for (int j = 0; j < kLegDofs; ++j) {
    V data = tick.model.stand_rad[side][j] + plan.cell.leg_rad[side][j];
    if (j == kKneeX) data = max_of(data, all_of<V>(kLeastKnee));
    auto& legs = state.legs;
    const V off = legs.even_rad[side][j] - legs.data_rad[side][j];
    // Extrapolates the change that the weights made in the last tick.
    const V shift = legs.angles_rad[side][j] - legs.even_rad[side][j];
    legs.angles_rad[side][j] = shift + (shift - legs.last_shift_rad[side][j]);
    legs.last_shift_rad[side][j] = shift;
    angles_rad[j] = start(data, off, V(legs.last_off_rad[side][j]));
    legs.last_off_rad[side][j] = off;
    legs.data_rad[side][j] = data;
  }
}

// The goals of a leg with even weights.
template <class V, class Limited>
void set_limits(const LegBuild& leg, Limited& to) noexcept {
  to.thigh_m = all_of<V>(leg.model.thigh_m);
  to.shank_m = all_of<V>(leg.model.shank_m);
  for (int j = 0; j < kLegDofs; ++j) {
    to.min_rad[j] = all_of<V>(leg.chain.dof[j].min_rad);
    to.max_rad[j] = all_of<V>(leg.chain.dof[j].max_rad);
  }
  // Solves without the ankle's limit first, so that the knee does not twist.
  to.min_rad[kAnkleX] = all_of<V>(-kPi);
}
template <class V>
void set_planned_leg(const LegBuild& leg, const PoseOf<V>& foot, const PelvisOf<V>& pelvis,
                     PlannedLeg<V>& planned) noexcept {
  set_limits<V>(leg, planned);
  const Quat<V> to_pelvis = conjugate_of(pelvis.rotation), q = to_pelvis * foot.rotation;
  const V xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z, xy = q.x * q.y, xz = q.x * q.z,
          yz = q.y * q.z, wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
  planned.foot_x = {1.0 - 2.0 * (yy + zz), 2.0 * (xy + wz), 2.0 * (xz - wy)};
  planned.foot_y = {2.0 * (xy - wz), 1.0 - 2.0 * (xx + zz), 2.0 * (yz + wx)};
  planned.foot_z = {2.0 * (xz + wy), 2.0 * (yz - wx), 1.0 - 2.0 * (xx + yy)};
  Vec3Of<V> heel;
  set_vector<V>(to_pelvis * (foot.heel_m - pelvis.hip(leg)), heel);
  const vec3& in_foot = leg.model.heel_m;
  planned.ankle_m =
      heel - (in_foot.x * planned.foot_x + in_foot.y * planned.foot_y + in_foot.z * planned.foot_z);
}
template <class V>
void set_even_goals(const LegBuild& leg, const StateOf<V>& state, const PelvisOf<V>& pelvis,
                    Side side, LegGoals<V>& goals) noexcept {
  set_limits<V>(leg, goals);
  goals.weight.fill(all_of<V>(1.0));
  set_leg<V>(leg, state.foot[side].pose, pelvis, goals);
  set_vector<V>(all_of<V>(leg.model.heel_m), goals.point_m[0]);
  set_vector<V>(all_of<V>(leg.model.toe_m), goals.point_m[1]);
  set_vector<V>(all_of<V>(leg.model.heel_m + leg.side * kSideLever_m), goals.point_m[2]);
  const Vec<V> heel =
      conjugate_of(pelvis.rotation) * (state.foot[side].pose.heel_m - pelvis.hip(leg));
  set_rows<V>(leg, heel, leg.model.toe_m - leg.model.heel_m, goals);
}

// True for a leg whose ankle bends up too far, or whose foot was not reached: it is solved again,
// for one walk at a time (mended_leg).
template <class V>
MaskOf<V> needs_mending(const WalkModel& model, const MomentOf<V>& at, Side side,
                        const V& ankle_rad, const V& failed) noexcept {
  const MaskOf<V> flies = at.in_flight[side], missed = failed != V{};
  const MaskOf<V> bends = kMostDorsiflexion - ankle_rad > -value<V>(flies, kSoftFlying, kSoftAnkle);
  if (!any(bends)) return missed;
  const MaskOf<V> may_rise =
      not_of(flies) & not_of(at.in_roll[side]) & (heel_rise<V>(model, at, side) != V{});
  const MaskOf<V> held = kHeldDorsiflexion - ankle_rad > all_of<V>(-kSoftHeld);
  return missed | (bends & (flies | may_rise)) | held;
}

// --- The weights ---------------------------------------------------------------------------------
// Equation (5) from the stride's mean pose. The pose of even weights is solved first. A joint of
// weight w is pulled from it to its running mean by 1 - w, and a weighted step meets the sole's
// planted point again: the toe in support, the heel in roll and in late flight, a point that moves
// along the sole in between. The foot gives way where it may turn: its pitch with the heel's rise
// and in flight, its yaw and roll in flight. The walk itself sees even legs alone: weights change
// no footprint, and cannot drift.

inline constexpr double kMeanTime_s = 0.5;  // time constant of each of two filters in a row
inline constexpr double kLeastW = 0.09;     // least weight, for a locked joint
inline constexpr double kMostPull_rad = 18.0 * kDegree;
inline constexpr double kHeldPull = 0.3;  // share of the pull that acts while the foot may not turn
inline constexpr double kFootLever_m = 0.2;
// Shares of the flight. The planted point is the toe until kToeUntil and the heel from kOnHeel on;
// the foot turns back to its plan between kToLand and kLanded.
inline constexpr double kToeUntil = 0.15, kOnHeel = 0.6, kToLand = 0.4, kLanded = 0.95;
// Squared radians by which a foot gives way for each squared radian of a joint: sideways, in
// flight, in the roll.
inline constexpr double kGiveAside = 0.15, kGiveFlying = 0.5, kGiveRolling = 0.05;
// When a walk begins, a foot that stood flat becomes free with this time constant.
inline constexpr double kLoosening_s = 0.04;
// Room for the foot's pitch below which it hardly gives way.
inline constexpr double kTight_rad = 3.0 * kDegree;
inline constexpr double kFloorRoom_m = 0.0003;
inline constexpr double kStraightest = 1.0 * kDegree, kBentKnee = 0.65, kLeastSoft = 0.1 * kDegree;

// The leg's weights divided by the largest. True for legs whose weights differ.
template <class V>
MaskOf<V> set_relative_weights(const GaitFlow<V>& gait, Side side,
                               std::array<V, kLegDofs>& weight) noexcept {
  V largest = all_of<V>(1e-9), least = all_of<V>(1.0);
  for (const Damped<V>& w : gait.weight[side]) largest = max_of(largest, w.x);
  for (int j = 0; j < kLegDofs; ++j) {
    weight[j] = within(V(gait.weight[side][j].x / largest), 0.0, 1.0);
    least = min_of(least, weight[j]);
  }
  return least < all_of<V>(1.0 - kEvenSpread);
}

// The angles by which the foot may turn about the planted point before toe or heel is on its floor.
template <class V>
void set_room(const Tick& tick, const StateOf<V>& state, Side side, const V& flown,
              LegShares<V>& shares) noexcept {
  const LegBuild& leg = tick.model.leg[side];
  const auto& foot = state.foot[side];
  V heel_m = foot.pose.heel_m.y, toe_m = foot.pose.toe_m.y;
  if constexpr (kAlone<V>) {
    if (!tick.flat) {
      const vec3 under(foot.pose.heel_m.x, foot.base_m, foot.pose.heel_m.z);
      const vec3 floor_m = mix(foot.plane.place_m, under, smootherstep(flown / kLiftGround));
      heel_m = glm::dot(foot.pose.heel_m - floor_m, foot.plane.normal);
      toe_m = glm::dot(foot.pose.toe_m - floor_m, foot.plane.normal);
    }
  }
  const auto room = [](const V& over_m, const V& arm_m) {
    return V((max_of(over_m, V{}) + kFloorRoom_m) / (arm_m + kFloorRoom_m));
  };
  shares.room_down_rad = room(V(toe_m - leg.model.toe_rest_m), V(leg.foot_m * shares.on_heel));
  shares.room_up_rad = room(heel_m, V(leg.foot_m * (1.0 - shares.on_heel)));
}

// Prepares the weights: updates the running means and the foot's freedom to turn.
template <class V>
void advance_weighted_leg(const Tick& tick, const MomentOf<V>& at, Side side,
                          StateOf<V>& state) noexcept {
  auto& legs = state.legs;
  const double pull = tick.dt_s / (kMeanTime_s * tick.model.time_scale + tick.dt_s);
  for (int j = 0; j < kLegDofs; ++j) {
    V &lagging = legs.lagging_rad[side][j], &mean = legs.mean_rad[side][j];
    lagging += pull * (legs.even_rad[side][j] - lagging);
    mean += pull * (lagging - mean);
  }
  const auto may_turn =
      at.in_flight[side] | (not_of(at.in_roll[side]) & (heel_rise<V>(tick.model, at, side) != V{}));
  state.legs.loose[side].advance(value<V>(may_turn, 1.0, 0.0),
                                 Damping(kLoosening_s * tick.model.time_scale, tick.dt_s));
}

// The goals of one leg with uneven weights. `goals` contains the leg and the axes of the planned
// foot, and receives the weighted leg's goals. `angles_rad`: the start.
template <class V>
void set_shares(const Tick& tick, const MomentOf<V>& at, const PlanOf<V>& plan,
                const PelvisOf<V>& pelvis, Side side, const StateOf<V>& state, LegGoals<V>& goals,
                LegShares<V>& shares, std::array<V, kLegDofs>& angles_rad) noexcept {
  const LegBuild& leg = tick.model.leg[side];
  const auto& foot = state.foot[side].pose;
  const auto& legs = state.legs;
  const MaskOf<V> flies = at.in_flight[side], rolls = at.in_roll[side];
  const V one = all_of<V>(1.0), zero{}, u = flies ? at.flight_progress() : zero,
          rolled = at.rolls ? V(at.tick / at.stage_ticks) : zero, lifts = state.legs.loose[side].x,
          rise = lifts * heel_rise<V>(tick.model, at, side);
  const auto by_mode = [&](const V& flying, const V& rolling, const V& standing) {
    const V planted = rolls ? rolling : standing;
    return V(flies ? flying : planted);
  };
  const V lands = smootherstep(V((u - kToLand) / (kLanded - kToLand))),
          free = by_mode(V(lifts * (1.0 - lands)), zero, rise),
          pitches = by_mode(V(lifts * (1.0 - (1.0 - kGiveFlying) * smootherstep(V(u / kToLand)) -
                                       (kGiveFlying - kGiveRolling) * lands)),
                            V(kGiveRolling * (1.0 - smootherstep(V(rolled / 0.9)))), rise),
          aside =
              flies ? smootherstep(V(u / 0.35)) * (1.0 - smootherstep(V((u - 0.6) / 0.4))) : zero;
  shares.on_heel = by_mode(smootherstep(V((u - kToeUntil) / (kOnHeel - kToeUntil))), one, zero);
  const auto uneven = set_relative_weights<V>(state.gait, side, goals.weight);
  shares.uneven = value<V>(uneven, 1.0, 0.0);
  const V bent = kBentKnee * (legs.even_rad[side][kKneeX] - kStraightest);
  shares.knee_rad = kStraightest + bent;
  shares.knee_soft_rad = max_of(bent, all_of<V>(kLeastSoft));
  const V pull = plan.shown * (kHeldPull + (1.0 - kHeldPull) * free);
  for (int j = 0; j < kLegDofs; ++j) {
    const V even = legs.even_rad[side][j], w = goals.weight[j];
    V& reference = shares.reference_rad[j] = even;
    if (any(w != one)) {
      const V way = (1.0 - w) * (legs.mean_rad[side][j] - even), share = way / kMostPull_rad;
      reference += pull * way / sqrt_of(V(1.0 + share * share));
    }
    goals.weight[j] = kLeastW + (1.0 - kLeastW) * w;
    angles_rad[j] = even + legs.angles_rad[side][j];
  }
  set_room<V>(tick, state, side, u, shares);
  const double lever_m = kFootLever_m * tick.model.size, square = lever_m * lever_m;
  const V room = shares.room_down_rad * shares.room_down_rad;
  shares.lever_m = all_of<V>(lever_m);
  shares.give_m2 = {square * kGiveAside * aside,
                    square * plan.shown * pitches * (room / (room + kTight_rad * kTight_rad)),
                    square * kGiveAside * aside};
  const Vec<V> in_foot =
      all_of<V>(leg.model.toe_m) + all_of<V>(leg.model.heel_m - leg.model.toe_m) * shares.on_heel;
  set_vector<V>(in_foot, goals.point_m[0]);
  set_vector<V>(in_foot + all_of<V>(lever_m * leg.line), goals.point_m[1]);
  set_vector<V>(in_foot + all_of<V>(lever_m * leg.side), goals.point_m[2]);
  const Vec<V> planted_m = foot.toe_m + (foot.heel_m - foot.toe_m) * shares.on_heel;
  set_rows<V>(leg, conjugate_of(pelvis.rotation) * (planted_m - pelvis.hip(leg)),
              lever_m * leg.line, goals);
}

// Takes over the result of the weighted step; for legs with even weights the even pose.
template <class V>
void keep_shared(const LegBuild& leg, Side side, const LegGoals<V>& goals,
                 const LegShares<V>& shares, const std::array<V, kLegDofs>& angles_rad,
                 const LegSolution<V>& solution, const PelvisOf<V>& pelvis, LegFlow<V>& legs,
                 PosedLegOf<V>& posed) noexcept {
  const auto uneven = shares.uneven != V{};
  for (int j = 0; j < kLegDofs; ++j)
    legs.angles_rad[side][j] = uneven ? angles_rad[j] : legs.even_rad[side][j];
  const Vec3Of<V>& point = solution.heel_m;
  const Vec3Of<V> line = (solution.toe_m - point) / shares.lever_m;
  const auto along = [&](const V& way_m) {
    const Vec3Of<V> place = point + line * way_m;
    return pelvis.place(leg, Vec<V>{place.x, place.y, place.z});
  };
  posed.iterations += uneven ? solution.iterations : V{};
  posed.squares = uneven ? solution.squares : posed.squares;
  posed.heel_m = chosen(uneven, along(V(-leg.foot_m * (1.0 - shares.on_heel))), posed.heel_m);
  posed.toe_m = chosen(uneven, along(V(leg.foot_m * shares.on_heel)), posed.toe_m);
  // The arc sine as a series: a foot turns by less than 20 degrees.
  const V sine = -dot_of(goals.across, line), cube = sine * sine * sine;
  posed.pitch_rad += uneven ? sine + cube / 6.0 + 0.075 * cube * sine * sine : V{};
}

// The pitch of the toes. They stay level while the heel is the higher end, on the floor and in the
// air, so they never enter the ground. In the air the change is rounded, on the floor it is exact.
template <class V>
V level_toe(const V& pitch_rad, const V& flight_progress) noexcept {
  const V air =
      smoothstep(0.0, 0.2, flight_progress) * (1.0 - smoothstep(0.85, 1.0, flight_progress));
  return -soft_positive(pitch_rad, max_of(all_of<V>(1e-9), V(kSoftToe * air)));
}

// The posed leg of a foot that is at its planned place.
template <class V>
PosedLegOf<V> closed_leg(const PoseOf<V>& foot) noexcept {
  return {all_of<V>(1.0), V{}, V{}, foot.heel_m, foot.toe_m, foot.pitch_rad};
}
// The solver's result for a leg that the closed form did not reach.
template <class V>
void keep_solved(const LegBuild& leg, const MaskOf<V>& where, const LegSolution<V>& solution,
                 const PelvisOf<V>& pelvis, PosedLegOf<V>& posed) noexcept {
  const auto& heel = solution.heel_m;
  const auto& toe = solution.toe_m;
  const MaskOf<V> reached =
      solution.squares <= all_of<V>(kRobust.tolerance_m * kRobust.tolerance_m);
  posed.iterations = where ? solution.iterations : posed.iterations;
  posed.squares = where ? solution.squares : posed.squares;
  posed.failed = where ? value<V>(reached, 0.0, 1.0) : posed.failed;
  posed.heel_m = chosen(where, pelvis.place(leg, Vec<V>{heel.x, heel.y, heel.z}), posed.heel_m);
  posed.toe_m = chosen(where, pelvis.place(leg, Vec<V>{toe.x, toe.y, toe.z}), posed.toe_m);
}

// Stores the results of the legs in one tick: the toes, and the values that the tick reports.
template <class V>
void report_leg(const MomentOf<V>& at, Side side, const PosedLegOf<V>& posed, StateOf<V>& state,
                std::span<WalkFrame* const> frames) noexcept {
  state.foot[side].pose.toe_rad =
      level_toe<V>(posed.pitch_rad, at.in_flight[side] ? at.flight_progress() : V{});
  const Vec<V>&heel = posed.heel_m, &toe = posed.toe_m;
  const V error_m = sqrt_of(posed.squares);
  for (std::size_t lane = 0; lane < frames.size(); ++lane) {
    const auto of = [lane](const V& v) { return lane_of(v, static_cast<int>(lane)); };
    WalkFrame& frame = *frames[lane];
    frame.heel_m[side] = vec3(of(heel.x), of(heel.y), of(heel.z));
    frame.toe_m[side] = vec3(of(toe.x), of(toe.y), of(toe.z));
    frame.ik_iterations[side] = static_cast<int>(of(posed.iterations));
    frame.ik_error_m[side] = of(error_m);
    frame.ik_failed[side] = of(posed.failed) != 0.0;
  }
}

// --- The pose ------------------------------------------------------------------------------------

// Sines and cosines of half the angles of both legs.
template <class V>
struct HalfTurns {
  std::array<V, kLegDofs> sine, cosine;
};
template <class V>
std::array<HalfTurns<V>, 2> half_turns(const typename LegFlow<V>::Angles& angles_rad) noexcept {
  std::array<HalfTurns<V>, 2> half;
  for (int j = 0; j < kLegDofs; ++j) {
    using Both = Lanes<kAlone<V> ? kLeastLanes : 1>;
    if constexpr (kWidthOf<Both> == 2) {  // both legs are computed side by side
      Both sine, cosine;
      sin_cos_of(0.5 * Both{angles_rad[0][j], angles_rad[1][j]}, sine, cosine);
      for (int side : {0, 1}) half[side].sine[j] = sine[side], half[side].cosine[j] = cosine[side];
    } else {
      for (int side : {0, 1})
        sin_cos_of(V(0.5 * angles_rad[side][j]), half[side].sine[j], half[side].cosine[j]);
    }
  }
  return half;
}

// The rotation Rx(x) Rz(z) Ry(y) of three angles, beginning with x.
template <class V>
Quat<V> turn_xzy(const HalfTurns<V>& half, int x) noexcept {
  const V xs = half.sine[x], xc = half.cosine[x], zs = half.sine[x + 1], zc = half.cosine[x + 1],
          ys = half.sine[x + 2], yc = half.cosine[x + 2];
  const V w = xc * zc, i = xs * zc, j = -xs * zs, k = xc * zs;
  return Quat<V>(w * yc - j * ys, i * yc - k * ys, w * ys + j * yc, k * yc + i * ys);
}

// The output of the walks' poses: local rotations by joint.
template <int kWidth>
using Locals = std::array<quat*, kWidth>;

template <class V>
Quat<V> joint_of(const Locals<kWidthOf<V>>& local, int joint) noexcept {
  if constexpr (kAlone<V>) {
    return local[0][joint];
  } else {
    Quat<V> q;
    for (int lane = 0; lane < kWidthOf<V>; ++lane) {
      const quat& from = local[lane][joint];
      q.w[lane] = from.w, q.x[lane] = from.x, q.y[lane] = from.y, q.z[lane] = from.z;
    }
    return q;
  }
}
template <class V>
void set_joint(const Quat<V>& q, int joint, const Locals<kWidthOf<V>>& local) noexcept {
  if constexpr (kAlone<V>) {
    local[0][joint] = q;
  } else {
    Locals<kWidthOf<V>> to;
    for (int lane = 0; lane < kWidthOf<V>; ++lane) to[lane] = local[lane] + joint;
    store_quats(q, to);
  }
}

template <class V>
void write_legs(const WalkModel& model, const StateOf<V>& state,
                const Locals<kWidthOf<V>>& local) noexcept {
  const std::array<HalfTurns<V>, 2> half = half_turns<V>(state.legs.angles_rad);
  for (const Side side : {kLeftSide, kRightSide}) {
    const LegBuild& leg = model.leg[side];
    const HalfTurns<V>& q = half[side];
    const auto& foot = state.foot[side].pose;
    const std::array<Quat<V>, 4> turn = {
        turn_xzy(q, kHipX), Quat<V>(q.cosine[kKneeX], q.sine[kKneeX], V{}, V{}),
        turn_xzy(q, kAnkleX), toes_turn<V>(leg, foot, foot.toe_rad)};
    for (int i = 0; i < 4; ++i) {
      const LegJointFrame& frame = leg.joint[i];
      if (frame.joint >= 0)
        set_joint<V>(all_of<V>(frame.before) * turn[i] * all_of<V>(frame.after), frame.joint,
                     local);
    }
  }
}

// The phase at which the data are read. Walking backwards is walking forwards run back
// (Thorstensson 1986), so a foot lands where the data lift it.
template <class V>
V data_phase(const WalkModel& model, const MomentOf<V>& at) noexcept {
  return at.backward ? model.share[0] + model.share[1] + model.share[2] - at.phase : at.phase;
}

// Converts rows of w, x, y and z to the rotations of the table's joints.
template <class V>
void write_quats(const double* blend, const PoseRows& rows, quat* to) noexcept {
  constexpr std::size_t kTogether = kAlone<V> ? kLeastLanes : kWidthOf<V>;
  const std::size_t count = rows.joint.size(), stride = rows.stride;
  std::size_t i = 0;
  for (; i + kTogether <= count; i += kTogether) {
    using Q = Lanes<static_cast<int>(kTogether)>;
    QuatOf<Q> q;
    std::memcpy(&q.w, blend + i, sizeof q.w);
    std::memcpy(&q.x, blend + stride + i, sizeof q.x);
    std::memcpy(&q.y, blend + 2 * stride + i, sizeof q.y);
    std::memcpy(&q.z, blend + 3 * stride + i, sizeof q.z);
    std::array<quat*, kTogether> joints;
    for (std::size_t k = 0; k < kTogether; ++k) joints[k] = to + rows.joint[i + k];
    store_quats(q, joints);
  }
  for (; i < count; ++i) {
    const double* q = blend + i;
    to[rows.joint[i]] = quat(q[0], q[stride], q[2 * stride], q[3 * stride]);
  }
}

// The data's rotations of the joints that the legs do not set, fading to the stand, with arms that
// swing as far as the pace asks.
template <class V>
void write_data(const WalkModel& model, const MomentOf<V>& at, const GaitFlow<V>& gait,
                const Locals<kWidthOf<V>>& local) noexcept {
  constexpr int kLanes = kWidthOf<V>;
  const PoseRows& rows = model.above;
  const std::size_t stride = rows.stride;
  const V phase = data_phase<V>(model, at), shown = presence_of<V>(gait);
  // Rotations of shoulder and elbow of both arms, from the data.
  std::array<Quat<V>, 4> arms;
  std::array<int, 4> column;
  for (int k = 0; k < 4; ++k) {
    const ArmBuild& arm = model.body.arm[k / 2];
    column[k] = !arm.is_there ? -1 : k % 2 == 0 ? arm.shoulder_column : arm.elbow_column;
  }
  alignas(64) std::array<double, 4 * (kMaxJoints + 8)> blend;
  for (int lane = 0; lane < kLanes; ++lane) {
    const Stencil s = stencil_at(lane_of(phase, lane));
    BlendedRows blended{{},           {},         rows.standing.data(), lane_of(shown, lane),
                        blend.data(), rows.stride};
    for (int k = 0; k < 4; ++k) {
      blended.sample[k] = rows.value.data() + static_cast<std::size_t>(s.index[k]) * 4 * stride;
      blended.weight[k] = s.weight[k];
    }
    if constexpr (kLanes == 1) {
      blend_rows(blended);
    } else {
      blend_rows<kLanes>(blended);
    }
    for (int k = 0; k < 4; ++k) {
      if (column[k] < 0) continue;
      const double* q = blend.data() + column[k];
      if constexpr (kAlone<V>) {
        arms[k] = quat(q[0], q[stride], q[2 * stride], q[3 * stride]);
      } else {
        arms[k].w[lane] = q[0], arms[k].x[lane] = q[stride];
        arms[k].y[lane] = q[2 * stride], arms[k].z[lane] = q[3 * stride];
      }
    }
    if (blended.shown < 1.0) {
      if constexpr (kLanes == 1) {
        fade_rows(blended);
      } else {
        fade_rows<kLanes>(blended);
      }
    }
    quat* to = local[lane];
    write_quats<V>(blend.data(), rows, to);
    for (const int j : rows.still) to[j] = kIdentity;
    for (const int j : model.kept) to[j] = model.cycle.standing_local[j];
  }
  for (int k = 0; k < 4; ++k) {
    const ArmBuild& arm = model.body.arm[k / 2];
    const V swing = gait.arm_swing[k / 2];
    const auto swings = swing != all_of<V>(1.0);
    if (column[k] < 0 || !any(swings)) continue;
    const int joint = k % 2 == 0 ? arm.joints.shoulder : arm.joints.elbow;
    const quat& middle = k % 2 == 0 ? arm.swing_shoulder : arm.swing_elbow;
    const V share = k % 2 == 0 ? swing : soft_min(swing, arm.most_elbow_swing, kSoftElbow);
    Quat<V> q = chosen(swings, nlerp_of<V>(all_of<V>(middle), arms[k], share), arms[k]);
    const auto fades = shown < all_of<V>(1.0);
    if (any(fades)) {
      const Quat<V> stand = all_of<V>(model.cycle.standing_local[joint]);
      q = chosen(fades, nlerp_of<V>(stand, q, shown), q);
    }
    set_joint<V>(q, joint, local);
  }
}

// Writes all joints; a style's changes of the upper body follow later.
template <class V>
void write_pose(const WalkModel& model, const MomentOf<V>& at, const StateOf<V>& state,
                const PelvisOf<V>& pelvis, const Locals<kWidthOf<V>>& local) noexcept {
  const GaitCycle& cycle = model.cycle;
  write_data<V>(model, at, state.gait, local);
  // Joints between root and pelvis turn with the heading and else move as in the data.
  set_joint<V>(pelvis.heading * joint_of<V>(local, 0), 0, local);
  Quat<V> above = all_of<V>(kIdentity);
  for (int j = cycle.skeleton.joints[cycle.pelvis].parent; j >= 0;
       j = cycle.skeleton.joints[j].parent) {
    above = joint_of<V>(local, j) * above;
  }
  set_joint<V>(conjugate_of(above) * (pelvis.rotation * all_of<V>(cycle.pelvis_standing)),
               cycle.pelvis, local);
  write_legs<V>(model, state, local);
}

}  // namespace
}  // namespace gaitpad
