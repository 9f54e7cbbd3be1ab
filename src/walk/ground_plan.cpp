// Footholds. Risers cut the ground into pieces, and a foot stands on one piece. For each piece
// between the wanted place and the standing foot's, a cost says how much the step would have to
// become longer, shorter, higher or more sideways, and whether the sole would overhang an edge. The
// cheapest piece wins; on it the heel goes as near to the wanted place as the room for the sole
// allows. The foot then gets a plane: the ground's best fit under its sole.
//
// Flights. A flight is planned over a ground line from one foothold's height to the other's. If
// ground rises above this line, a B-spline raises it: its control points are the greatest heights
// of the ground under the sole in their neighbourhood. At a riser close to a foothold a second
// spline moves the foot along z, away from the riser, and as far along the standing foot as this
// needs (move_along_z()); down stairs it moves the foot ahead, and the first spline is drawn taut
// over the edges, so that the foot sinks early. Where such a move would still bring the foot to the
// standing one, the first spline raises it over the riser instead.
#include "walk/ground_plan.h"

#include "animation/floor.h"
#include "walk/feet.h"

namespace gaitpad {
namespace {

// The step frame in the walk's own coordinates.
struct Frame {
  vec3 at_m;
  double heading_rad, sine, cosine;
  explicit Frame(const Origin& origin) noexcept
      : at_m(origin.x_m, origin.y_m, origin.z_m), heading_rad(origin.heading_rad) {
    const SinCos s = gaitpad::sin_cos(wrapped(origin.heading_rad));
    sine = s.sin, cosine = s.cos;
  }
  // A direction or a place in the step frame, in the walk's own coordinates.
  vec3 way(const vec3& v) const noexcept {
    return vec3(cosine * v.x + sine * v.z, v.y, cosine * v.z - sine * v.x);
  }
  vec3 out(const vec3& place) const noexcept { return at_m + way(place); }
  // A place or a slope in the walk's own coordinates, in the step frame.
  vec3 in(const vec3& place) const noexcept {
    const vec3 v = place - at_m;
    return vec3(cosine * v.x - sine * v.z, v.y, cosine * v.z + sine * v.x);
  }
  Slope<float> in(double x, double z) const noexcept {
    return {static_cast<float>(cosine * x - sine * z), static_cast<float>(cosine * z + sine * x)};
  }
};

// --- Footholds -----------------------------------------------------------------------------------

constexpr double kLeastStep = 0.05;  // in legs: shorter steps count as this long
constexpr double kBeside_m = 1e-6;   // a place so near to a riser is certainly on one side of it
constexpr double kLeast = 1e-6;      // metres or weights: not to divide by 0

// The reach of the sole along z from its heel point.
struct Extent {
  double back_m = 0.0, front_m = 0.0;
  double middle_m() const noexcept { return 0.5 * (back_m + front_m); }
};
Extent sole_extent(const LegBones& leg, double yaw_rad) noexcept {
  const quat yaw = rotation_y(yaw_rad);
  const double tip = (yaw * (wide(leg.tip_m) - wide(leg.heel_m))).z;
  const double half = std::abs((yaw * wide(leg.side)).z) * leg.half_width_m;
  return {std::min(0.0, tip) - half, std::max(0.0, tip) + half};
}

// The places along z at which the heel may stand on a piece, and by how much the piece is too short
// for the sole.
struct Room {
  double low_m, high_m, lacks_m;
};
Room room_on(const Stretch& piece, const Extent& sole, double leg_m) noexcept {
  // The sole keeps kEdgeRoom legs away from an edge, but gives up at most this share of its room.
  constexpr double kEdgeRoom = 0.05, kMostEdgeShare = 0.3;
  const double low = piece.from_m - sole.back_m, high = piece.to_m - sole.front_m;
  if (high < low) return {0.5 * (low + high), 0.5 * (low + high), low - high};
  const double edge = std::min(kEdgeRoom * leg_m, kMostEdgeShare * (high - low));
  return {low + edge, high - edge, 0.0};
}

// A step for which a foothold is chosen.
struct Step {
  vec3 from_m{0.0}, lift_m{0.0};  // heels of the standing and of the flying foot
  Stretch stands, lifts;          // their pieces
  vec3 forward{0.0, 0.0, 1.0}, wanted_m{0.0};
  double leg_m = 0.0;
  bool is_right = false;  // the flying foot
  Extent sole;
  // How far a place is on the flying foot's side of the standing foot.
  double aside_m(const vec3& place) const noexcept {
    return glm::dot(place - from_m, glm::cross(is_right ? -kUp : kUp, forward));
  }
  double length_m() const noexcept { return glm::dot(wanted_m - from_m, forward); }
};

// The longest step over a riser, counted from the foot that stands and over the whole way of the
// foot that flies: that foot has to rise before it may go forward.
double longest_to(const Step& step, const Stretch& piece) noexcept {
  // In legs: the longest step, the longest way of the flying foot, and the least that this way
  // leaves to a step.
  constexpr double kCrossStep = 0.5, kCrossWay = 0.85, kLeastCross = 0.25;
  double longest = std::numeric_limits<double>::infinity();
  const double sign = step.length_m() < 0.0 ? -1.0 : 1.0;
  if (piece.from_m != step.stands.from_m) longest = kCrossStep * step.leg_m;
  if (piece.from_m != step.lifts.from_m) {
    const double gone = sign * glm::dot(step.from_m - step.lift_m, step.forward);
    longest = std::min(longest, std::max(kLeastCross, kCrossWay - gone / step.leg_m) * step.leg_m);
  }
  return longest;
}
vec3 wanted_on(const Step& step, const Stretch& piece) noexcept {
  const double wanted = step.length_m(), longest = longest_to(step, piece);
  return step.wanted_m + step.forward * (std::clamp(wanted, -longest, longest) - wanted);
}

// The cheapest move that shifts a place by `dz_m` along z.
vec3 shifted(const Step& step, double dz_m) noexcept {
  const vec3& f = step.forward;
  const vec3 left = glm::cross(kUp, f);
  return (f * f.z + left * (left.z * kMoveAhead)) *
         (dz_m / (f.z * f.z + left.z * left.z * kMoveAhead));
}
vec3 place_on(const Step& step, const Stretch& piece) noexcept {
  const Room room = room_on(piece, step.sole, step.leg_m);
  const vec3 near = wanted_on(step, piece);
  return near + shifted(step, std::clamp(near.z, room.low_m, room.high_m) - near.z);
}

// True if a step of this length would hardly leave its place although a longer one is wanted.
bool is_stuck(const Step& step, double length_m) noexcept {
  constexpr double kStuck = 0.3;  // share of the wanted length
  const double wanted = step.length_m(), sign = wanted < 0.0 ? -1.0 : 1.0;
  return sign * wanted > kLeastStep * step.leg_m && sign * length_m < kStuck * sign * wanted;
}

// By how much a place is nearer to the standing foot's line than feet need, if the wanted one is
// not.
double crowds_m(const Step& step, const Stretch& piece) noexcept {
  constexpr double kFeetApart = 0.12;  // in legs
  const double wanted = step.aside_m(wanted_on(step, piece));
  return std::max(0.0,
                  std::min(kFeetApart * step.leg_m, wanted) - step.aside_m(place_on(step, piece)));
}

// About the logarithm of the factor by which a piece lengthens or shortens the step, and costs of a
// step that goes aside, is stuck in place, becomes long, comes to the standing foot's line, rises
// or overhangs an edge.
double cost_of(const Floor& floor, const Step& step, const Stretch& piece) noexcept {
  // Costs of being stuck, and for each leg aside, beyond a long step, nearer to the standing foot's
  // line than feet need, beyond an easy rise, beyond the highest rise, and of an overhang.
  constexpr double kStuckCosts = 2.0, kAside = 3.0, kLongCosts = 10.0, kNearCosts = 20.0,
                   kRiseCosts = 10.0, kTooHigh = 100.0, kOverhang = 30.0;
  constexpr double kLongStep = 0.6, kEasyRise = 0.22;  // in legs
  const vec3 place = place_on(step, piece), move = place - wanted_on(step, piece);
  const double middle =
      std::clamp(place.z + step.sole.middle_m(), piece.from_m + kBeside_m, piece.to_m - kBeside_m);
  const double rise =
      std::abs(ground_at(floor, place.x, middle).height_m - step.from_m.y) / step.leg_m;
  const double wanted = step.length_m(), length = glm::dot(place - step.from_m, step.forward),
               sign = wanted < 0.0 ? -1.0 : 1.0;
  const double least = kLeastStep * step.leg_m;
  const double ratio = std::max(0.0, sign * length + least) / (sign * wanted + least);
  const double aside = std::abs(glm::dot(move, glm::cross(kUp, step.forward))) / step.leg_m;
  const double longer = sign * length - std::min(longest_to(step, piece),
                                                 std::max(sign * wanted, kLongStep * step.leg_m));
  return 2.0 * std::abs(1.0 - ratio) / (1.0 + ratio) + kAside * aside +
         kNearCosts * crowds_m(step, piece) / step.leg_m +
         (is_stuck(step, length) ? kStuckCosts : 0.0) +
         kLongCosts * std::max(0.0, longer) / step.leg_m +
         kRiseCosts * std::max(0.0, rise - kEasyRise) + kTooHigh * std::max(0.0, rise - kMostRise) +
         kOverhang * room_on(piece, step.sole, step.leg_m).lacks_m / step.leg_m;
}

// Tries the pieces from the one of the wanted place back to the standing foot's. If both are the
// same piece, and its edge stops the step, it also tries the piece beyond this edge; also if the
// edge brings the feet together and the flying foot comes from that piece.
Stretch best_piece(const Floor& floor, const Step& step, const Stretch* settled) noexcept {
  constexpr int kMostPieces = 8;  // compared
  constexpr double kStay = 0.1;   // cost by which another piece than `settled` has to be cheaper
  const double middle = step.sole.middle_m(), stands = step.from_m.z + middle;
  Stretch piece = piece_at(floor, step.wanted_m.z + middle), best = piece;
  if (piece.from_m == step.stands.from_m) {
    const Room room = room_on(piece, step.sole, step.leg_m);
    const double z = std::clamp(step.wanted_m.z, room.low_m, room.high_m), dz = z - step.wanted_m.z;
    const Stretch beyond =
        piece_at(floor, dz > 0.0 ? piece.from_m - kBeside_m : piece.to_m + kBeside_m);
    const bool stays = beyond.from_m == step.lifts.from_m && crowds_m(step, piece) > 0.0;
    if (stays || is_stuck(step, step.length_m() + step.forward.z * dz)) piece = beyond;
  }
  double least = std::numeric_limits<double>::infinity();
  for (int n = 0; n < kMostPieces; ++n) {
    double cost = cost_of(floor, step, piece);
    if (settled && piece.from_m == settled->from_m) cost -= kStay;
    if (cost < least) {
      least = cost;
      best = piece;
    }
    if (stands < piece.from_m) {
      piece = piece_at(floor, piece.from_m - kBeside_m);
    } else if (stands > piece.to_m) {
      piece = piece_at(floor, piece.to_m + kBeside_m);
    } else {
      break;
    }
  }
  return best;
}

// The share of its length that a step keeps on a slope: 1 / (1 + grade).
double slope_share(const Floor& floor, const Step& step) noexcept {
  const double length = horizontal_length(step.wanted_m - step.from_m);
  if (length < kLeast || step.wanted_m.z < step.stands.from_m || step.wanted_m.z > step.stands.to_m)
    return 1.0;
  const double rise = ground_at(floor, step.wanted_m.x, step.wanted_m.z).height_m - step.from_m.y;
  return 1.0 / (1.0 + std::abs(rise) / length);
}

// A plane through a heel's place.
struct Plane {
  vec3 place_m;
  double slope_x = 0.0, slope_z = 0.0;
};

// The directions and points of a sole that stands level.
struct Track {
  vec3 along, across;  // unit
  double length_m;     // from the heel to the tip
  vec3 ball_m, tip_m;  // from the heel
};
Track track_of(const LegBones& leg, double yaw_rad) noexcept {
  const quat yaw = rotation_y(yaw_rad);
  Track track;
  track.ball_m = yaw * (wide(leg.ball_m) - wide(leg.heel_m));
  track.tip_m = yaw * (wide(leg.tip_m) - wide(leg.heel_m));
  track.across = yaw * wide(leg.side);
  track.length_m = horizontal_length(track.tip_m);
  track.along = vec3(track.tip_m.x, 0.0, track.tip_m.z) / track.length_m;
  return track;
}
Plane plane_of(const vec3& place_m, const Track& track, double grade, double bank) noexcept {
  return {place_m, track.along.x * grade + track.across.x * bank,
          track.along.z * grade + track.across.z * bank};
}

// The plane on which heel and ball of a sole lie on the ground of a game exactly: a game draws its
// ground, and a foot is seen beside it. Across, the plane is the best fit under heel and tip.
Plane plane_through(const Floor& floor, const LegBones& leg, const vec3& heel_m,
                    double yaw_rad) noexcept {
  // The ball moves as the plane tilts; each round leaves a tenth of its error or less.
  constexpr int kRounds = 3;
  Track track = track_of(leg, yaw_rad);
  const double length = horizontal_length(track.ball_m), half = leg.half_width_m;
  track.along = vec3(track.ball_m.x, 0.0, track.ball_m.z) / length;
  const vec3 side = track.across * half;
  const std::array<double, 6> ground =
      heights_at<6>(floor, {heel_m, heel_m + track.ball_m, heel_m + side, heel_m - side,
                            heel_m + track.tip_m + side, heel_m + track.tip_m - side});
  const double bank = (ground[2] - ground[3] + ground[4] - ground[5]) / (4.0 * half);
  double grade = (ground[1] - ground[0]) / length;
  const vec3 place(heel_m.x, ground[0], heel_m.z);
  for (int round = 0; round < kRounds; ++round) {
    const vec3 normal = glm::normalize(kUp - track.along * grade - track.across * bank);
    const vec3 lies = place + rotation_between(kUp, normal) * track.ball_m;
    grade += (ground_at(floor, lies.x, lies.z).height_m - lies.y) / length;
  }
  return plane_of(place, track, grade, bank);
}

// The best fit to the ground under a sole: the ground is as far above the plane as below it. It
// ignores ground beyond the risers around `piece`.
Plane plane_under(const Floor& floor, const LegBones& leg, const vec3& heel_m, double yaw_rad,
                  const Stretch& piece) noexcept {
  if (floor.terrain.asked.ask != nullptr) return plane_through(floor, leg, heel_m, yaw_rad);
  const Track track = track_of(leg, yaw_rad);
  const double length = track.length_m, half = leg.half_width_m;
  const auto height = [&](double a, double c) {  // of the ground, shares of length and half width
    const vec3 p = heel_m + track.along * (a * length) + track.across * (c * half);
    return ground_at(floor, p.x, std::clamp(p.z, piece.from_m + kBeside_m, piece.to_m - kBeside_m))
        .height_m;
  };
  const std::array<double, 4> corner = {height(0, 1), height(0, -1), height(1, 1), height(1, -1)};
  const double grade = (corner[2] + corner[3] - corner[0] - corner[1]) / (2.0 * length);
  const double bank = (corner[0] - corner[1] + corner[2] - corner[3]) / (4.0 * half);
  const double middle = 0.25 * (corner[0] + corner[1] + corner[2] + corner[3]);
  double low = 0.0, high = 0.0;  // of the ground over the plane through the corners
  const auto compare = [&](double a, double c, double y) {
    const double over = y - (middle + grade * (a - 0.5) * length + bank * c * half);
    low = std::min(low, over);
    high = std::max(high, over);
  };
  compare(0, 1, corner[0]);
  compare(0, -1, corner[1]);
  compare(1, 1, corner[2]);
  compare(1, -1, corner[3]);
  for (const double a : {0.0, 0.35, 0.7, 1.0}) compare(a, 0, height(a, 0));
  const double y_m = middle - grade * 0.5 * length + 0.5 * (low + high);
  return plane_of(vec3(heel_m.x, y_m, heel_m.z), track, grade, bank);
}

// The rise of the step after the landing, in legs, which makes a step on stairs longer in time: the
// rise to the next landing or the rest of the flying foot's rise, whichever is greater.
double next_rise(const Tables& tables, const Floor& floor, const Step& landing,
                 const vec3& landing_m, const Stretch& piece, double length_m, const vec3& across_m,
                 double middle_m) noexcept {
  Step step = landing;
  step.lift_m = landing.from_m;
  step.lifts = landing.stands;
  step.is_right = !landing.is_right;
  step.from_m = landing_m;
  step.stands = piece;
  step.wanted_m = step.from_m + step.forward * length_m - across_m;
  const vec3 place = place_on(step, best_piece(floor, step, nullptr));
  const vec3 middle =
      place + (tables.terrain->asked.ask == nullptr ? kForward * step.sole.middle_m()
                                                    : step.forward * middle_m);
  const double next_m = ground_at(floor, middle.x, middle.z).height_m;
  const double step_m = std::abs(next_m - landing_m.y), way_m = std::abs(next_m - landing.from_m.y);
  return std::max(step_m, way_m - step_m) / tables.leg_m;
}

}  // namespace

void choose_foothold(const Tables& tables, const AskedFoothold& asked, Block<1>& block) noexcept {
  const State<float>& state = block.state;
  Footing<float>& footing = block.footing;
  const Frame frame(block.origin[0]);
  const Floor floor{*tables.terrain, block.placed[0]};
  const int swing = state.right_swings != 0.0f ? 1 : 0;
  const LegBones& leg = tables.leg[swing];
  Step step;
  step.from_m = frame.at_m;
  step.lift_m = frame.out(vec3(state.print_x_m, footing.print_y_m, state.print_z_m));
  step.stands = piece_at(floor, step.from_m.z);
  step.lifts = piece_at(floor, step.lift_m.z);
  const vec3 along(asked.sine, 0.0, asked.cosine);
  step.forward = frame.way(along);
  step.leg_m = tables.leg_m;
  step.is_right = swing == 1;
  const double yaw = state.landing_rad + frame.heading_rad, length = asked.length_m;
  step.sole = sole_extent(leg, yaw);
  const vec3 level(footing.level_x_m, 0.0, footing.level_z_m),
      across_m = frame.way(level - along * length);
  const auto wanted = [&] {
    return step.from_m + step.forward * (length * footing.share) + across_m;
  };
  if (state.flies == 0.0f) {
    footing.share = 1.0f;
    step.wanted_m = wanted();
    footing.share = static_cast<float>(slope_share(floor, step));
  }
  step.wanted_m = wanted();
  Stretch& piece = block.piece[0];
  if (asked.settles) piece = best_piece(floor, step, asked.begins ? nullptr : &piece);
  footing.overhangs = room_on(piece, step.sole, step.leg_m).lacks_m > 0.0 ? 1.0f : 0.0f;
  const Plane plane = plane_under(floor, leg, place_on(step, piece), yaw, piece);
  const vec3 landing = frame.in(plane.place_m);
  if (state.flies == 0.0f || asked.settles)
    footing.crosses = piece_at(floor, plane.place_m.z).from_m != step.lifts.from_m ? 1.0f : 0.0f;
  block.state.landing_x_m = static_cast<float>(landing.x);
  block.state.landing_z_m = static_cast<float>(landing.z);
  footing.landing_y_m = static_cast<float>(landing.y);
  footing.landing = frame.in(plane.slope_x, plane.slope_z);
  const double way = state.backward != 0.0f ? -1.0 : 1.0,
               next_m = asked.goes_on ? way * state.length_m[1 - swing].x * footing.share : 0.0;
  footing.next_rise =
      static_cast<float>(next_rise(tables, floor, step, plane.place_m, piece, next_m, across_m,
                                   sole_extent(leg, yaw - heading_of(step.forward)).middle_m()));
}

StandingPlace standing_place(const Tables& tables, const Placement& placed, int side,
                             const vec3& heel_m, double heading_rad) noexcept {
  const LegBones& leg = tables.leg[side];
  const Floor floor{*tables.terrain, placed};
  Step step;
  step.wanted_m = step.from_m = step.lift_m = heel_m;
  step.leg_m = tables.leg_m;
  step.sole = sole_extent(leg, heading_rad);
  const Stretch piece = piece_at(floor, heel_m.z + step.sole.middle_m());
  const Plane plane = plane_under(floor, leg, place_on(step, piece), heading_rad, piece);
  const Frame frame(Origin{plane.place_m.x, plane.place_m.z, heading_rad, plane.place_m.y});
  return {plane.place_m, frame.in(plane.slope_x, plane.slope_z)};
}

double ground_height(const Tables& tables, const Placement& placed, const vec3& place_m) noexcept {
  if (tables.terrain == nullptr) return 0.0;
  return ground_at(Floor{*tables.terrain, placed}, place_m.x, place_m.z).height_m;
}

namespace {

// --- Flights over the ground between two footholds -----------------------------------------------

constexpr int kProbes = 48;                     // along a flight
constexpr int kKnotsOfFlight = kRoomKnots + 1;  // intervals between knots
// Metres at the reference leg. The room that a sole keeps above the ground, beside a riser where it
// lands and beside one where it lifts off; the height from which on a step of the ground counts.
constexpr double kRoomAbove_m = 0.025, kRoomBeside_m = 0.005, kRoomAhead_m = 0.016;
constexpr double kRiser_m = 0.01;
constexpr double kMostShift_m = 0.30;     // along z
constexpr double kLeastWanted_m = 0.004;  // smaller shifts and heights are ignored
constexpr double kOver = 0.685;  // share of a flight down at which it is over its landing's piece

double share_at(int probe) noexcept { return static_cast<double>(probe) / kProbes; }

using Spline = std::array<double, kRoomKnots>;
double spline_of(const Spline& knots, double end, double u) noexcept {
  return spline_at(knots.data(), end, u);
}
double weight_of(int knot, double u) noexcept {
  Spline alone{};
  alone[knot] = 1.0;
  return spline_of(alone, 0.0, u);
}
// 1 in mid-flight, 0 at its ends.
double in_flight(double u) noexcept {
  return gaitpad::smoothstep(0.0, 0.2, u) * (1.0 - gaitpad::smoothstep(0.8, 1.0, u));
}

// A value wanted at each probe of the flight.
using Wanted = std::array<double, kProbes + 1>;

// The outer knots as shares of their neighbours: the smaller, the gentler the spline's ends.
struct Ends {
  double first = 0.2, last = 0.2;
};

// Each knot is the greatest wanted value within its reach. The outer ones are bounded, so that the
// spline ends gently.
Spline envelope(const Wanted& wanted, const Ends& ends) noexcept {
  Spline knots;
  for (int k = 1; k < kKnotsOfFlight; ++k) {
    double& knot = knots[k - 1];
    knot = wanted[k * kProbes / kKnotsOfFlight];
    for (int i = 0; i <= kProbes; ++i) {
      if (std::abs(i * kKnotsOfFlight - k * kProbes) < 2 * kProbes)
        knot = std::max(knot, wanted[i]);
    }
  }
  const auto gentle = [](double knot, double end, double next, double share) {
    const double most_off = share * std::abs(next - end);
    return std::clamp(knot, end - most_off, end + most_off);
  };
  knots.front() = gentle(knots.front(), 0.0, knots[1], ends.first);
  knots.back() = gentle(knots.back(), wanted.back(), knots[kKnotsOfFlight - 3], ends.last);
  return knots;
}

// The same for values of both signs. If the spline falls short of them, a gain multiplies all of
// it; no knot exceeds kMostShift_m.
Spline wide_envelope(const Wanted& wanted, double size) noexcept {
  constexpr double kMostGain = 6.0;
  Wanted positive, negative;
  for (int i = 0; i <= kProbes; ++i) {
    positive[i] = std::max(0.0, wanted[i]);
    negative[i] = std::max(0.0, -wanted[i]);
  }
  Spline knots = envelope(positive, Ends{});
  const Spline other = envelope(negative, Ends{});
  for (int k = 0; k < kRoomKnots; ++k) knots[k] -= other[k];
  double gain = 1.0;
  for (int i = 1; i < kProbes; ++i) {
    if (std::abs(wanted[i]) < kLeastWanted_m) continue;
    const double got = spline_of(knots, 0.0, share_at(i));
    gain = std::max(gain, got * wanted[i] > 0.0 ? wanted[i] / got : 1.0);
  }
  for (double& knot : knots)
    knot = std::clamp(knot * std::min(gain, kMostGain), -kMostShift_m * size, kMostShift_m * size);
  return knots;
}

// Sharpens an end if the sideways shift there is too large or was not reached; returns false if
// neither end changed.
bool sharpen(const Wanted& beside, const Spline& shift, double size, Ends& ends) noexcept {
  constexpr double kLack_m = 0.006, kEasyShift_m = 0.2;  // at the reference leg
  // The factor on an end. The lift-off stays gentler, for there the leg is stretched.
  constexpr double kSharper = 1.5, kMostSharp = 0.38;
  Ends more = ends;
  for (int i = 1; i < kProbes; ++i) {
    const double got = spline_of(shift, 0.0, share_at(i));
    const double lack = beside[i] > 0.0 ? beside[i] - got : beside[i] < 0.0 ? got - beside[i] : 0.0;
    if (lack < kLack_m * size && std::abs(beside[i]) < kEasyShift_m * size) continue;
    if (2 * i < kProbes) {
      more.first = std::min(kMostSharp, kSharper * ends.first);
    } else {
      more.last = kSharper * ends.last;
    }
  }
  const bool changed = more.first > ends.first || more.last > ends.last;
  ends = more;
  return changed;
}

// Points of a sole in the walk's own coordinates: the sides of heel, ball and tip. A foot that
// flies along a riser is in it with the ball's side first.
using SolePoints = std::array<vec3, 6>;

// A flight as planned over its ground line.
struct PlannedFlight {
  std::array<SolePoints, kProbes + 1> sole;
  std::array<SolePoints, kProbes + 1> base;  // the ground line's plane below each of them
  Wanted left{};                             // the way along z that is left to the landing
  vec3 away{0.0};                            // the move that shifts a foot by a metre along z
  Stretch begin, end;
  double begin_room = 0.0, begin_m = 0.0, end_m = 0.0, climb = 0.0;
  // Where the standing foot is in the way beside a riser, the flight goes over the riser until this
  // probe, at which it has passed that foot.
  int over_until = 0;
  bool sinks = false;  // from there on, to a lower landing
  // A flight that ends on its own piece goes beside a riser, not over it.
  bool stays() const noexcept { return begin.from_m == end.from_m && over_until == 0; }
};

void set_points(const LegBones& leg, const Frame& frame, const Flight<float>& flight,
                const Foot<float>& foot, SolePoints& points, SolePoints& base) noexcept {
  const Vec<float> side{leg.side[0], leg.side[1], leg.side[2]};
  const auto place = [](const std::array<float, 3>& v, const std::array<float, 3>& from) {
    return Vec<float>{v[0] - from[0], v[1] - from[1], v[2] - from[2]};
  };
  const Turn<float> toes =
      foot.turn * (back(foot.edge) * turn_about(side, -std::max(0.0f, foot.pitch_rad)));
  const Vec<float> half = (foot.turn * side) * leg.half_width_m,
                   ball = foot.heel_m + foot.turn * place(leg.ball_m, leg.heel_m),
                   tip = foot.toe_m + toes * place(leg.tip_m, leg.toe_m);
  const std::array<Vec<float>, 6> local = {foot.heel_m - half, foot.heel_m + half, ball - half,
                                           ball + half,        tip - half,         tip + half};
  const Vec<float> n = flight.tilt * Vec<float>{0.0f, 1.0f, 0.0f};
  for (std::size_t k = 0; k < local.size(); ++k) {
    points[k] = frame.out(wide(local[k]));
    const float line_m =
        flight.base_m -
        (n.x * (local[k].x - foot.heel_m.x) + n.z * (local[k].z - foot.heel_m.z)) / n.y;
    base[k] = vec3(points[k].x, frame.at_m.y + line_m, points[k].z);
  }
}

PlannedFlight planned_flight(const Tables& tables, const Floor& floor, const Frame& frame,
                             const Block<1>& block) noexcept {
  const State<float>& state = block.state;
  Change<float> change = block.change;
  const Footing<float>& footing = block.footing;
  Time<float> time = time_of(tables, state);
  const Way<float> to = way_of(state.landing_rad);
  Landing<float> landing;
  Hips<float> hips;
  hips.behind = footprints_of(tables, time, state.ratio_behind);
  const auto read_ratio = [&] {
    landing = landing_over(tables, time, to, change, state, footing);
    hips.ahead = footprints_of(tables, time, landing.ratio);
    hips.own = footprints_of(tables, time, short_ratio(tables, landing, change, state));
  };
  read_ratio();
  const float left = state.flight_ticks - state.tick;
  const PhaseCubic<float> moves(time.stage_end - state.phase, state.phase_rate * left,
                                state.end_rate * left);
  const vec3 lands = frame.out(vec3(landing.x_m, footing.landing_y_m, landing.z_m)),
             print = frame.out(vec3(state.print_x_m, footing.print_y_m, state.print_z_m));
  const LegBones& leg = tables.leg[time.right ? 1 : 0];
  PlannedFlight flight;
  float seen_tick = state.tick;
  for (int i = 0; i <= kProbes; ++i) {
    // Skip the part of the flight before a change of plan.
    time.u = std::max(static_cast<float>(i) / kProbes, change.gap_begin);
    // The difference of the ratio from before a change of plan fades on the way.
    const float tick = time.u * state.flight_ticks, s = (tick - state.tick) / left,
                off_ratio = change.off_ratio.x;
    for (; seen_tick < tick && change.off_ratio.x != 0.0f; seen_tick += 1.0f) {
      fade(least(change.off_ticks, state.flight_ticks - seen_tick), change.off_ratio);
      change.off_ticks -= 1.0f;
    }
    if (change.off_ratio.x != off_ratio) read_ratio();
    const float phase = state.phase + moves.at(s);
    time.share = (state.roll_ticks + tick) / (state.roll_ticks + state.flight_ticks);
    const Stride<float> stride = read_by_clock(tables, time, landing, phase, time.share, time.u,
                                               Reads<float>{true, false}, change, state);
    const Sole<float> sole = sole_of<float>(tables, time.right);
    const Flight<float> flies =
        fly(tables, time, landing, stride, stride, hips, phase, sole, change, state, footing);
    const float off = pitch_off(time, tick, change, state);
    Foot<float> foot;
    const float low = low_pitch(low_lift<float>(time.right, state), time.u);
    // After a change of plan toes are as free as if the foot were still as high over its old line.
    Flight<float> over = flies;
    over.base_m +=
        gap_left(time.u, footing.gap_line_m, change) + gap_left(time.u, footing.gap_room_m, change);
    pitch_in_flight(time, sole, over, low * stride.foot[0].pitch_rad + off, off, change, state,
                    footing, foot);
    set_points(leg, frame, flies, foot, flight.sole[i], flight.base[i]);
    flight.left[i] = lands.z - frame.out(wide(flies.heel_m)).z;
  }
  const Vec<float> away = move_along_z<float>(way_of_half(state.frame_sine, state.frame_cosine));
  flight.away = frame.way(wide(away));
  flight.begin = piece_at(floor, print.z);
  flight.end = piece_at(floor, lands.z);
  flight.begin_m = print.y, flight.end_m = lands.y;
  flight.begin_room = kRoomAhead_m * tables.size;  // generous: the pitch may still change
  constexpr double kRoomTaken = 0.7;  // of the room that the sole has before its lift-off
  for (const vec3& p : flight.sole.front())
    flight.begin_room = std::min({flight.begin_room, kRoomTaken * (flight.begin.to_m - p.z),
                                  kRoomTaken * (p.z - flight.begin.from_m)});
  flight.climb = climb_over_risers(footing);
  return flight;
}

// The risers of which a sole keeps clear: both of its piece, or the one behind its lift-off and the
// one ahead of its landing.
enum class Risers { both, of_flight };
// The move along z with which no part of the sole is inside a riser that leads up from the piece of
// the lift-off, and in the second half of the flight from that of the landing.
double way_back(const Floor& floor, const PlannedFlight& flight, int probe, double size,
                Risers risers) noexcept {
  const bool early = 2 * probe < kProbes, forwards = flight.left.front() >= 0.0,
             both = risers == Risers::both;
  const Stretch& piece = early ? flight.begin : flight.end;
  const double high_m = (early ? flight.begin_m : flight.end_m) + kRiser_m,
               room = early ? flight.begin_room : kRoomBeside_m * size;
  const auto leads_up = [&](double x, double edge, double beyond) {
    return std::isfinite(edge) && ground_at(floor, x, edge + beyond).height_m > high_m;
  };
  double shift = 0.0;
  for (const vec3& p : flight.sole[probe]) {
    if ((both || early != forwards) && leads_up(p.x, piece.to_m, kRiser_m))
      shift = std::min(shift, piece.to_m - room - p.z);
    if ((both || early == forwards) && leads_up(p.x, piece.from_m, -kRiser_m))
      shift = std::max(shift, piece.from_m + room - p.z);
  }
  return std::clamp(shift, -kMostShift_m * size, kMostShift_m * size);
}

// Moves a flight so far along z that its sole keeps clear of the riser behind it where it lifts
// off, and of the one ahead of its landing: over a riser that it only touches it would be raised as
// high as over one that it crosses. Returns the move's spline.
Spline keep_clear(const Floor& floor, double size, PlannedFlight& flight) noexcept {
  constexpr double kTouches_m = 0.06;  // at the reference leg: a sole that is farther in crosses
  Wanted away{};
  bool touches = false;
  for (int i = 1; i < kProbes; ++i) {
    const double move = way_back(floor, flight, i, size, Risers::of_flight);
    if (std::abs(move) < kTouches_m * size) away[i] = move;
    touches |= std::abs(away[i]) > kLeastWanted_m * size;
  }
  if (!touches) return {};
  const Spline moves = wide_envelope(away, size);
  for (int i = 0; i <= kProbes; ++i) {
    const double moved = spline_of(moves, 0.0, share_at(i));
    for (vec3& p : flight.sole[i]) p += flight.away * moved;
    for (vec3& p : flight.base[i]) p += flight.away * moved;
    flight.left[i] -= moved;
  }
  return moves;
}

// The height by which the ground line has to rise so that the sole, moved along z by `shift`,
// clears the ground.
Wanted wanted_raise(const Tables& tables, const Floor& floor, const PlannedFlight& flight,
                    bool crosses, const Spline& shift) noexcept {
  const double above_m = kRoomAbove_m * tables.size;
  Wanted above;
  for (int i = 0; i <= kProbes; ++i) {
    const double u = share_at(i), moved = spline_of(shift, 0.0, u);
    double over = -tables.leg_m;
    SolePoints sole = flight.sole[i];
    for (vec3& p : sole) {
      p += flight.away * moved;
      if (flight.stays())
        p.z = std::clamp(p.z, flight.begin.from_m + kBeside_m, flight.begin.to_m - kBeside_m);
    }
    const auto ground = heights_at(floor, sole);
    const SolePoints& from = flight.over_until != 0 && !crosses ? sole : flight.base[i];
    for (std::size_t k = 0; k < sole.size(); ++k) over = std::max(over, ground[k] - from[k].y);
    above[i] = crosses ? over + above_m * in_flight(u)
                       : std::max(0.0, over) + std::clamp(over, 0.0, above_m);
  }
  above.front() = 0.0;
  above.back() = flight.climb;
  return above;
}

// In the second half of a flight a shift towards the landing is taken out of `beside` and becomes a
// share of the way that is left. The share only grows, so the foot is over its landing early and
// sinks to it; it never overshoots and comes back.
Spline lead_in(const PlannedFlight& flight, Wanted& beside) noexcept {
  Spline knots;
  double share = 0.0, to_m = 0.0;
  for (int k = 1; k < kKnotsOfFlight; ++k) {
    for (int i = kProbes / 2; i < std::min(kProbes, (k + 2) * kProbes / kKnotsOfFlight); ++i) {
      const double left_m = flight.left[i];
      if (beside[i] * left_m <= share * left_m * left_m) continue;
      share = std::min(1.0, beside[i] / left_m), to_m = beside[i];
    }
    // Before a flight that goes beyond its landing comes back, its way leads into the riser.
    const double left_m = flight.left[k * kProbes / kKnotsOfFlight];
    knots[k - 1] = left_m * to_m > 0.0 ? share * left_m : 0.0;
  }
  for (int i = kProbes / 2; i < kProbes; ++i) {
    if (beside[i] * flight.left[i] > 0.0) beside[i] = 0.0;
  }
  return knots;
}

// Moves the knots of a shift until it lacks no more than kLack_m anywhere: the spline is flatter
// than the way that is left, of which it is a share.
void make_up_for_lacks(const Wanted& beside, double size, Spline& shift) noexcept {
  constexpr double kLack_m = 0.001;  // at the reference leg: the room beside a riser is 5 mm
  constexpr int kRounds = 12;
  for (int round = 0; round < kRounds; ++round) {
    int at = 0;
    double most = kLack_m * size, lacks = 0.0;
    for (int i = 1; i < kProbes; ++i) {
      const double got = spline_of(shift, 0.0, share_at(i)), lack = beside[i] - got;
      if (lack * beside[i] <= 0.0 || std::abs(lack) <= most) continue;
      at = i, most = std::abs(lack), lacks = lack;
    }
    if (at == 0) return;
    const int k = std::clamp((at * kKnotsOfFlight + kProbes / 2) / kProbes, 1, kRoomKnots) - 1;
    const double weight = weight_of(k, share_at(at));
    if (weight < kLeast) return;
    shift[k] = std::clamp(shift[k] + lacks / weight, -kMostShift_m * size, kMostShift_m * size);
  }
}

// Lowers the inner knots until the spline is a taut line over the wanted heights, less some of
// their room, of which it keeps a share: the envelope alone holds each height for two knots longer
// than needed, so a foot would be thrown up and come down hard. A spline that is too low already is
// not lowered.
void draw_taut(const Wanted& wanted, double room_m, double kept, Spline& knots) noexcept {
  constexpr int kTautRounds = 24;
  Wanted slack;
  std::array<Wanted, kRoomKnots> weight;  // of each knot at each probe
  for (int i = 0; i <= kProbes; ++i) {
    const double u = share_at(i);
    const double spare = (1.0 - kept) * room_m * in_flight(u);
    slack[i] = std::max(0.0, spline_of(knots, wanted.back(), u) - wanted[i] + spare);
    for (int k = 0; k < kRoomKnots; ++k) weight[k][i] = weight_of(k, u);
  }
  for (int round = 0; round < kTautRounds; ++round) {
    for (int k = kKnotsOfFlight - 3; k > 0; --k) {
      double fall = knots[k] - 0.5 * (knots[k - 1] + knots[k + 1]);
      for (int i = 0; i <= kProbes; ++i) {
        if (weight[k][i] > kLeast) fall = std::min(fall, slack[i] / weight[k][i]);
      }
      knots[k] -= fall;
      for (int i = 0; i <= kProbes; ++i) slack[i] -= fall * weight[k][i];
    }
  }
}

struct RoomPlan {
  Spline raise_m{}, shift_m{};
};

// Share of its room above the ground that a taut spline keeps. Down, the foot sinks early; up, it
// is above the line where its plan has changed.
constexpr double kTautRoomDown = 0.5, kTautRoomUp = 0.75;

// The plan of a flight that stays level or goes up somewhere.
RoomPlan plan_over(const Tables& tables, const Floor& floor, const PlannedFlight& flight,
                   bool crosses) noexcept {
  constexpr int kTries = 4;
  const double size = tables.size;
  constexpr int kComesDown = kProbes / kKnotsOfFlight;  // after the standing foot
  const Wanted over = wanted_raise(tables, floor, flight, crosses, Spline{});
  Wanted above = over, beside{};
  if (flight.over_until != 0 && (!crosses || flight.sinks)) {
    for (int i = flight.over_until + kComesDown; i < kProbes; ++i)
      above[i] = std::min(0.0, flight.climb);
  }
  RoomPlan room;
  // Start gentle; sharpen until the riser is cleared.
  Ends ends;
  for (int tries = 0; tries < kTries; ++tries) {
    room.raise_m = envelope(above, ends);
    if (crosses || flight.over_until != 0)
      draw_taut(above, kRoomAbove_m * size, kTautRoomUp, room.raise_m);
    for (int i = 1; i < kProbes; ++i) {
      beside[i] = 0.0;
      const double u = share_at(i);
      if (!flight.stays() && over[i] <= spline_of(room.raise_m, above.back(), u)) continue;
      beside[i] = way_back(floor, flight, i, size, Risers::both);
    }
    Wanted away = beside;
    room.shift_m = lead_in(flight, away);
    const Spline back_m = wide_envelope(away, size);
    for (int k = 0; k < kRoomKnots; ++k) {
      room.shift_m[k] += back_m[k];
      if (k * kProbes < flight.over_until * kKnotsOfFlight) room.shift_m[k] = 0.0;
    }
    if (!sharpen(beside, room.shift_m, size, ends)) break;
  }
  if (flight.stays()) make_up_for_lacks(beside, size, room.shift_m);
  return room;
}

// Smallest advance that puts the sole past all ground that is higher than the ground line with
// `raise` and lies before the landing's piece.
double way_on(const Tables& tables, const Floor& floor, const PlannedFlight& flight, int i,
              double raise) noexcept {
  constexpr int kMostRisers = 4;  // before the landing's piece
  const double room = kRoomBeside_m * tables.size, least_m = kLeastWanted_m * tables.size;
  const bool ahead = flight.left[i] > 0.0;
  double on = 0.0;
  for (int risers = 0; risers < kMostRisers; ++risers) {
    for (std::size_t k = 0; k < flight.sole[i].size(); ++k) {
      const vec3& p = flight.sole[i][k];
      const double z = p.z + on;
      if (ahead ? z >= flight.end.from_m : z <= flight.end.to_m) continue;
      if (ground_at(floor, p.x, z).height_m <= flight.base[i][k].y + raise + least_m) continue;
      const Stretch piece = piece_at(floor, z);
      on += ahead ? piece.to_m + room - z : piece.from_m - room - z;
    }
  }
  return on;
}

// True for a flight over risers that only lead down.
bool leads_down(const Tables& tables, const Floor& floor, const PlannedFlight& flight) noexcept {
  if (flight.climb > -kRiser_m) return false;
  const Wanted above = wanted_raise(tables, floor, flight, true, Spline{});
  return *std::max_element(above.begin(), above.end()) < kRoomAbove_m * tables.size + kRiser_m;
}

// Moves the knots of a shift on where a sole that has sunk as far as at the next probe would be on
// an edge that it passes: between two probes a foot sinks by more than its room. The shift's spline
// comes to its end earlier than the way that is left.
void reach_on(const Tables& tables, const Floor& floor, const PlannedFlight& flight, int first,
              const Spline& raise, Spline& shift) noexcept {
  constexpr double kPeak = 2.0 / 3.0;  // of a knot's weight
  Spline lacks{};
  for (int i = first; i < kProbes; ++i) {
    const double u = share_at(i), next = share_at(i + 1),
                 on = way_on(tables, floor, flight, i, spline_of(raise, flight.climb, next)),
                 left = flight.left[i], got = spline_of(shift, 0.0, u),
                 lack = std::clamp(on, std::min(0.0, left), std::max(0.0, left)) - got;
    if (on * lack <= 0.0) continue;
    const int k = std::clamp((i * kKnotsOfFlight + kProbes / 2) / kProbes, 1, kRoomKnots);
    if (std::abs(lack) > std::abs(lacks[k - 1])) lacks[k - 1] = lack;
  }
  for (int k = 0; k < kRoomKnots; ++k) shift[k] += lacks[k] / kPeak;
}

// The plan of a flight down: a shift by a growing share of the way that is left brings the foot
// ahead of its path, so that it sinks as soon as it has passed an edge.
RoomPlan plan_down(const Tables& tables, const Floor& floor, const PlannedFlight& flight) noexcept {
  constexpr int over = static_cast<int>(kOver * kProbes);
  const double left = flight.left[over];
  const double needed =
      std::abs(left) < kLeast ? 0.0 : way_on(tables, floor, flight, over, flight.climb) / left;
  const double share = std::clamp(needed, 0.0, 1.0);
  RoomPlan room;
  for (int k = 1; k < kKnotsOfFlight; ++k)
    room.shift_m[k - 1] = share *
                          gaitpad::smoothstep(0.0, kOver, static_cast<double>(k) / kKnotsOfFlight) *
                          flight.left[k * kProbes / kKnotsOfFlight];
  const Wanted above = wanted_raise(tables, floor, flight, true, room.shift_m);
  room.raise_m = envelope(above, Ends{});
  draw_taut(above, kRoomAbove_m * tables.size, kTautRoomDown, room.raise_m);
  reach_on(tables, floor, flight, over, room.raise_m, room.shift_m);
  return room;
}

// The plan of a flight, which it takes by value to keep it clear.
RoomPlan room_of(const Tables& tables, const Floor& floor, PlannedFlight flight,
                 bool crosses) noexcept {
  const Spline clear =
      flight.stays() || flight.over_until != 0 ? Spline{} : keep_clear(floor, tables.size, flight);
  RoomPlan room = flight.over_until == 0 && leads_down(tables, floor, flight)
                      ? plan_down(tables, floor, flight)
                      : plan_over(tables, floor, flight, crosses);
  for (int k = 0; k < kRoomKnots; ++k) room.shift_m[k] += clear[k];
  return room;
}

// How deep a flight's sole gets into the ground from the share `from` on, in metres. It comes from
// the plan `now` to the plan `to` in the share `lasts`.
double depth_of(const Floor& floor, const PlannedFlight& flight, const RoomPlan& now,
                const RoomPlan& to, double from, double lasts) noexcept {
  double deep_m = 0.0;
  for (int i = 0; i <= kProbes; ++i) {
    const double u = share_at(i);
    if (u < from) continue;
    const double share = smooth(static_cast<float>((u - from) / lasts));
    const auto between = [&](const Spline& a, const Spline& b, double end) {
      const double was = spline_of(a, end, u);
      return was + (spline_of(b, end, u) - was) * share;
    };
    SolePoints sole = flight.sole[i];
    for (vec3& p : sole) {
      p.y += between(now.raise_m, to.raise_m, flight.climb);
      p += flight.away * between(now.shift_m, to.shift_m, 0.0);
    }
    const auto ground = heights_at(floor, sole);
    for (std::size_t k = 0; k < sole.size(); ++k) deep_m = std::max(deep_m, ground[k] - sole[k].y);
  }
  return deep_m;
}

// The plan in force.
RoomPlan room_now(const Footing<float>& footing) noexcept {
  RoomPlan room;
  for (int k = 0; k < kRoomKnots; ++k)
    room.raise_m[k] = footing.raise[k].x, room.shift_m[k] = footing.shift[k].x;
  return room;
}

// The distance of a point from a line between two points, seen from above.
double from_line(const vec3& point, const vec3& begin, const vec3& end) noexcept {
  const double x = end.x - begin.x, z = end.z - begin.z,
               share = std::clamp(((point.x - begin.x) * x + (point.z - begin.z) * z) /
                                      std::max(kLeast, x * x + z * z),
                                  0.0, 1.0);
  return horizontal_length(point - (begin + (end - begin) * share));
}

// Leads a flight over risers until it has passed the standing foot, if a shift would bring it
// nearer to that foot than it comes without one; returns true if it did.
bool lead_past_stand(const Tables& tables, const Frame& frame, bool right, const Spline& shift,
                     PlannedFlight& flight) noexcept {
  constexpr double kApart_m = 0.06;  // at the reference leg: as far apart as in turns
  const LegBones& stands = tables.leg[right ? 0 : 1];
  const vec3 heel_m = frame.at_m, toe_m = frame.out(wide(stands.toe_m) - wide(stands.heel_m));
  const auto near_m = [&](const SolePoints& sole, double moved) {
    const vec3 away = flight.away * moved, from = 0.5 * (sole[0] + sole[1]) + away,
               to = 0.5 * (sole[4] + sole[5]) + away;
    return std::min({from_line(from, heel_m, toe_m), from_line(to, heel_m, toe_m),
                     from_line(heel_m, from, to), from_line(toe_m, from, to)});
  };
  double apart_m = kApart_m * tables.size;
  for (const SolePoints& sole : flight.sole)
    apart_m = std::min(apart_m, near_m(sole, 0.0) - kLeastWanted_m * tables.size);
  int last = 0;
  for (int i = 1; i < kProbes; ++i) {
    if (near_m(flight.sole[i], spline_of(shift, 0.0, share_at(i))) < apart_m) last = i;
  }
  if (last == 0) return false;
  flight.over_until = last > flight.over_until ? last : kProbes;
  return true;
}

// Whether a flight takes the way `past` over risers, of plan `over`, and not the way `beside` them,
// of plan `room`. It chooses as it lifts off, and may go back to the way beside, never once more
// over: between both ways the foot would sink.
bool goes_over(const Tables& tables, const Floor& floor, bool begins, const PlannedFlight& beside,
               const RoomPlan& room, const PlannedFlight& past, const RoomPlan& over,
               const Block<1>& block) noexcept {
  // Share of the flight in which it may still choose. In walks by chance on stairs, with 0.07 a
  // sole is 12 mm deep in the ground; with 0.03 feet come to 12 mm in a turn.
  constexpr double kLiftsOff = 0.05;
  constexpr double kDeep_m = 0.0015;  // flights that keep clear are up to 1.4 mm deep
  constexpr float kComes_s = 0.16f;   // at the reference leg: four time constants of Filters::room
  const State<float>& state = block.state;
  const Footing<float>& footing = block.footing;
  const RoomPlan now = room_now(footing);
  const double from = state.tick / state.flight_ticks,
               lasts = kComes_s * tables.time_scale / tables.tick_s / state.flight_ticks;
  const auto depth_m = [&](const PlannedFlight& flight, const RoomPlan& plan) {
    return depth_of(floor, flight, begins ? plan : now, plan, from, lasts);
  };
  const auto differs_m = [&](const RoomPlan& plan) {
    double sum_m = 0.0;
    for (int k = 0; k < kRoomKnots; ++k)
      sum_m += std::abs(plan.raise_m[k] - footing.raise_m[k]) +
               std::abs(plan.shift_m[k] - footing.shift_m[k]);
    return sum_m;
  };
  const bool is_over = !begins && differs_m(over) < differs_m(room);
  if (!begins && !is_over && from >= kLiftsOff) return false;
  return depth_m(past, over) <= std::max(kDeep_m, is_over ? depth_m(beside, room) : 0.0);
}

}  // namespace

float depth_of_flight(const Tables& tables, const Block<1>& block) noexcept {
  const Floor floor{*tables.terrain, block.placed[0]};
  const RoomPlan room = room_now(block.footing);
  PlannedFlight flight = planned_flight(tables, floor, Frame(block.origin[0]), block);
  // Over risers an ankle at its limit points the foot down, as far as to its line.
  if (block.footing.crosses != 0.0f) {
    for (int i = 0; i <= kProbes; ++i) {
      for (std::size_t k = 0; k < flight.sole[i].size(); ++k)
        flight.sole[i][k].y = std::min(flight.sole[i][k].y, flight.base[i][k].y);
    }
  }
  return static_cast<float>(
      depth_of(floor, flight, room, room, block.state.tick / block.state.flight_ticks, 1.0));
}

void plan_room(const Tables& tables, bool begins, Block<1>& block) noexcept {
  const State<float>& state = block.state;
  Footing<float>& footing = block.footing;
  const Frame frame(block.origin[0]);
  const Floor floor{*tables.terrain, block.placed[0]};
  footing.room_for_m = {state.landing_x_m, footing.landing_y_m, state.landing_z_m};
  const PlannedFlight flight = planned_flight(tables, floor, frame, block);
  const bool crosses = footing.crosses != 0.0f, right = state.right_swings != 0.0f;
  RoomPlan room = room_of(tables, floor, flight, crosses);
  constexpr int kRounds = 4;  // each leads it farther
  for (const bool sinks : {true, false}) {
    if (sinks && flight.climb >= 0.0) continue;
    PlannedFlight past = flight;
    past.sinks = sinks;
    RoomPlan over = room;
    for (int round = 0; round < kRounds; ++round) {
      if (!lead_past_stand(tables, frame, right, over.shift_m, past)) break;
      over = room_of(tables, floor, past, crosses);
    }
    if (past.over_until == 0) break;
    if (!goes_over(tables, floor, begins, flight, room, past, over, block)) continue;
    room = over;
    break;
  }
  for (int k = 0; k < kRoomKnots; ++k) {
    footing.raise_m[k] = static_cast<float>(room.raise_m[k]);
    footing.shift_m[k] = static_cast<float>(room.shift_m[k]);
    if (begins) footing.raise[k] = {footing.raise_m[k], 0.0f};
    if (begins) footing.shift[k] = {footing.shift_m[k], 0.0f};
  }
}

}  // namespace gaitpad
