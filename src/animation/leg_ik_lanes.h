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

// The error of the first point alone, squared.
template <class V>
inline V first_rows(const LegRows<V>& dx) noexcept {
  return dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2];
}

// What one step of the solver closes, and from where.
template <class V>
struct LegStep {
  LegValues<V> weight, first_rad;  // the part of the step that the rows do not ask for
  LegRows<V> give, error;          // what the rows give way, and what is left to close
};

// Solves for a step within the limits. A rotation that the step would carry past a limit moves
// exactly to the limit, its column leaves the system, and the system is solved again for the
// others. A lane that is done finds the same step again.
template <class V, bool kWeighted>
inline void limited_step(const LegGoals<V>& goals, const LegColumns<V>& column, LegStep<V>& step,
                         const LegValues<V>& angles_rad, const MaskOf<V>& lanes,
                         LegValues<V>& delta) noexcept {
  LegRows<V> y;
  for (V& d : delta) d = V{};
  for (int round = 0; round <= kLegDofs; ++round) {
    solve_step(column, step.weight, step.give, step.error, y);
    auto frozen = lanes & 0;
    for (int j = 0; j < kLegDofs; ++j) {
      const V even = column[j][0] * y[0] + column[j][2] * y[2] + column[j][4] * y[4],
              odd = column[j][1] * y[1] + column[j][3] * y[3] + column[j][5] * y[5];
      const auto moves = step.weight[j] != V{};
      V turn = step.weight[j] * (even + odd);
      if constexpr (kWeighted) turn += step.first_rad[j];
      delta[j] = moves ? turn : delta[j];
      const V wanted = angles_rad[j] + delta[j],
              allowed = min_of(max_of(wanted, goals.min_rad[j]), goals.max_rad[j]);
      const auto stops = lanes & moves & (allowed != wanted);
      if (!any(stops)) continue;
      frozen |= stops;
      delta[j] = stops ? allowed - angles_rad[j] : delta[j];
      step.weight[j] = stops ? V{} : step.weight[j];
      V closes = delta[j];
      if constexpr (kWeighted) closes -= step.first_rad[j];
      for (int r = 0; r < 6; ++r)
        step.error[r] = stops ? step.error[r] - column[j][r] * closes : step.error[r];
    }
    if (!any(frozen)) return;
  }
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
// Of the room of a foot's pitch: from here on it gives way no more.
constexpr double kRoomUsed = 0.8;

// Makes a step of legs whose weights differ one towards the least sum of (angle - reference)^2 / W
// and of the squares of the rows that give way over what they give, under the exact rows.
template <class V>
inline void share_step(const LegShares<V>& shares, const MaskOf<V>& shared, const LegPlace<V>& at,
                       const LegValues<V>& angles_rad, LegColumns<V>& column,
                       LegStep<V>& step) noexcept {
  LegRows<V> b = at.dx;
  for (int r : {3, 4, 5}) {
    const int of = r == 3 ? 0 : 1;
    for (auto& c : column) c[r] = shared ? c[r] - c[of] : c[r];
    b[r] -= at.dx[of];
  }
  // Down positive. Near the floor, and near a toe's, a turn counts more and more.
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

// --- The solver ----------------------------------------------------------------------------------

// kWeighted: some of the legs have weights that differ.
template <class V, bool kWeighted>
inline LegSolution<V> solve_lanes(const LegGoals<V>& goals,
                                  [[maybe_unused]] const LegShares<V>* shares,
                                  const RobustOptions& options, LegValues<V>& angles_rad) noexcept {
  for (int j = 0; j < kLegDofs; ++j)
    angles_rad[j] = min_of(max_of(angles_rad[j], goals.min_rad[j]), goals.max_rad[j]);
  LegValues<V> next = angles_rad;
  LegPlace<V> best, place;
  const V infinite = all_of<V>(std::numeric_limits<double>::infinity());
  V growth = all_of<V>(kGrowth), iterations{}, seen_m = infinite, seen_at{};
  best.squares = infinite;
  auto lanes = V{} == V{};  // still on their way
  auto shared = V{} != V{}, settled = shared;
  if constexpr (kWeighted) {
    lanes = shared = shares->uneven != V{};
  }
  const double enough = options.tolerance_m * options.tolerance_m;
  for (int k = 0;; ++k) {
    place_legs(goals, next, k == 0 ? best : place);
    if (k > 0) {
      const auto better = lanes & ((place.squares < best.squares) | shared);
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
    lanes &= ~((best.squares <= all_of<V>(enough)) & ~shared) & ~settled;
    if (!any(lanes) || k >= options.max_iterations) break;
    const V error_m = sqrt_of(best.squares);
    const auto falls = error_m < seen_m - kLeastGain * min_of(error_m, all_of<V>(kGainFrom));
    seen_at = falls ? all_of<V>(k) : seen_at;
    seen_m = falls ? error_m : seen_m;
    lanes &= best.squares < infinite;
    lanes &= (all_of<V>(k) - seen_at < all_of<V>(kPatience)) | shared;
    if (!any(lanes)) break;

    LegColumns<V> column;
    set_columns(goals, best, column);
    constexpr double most = kFarthest * kFarthest;
    const V share = best.squares > all_of<V>(most) ? kFarthest / error_m : all_of<V>(1.0);
    LegStep<V> step;
    step.weight = goals.weight;
    step.give.fill(std::max(options.damping * options.damping, kLeastDampingSquared) +
                   growth * min_of(best.squares, all_of<V>(most)));
    for (int r = 0; r < 6; ++r) step.error[r] = share * best.dx[r];
    if constexpr (kWeighted) share_step(*shares, shared, best, angles_rad, column, step);
    LegValues<V> delta;
    limited_step<V, kWeighted>(goals, column, step, angles_rad, lanes, delta);
    V greatest{};
    for (const V& d : delta) greatest = max_of(greatest, abs_of(d));
    const V cap_rad = shared ? all_of<V>(kMostShareStep_rad) : all_of<V>(options.max_step_rad),
            cap = greatest > cap_rad ? cap_rad / greatest : all_of<V>(1.0);
    for (int j = 0; j < kLegDofs; ++j) {
      const V wanted = angles_rad[j] + cap * delta[j];
      next[j] = min_of(max_of(wanted, goals.min_rad[j]), goals.max_rad[j]);
      next[j] = lanes ? next[j] : angles_rad[j];
    }
    if constexpr (kWeighted) {
      const V missed = first_rows(best.dx);
      settled = shared & (((greatest < all_of<V>(kSharedNear_rad)) &
                           (missed < all_of<V>(kSharedNear_m * kSharedNear_m))) |
                          (all_of<V>(k + 1) >= all_of<V>(kMostShareSteps)));
    }
  }
  if constexpr (kWeighted) best.squares = shared ? first_rows(best.dx) : best.squares;
  return {best.squares, iterations, best.point_m[0], best.point_m[1]};
}

// Numbers of several legs side by side, and back: the structs are the same numbers in the same
// order.
template <std::size_t kWidth, class One, class Several>
inline void gather(const std::array<LegToSolve*, kWidth>& legs, One LegToSolve::*part,
                   Several& to) noexcept {
  static_assert(sizeof to == kWidth * sizeof(One));
  auto* lanes = reinterpret_cast<Lanes<kWidth>*>(&to);
  std::array<const double*, kWidth> from;
  for (std::size_t i = 0; i < kWidth; ++i)
    from[i] = reinterpret_cast<const double*>(&(legs[i]->*part));
  for (std::size_t k = 0; k < sizeof(One) / sizeof(double); ++k) {
    Lanes<kWidth> row;
    for (std::size_t i = 0; i < kWidth; ++i) row[i] = from[i][k];
    lanes[k] = row;
  }
}
template <std::size_t kWidth, class One, class Several>
inline void scatter(const Several& from, One LegToSolve::*part,
                    const std::array<LegToSolve*, kWidth>& legs) noexcept {
  const auto* lanes = reinterpret_cast<const Lanes<kWidth>*>(&from);
  for (std::size_t i = 0; i < kWidth; ++i) {
    auto* to = reinterpret_cast<double*>(&(legs[i]->*part));
    for (std::size_t k = 0; k < sizeof(One) / sizeof(double); ++k) to[k] = lanes[k][i];
  }
}

}  // namespace

template <int kWidth, bool kWeighted, int kRegister>
void solve_legs(const RobustOptions& options,
                const std::array<LegToSolve*, kWidth>& legs) noexcept {
  using V = Lanes<kWidth>;
  LegGoals<V> goals;
  LegShares<V> shares;
  LegValues<V> angles_rad;
  gather(legs, &LegToSolve::goals, goals);
  if constexpr (kWeighted) gather(legs, &LegToSolve::shares, shares);
  gather(legs, &LegToSolve::angles_rad, angles_rad);
  const LegSolution<V> solution = solve_lanes<V, kWeighted>(goals, &shares, options, angles_rad);
  scatter(angles_rad, &LegToSolve::angles_rad, legs);
  scatter(solution, &LegToSolve::solution, legs);
}

}  // namespace gaitpad
