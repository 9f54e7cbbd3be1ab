// The body of solve_legs(), for one width and one set of instructions at a time.
#pragma once
#include "animation/leg_ik.h"
#include "animation/robust_solver.h"

namespace gaitpad {

// For each row the index of its point in the goal.
inline constexpr std::array<int, 6> kPointOf = {0, 0, 0, 1, 1, 2};

namespace {

template <class V>
using LegValues = std::array<V, kLegDofs>;
template <class V>
using LegRows = std::array<V, 6>;

// The legs in one pose, and the distances of their rows from their goals.
template <class V>
struct LegPlace {
  std::array<Vec3Of<V>, kLegDofs> axis;  // axes in the pelvis' frame; the first is its x axis
  // Places of knee and ankle, from the hip joint, about which its rotations turn.
  Vec3Of<V> knee_m, ankle_m;
  std::array<Vec3Of<V>, 3> point_m;
  LegRows<V> dx;
  V squares;
};

template <class V>
inline void place_legs(const LegGoals<V>& goals, const LegValues<V>& angles_rad,
                       LegPlace<V>& place) noexcept {
  LegValues<V> s, c;
  for (int j = 0; j < kLegDofs; ++j) sin_cos_of(angles_rad[j], s[j], c[j]);
  const V zero{}, one = all_of<V>(1.0);
  Vec3Of<V> x{one, zero, zero}, y{zero, c[0], s[0]}, z{zero, -s[0], c[0]};
  place.axis[0] = x;
  place.axis[1] = z;
  // x is still the pelvis' own axis, so half of the products with it are 0.
  x = {c[1], s[1] * y.y, s[1] * y.z};
  y = {-s[1], c[1] * y.y, c[1] * y.z};
  place.axis[2] = y;
  turn(z, x, s[2], c[2]);
  place.knee_m = -goals.thigh_m * y;
  place.axis[3] = x;
  turn(y, z, s[3], c[3]);
  place.ankle_m = place.knee_m + -goals.shank_m * y;
  place.axis[4] = x;
  turn(y, z, s[4], c[4]);
  place.axis[5] = z;
  turn(x, y, s[5], c[5]);
  place.axis[6] = y;
  turn(z, x, s[6], c[6]);
  for (int p = 0; p < 3; ++p) {
    const Vec3Of<V>& in_foot = goals.point_m[p];
    place.point_m[p] = place.ankle_m + in_foot.x * x + in_foot.y * y + in_foot.z * z;
  }
  const std::array<const Vec3Of<V>*, 6> direction = {&goals.side, &goals.across, &goals.along,
                                                     &goals.side, &goals.across, &goals.across};
  place.squares = zero;
  for (int r = 0; r < 6; ++r) {
    place.dx[r] = goals.goal_m[r] - dot_of(*direction[r], place.point_m[kPointOf[r]]);
    place.squares += place.dx[r] * place.dx[r];
  }
}

// Columns of the Jacobian. The hip's axes go through the origin.
template <class V>
using LegColumns = std::array<LegRows<V>, kLegDofs>;
template <class V>
inline void set_columns(const LegGoals<V>& goals, const LegPlace<V>& place,
                        LegColumns<V>& column) noexcept {
  const std::array<const Vec3Of<V>*, 6> direction = {&goals.side, &goals.across, &goals.along,
                                                     &goals.side, &goals.across, &goals.across};
  std::array<Vec3Of<V>, 6> moment;
  for (int r = 0; r < 6; ++r) moment[r] = cross_of(place.point_m[kPointOf[r]], *direction[r]);
  for (int r = 0; r < 6; ++r) column[0][r] = moment[r].x;
  for (int j = 1; j < 3; ++j) {
    const Vec3Of<V>& a = place.axis[j];
    for (int r = 0; r < 6; ++r)
      column[j][r] = (a.x * moment[r].x + a.y * moment[r].y) + a.z * moment[r].z;
  }
  for (int j = 3; j < kLegDofs; ++j) {
    const Vec3Of<V>& a = place.axis[j];
    const Vec3Of<V> n = cross_of(j == 3 ? place.knee_m : place.ankle_m, a);
    for (int r = 0; r < 6; ++r) column[j][r] = jacobian_entry(a, n, *direction[r], moment[r]);
  }
}

// The squared error of the first point.
template <class V>
inline V first_rows(const LegRows<V>& dx) noexcept {
  return dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2];
}

// --- The closed form -----------------------------------------------------------------------------

// The angle with this sine and cosine, which may have a common factor, near another angle. Clears
// `is_near` in lanes in which it is not near.
template <class V>
inline V angle_near(const V& sine, const V& cosine, const V& old_rad, const V& old_sine,
                    const V& old_cosine, MaskOf<V>& is_near) noexcept {
  // Tangent of an angle; a solution farther from the start would not have the nearest swivel.
  constexpr double kNear = 0.035;
  const V across = sine * old_cosine - cosine * old_sine,
          along = cosine * old_cosine + sine * old_sine;
  is_near = is_near & (abs_of(across) < kNear * along);
  return old_rad + atan_kernel(V(across / along));
}

// The turns of three joint axes that together make a rotation vector: x, z and y of Rx Rz Ry. `x`
// and `y` are the axes before the last turn, `z` is the second one.
template <class V>
inline std::array<V, 3> turns_xzy(const Vec3Of<V>& vector, const Vec3Of<V>& x, const Vec3Of<V>& y,
                                  const Vec3Of<V>& z, const V& sine_z, const V& cosine_z) noexcept {
  const V first = dot_of(vector, x) / cosine_z;
  return {first, dot_of(vector, z), dot_of(vector, y) + sine_z * first};
}

// Brings a leg's foot to its planned place. The knee's bend follows from the distance to the ankle.
// The remaining poses differ by the knee's swivel about the line from hip to ankle; the one nearest
// to the start is taken: the least sum of squares of the angles' changes, as with the
// pseudoinverse, to first order. In the returned mask the angles are exact; in other lanes, where a
// leg is too short, at a limit or far from its start, they are unchanged.
template <class V>
inline MaskOf<V> close_lanes(const PlannedLeg<V>& planned, LegValues<V>& angles_rad) noexcept {
  LegValues<V> s, c;
  for (int j = 0; j < kLegDofs; ++j) sin_cos_of(angles_rad[j], s[j], c[j]);
  const V zero{}, one = all_of<V>(1.0), a = planned.thigh_m, b = planned.shank_m;
  // The hip's axes at the start: of its second turn, then all of them after that turn, then the
  // thigh's.
  const Vec3Of<V> hip_z{zero, -s[0], c[0]}, hip_x{c[1], s[1] * c[0], s[1] * s[0]},
      hip_y{-s[1], c[1] * c[0], c[1] * s[0]};
  Vec3Of<V> x = hip_x, z = hip_z;
  const Vec3Of<V>& y = hip_y;
  turn(z, x, s[2], c[2]);
  Vec3Of<V> shank_y = y, shank_z = z;
  turn(shank_y, shank_z, s[3], c[3]);
  Vec3Of<V> foot_x = x, foot_y = shank_y, ankle_z = shank_z;
  turn(foot_y, ankle_z, s[4], c[4]);
  turn(foot_x, foot_y, s[5], c[5]);
  const Vec3Of<V> ankle_x = foot_x;
  Vec3Of<V> foot_z = ankle_z;
  turn(foot_z, foot_x, s[6], c[6]);

  // The knee, then the smallest turn of the hip that brings the ankle to its place.
  const Vec3Of<V>& ankle = planned.ankle_m;
  const V square = dot_of(ankle, ankle), bends = (square - a * a - b * b) / (2.0 * a * b),
          bent = sqrt_of(max_of(V(1.0 - bends * bends), zero));
  MaskOf<V> good = bends * bends < one;
  LegValues<V> next;
  next[kKneeX] = angle_near(bent, bends, angles_rad[kKneeX], s[3], c[3], good);
  const Vec3Of<V> from = -(a + b * bends) * y - (b * bent) * z;
  Vec3Of<V> axis = cross_of(from, ankle);
  V w = square + dot_of(from, ankle);
  // Rotation vectors of hip and foot, and the part of the foot's rotation that the ankle has to
  // make.
  const Vec3Of<V> of_hip = axis * (2.0 / w),
                  of_foot =
                      0.5 * (cross_of(foot_x, planned.foot_x) + cross_of(foot_y, planned.foot_y) +
                             cross_of(foot_z, planned.foot_z)),
                  of_ankle = of_foot - of_hip - x * (next[kKneeX] - angles_rad[kKneeX]),
                  line = ankle * (1.0 / sqrt_of(square));
  const auto hip = turns_xzy(of_hip, hip_x, hip_y, hip_z, s[1], c[1]),
             turns = turns_xzy(of_ankle, ankle_x, foot_y, ankle_z, s[5], c[5]),
             hip_swivels = turns_xzy(line, hip_x, hip_y, hip_z, s[1], c[1]),
             ankle_swivels = turns_xzy(line, ankle_x, foot_y, ankle_z, s[5], c[5]);
  V along{}, squares{};
  for (int i = 0; i < 3; ++i) {
    along += ankle_swivels[i] * turns[i] - hip_swivels[i] * hip[i];
    squares += hip_swivels[i] * hip_swivels[i] + ankle_swivels[i] * ankle_swivels[i];
  }
  const Vec3Of<V> swivel = line * (0.5 * along / squares);
  const Vec3Of<V> vector = axis + swivel * w + cross_of(swivel, axis);
  w = w - dot_of(swivel, axis);
  const V norm = 1.0 / sqrt_of(V(w * w + dot_of(vector, vector)));
  const QuatOf<V> hip_turn{w * norm, vector.x * norm, vector.y * norm, vector.z * norm};

  // The angles of the pose that was found.
  const Vec3Of<V> thigh_x = hip_turn * x, thigh_y = hip_turn * y,
                  thigh_z = cross_of(thigh_x, thigh_y);
  next[kHipX] = angle_near(thigh_y.z, thigh_y.y, angles_rad[kHipX], s[0], c[0], good);
  next[kHipZ] = angle_near(V(-thigh_y.x), sqrt_of(V(thigh_y.y * thigh_y.y + thigh_y.z * thigh_y.z)),
                           angles_rad[kHipZ], s[1], c[1], good);
  next[kHipY] = angle_near(thigh_z.x, thigh_x.x, angles_rad[kHipY], s[2], c[2], good);
  shank_y = bends * thigh_y + bent * thigh_z;
  shank_z = bends * thigh_z - bent * thigh_y;
  const V up_x = dot_of(thigh_x, planned.foot_y), up_y = dot_of(shank_y, planned.foot_y),
          up_z = dot_of(shank_z, planned.foot_y);
  next[kAnkleX] = angle_near(up_z, up_y, angles_rad[kAnkleX], s[4], c[4], good);
  next[kAnkleZ] = angle_near(V(-up_x), sqrt_of(V(up_y * up_y + up_z * up_z)), angles_rad[kAnkleZ],
                             s[5], c[5], good);
  next[kAnkleY] = angle_near(dot_of(thigh_x, planned.foot_z), dot_of(thigh_x, planned.foot_x),
                             angles_rad[kAnkleY], s[6], c[6], good);
  for (int j = 0; j < kLegDofs; ++j)
    good = good & (next[j] >= planned.min_rad[j]) & (next[j] <= planned.max_rad[j]);
  for (int j = 0; j < kLegDofs; ++j) angles_rad[j] = good ? next[j] : angles_rad[j];
  return good;
}

// --- Equation (5) --------------------------------------------------------------------------------

// The share of the errors closed in one step; the exact rows are closed fully in every step. With a
// share of 1 some walks swing between two poses.
inline constexpr double kShareStep = 0.5;
inline constexpr double kMostShareStep_rad = 0.6;
inline constexpr double kSharedNear_rad = 0.05 * kDegree, kSharedNear_m = 0.001;
inline constexpr int kMostShareSteps = 8;
inline constexpr double kExactRow_m2 = 1e-13;
inline constexpr double kKneeSpring = 100.0;
// Share of the room of a foot's pitch up to which it gives way.
inline constexpr double kRoomUsed = 0.8;

// A step of legs whose weights differ. It reduces the sum of (angle - reference)^2 / W and of the
// squared errors of the rows that give way, each divided by its allowance, while the exact rows
// stay met.
template <class V, class Step>
inline void share_step(const LegShares<V>& shares, const MaskOf<V>& shared, const LegPlace<V>& at,
                       const LegValues<V>& angles_rad, LegColumns<V>& column, Step& step) noexcept {
  LegRows<V> b = at.dx;
  for (int r : {3, 4, 5}) {
    const int of = r == 3 ? 0 : 1;
    for (auto& c : column) c[r] = shared ? c[r] - c[of] : c[r];
    b[r] -= at.dx[of];
  }
  // The pitch, down positive. Near the floor, and near a toe's limit, a turn has a growing cost.
  const V lever = shares.lever_m, down = b[4] / lever;
  const V room = down > V{} ? shares.room_down_rad : shares.room_up_rad, size = abs_of(down),
          t = min_of(V(size / room), all_of<V>(kRoomUsed)), left = 1.0 / (1.0 - t),
          steep = left * left, bent = t * room * left + steep * (size - t * room);
  b[4] = lever * (down > V{} ? bent : -bent);
  for (auto& c : column) c[4] = shared ? steep * c[4] : c[4];
  LegValues<V> first, weight = step.weight;
  for (int j = 0; j < kLegDofs; ++j) first[j] = shares.reference_rad[j] - angles_rad[j];
  const V knee = angles_rad[kKneeX], bend = max_of(V(shares.knee_rad - knee), V{}),
          q = bend + shares.knee_soft_rad, push = kKneeSpring * bend * bend / q,
          stiff = kKneeSpring * bend * (bend + 2.0 * shares.knee_soft_rad) / (q * q),
          free = weight[kKneeX] / (1.0 + weight[kKneeX] * stiff);
  first[kKneeX] =
      free * (shares.reference_rad[kKneeX] / weight[kKneeX] + push + stiff * knee) - knee;
  step.weight[kKneeX] = shared ? free : weight[kKneeX];
  for (int r : {3, 4, 5}) b[r] = kShareStep * b[r];
  for (int j = 0; j < kLegDofs; ++j) {
    step.first_rad[j] = shared ? kShareStep * first[j] : V{};
    for (int r = 0; r < 6; ++r) b[r] -= column[j][r] * step.first_rad[j];
  }
  for (int r = 0; r < 6; ++r) {
    const V give = r < 3 ? all_of<V>(kExactRow_m2) : kExactRow_m2 + shares.give_m2[r - 3];
    step.give[r] = shared ? give : step.give[r];
    step.error[r] = shared ? b[r] : step.error[r];
  }
}

// Several legs in the form of the robust solver.
template <class Lane, bool kShares>
struct LegSystem {
  using V = Lane;
  static constexpr int kRows = 6, kDofs = kLegDofs, dofs = kLegDofs;
  static constexpr bool kWeighted = kShares;
  static constexpr double kMostStep_rad = kMostShareStep_rad;
  using Place = LegPlace<V>;

  const LegGoals<V>& goals;
  const LegShares<V>& shares;
  const LegValues<V>&weight = goals.weight, &min_rad = goals.min_rad, &max_rad = goals.max_rad;
  const MaskOf<V> shared = kShares ? shares.uneven != V{} : V{} != V{};

  void place(const LegValues<V>& angles_rad, Place& place) const noexcept {
    place_legs(goals, angles_rad, place);
  }
  void set_columns(const Place& place, LegColumns<V>& column) const noexcept {
    gaitpad::set_columns(goals, place, column);
  }
  static void keep(const MaskOf<V>& better, const Place& place, Place& best) noexcept {
    if (!any(not_of(better))) {
      best = place;
      return;
    }
    for (int j = 1; j < kLegDofs; ++j) best.axis[j] = chosen(better, place.axis[j], best.axis[j]);
    for (const auto member : {&Place::knee_m, &Place::ankle_m})
      best.*member = chosen(better, place.*member, best.*member);
    for (int p = 0; p < 3; ++p) best.point_m[p] = chosen(better, place.point_m[p], best.point_m[p]);
    for (int r = 0; r < 6; ++r) best.dx[r] = better ? place.dx[r] : best.dx[r];
    best.squares = better ? place.squares : best.squares;
  }
  static void trace(const LegValues<V>&, const V&) noexcept {}
  void share_step(const Place& at, const LegValues<V>& angles_rad, LegColumns<V>& column,
                  StepIn<LegSystem>& step) const noexcept {
    gaitpad::share_step(shares, shared, at, angles_rad, column, step);
  }
  // True if the exact point was near enough before a step this small.
  MaskOf<V> settles(const Place& at, const V& greatest_rad, int steps) const noexcept {
    return shared & (((greatest_rad < all_of<V>(kSharedNear_rad)) &
                      (first_rows(at.dx) < all_of<V>(kSharedNear_m * kSharedNear_m))) |
                     (all_of<V>(steps) >= all_of<V>(kMostShareSteps)));
  }
};

// kWeighted: some of the legs have weights that differ.
template <class V, bool kWeighted>
inline LegSolution<V> solve_lanes(const LegGoals<V>& goals, const LegShares<V>& shares,
                                  LegValues<V>& angles_rad) noexcept {
  for (int j = 0; j < kLegDofs; ++j)
    angles_rad[j] = min_of(max_of(angles_rad[j], goals.min_rad[j]), goals.max_rad[j]);
  LegSystem<V, kWeighted> system{goals, shares};
  LegPlace<V> best;
  const auto lanes = kWeighted ? system.shared : V{} == V{};
  auto [squares, iterations] =
      iterate(system, kRobust, kRobust.max_iterations, lanes, angles_rad, best);
  if constexpr (kWeighted) squares = first_rows(best.dx);
  return {squares, iterations, best.point_m[0], best.point_m[1]};
}

// Copies the numbers of several legs into lanes, and back: the structs have the same numbers in the
// same order.
template <std::size_t kWidth, class Leg, class One, class Several>
inline void gather(const std::array<Leg*, kWidth>& legs, One Leg::*part, Several& to) noexcept {
  static_assert(sizeof to == kWidth * sizeof(One));
  auto* lanes = reinterpret_cast<Lanes<kWidth>*>(&to);
  std::array<const double*, kWidth> from;
  for (std::size_t i = 0; i < kWidth; ++i)
    from[i] = reinterpret_cast<const double*>(&(legs[i]->*part));
  for (std::size_t k = 0; k < sizeof(One) / sizeof(double); ++k) {
    Lanes<kWidth> row;
    for (std::size_t i = 0; i < kWidth; ++i) set_lane(from[i][k], static_cast<int>(i), row);
    lanes[k] = row;
  }
}
template <std::size_t kWidth, class Leg, class One, class Several>
inline void scatter(const Several& from, One Leg::*part,
                    const std::array<Leg*, kWidth>& legs) noexcept {
  const auto* lanes = reinterpret_cast<const Lanes<kWidth>*>(&from);
  for (std::size_t i = 0; i < kWidth; ++i) {
    auto* to = reinterpret_cast<double*>(&(legs[i]->*part));
    for (std::size_t k = 0; k < sizeof(One) / sizeof(double); ++k)
      to[k] = lane_of(lanes[k], static_cast<int>(i));
  }
}

}  // namespace

template <int kRegister>
void close_legs(std::array<LegToClose, 2>& legs) noexcept {
  constexpr std::size_t kWidth = kLeastLanes;
  using V = Lanes<kLeastLanes>;
  for (std::size_t first = 0; first < legs.size(); first += kWidth) {
    std::array<LegToClose*, kWidth> some;
    for (std::size_t i = 0; i < kWidth; ++i) some[i] = &legs[first + i];
    PlannedLeg<V> planned;
    LegValues<V> angles_rad;
    gather(some, &LegToClose::planned, planned);
    gather(some, &LegToClose::angles_rad, angles_rad);
    const auto reached = close_lanes<V>(planned, angles_rad);
    scatter(angles_rad, &LegToClose::angles_rad, some);
    for (std::size_t i = 0; i < kWidth; ++i)
      some[i]->reached = is_set(reached, static_cast<int>(i)) ? 1.0 : 0.0;
  }
}

template <int kWidth, bool kWeighted, int kRegister>
void solve_legs(const std::array<LegToSolve*, kWidth>& legs) noexcept {
  using V = Lanes<kWidth>;
  LegGoals<V> goals;
  LegShares<V> shares;
  LegValues<V> angles_rad;
  gather(legs, &LegToSolve::goals, goals);
  if constexpr (kWeighted) gather(legs, &LegToSolve::shares, shares);
  gather(legs, &LegToSolve::angles_rad, angles_rad);
  const LegSolution<V> solution = solve_lanes<V, kWeighted>(goals, shares, angles_rad);
  scatter(angles_rad, &LegToSolve::angles_rad, legs);
  scatter(solution, &LegToSolve::solution, legs);
}

}  // namespace gaitpad
