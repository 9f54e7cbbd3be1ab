// How a flying foot clears what lies between two footholds. Its flight is planned over a ground
// line; the control points of a spline that makes this line are the greatest heights of the ground
// below the sole in their neighbourhood, and a B-spline stays within the hull of its control
// points: above all of that ground and never higher than its highest. Between footholds without a
// riser the line is straight, and the spline is what it lacks. At a riser close to a foothold,
// where height comes too late (or goes too early), the foot keeps away from it. Down stairs the
// foot goes ahead of its flight, and the line is drawn taut over the edges.
#include "animation/walk_parts.h"

namespace gaitpad {
namespace {

constexpr int kProbes = 48;            // along a flight
constexpr double kRoomAbove_m = 0.02;  // at the reference leg, as the following
constexpr double kRoomBeside_m = 0.005, kRoomAhead_m = 0.016, kMostShift_m = 0.25, kRiser_m = 0.01;
constexpr double kLack_m = 0.008, kEasyShift_m = 0.2, kSharper = 1.5;
constexpr int kTries = 4;
constexpr double kOver = 0.67;  // of the flight: a falling foot is over its landing's piece
constexpr int kMostRisers = 4, kTautRounds = 24;
constexpr double kTautRoom = 0.5;  // of kRoomAbove_m
constexpr double kLeastWeight = 1e-6, kLeastLeft_m = 1e-6;
constexpr double kLeastWanted_m = 0.004, kMostGain = 6.0;
constexpr double kRoomSmoothing_s = 0.04;
constexpr double kReplan_m = 0.005;  // of the landing

// The spline through 0 and `end` with slope 0 there.
template <class Knots, class Value>
constexpr double spline_at(const Knots& knots, double end, double u, const Value& value) noexcept {
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
constexpr double spline_at(const FlightSpline& knots, double end, double u) noexcept {
  return spline_at(knots, end, u, [](double k) { return k; });
}

// 1 in mid-flight, 0 at its ends.
double in_flight(double u) noexcept {
  return smoothstep(0.0, 0.2, u) * (1.0 - smoothstep(0.8, 1.0, u));
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

// A flight as planned over its ground line.
struct Flight {
  std::array<FlightPoint, kProbes + 1> point;
  std::array<Sole, kProbes + 1> sole;
  Wanted left{};  // of the way along z
  Stretch begin, end;
  double begin_room = 0.0;
  double climb = 0.0;
};
Flight planned_flight(const Tick& tick, const WalkState& state, Side side) noexcept {
  const WalkModel& model = tick.model;
  const FootState& foot = state.foot[side];
  Flight flight;
  for (int i = 0; i <= kProbes; ++i) {
    const double u = static_cast<double>(i) / kProbes;
    flight.point[i] =
        flight_point(model, state, side, u, foot.pitch_fade.at(u * state.stage_ticks));
    flight.sole[i] = sole_of(model.leg[side], flight.point[i].pose);
    flight.left[i] = state.landing_m.z - flight.point[i].pose.heel_m.z;
  }
  flight.begin = piece_at(*model.terrain, foot.plane.place_m.z);
  flight.end = piece_at(*model.terrain, state.landing_m.z);
  flight.begin_room = kRoomAhead_m * model.size;  // as the pitch may still come out otherwise
  for (const vec3& p : flight.sole.front())
    flight.begin_room = std::min(
        {flight.begin_room, 0.7 * (flight.begin.to_m - p.z), 0.7 * (p.z - flight.begin.from_m)});
  flight.climb = climb(state, foot);
  return flight;
}

// How far the ground line has to rise for the sole, moved along z by `shift`.
Wanted wanted_raise(const Tick& tick, const Flight& flight, bool crosses_riser,
                    const FlightSpline& shift) noexcept {
  const Terrain& terrain = *tick.model.terrain;
  const double above_m = kRoomAbove_m * tick.model.size;
  Wanted above;
  for (int i = 0; i <= kProbes; ++i) {
    const double u = static_cast<double>(i) / kProbes, moved = spline_at(shift, 0.0, u);
    double over = -tick.model.leg_length_m;
    for (const vec3& p : flight.sole[i])
      over = std::max(
          over, ground_at(terrain, p.x, p.z + moved).height_m - base_under(flight.point[i], p));
    above[i] = crosses_riser ? over + above_m * in_flight(u)
                             : std::max(0.0, over) + std::clamp(over, 0.0, above_m);
  }
  above.front() = 0.0;
  above.back() = flight.climb;
  return above;
}

// Takes what leads towards the landing, in the second half of a flight, out of `beside`: it becomes
// a share of the way that is left, and one that only grows, so that the foot is over its landing
// early and sinks to it, it does not go beyond it and come back.
FlightSpline lead_in(const Flight& flight, Wanted& beside) noexcept {
  FlightSpline knots;
  double share = 0.0;
  for (int k = 1; k < kFlightKnots; ++k) {
    for (int i = kProbes / 2; i < std::min(kProbes, (k + 2) * kProbes / kFlightKnots); ++i) {
      if (beside[i] * flight.left[i] > 0.0)
        share = std::max(share, std::min(1.0, beside[i] / flight.left[i]));
    }
    knots[k - 1] = share * flight.left[k * kProbes / kFlightKnots];
  }
  for (int i = kProbes / 2; i < kProbes; ++i) {
    if (beside[i] * flight.left[i] > 0.0) beside[i] = 0.0;
  }
  return knots;
}

// Every flight that does not only lead down.
void plan_over(const Tick& tick, const WalkState& state, const FootState& foot,
               const Flight& flight, FlightRoom& room) noexcept {
  const double size = tick.model.size;
  const Terrain& terrain = *tick.model.terrain;
  const Wanted above = wanted_raise(tick, flight, foot.crosses_riser, FlightSpline{});
  Wanted beside{};
  // As gently as it does.
  Ends ends;
  for (int tries = 0; tries < kTries; ++tries) {
    room.raise_m = envelope(above, ends);
    for (int i = 1; i < kProbes; ++i) {
      beside[i] = 0.0;
      if (above[i] <= spline_at(room.raise_m, above.back(), static_cast<double>(i) / kProbes))
        continue;
      beside[i] = 2 * i < kProbes ? way_back(terrain, flight.sole[i], flight.begin,
                                             foot.plane.place_m.y, flight.begin_room, size)
                                  : way_back(terrain, flight.sole[i], flight.end, state.landing_m.y,
                                             kRoomBeside_m * size, size);
    }
    Wanted away = beside;
    room.shift_m = lead_in(flight, away);
    const FlightSpline back = wide_envelope(away, kMostShift_m * size);
    for (int k = 0; k < kFlightKnots - 1; ++k) room.shift_m[k] += back[k];
    if (!sharpen(beside, room.shift_m, size, ends)) break;
  }
}

// The smallest way on to where no part of the sole is before the landing's piece and over ground
// higher than the ground line with `raise`.
double way_on(const Tick& tick, const Flight& flight, int i, double raise) noexcept {
  const Terrain& terrain = *tick.model.terrain;
  const double room = kRoomBeside_m * tick.model.size, least = kLeastWanted_m * tick.model.size;
  const bool ahead = flight.left[i] > 0.0;
  double on = 0.0;
  for (int risers = 0; risers < kMostRisers; ++risers) {
    for (const vec3& p : flight.sole[i]) {
      const double z = p.z + on;
      if (ahead ? z >= flight.end.from_m : z <= flight.end.to_m) continue;
      if (ground_at(terrain, p.x, z).height_m <= base_under(flight.point[i], p) + raise + least)
        continue;
      const Stretch piece = piece_at(terrain, z);
      on += ahead ? piece.to_m + room - z : piece.from_m - room - z;
    }
  }
  return on;
}

// Of each knot along the flight.
constexpr auto kKnotWeights = [] {
  std::array<Wanted, kFlightKnots - 1> weights;
  for (int k = 0; k < kFlightKnots - 1; ++k) {
    FlightSpline alone{};
    alone[k] = 1.0;
    for (int i = 0; i <= kProbes; ++i)
      weights[k][i] = spline_at(alone, 0.0, static_cast<double>(i) / kProbes);
  }
  return weights;
}();

// Draws the inner knots to a taut line over what is wanted, less some of its room: the envelope
// alone holds each height for two knots longer than needed. Where the spline lacks more already, it
// sinks no further.
void draw_taut(const Wanted& wanted, double room_m, FlightSpline& knots) noexcept {
  Wanted slack;
  for (int i = 0; i <= kProbes; ++i) {
    const double u = static_cast<double>(i) / kProbes;
    const double spare = (1.0 - kTautRoom) * room_m * in_flight(u);
    slack[i] = std::max(0.0, spline_at(knots, wanted.back(), u) - wanted[i] + spare);
  }
  for (int round = 0; round < kTautRounds; ++round) {
    for (int k = kFlightKnots - 3; k > 0; --k) {
      const Wanted& weight = kKnotWeights[k];
      double fall = knots[k] - 0.5 * (knots[k - 1] + knots[k + 1]);
      for (int i = 0; i <= kProbes; ++i) {
        if (weight[i] > kLeastWeight) fall = std::min(fall, slack[i] / weight[i]);
      }
      knots[k] -= fall;
      for (int i = 0; i <= kProbes; ++i) slack[i] -= fall * weight[i];
    }
  }
}

// Over risers that all lead down.
bool leads_down(const Tick& tick, const Flight& flight) noexcept {
  if (flight.climb > -kRiser_m) return false;
  const Wanted above = wanted_raise(tick, flight, true, FlightSpline{});
  return *std::max_element(above.begin(), above.end()) < kRoomAbove_m * tick.model.size + kRiser_m;
}

// As much ahead of its own way as brings the foot over its landing's piece in time: a growing share
// of what is left, as in lead_in().
FlightSpline early_lead(const Tick& tick, const Flight& flight) noexcept {
  constexpr int over = static_cast<int>(kOver * kProbes);
  const double left = flight.left[over];
  const double needed =
      std::abs(left) < kLeastLeft_m ? 0.0 : way_on(tick, flight, over, flight.climb) / left;
  const double share = std::clamp(needed, 0.0, 1.0);
  FlightSpline knots;
  for (int k = 1; k < kFlightKnots; ++k) {
    knots[k - 1] = share * smoothstep(0.0, kOver, static_cast<double>(k) / kFlightKnots) *
                   flight.left[k * kProbes / kFlightKnots];
  }
  return knots;
}

// Ahead of its own way the foot sinks as soon as an edge is behind it.
void plan_down(const Tick& tick, const Flight& flight, FlightRoom& room) noexcept {
  room.shift_m = early_lead(tick, flight);
  const Wanted above = wanted_raise(tick, flight, true, room.shift_m);
  room.raise_m = envelope(above, Ends{});
  draw_taut(above, kRoomAbove_m * tick.model.size, room.raise_m);
}

}  // namespace

void plan_room(const Tick& tick, WalkState& state, Side side) noexcept {
  FootState& foot = state.foot[side];
  FlightRoom& room = foot.room;
  room.planned_for_m = state.landing_m;
  const Flight flight = planned_flight(tick, state, side);
  if (leads_down(tick, flight)) {
    plan_down(tick, flight, room);
  } else {
    plan_over(tick, state, foot, flight, room);
  }
  if (foot.mode_ticks != 0) return;
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
