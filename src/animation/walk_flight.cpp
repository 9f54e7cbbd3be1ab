// How a flying foot clears what lies between two footholds. Its flight is planned over a ground
// line; the control points of a spline that makes this line are the greatest heights of the ground
// below the sole in their neighbourhood, and a B-spline stays within the hull of its control
// points: above all of that ground and never higher than its highest. Between footholds without a
// riser the line is straight, and the spline is what it lacks. At a riser close to a foothold,
// where height comes too late (or goes too early), the foot keeps away from it.
#include "animation/walk_parts.h"

namespace gaitpad {
namespace {

constexpr int kProbes = 48;            // along a flight
constexpr double kRoomAbove_m = 0.02;  // at the reference leg, as the following
constexpr double kRoomBeside_m = 0.005, kRoomAhead_m = 0.016, kMostShift_m = .25, kRiser_m = 0.01;
constexpr double kLack_m = 0.008, kEasyShift_m = 0.2, kSharper = 1.5;
constexpr int kTries = 4;
constexpr double kLeastWanted_m = 0.004, kMostGain = 6.0;
constexpr double kRoomSmoothing_s = 0.04;
constexpr double kReplan_m = 0.005;  // of the landing

// The spline through 0 and `end` with slope 0 there.
template <class Knots, class Value>
double spline_at(const Knots& knots, double end, double u, const Value& value) noexcept {
  constexpr int n = kFlightKnots;
  const auto control = [&](int k) {
    if (k <= 0) return value(knots[0]) * (k == 0 ? -0.5 : 1.0);
    if (k < n) return value(knots[k - 1]);
    return k == n ? 1.5 * end - 0.5 * value(knots[n - 2]) : value(knots[n - 2]);
  };
  const double x = std::clamp(u, 0.0, 1.0) * n;
  const int i = std::min(static_cast<int>(x), n - 1);
  const double t = x - i, t2 = t * t, t3 = t2 * t;
  return (control(i - 1) * (1.0 - 3.0 * t + 3.0 * t2 - t3) +
          control(i) * (4.0 - 6.0 * t2 + 3.0 * t3) +
          control(i + 1) * (1.0 + 3.0 * t + 3.0 * t2 - 3.0 * t3) + control(i + 2) * t3) /
         6.0;
}
double spline_at(const FlightSpline& knots, double end, double u) noexcept {
  return spline_at(knots, end, u, [](double k) { return k; });
}

using Wanted = std::array<double, kProbes + 1>;

// Outer knots over their neighbours: the less, the gentler the ends.
struct Ends {
  double first = 0.2, last = 0.2;
};

// At each knot the greatest value within its reach; the outer ones end the spline gently.
FlightSpline envelope(const Wanted& wanted, const Ends& ends) noexcept {
  FlightSpline knots;
  for (int k = 1; k < kFlightKnots; ++k) {
    double& knot = knots[k - 1];
    knot = wanted[k * kProbes / kFlightKnots];
    for (int i = 0; i <= kProbes; ++i) {
      if (std::abs(i * kFlightKnots - k * kProbes) < 2 * kProbes) knot = std::max(knot, wanted[i]);
    }
  }
  const auto gentle = [](double knot, double end, double next, double share) {
    const double most = share * std::abs(next - end);
    return std::clamp(knot, end - most, end + most);
  };
  knots.front() = gentle(knots.front(), 0.0, knots[1], ends.first);
  knots.back() = gentle(knots.back(), wanted.back(), knots[kFlightKnots - 3], ends.last);
  return knots;
}

// The same of the greatest magnitudes; where it falls short of them, all of it times a gain,
// up to `most`.
FlightSpline wide_envelope(const Wanted& wanted, double most) noexcept {
  Wanted positive, negative;
  for (int i = 0; i <= kProbes; ++i) {
    positive[i] = std::max(0.0, wanted[i]);
    negative[i] = std::max(0.0, -wanted[i]);
  }
  FlightSpline knots = envelope(positive, Ends{});
  const FlightSpline other = envelope(negative, Ends{});
  for (int k = 0; k < kFlightKnots - 1; ++k) knots[k] -= other[k];
  double gain = 1.0;
  for (int i = 1; i < kProbes; ++i) {
    if (std::abs(wanted[i]) < kLeastWanted_m) continue;
    const double got = spline_at(knots, 0.0, static_cast<double>(i) / kProbes);
    gain = std::max(gain, got * wanted[i] > 0.0 ? wanted[i] / got : 1.0);
  }
  for (double& knot : knots) knot = std::clamp(knot * std::min(gain, kMostGain), -most, most);
  return knots;
}

// Makes an end less gentle where the way beside is long or not got. False: both do.
bool sharpen(const Wanted& beside, const FlightSpline& shift, double size, Ends& ends) noexcept {
  Ends more = ends;
  for (int i = 1; i < kProbes; ++i) {
    const double got = spline_at(shift, 0.0, static_cast<double>(i) / kProbes);
    const double lack = beside[i] > 0.0 ? beside[i] - got : beside[i] < 0.0 ? got - beside[i] : 0.0;
    if (lack < kLack_m * size && std::abs(beside[i]) < kEasyShift_m * size) continue;
    (2 * i < kProbes ? more.first : more.last) =
        kSharper * (2 * i < kProbes ? ends.first : ends.last);
  }
  const bool any = more.first > ends.first || more.last > ends.last;
  ends = more;
  return any;
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
                double room, double size) noexcept {
  double shift = 0.0;
  for (const vec3& p : sole) {
    const bool ahead_up =
        ground_at(terrain, p.x, piece.to_m + kRiser_m).height_m > height_m + kRiser_m;
    const bool behind_up =
        ground_at(terrain, p.x, piece.from_m - kRiser_m).height_m > height_m + kRiser_m;
    if (ahead_up) shift = std::min(shift, piece.to_m - room - p.z);
    if (behind_up) shift = std::max(shift, piece.from_m + room - p.z);
  }
  return std::clamp(shift, -kMostShift_m * size, kMostShift_m * size);
}

// Of the ground line, from lift-off to landing, where the spline has to make it.
double climb(const WalkState& state, const FootState& foot) noexcept {
  return foot.crosses_riser ? state.landing_m.y - height_on(foot.plane, foot.lift_m) : 0.0;
}

}  // namespace

void plan_room(const Tick& tick, WalkState& state, Side side) noexcept {
  const WalkModel& model = tick.model;
  const Terrain& terrain = *model.terrain;
  FootState& foot = state.foot[side];
  FlightRoom& room = foot.room;
  const bool begins = foot.mode_ticks == 0;
  room.planned_for_m = state.landing_m;
  Wanted above{}, beside{};
  std::array<Sole, kProbes + 1> sole;
  for (int i = 0; i <= kProbes; ++i) {
    const double u = static_cast<double>(i) / kProbes;
    const FlightPoint point =
        flight_point(model, state, side, u, foot.pitch_fade.at(u * state.stage_ticks));
    sole[i] = sole_of(model.leg[side], point.pose);
    double over = -model.leg_length_m;
    for (const vec3& p : sole[i])
      over = std::max(over, ground_at(terrain, p.x, p.z).height_m - base_under(point, p));
    const double above_m = kRoomAbove_m * model.size;
    above[i] = foot.crosses_riser
                   ? over + above_m * smoothstep(0.0, 0.2, u) * (1.0 - smoothstep(0.8, 1.0, u))
                   : std::max(0.0, over) + std::clamp(over, 0.0, above_m);
  }
  above.front() = 0.0;
  above.back() = climb(state, foot);
  const Stretch begin = piece_at(terrain, foot.plane.place_m.z),
                end = piece_at(terrain, state.landing_m.z);
  const double end_room = kRoomBeside_m * model.size;
  double begin_room = kRoomAhead_m * model.size;  // as the pitch may still come out otherwise
  for (const vec3& p : sole.front())
    begin_room = std::min({begin_room, 0.7 * (begin.to_m - p.z), 0.7 * (p.z - begin.from_m)});
  // As gently as it does.
  Ends ends;
  for (int tries = 0; tries < kTries; ++tries) {
    room.raise_m = envelope(above, ends);
    for (int i = 1; i < kProbes; ++i) {
      const double u = static_cast<double>(i) / kProbes;
      beside[i] = 0.0;
      if (above[i] <= spline_at(room.raise_m, above.back(), u)) continue;
      beside[i] =
          2 * i < kProbes
              ? way_back(terrain, sole[i], begin, foot.plane.place_m.y, begin_room, model.size)
              : way_back(terrain, sole[i], end, state.landing_m.y, end_room, model.size);
    }
    room.shift_m = wide_envelope(beside, kMostShift_m * model.size);
    if (!sharpen(beside, room.shift_m, model.size, ends)) break;
  }
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
  const double raise = spline_at(room.raise, climb(state, foot), u, in_force);
  const vec3 move(0.0, raise, spline_at(room.shift, 0.0, u, in_force));
  foot.base_m += raise;
  foot.pose.heel_m += move;
  foot.pose.toe_m += move;
}

}  // namespace gaitpad
