#include "animation/walk_parts.h"

namespace gaitpad {
namespace {

constexpr double kSlopeShortens = 1.0;  // steps per grade
// Of the leg: what the sole keeps from an edge where there is room, and it takes at most this share
// of the room.
constexpr double kEdgeRoom = 0.05, kMostEdgeShare = 0.3;
constexpr int kMostPieces = 8;  // looked at from the wanted one to the standing foot's
constexpr double kSkew = 0.25;  // of leaving the heading sideways, against along it
// What a piece costs: about the logarithm of how much longer or shorter it makes the step (a step
// of less than kLeastStep legs counts as one), and for what it does besides. Rises are in legs.
constexpr double kLeastStep = 0.05, kStuck = 0.3, kStuckCosts = 2.0, kAside = 3.0;
constexpr double kEasyRise = 0.22, kRiseCosts = 10.0, kMostRise = 0.345, kTooHigh = 100.0;
constexpr double kOverhang = 30.0, kLongStep = 0.6, kLongCosts = 10.0;
constexpr double kCrossStep = 0.5, kCrossWay = 0.85, kLeastCross = 0.25;  // lengths in legs
constexpr double kCrossWayBackward = 0.6;
constexpr double kStay = 0.1;       // another piece than before must be this much better
constexpr double kBeside_m = 1e-6;  // from a riser: on one side of it
constexpr double kMoved_m = 1e-6, kTurned_rad = 1e-6;

// How far the sole reaches along z from its heel point.
struct Extent {
  double back_m = 0.0, front_m = 0.0;
};
Extent sole_extent(const LegBuild& leg, double yaw_rad) noexcept {
  const quat yaw = rotation_y(yaw_rad);
  const double tip = (yaw * (leg.tip_m - leg.model.heel_m)).z;
  const double half = std::abs((yaw * leg.side).z) * leg.half_width_m;
  return {std::min(0.0, tip) - half, std::max(0.0, tip) + half};
}

// Where the heel may stand on a piece, along z.
struct Room {
  double low_m, high_m, lacks_m;
};
Room room_on(const Stretch& piece, const Extent& sole, double leg_m) noexcept {
  const double low = piece.from_m - sole.back_m, high = piece.to_m - sole.front_m;
  if (high < low) return {0.5 * (low + high), 0.5 * (low + high), low - high};
  const double edge = std::min(kEdgeRoom * leg_m, kMostEdgeShare * (high - low));
  return {low + edge, high - edge, 0.0};
}

struct Step {
  vec3 from_m{0.0}, lift_m{0.0};  // heels of the foot that stands and of the one that flies
  Stretch stands, lifts;          // their pieces
  vec3 forward{0.0, 0.0, 1.0}, wanted_m{0.0};
  double leg_m = 0.0;
  Extent sole;
  double wanted_length_m() const noexcept { return glm::dot(wanted_m - from_m, forward); }
};

// Over a riser a step is short: from the foot that stands, and on the whole way of the one that
// flies, which has to rise before it may go.
double longest_to(const Step& step, const Stretch& piece) noexcept {
  double longest = std::numeric_limits<double>::infinity();
  const double sign = step.wanted_length_m() < 0.0 ? -1.0 : 1.0;
  if (piece.from_m != step.stands.from_m) longest = kCrossStep * step.leg_m;
  if (piece.from_m != step.lifts.from_m) {
    const double gone = sign * glm::dot(step.from_m - step.lift_m, step.forward);
    const double way = sign < 0.0 ? kCrossWayBackward : kCrossWay;
    longest = std::min(longest, std::max(kLeastCross, way - gone / step.leg_m) * step.leg_m);
  }
  return longest;
}
vec3 wanted_on(const Step& step, const Stretch& piece) noexcept {
  const double wanted = step.wanted_length_m(), longest = longest_to(step, piece);
  return step.wanted_m + step.forward * (std::clamp(wanted, -longest, longest) - wanted);
}

// A shift along z by a move that leaves the heading little.
vec3 shifted(const Step& step, double dz_m) noexcept {
  const vec3& f = step.forward;
  const vec3 left = glm::cross(kUp, f);
  return (f * f.z + left * (left.z * kSkew)) * (dz_m / (f.z * f.z + left.z * left.z * kSkew));
}

double cost_of(const Terrain& terrain, const Step& step, const Stretch& piece) noexcept {
  const Room room = room_on(piece, step.sole, step.leg_m);
  const vec3 near = wanted_on(step, piece);
  const double dz = std::clamp(near.z, room.low_m, room.high_m) - near.z;
  const vec3 move = shifted(step, dz), place = near + move;
  const double middle = std::clamp(place.z + 0.5 * (step.sole.back_m + step.sole.front_m),
                                   piece.from_m + kBeside_m, piece.to_m - kBeside_m);
  const double rise =
      std::abs(ground_at(terrain, place.x, middle).height_m - step.from_m.y) / step.leg_m;
  const double wanted = step.wanted_length_m(),
               length = glm::dot(place - step.from_m, step.forward),
               sign = wanted < 0.0 ? -1.0 : 1.0;
  const double least = kLeastStep * step.leg_m;
  const double ratio = std::max(0.0, sign * length + least) / (sign * wanted + least);
  const double aside = std::abs(glm::dot(move, glm::cross(kUp, step.forward))) / step.leg_m;
  const bool stuck = sign * wanted > least && sign * length < kStuck * sign * wanted;
  const double longer = sign * length - std::min(longest_to(step, piece),
                                                 std::max(sign * wanted, kLongStep * step.leg_m));
  return 2.0 * std::abs(1.0 - ratio) / (1.0 + ratio) + kAside * aside +
         (stuck ? kStuckCosts : 0.0) + kLongCosts * std::max(0.0, longer) / step.leg_m +
         kRiseCosts * std::max(0.0, rise - kEasyRise) + kTooHigh * std::max(0.0, rise - kMostRise) +
         kOverhang * room.lacks_m / step.leg_m;
}

// From the piece that the wanted place is on back to the standing foot's.
Stretch best_piece(const Terrain& terrain, const Step& step, const Stretch* settled) noexcept {
  const double middle = 0.5 * (step.sole.back_m + step.sole.front_m);
  const double stands = step.from_m.z + middle;
  Stretch piece = piece_at(terrain, step.wanted_m.z + middle), best = piece;
  double least = std::numeric_limits<double>::infinity();
  for (int n = 0; n < kMostPieces; ++n) {
    double cost = cost_of(terrain, step, piece);
    if (settled && piece.from_m == settled->from_m) cost -= kStay;
    if (cost < least) {
      least = cost;
      best = piece;
    }
    if (stands < piece.from_m) {
      piece = piece_at(terrain, piece.from_m - kBeside_m);
    } else if (stands > piece.to_m) {
      piece = piece_at(terrain, piece.to_m + kBeside_m);
    } else {
      break;
    }
  }
  return best;
}

vec3 place_on(const Step& step, const Stretch& piece, bool& fits) noexcept {
  const Room room = room_on(piece, step.sole, step.leg_m);
  fits = room.lacks_m == 0.0;
  const vec3 near = wanted_on(step, piece);
  return near + shifted(step, std::clamp(near.z, room.low_m, room.high_m) - near.z);
}

// The step after the landing, as far as the hips have to know it.
void look_ahead(const Tick& tick, const Step& landing, const vec3& across_m,
                WalkState& state) noexcept {
  const Side next = other(step_foot(state));
  Step step = landing;
  step.lift_m = landing.from_m;
  step.lifts = landing.stands;
  step.from_m = state.landing_m;
  step.stands = state.landing.piece;
  const double wanted =
      walks_on(tick.params, state) ? step_length(state, next) * state.landing.share : 0.0;
  step.wanted_m = step.from_m + step.forward * wanted - across_m;
  const Terrain& terrain = *tick.model.terrain;
  bool fits = false;
  const vec3 place = place_on(step, best_piece(terrain, step, nullptr), fits);
  const double middle = 0.5 * (step.sole.back_m + step.sole.front_m);
  state.landing.next_m = glm::dot(place - step.from_m, step.forward);
  state.landing.next_base_m = ground_at(terrain, place.x, place.z + middle).height_m;
  // Of the foot that lands, or of the whole way of the one that flies, whichever is the steeper.
  const double step_m = std::abs(state.landing.next_base_m - state.landing_m.y),
               way_m = std::abs(state.landing.next_base_m - landing.from_m.y);
  state.landing.next_rise = std::max(step_m, way_m - step_m) / tick.model.leg_length_m;
}

// What a slope between here and there leaves of a step.
double slope_share(const Terrain& terrain, const Step& step, const Stretch& stands) noexcept {
  const double length =
      glm::distance(vec2(step.wanted_m.x, step.wanted_m.z), vec2(step.from_m.x, step.from_m.z));
  if (length < kMoved_m || step.wanted_m.z < stands.from_m || step.wanted_m.z > stands.to_m)
    return 1.0;
  const double rise = ground_at(terrain, step.wanted_m.x, step.wanted_m.z).height_m - step.from_m.y;
  return 1.0 / (1.0 + kSlopeShortens * std::abs(rise) / length);
}

}  // namespace

double height_on(const FootPlane& plane, const vec3& place_m) noexcept {
  const vec3& n = plane.normal;
  return plane.place_m.y -
         (n.x * (place_m.x - plane.place_m.x) + n.z * (place_m.z - plane.place_m.z)) / n.y;
}

FootPlane plane_under(const Terrain& terrain, const LegBuild& leg, const vec3& heel_m,
                      double yaw_rad, const Stretch& piece) noexcept {
  const quat yaw = rotation_y(yaw_rad);
  const vec3 sole = yaw * (leg.tip_m - leg.model.heel_m), across = yaw * leg.side;
  const double length = std::sqrt(sole.x * sole.x + sole.z * sole.z), half = leg.half_width_m;
  const vec3 along = vec3(sole.x, 0.0, sole.z) / length;
  const auto height = [&](double a, double c) {  // of the ground, shares of length and half width
    const vec3 p = heel_m + along * (a * length) + across * (c * half);
    return ground_at(terrain, p.x,
                     std::clamp(p.z, piece.from_m + kBeside_m, piece.to_m - kBeside_m))
        .height_m;
  };
  const std::array<double, 4> corner = {height(0, 1), height(0, -1), height(1, 1), height(1, -1)};
  const double grade = (corner[2] + corner[3] - corner[0] - corner[1]) / (2.0 * length);
  const double bank = (corner[0] - corner[1] + corner[2] - corner[3]) / (4.0 * half);
  const double middle = 0.25 * (corner[0] + corner[1] + corner[2] + corner[3]);
  double low = 0.0, high = 0.0;  // of the ground over the plane through the corners
  const auto see = [&](double a, double c, double y) {
    const double over = y - (middle + grade * (a - 0.5) * length + bank * c * half);
    low = std::min(low, over);
    high = std::max(high, over);
  };
  see(0, 1, corner[0]);
  see(0, -1, corner[1]);
  see(1, 1, corner[2]);
  see(1, -1, corner[3]);
  for (const double a : {0.0, 0.35, 0.7, 1.0}) see(a, 0, height(a, 0));
  FootPlane plane;
  plane.place_m = heel_m;
  plane.place_m.y = middle - grade * 0.5 * length + 0.5 * (low + high);
  plane.normal = glm::normalize(kUp - along * grade - across * bank);
  plane.tilt = rotation_between(kUp, plane.normal);
  return plane;
}

bool crosses_riser(const Terrain& terrain, const FootPlane& a, const FootPlane& b) noexcept {
  return piece_at(terrain, a.place_m.z).from_m != piece_at(terrain, b.place_m.z).from_m;
}

FootPlane standing_plane(const WalkModel& model, Side side, const vec3& heel_m,
                         double yaw_rad) noexcept {
  const LegBuild& leg = model.leg[side];
  Step step;
  step.wanted_m = step.from_m = step.lift_m = heel_m;
  step.leg_m = model.leg_length_m;
  step.sole = sole_extent(leg, yaw_rad);
  const Stretch piece =
      piece_at(*model.terrain, heel_m.z + 0.5 * (step.sole.back_m + step.sole.front_m));
  bool fits = false;
  return plane_under(*model.terrain, leg, place_on(step, piece, fits), yaw_rad, piece);
}

void choose_foothold(const Tick& tick, WalkState& state, const vec3& forward,
                     const vec3& across_m) noexcept {
  const Terrain& terrain = *tick.model.terrain;
  const Side swing = step_foot(state), stand = other(swing);
  Foothold& landing = state.landing;
  const bool flies = state.stage == Stage::flight,
             first = state.stage == Stage::roll && state.tick <= 1;
  Step step;
  step.from_m = state.foot[stand].plane.place_m;
  step.lift_m = state.foot[swing].plane.place_m;
  step.stands = piece_at(terrain, step.from_m.z);
  step.lifts = piece_at(terrain, step.lift_m.z);
  step.forward = forward;
  step.leg_m = tick.model.leg_length_m;
  const double yaw = state.landing_heading_rad;
  step.sole = sole_extent(tick.model.leg[swing], yaw);
  const double length = step_length(state, swing);
  const auto wanted = [&] { return step.from_m + forward * (length * landing.share) + across_m; };
  if (!flies) {
    landing.share = 1.0;
    step.wanted_m = wanted();
    landing.share = slope_share(terrain, step, step.stands);
  }
  step.wanted_m = wanted();
  const bool moved = glm::distance(step.wanted_m, landing.wanted_m) > kMoved_m ||
                     std::abs(yaw - landing.yaw_rad) > kTurned_rad || first;
  if (moved) {
    landing.wanted_m = step.wanted_m;
    landing.yaw_rad = yaw;
    if (!flies) landing.piece = best_piece(terrain, step, first ? nullptr : &landing.piece);
    const vec3 place = place_on(step, landing.piece, landing.fits);
    state.landing_plane = plane_under(terrain, tick.model.leg[swing], place, yaw, landing.piece);
  }
  state.landing_m = state.landing_plane.place_m;
  if (moved) look_ahead(tick, step, across_m, state);
}

}  // namespace gaitpad
