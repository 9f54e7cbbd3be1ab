// The body of solve_legs(), for one width and one set of instructions at a time.
#pragma once
#include <limits>
#include <utility>

#include "animation/leg_ik.h"
#include "animation/robust_step.h"

namespace gaitpad {

// Which of a goal's points a row is of.
inline constexpr std::array<int, 6> kPointOf = {0, 0, 0, 1, 1, 2};

namespace {

template <class V>
using LegValues = std::array<V, kLegDofs>;
template <class V>
using LegRows = std::array<V, 6>;

// The legs in one pose, and how far their rows are from their goals.
template <class V>
struct LegPlace {
  std::array<Vec3Of<V>, kLegDofs> axis;  // in the pelvis' frame; the first is its x axis
  Vec3Of<V> knee_m, ankle_m;             // the rotations of the hip turn about the origin
  std::array<Vec3Of<V>, 3> point_m;
  LegRows<V> dx;
  V squares;
};

// Turns a frame about its own first axis: (y, z) are the other two, in cyclic order.
template <class V>
inline void turn_lanes(Vec3Of<V>& y, Vec3Of<V>& z, const V& sine, const V& cosine) noexcept {
  const Vec3Of<V> old = y;
  y = cosine * old + sine * z;
  z = cosine * z - sine * old;
}

template <class V>
inline void place_legs(const LegGoals<V>& goals, const LegValues<V>& angles_rad,
                       LegPlace<V>& place) noexcept {
  LegValues<V> s, c;
  for (int j = 0; j < kLegDofs; ++j) sin_cos_of(angles_rad[j], s[j], c[j]);
  const V zero{}, one = all_of<V>(1.0);
  Vec3Of<V> x{one, zero, zero}, y{zero, c[0], s[0]}, z{zero, -s[0], c[0]};
  place.axis[0] = x;
  place.axis[1] = z;
  // x is still the pelvis' own: half of the products with it are 0.
  x = {c[1], s[1] * y.y, s[1] * y.z};
  y = {-s[1], c[1] * y.y, c[1] * y.z};
  place.axis[2] = y;
  turn_lanes(z, x, s[2], c[2]);
  place.knee_m = -goals.thigh_m * y;
  place.axis[3] = x;
  turn_lanes(y, z, s[3], c[3]);
  place.ankle_m = place.knee_m + -goals.shank_m * y;
  place.axis[4] = x;
  turn_lanes(y, z, s[4], c[4]);
  place.axis[5] = z;
  turn_lanes(x, y, s[5], c[5]);
  place.axis[6] = y;
  turn_lanes(z, x, s[6], c[6]);
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

// Columns of the Jacobian. An entry is d . (a x (p - q)) for direction d, point p and an axis a
// through q, which is a . (p x d) + d . (q x a).
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
    for (int r = 0; r < 6; ++r) {
      const Vec3Of<V>& d = *direction[r];
      column[j][r] = (a.x * moment[r].x + a.y * moment[r].y) + (a.z * moment[r].z + n.x * d.x) +
                     (n.y * d.y + n.z * d.z);
    }
  }
}

// J W J^T + a diagonal = L D L^T, y = its inverse times b.
template <class V>
inline void solve_step(const LegColumns<V>& column, const LegValues<V>& weight,
                       const LegRows<V>& diagonal, const LegRows<V>& b, LegRows<V>& y) noexcept {
  std::array<LegRows<V>, 6> m;
  for (int r = 0; r < 6; ++r) {
    for (int s = 0; s <= r; ++s) m[r][s] = (weight[0] * column[0][r]) * column[0][s];
  }
  for (int j = 1; j < kLegDofs; ++j) {
    for (int r = 0; r < 6; ++r) {
      const V weighted = weight[j] * column[j][r];
      for (int s = 0; s <= r; ++s) m[r][s] += weighted * column[j][s];
    }
  }
  for (int r = 0; r < 6; ++r) m[r][r] += diagonal[r];
  LegRows<V> reciprocal;
  for (int k = 0; k < 6; ++k) {
    reciprocal[k] = 1.0 / m[k][k];
    for (int r = k + 1; r < 6; ++r) {
      const V l = m[k][r] = m[r][k] * reciprocal[k];
      for (int s = k + 1; s <= r; ++s) m[r][s] -= l * m[s][k];
    }
  }
  y = b;
  for (int k = 0; k < 6; ++k) {
    for (int r = k + 1; r < 6; ++r) y[r] -= m[k][r] * y[k];
  }
  for (int k = 0; k < 6; ++k) y[k] *= reciprocal[k];
  for (int k = 5; k > 0; --k) {
    for (int r = 0; r < k; ++r) y[r] -= m[r][k] * y[k];
  }
}

// Solves for a step within the limits. A rotation that the step would carry past a limit moves
// exactly to the limit, its column leaves the system, and the system is solved again for the
// others. A lane that is done finds the same step again.
template <class V>
inline void limited_step(const LegGoals<V>& goals, const LegColumns<V>& column,
                         const V& damping_squared, LegRows<V> dx, const LegValues<V>& angles_rad,
                         const MaskOf<V>& lanes, LegValues<V>& delta) noexcept {
  LegValues<V> weight = goals.weight;
  LegRows<V> y, damping;
  damping.fill(damping_squared);
  for (V& d : delta) d = V{};
  for (int round = 0; round <= kLegDofs; ++round) {
    solve_step(column, weight, damping, dx, y);
    auto frozen = lanes & 0;
    for (int j = 0; j < kLegDofs; ++j) {
      const V even = column[j][0] * y[0] + column[j][2] * y[2] + column[j][4] * y[4],
              odd = column[j][1] * y[1] + column[j][3] * y[3] + column[j][5] * y[5];
      const auto moves = weight[j] != V{};
      delta[j] = moves ? weight[j] * (even + odd) : delta[j];
      const V wanted = angles_rad[j] + delta[j],
              allowed = min_of(max_of(wanted, goals.min_rad[j]), goals.max_rad[j]);
      const auto stops = lanes & moves & (allowed != wanted);
      if (!any(stops)) continue;
      frozen |= stops;
      delta[j] = stops ? allowed - angles_rad[j] : delta[j];
      weight[j] = stops ? V{} : weight[j];
      for (int r = 0; r < 6; ++r) dx[r] = stops ? dx[r] - column[j][r] * delta[j] : dx[r];
    }
    if (!any(frozen)) return;
  }
}

template <class V>
inline LegSolution<V> solve_lanes(const LegGoals<V>& goals, const RobustOptions& options,
                                  LegValues<V>& angles_rad) noexcept {
  for (int j = 0; j < kLegDofs; ++j)
    angles_rad[j] = min_of(max_of(angles_rad[j], goals.min_rad[j]), goals.max_rad[j]);
  LegValues<V> next = angles_rad;
  LegPlace<V> best, place;
  const V infinite = all_of<V>(std::numeric_limits<double>::infinity());
  V growth = all_of<V>(kGrowth), iterations{}, seen_m = infinite, seen_at{};
  best.squares = infinite;
  auto lanes = V{} == V{};  // still on their way
  const double enough = options.tolerance_m * options.tolerance_m;
  for (int k = 0;; ++k) {
    place_legs(goals, next, k == 0 ? best : place);
    if (k > 0) {
      const auto better = lanes & (place.squares < best.squares);
      growth = better ? max_of(growth * kGrowthDown, all_of<V>(kGrowth)) : growth * kGrowthUp;
      for (int j = 0; j < kLegDofs; ++j) angles_rad[j] = better ? next[j] : angles_rad[j];
      if (!any(~better)) {
        best = place;
      } else if (any(better)) {
        for (int j = 1; j < kLegDofs; ++j)
          best.axis[j] = chosen(better, place.axis[j], best.axis[j]);
        for (const auto member : {&LegPlace<V>::knee_m, &LegPlace<V>::ankle_m})
          best.*member = chosen(better, place.*member, best.*member);
        for (int p = 0; p < 3; ++p)
          best.point_m[p] = chosen(better, place.point_m[p], best.point_m[p]);
        for (int r = 0; r < 6; ++r) best.dx[r] = better ? place.dx[r] : best.dx[r];
        best.squares = better ? place.squares : best.squares;
      }
    }
    iterations = lanes ? all_of<V>(k) : iterations;
    lanes &= ~(best.squares <= all_of<V>(enough));
    if (!any(lanes) || k >= options.max_iterations) break;
    const V error_m = sqrt_of(best.squares);
    const auto falls = error_m < seen_m - kLeastGain * min_of(error_m, all_of<V>(kGainFrom));
    seen_at = falls ? all_of<V>(k) : seen_at;
    seen_m = falls ? error_m : seen_m;
    lanes &= best.squares < infinite;
    lanes &= all_of<V>(k) - seen_at < all_of<V>(kPatience);
    if (!any(lanes)) break;

    LegColumns<V> column;
    set_columns(goals, best, column);
    constexpr double most = kFarthest * kFarthest;
    const V share = best.squares > all_of<V>(most) ? kFarthest / error_m : all_of<V>(1.0);
    LegRows<V> dx;
    for (int r = 0; r < 6; ++r) dx[r] = share * best.dx[r];
    const V damping_squared = std::max(options.damping * options.damping, kLeastDampingSquared) +
                              growth * min_of(best.squares, all_of<V>(most));
    LegValues<V> delta;
    limited_step(goals, column, damping_squared, dx, angles_rad, lanes, delta);
    V greatest{};
    for (const V& d : delta) greatest = max_of(greatest, abs_of(d));
    const V cap_rad = all_of<V>(options.max_step_rad),
            cap = greatest > cap_rad ? cap_rad / greatest : all_of<V>(1.0);
    for (int j = 0; j < kLegDofs; ++j) {
      const V wanted = angles_rad[j] + cap * delta[j];
      next[j] = min_of(max_of(wanted, goals.min_rad[j]), goals.max_rad[j]);
      next[j] = lanes ? next[j] : angles_rad[j];
    }
  }
  return {best.squares, iterations, best.point_m[0], best.point_m[1]};
}

// --- Equation (5) --------------------------------------------------------------------------------

// The exact rows are closed in every step, this share of the rest: with all of it some walks swing
// between two poses.
constexpr double kShareStep = 0.5;
constexpr double kMostShareStep_rad = 0.6;
constexpr double kSharedNear_rad = 0.05 * kDegree, kSharedNear_m = 0.001;
constexpr int kMostShareSteps = 8;
constexpr double kExactRow_m2 = 1e-13;
constexpr double kKneeSpring = 100.0;
constexpr double kRoomUsed =
    0.8;  // of the room of a foot's pitch: from here on it gives way no more

// Least sum of (angle - reference)^2 / W and of the squares of the rows that give way over what
// they give, under the exact rows: one step from `angles_rad` to it.
template <class V>
inline void share_step(const LegGoals<V>& goals, const LegShares<V>& shares, const LegPlace<V>& at,
                       const LegValues<V>& angles_rad, LegValues<V>& delta) noexcept {
  LegColumns<V> column;
  set_columns(goals, at, column);
  LegRows<V> b = at.dx;
  for (int r : {3, 4, 5}) {
    const int of = r == 3 ? 0 : 1;
    for (auto& c : column) c[r] -= c[of];
    b[r] -= at.dx[of];
  }
  // Down positive. Near the floor, and near a toe's, a turn counts more and more.
  const V lever = shares.lever_m, down = b[4] / lever;
  const V room = down > V{} ? shares.room_down_rad : shares.room_up_rad, size = abs_of(down),
          t = min_of(V(size / room), all_of<V>(kRoomUsed)), left = 1.0 / (1.0 - t),
          steep = left * left, bent = t * room * left + steep * (size - t * room);
  b[4] = lever * (down > V{} ? bent : -bent);
  for (auto& c : column) c[4] = steep * c[4];
  LegValues<V> weight = shares.weight;
  for (int j = 0; j < kLegDofs; ++j) delta[j] = shares.reference_rad[j] - angles_rad[j];
  const V knee = angles_rad[kKneeX], bend = max_of(V(shares.knee_rad - knee), V{}),
          q = bend + shares.knee_soft_rad, push = kKneeSpring * bend * bend / q,
          stiff = kKneeSpring * bend * (bend + 2.0 * shares.knee_soft_rad) / (q * q),
          free = weight[kKneeX] / (1.0 + weight[kKneeX] * stiff);
  delta[kKneeX] =
      free * (shares.reference_rad[kKneeX] / weight[kKneeX] + push + stiff * knee) - knee;
  weight[kKneeX] = free;
  for (int r : {3, 4, 5}) b[r] = kShareStep * b[r];
  for (int j = 0; j < kLegDofs; ++j) {
    delta[j] = kShareStep * delta[j];
    for (int r = 0; r < 6; ++r) b[r] -= column[j][r] * delta[j];
  }
  LegRows<V> diagonal, y;
  for (int r = 0; r < 6; ++r)
    diagonal[r] = r < 3 ? all_of<V>(kExactRow_m2) : kExactRow_m2 + shares.give_m2[r - 3];
  solve_step(column, weight, diagonal, b, y);
  for (int j = 0; j < kLegDofs; ++j) {
    const V even = column[j][0] * y[0] + column[j][2] * y[2] + column[j][4] * y[4],
            odd = column[j][1] * y[1] + column[j][3] * y[3] + column[j][5] * y[5];
    delta[j] += weight[j] * (even + odd);
  }
}

template <class V>
inline LegSolution<V> share_lanes(const LegGoals<V>& goals, const LegShares<V>& shares,
                                  LegValues<V>& angles_rad) noexcept {
  LegPlace<V> at;
  auto lanes = shares.uneven != V{};  // still on their way
  V greatest = all_of<V>(1.0), missed{}, steps{};
  for (int k = 0;; ++k) {
    place_legs(goals, angles_rad, at);
    lanes &= ~((greatest < all_of<V>(kSharedNear_rad)) &
               (missed < all_of<V>(kSharedNear_m * kSharedNear_m)));
    missed = at.dx[0] * at.dx[0] + at.dx[1] * at.dx[1] + at.dx[2] * at.dx[2];
    if (!any(lanes) || k == kMostShareSteps) break;
    LegValues<V> delta;
    share_step(goals, shares, at, angles_rad, delta);
    greatest = V{};
    for (const V& d : delta) greatest = max_of(greatest, abs_of(d));
    const V cap_rad = all_of<V>(kMostShareStep_rad),
            cap = greatest > cap_rad ? cap_rad / greatest : all_of<V>(1.0);
    for (int j = 0; j < kLegDofs; ++j)
      angles_rad[j] = lanes ? angles_rad[j] + cap * delta[j] : angles_rad[j];
    steps = lanes ? steps + 1.0 : steps;
  }
  return {missed, steps, at.point_m[0], at.point_m[1]};
}

}  // namespace

template <int kWidth, int kRegister>
void share_legs(SharedLegs<kWidth>& legs) noexcept {
  using V = Lanes<kWidth>;
  LegGoals<V> goals;
  LegShares<V> shares;
  LegValues<V> angles_rad;
  std::memcpy(&goals, &legs.goals, sizeof goals);
  std::memcpy(&shares, &legs.shares, sizeof shares);
  std::memcpy(&angles_rad, &legs.angles_rad, sizeof angles_rad);
  const LegSolution<V> solution = share_lanes(goals, shares, angles_rad);
  std::memcpy(&legs.angles_rad, &angles_rad, sizeof angles_rad);
  std::memcpy(&legs.solution, &solution, sizeof solution);
}

template <int kWidth, int kRegister>
void solve_legs(const RobustOptions& options, LegLanes<kWidth>& legs) noexcept {
  using V = Lanes<kWidth>;
  LegGoals<V> goals;
  LegValues<V> angles_rad;
  static_assert(sizeof goals == sizeof legs.goals && sizeof angles_rad == sizeof legs.angles_rad);
  std::memcpy(&goals, &legs.goals, sizeof goals);
  std::memcpy(&angles_rad, &legs.angles_rad, sizeof angles_rad);
  const LegSolution<V> solution = solve_lanes(goals, options, angles_rad);
  std::memcpy(&legs.angles_rad, &angles_rad, sizeof angles_rad);
  std::memcpy(&legs.solution, &solution, sizeof solution);
}

}  // namespace gaitpad
