// How a flying foot clears what lies between two footholds. Its flight is planned over a line from
// one plane to the other; where the ground below the sole is higher than that line, the line is
// raised by a spline whose control points are the greatest such heights in their neighbourhood: a
// B-spline stays within the hull of its control points, so it lies above them all. At a riser close
// to a foothold, where height comes too late (or goes too early), the foot keeps away from it.
#include "animation/walk_parts.h"

namespace gaitpad {
namespace {

constexpr int kProbes = 48;            // along a flight
constexpr double kRoomAbove_m = 0.02;  // at the reference leg, as the following
constexpr double kRoomBeside_m = 0.005, kMostShift_m = 0.14, kRiser_m = 0.01;
constexpr double kFirstKnot = 0.35;  // of the next one: the least jerk at both ends
constexpr double kLeastWanted_m = 0.004, kMostRaiseGain = 1.2, kMostShiftGain = 2.5;
constexpr double kRoomSmoothing_s = 0.04;
constexpr double kReplan_m = 0.005;  // of the landing

// The spline's control points, the ends' such that value and slope are 0 there.
template <class Knots, class Value>
double spline_at(const Knots& knots, double u, const Value& value) noexcept {
  constexpr int n = kFlightKnots;
  const auto control = [&](int k) {
    if (k <= 0) return value(knots[0]) * (k == 0 ? -0.5 : 1.0);
    if (k >= n) return value(knots[n - 2]) * (k == n ? -0.5 : 1.0);
    return value(knots[k - 1]);
  };
  const double x = std::clamp(u, 0.0, 1.0) * n;
  const int i = std::min(static_cast<int>(x), n - 1);
  const double t = x - i, t2 = t * t, t3 = t2 * t;
  return (control(i - 1) * (1.0 - 3.0 * t + 3.0 * t2 - t3) + control(i) * (4.0 - 6.0 * t2 + 3.0 * t3) +
          control(i + 1) * (1.0 + 3.0 * t + 3.0 * t2 - 3.0 * t3) + control(i + 2) * t3) / 6.0;
}
double spline_at(const FlightSpline& knots, double u) noexcept {
  return spline_at(knots, u, [](double k) { return k; });
}

// At each knot the value of the largest magnitude within its reach; near the ends, where a spline
// that ends gently falls short of it, all of it times at most `most_gain`.
FlightSpline envelope(const std::array<double, kProbes + 1>& wanted, double most_gain) noexcept {
  FlightSpline knots{};
  for (int k = 1; k < kFlightKnots; ++k) {
    for (int i = 0; i <= kProbes; ++i) {
      const double off = static_cast<double>(i * kFlightKnots) / kProbes - k;
      if (std::abs(off) < 2.0 && std::abs(wanted[i]) > std::abs(knots[k - 1]))
        knots[k - 1] = wanted[i];
    }
  }
  const auto gentle = [](double end, double next) {
    return std::clamp(end, -kFirstKnot * std::abs(next), kFirstKnot * std::abs(next));
  };
  knots.front() = gentle(knots.front(), knots[1]);
  knots.back() = gentle(knots.back(), knots[kFlightKnots - 3]);
  double gain = 1.0;
  for (int i = 1; i < kProbes; ++i) {
    if (std::abs(wanted[i]) < kLeastWanted_m) continue;
    const double got = spline_at(knots, static_cast<double>(i) / kProbes);
    gain = std::max(gain, got * wanted[i] > 0.0 ? wanted[i] / got : 1.0);
  }
  for (double& knot : knots) knot *= std::min(gain, most_gain);
  return knots;
}

using Sole = std::array<vec3, 5>;  // heel and tip on both sides, ball
Sole sole_of(const LegBuild& leg, const FootPose& pose) noexcept {
  const quat foot = foot_rotation(leg, pose);
  const quat toes = foot * rotation_about(leg.side, -std::max(0.0, pose.pitch_rad));
  const vec3 ball = pose.heel_m + foot * (leg.ball_m - leg.model.heel_m);
  const vec3 tip = ball + toes * (leg.tip_m - leg.ball_m);
  const vec3 side = foot * leg.side * leg.half_width_m;
  return {pose.heel_m - side, pose.heel_m + side, ball, tip - side, tip + side};
}

// The plane through the heel's ground that the pose is tilted to.
double base_under(const FlightPoint& point, const vec3& p) noexcept {
  const vec3 n = point.pose.tilt * kUp;
  return point.base_m -
         (n.x * (p.x - point.pose.heel_m.x) + n.z * (p.z - point.pose.heel_m.z)) / n.y;
}

// How far to move along z so that no part of the sole is beyond a riser at an end of `piece` that
// leads up from `height_m`.
double way_back(const Terrain& terrain, const Sole& sole, const Stretch& piece, double height_m,
                double size) noexcept {
  const double room = kRoomBeside_m * size;
  double shift = 0.0;
  for (const vec3& p : sole) {
    const bool ahead_up = ground_at(terrain, p.x, piece.to_m + kRiser_m).height_m > height_m + kRiser_m;
    const bool behind_up =
        ground_at(terrain, p.x, piece.from_m - kRiser_m).height_m > height_m + kRiser_m;
    if (ahead_up) shift = std::min(shift, piece.to_m - room - p.z);
    if (behind_up) shift = std::max(shift, piece.from_m + room - p.z);
  }
  return std::clamp(shift, -kMostShift_m * size, kMostShift_m * size);
}

}  // namespace

void plan_room(const Tick& tick, WalkState& state, Side side) noexcept {
  const WalkModel& model = tick.model;
  const Terrain& terrain = *model.terrain;
  FootState& foot = state.foot[side];
  FlightRoom& room = foot.room;
  const bool begins = foot.mode_ticks == 0;
  room.planned_for_m = state.landing_m;
  std::array<double, kProbes + 1> above{}, beside{};
  std::array<Sole, kProbes + 1> sole;
  for (int i = 0; i <= kProbes; ++i) {
    const double u = static_cast<double>(i) / kProbes;
    const FlightPoint point =
        flight_point(model, state, side, u, foot.pitch_fade.at(u * state.stage_ticks));
    sole[i] = sole_of(model.leg[side], point.pose);
    if (i == 0 || i == kProbes) continue;
    double over = 0.0;
    for (const vec3& p : sole[i])
      over = std::max(over, ground_at(terrain, p.x, p.z).height_m - base_under(point, p));
    above[i] = over + std::min(over, kRoomAbove_m * model.size);
  }
  room.raise_m = envelope(above, kMostRaiseGain);
  const Stretch begin = piece_at(terrain, foot.plane.place_m.z), end = piece_at(terrain, state.landing_m.z);
  for (int i = 1; i < kProbes; ++i) {
    const double u = static_cast<double>(i) / kProbes;
    if (above[i] <= spline_at(room.raise_m, u)) continue;
    beside[i] = 2 * i < kProbes
                    ? way_back(terrain, sole[i], begin, foot.plane.place_m.y, model.size)
                    : way_back(terrain, sole[i], end, state.landing_m.y, model.size);
  }
  room.shift_m = envelope(beside, kMostShiftGain);
  if (!begins) return;
  for (int k = 0; k < kFlightKnots - 1; ++k) {
    room.raise[k] = {room.raise_m[k], 0.0};
    room.shift[k] = {room.shift_m[k], 0.0};
  }
}

void keep_room(const Tick& tick, WalkState& state, Side side, double u) noexcept {
  FootState& foot = state.foot[side];
  FlightRoom& room = foot.room;
  if (glm::distance(room.planned_for_m, state.landing_m) > kReplan_m * tick.model.size)
    plan_room(tick, state, side);
  for (int k = 0; k < kFlightKnots - 1; ++k) {
    const double time_s = kRoomSmoothing_s * tick.model.time_scale;
    room.raise[k].advance(room.raise_m[k], time_s, tick.dt_s);
    room.shift[k].advance(room.shift_m[k], time_s, tick.dt_s);
  }
  const auto in_force = [](const Damped<double>& k) { return k.x; };
  const double raise = spline_at(room.raise, u, in_force);
  const vec3 move(0.0, raise, spline_at(room.shift, u, in_force));
  foot.base_m += raise;
  foot.pose.heel_m += move;
  foot.pose.toe_m += move;
}

}  // namespace gaitpad
