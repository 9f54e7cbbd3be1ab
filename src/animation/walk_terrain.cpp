// Adapts a walk to uneven ground: where a foot may land, the ground that the hips go over, and the
// flight over the ground in between.
//
// Footholds. Risers cut the ground into pieces, and a foot stands on one piece. For each piece
// between the wanted place and the standing foot's, a cost says how much the step would have to
// become longer, shorter, higher or more sideways, and whether the sole would overhang an edge. The
// cheapest piece wins; on it the heel goes as near to the wanted place as the room for the sole
// allows. The foot then gets a plane: the ground's best fit under its sole. Before the flight
// begins, the piece is settled.
//
// Hips. The tables' heights ride on a ground of the hips' own. After a step up it rises as the
// landed knee straightens; before a step down it sinks late. Feet that would be out of reach rise
// with it.
//
// Flights. A flight is planned over a ground line from one foothold's height to the other's. Where
// ground rises above this line, a B-spline raises it. The spline's control points are the greatest
// heights of the ground under the sole in their neighbourhood, and a B-spline stays within the hull
// of its control points, so it is above all of that ground and never higher than its highest point.
// Between footholds without a riser the line is straight, and the spline adds only what is missing.
// At a riser close to a foothold the spline would rise too late or sink too early there, so a
// second spline moves the foot along z, away from the riser. Down stairs that second spline moves
// the foot ahead instead, and the first one is drawn taut over the edges, so that the foot sinks
// early.
#include "animation/floor.h"
#include "animation/walk_flow.h"

namespace gaitpad {
namespace {

// --- Footholds -----------------------------------------------------------------------------------

// On a grade g a step keeps 1 / (1 + kSlopeShortens g) of its length.
constexpr double kSlopeShortens = 1.0;
// The sole keeps kEdgeRoom legs away from an edge, but gives up at most kMostEdgeShare of its room.
constexpr double kEdgeRoom = 0.05, kMostEdgeShare = 0.3;
// Most pieces that are compared, from the wanted one to the standing foot's.
constexpr int kMostPieces = 8;
// Weight of moving a step across its heading, relative to moving it along.
constexpr double kSkew = 0.25;
// The cost of a piece: about the logarithm of the factor by which it makes the step longer or
// shorter (steps shorter than kLeastStep legs count as that long), and further costs if the step
// gets stuck, goes sideways, high, over an edge, or becomes long. Rises are in legs.
constexpr double kLeastStep = 0.05, kStuck = 0.3, kStuckCosts = 2.0, kAside = 3.0;
constexpr double kEasyRise = 0.22, kRiseCosts = 10.0, kMostRise = 0.345, kTooHigh = 100.0;
constexpr double kOverhang = 30.0, kLongStep = 0.6, kLongCosts = 10.0;
constexpr double kCrossStep = 0.5, kCrossWay = 0.85, kLeastCross = 0.25;  // lengths in legs
constexpr double kCrossWayBackward = 0.6;
// Share of the roll until which a step may still choose another piece.
constexpr double kPieceSettles = 0.6;
constexpr double kStay = 0.1;  // another piece than before has to be cheaper by this much
// Distance from a riser at which a place is clearly on one side of it.
constexpr double kBeside_m = 1e-6;
constexpr double kMoved_m = 1e-6, kTurned_rad = 1e-6;

// The extent of a sole along z, from its heel point.
struct Extent {
  double back_m = 0.0, front_m = 0.0;
};
Extent sole_extent(const LegBuild& leg, double yaw_rad) noexcept {
  const quat yaw = rotation_y(yaw_rad);
  const double tip = (yaw * (leg.tip_m - leg.model.heel_m)).z;
  const double half = std::abs((yaw * leg.side).z) * leg.half_width_m;
  return {std::min(0.0, tip) - half, std::max(0.0, tip) + half};
}

// The part of a piece, along z, on which the heel may stand.
struct Room {
  double low_m, high_m, lacks_m;
};
Room room_on(const Stretch& piece, const Extent& sole, double leg_m) noexcept {
  const double low = piece.from_m - sole.back_m, high = piece.to_m - sole.front_m;
  if (high < low) return {0.5 * (low + high), 0.5 * (low + high), low - high};
  const double edge = std::min(kEdgeRoom * leg_m, kMostEdgeShare * (high - low));
  return {low + edge, high - edge, 0.0};
}

// A step for which a foothold is searched.
struct Step {
  vec3 from_m{0.0}, lift_m{0.0};  // heels of the standing foot and of the flying one
  Stretch stands, lifts;          // pieces on which these heels stand
  vec3 forward{0.0, 0.0, 1.0}, wanted_m{0.0};
  double leg_m = 0.0;
  Extent sole;
  vec3 middle_m{0.0};  // from the heel to the middle of the sole
  double wanted_length_m() const noexcept { return glm::dot(wanted_m - from_m, forward); }
};

// The longest step over a riser, counted from the standing foot, and also over the whole way of the
// flying foot: that foot has to rise before it may go forward.
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

// Shifts a place by `dz_m` along z, with the least change of the heading.
vec3 shifted(const Step& step, double dz_m) noexcept {
  const vec3& f = step.forward;
  const vec3 left = glm::cross(kUp, f);
  return (f * f.z + left * (left.z * kSkew)) * (dz_m / (f.z * f.z + left.z * left.z * kSkew));
}

// True if a step of this length would hardly leave the place.
bool is_stuck(const Step& step, double length_m) noexcept {
  const double wanted = step.wanted_length_m(), sign = wanted < 0.0 ? -1.0 : 1.0;
  return sign * wanted > kLeastStep * step.leg_m && sign * length_m < kStuck * sign * wanted;
}

double cost_of(const Floor& terrain, const Step& step, const Stretch& piece) noexcept {
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
  const double longer = sign * length - std::min(longest_to(step, piece),
                                                 std::max(sign * wanted, kLongStep * step.leg_m));
  return 2.0 * std::abs(1.0 - ratio) / (1.0 + ratio) + kAside * aside +
         (is_stuck(step, length) ? kStuckCosts : 0.0) +
         kLongCosts * std::max(0.0, longer) / step.leg_m +
         kRiseCosts * std::max(0.0, rise - kEasyRise) + kTooHigh * std::max(0.0, rise - kMostRise) +
         kOverhang * room.lacks_m / step.leg_m;
}

// Tries the pieces from the wanted place's back to the standing foot's. If both are the same piece,
// and its edge is in the way, the piece beyond this edge is tried as well.
Stretch best_piece(const Floor& terrain, const Step& step, const Stretch* settled) noexcept {
  const double middle = 0.5 * (step.sole.back_m + step.sole.front_m);
  const double stands = step.from_m.z + middle;
  Stretch piece = piece_at(terrain, step.wanted_m.z + middle), best = piece;
  if (piece.from_m == step.stands.from_m) {
    const Room room = room_on(piece, step.sole, step.leg_m);
    const double z = std::clamp(step.wanted_m.z, room.low_m, room.high_m), dz = z - step.wanted_m.z;
    if (is_stuck(step, step.wanted_length_m() + step.forward.z * dz))
      piece = piece_at(terrain, dz > 0.0 ? piece.from_m - kBeside_m : piece.to_m + kBeside_m);
  }
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

// Looks ahead at the step after the landing, which takes longer on stairs.
void look_ahead(const Tick& tick, const Step& landing, const vec3& across_m,
                WalkState& state) noexcept {
  const Side next = other(step_foot(state));
  Step step = landing;
  step.lift_m = landing.from_m;
  step.lifts = landing.stands;
  step.from_m = state.path.landing_m;
  step.stands = state.path.foothold.piece;
  const double wanted =
      walks_on(tick.params, state)
          ? step_length<double>(moment_of(tick.model, state), state.gait.length_m[next].x) *
                state.path.foothold.share
          : 0.0;
  step.wanted_m = step.from_m + step.forward * wanted - across_m;
  const Floor terrain{*tick.model.terrain, tick.placed};
  bool fits = false;
  const vec3 place = place_on(step, best_piece(terrain, step, nullptr), fits);
  const vec3 middle = place + step.middle_m;
  const double next_m = ground_at(terrain, middle.x, middle.z).height_m;
  // The larger of the rise to the next landing and the rest of the flying foot's rise.
  const double step_m = std::abs(next_m - state.path.landing_m.y),
               way_m = std::abs(next_m - landing.from_m.y);
  state.path.foothold.next_rise = std::max(step_m, way_m - step_m) / tick.model.leg_length_m;
}

// The share of its length that a step keeps on a slope.
double slope_share(const Floor& terrain, const Step& step, const Stretch& stands) noexcept {
  const double length =
      glm::distance(vec2(step.wanted_m.x, step.wanted_m.z), vec2(step.from_m.x, step.from_m.z));
  if (length < kMoved_m || step.wanted_m.z < stands.from_m || step.wanted_m.z > stands.to_m)
    return 1.0;
  const double rise = ground_at(terrain, step.wanted_m.x, step.wanted_m.z).height_m - step.from_m.y;
  return 1.0 / (1.0 + kSlopeShortens * std::abs(rise) / length);
}

// The plane on which heel and ball of a sole are exactly on the ground of a game: a game draws its
// ground, so a gap under a foot is visible. Across, the plane is the best fit under heel and tip.
FootPlane plane_through(const Floor& floor, const LegBuild& leg, const vec3& heel_m,
                        double yaw_rad) noexcept {
  constexpr int kRounds = 3;  // iterations: the ball moves when the plane tilts; each iteration
                              // leaves a tenth of the error or less
  const quat yaw = rotation_y(yaw_rad);
  const vec3 ball = yaw * (leg.ball_m - leg.model.heel_m),
             tip = yaw * (leg.tip_m - leg.model.heel_m), across = yaw * leg.side;
  const double length = horizontal_length(ball), half = leg.half_width_m;
  const vec3 along = vec3(ball.x, 0.0, ball.z) / length, side = across * half;
  const std::array<double, 6> ground =
      heights_at<6>(floor, {heel_m, heel_m + ball, heel_m + side, heel_m - side,
                            heel_m + tip + side, heel_m + tip - side});
  const double bank = (ground[2] - ground[3] + ground[4] - ground[5]) / (4.0 * half);
  double grade = (ground[1] - ground[0]) / length;
  FootPlane plane;
  plane.place_m = vec3(heel_m.x, ground[0], heel_m.z);
  for (int round = 0; round <= kRounds; ++round) {
    plane.normal = glm::normalize(kUp - along * grade - across * bank);
    plane.tilt = rotation_between(kUp, plane.normal);
    if (round == kRounds) break;
    const vec3 lies = plane.place_m + plane.tilt * ball;
    grade += (ground_at(floor, lies.x, lies.z).height_m - lies.y) / length;
  }
  return plane;
}

// The best fit to the ground under a sole: the ground is as far above the plane as below it. Ground
// beyond the risers around `piece` is ignored.
FootPlane plane_under(const Floor& terrain, const LegBuild& leg, const vec3& heel_m, double yaw_rad,
                      const Stretch& piece) noexcept {
  if (terrain.terrain.asked.ask != nullptr) return plane_through(terrain, leg, heel_m, yaw_rad);
  const quat yaw = rotation_y(yaw_rad);
  const vec3 sole = yaw * (leg.tip_m - leg.model.heel_m), across = yaw * leg.side;
  const double length = horizontal_length(sole), half = leg.half_width_m;
  const vec3 along = vec3(sole.x, 0.0, sole.z) / length;
  // Height of the ground at shares of the sole's length and half width.
  const auto height = [&](double a, double c) {
    const vec3 p = heel_m + along * (a * length) + across * (c * half);
    return ground_at(terrain, p.x,
                     std::clamp(p.z, piece.from_m + kBeside_m, piece.to_m - kBeside_m))
        .height_m;
  };
  const std::array<double, 4> corner = {height(0, 1), height(0, -1), height(1, 1), height(1, -1)};
  const double grade = (corner[2] + corner[3] - corner[0] - corner[1]) / (2.0 * length);
  const double bank = (corner[0] - corner[1] + corner[2] - corner[3]) / (4.0 * half);
  const double middle = 0.25 * (corner[0] + corner[1] + corner[2] + corner[3]);
  // Lowest and highest ground relative to the plane through the corners.
  double low = 0.0, high = 0.0;
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
  FootPlane plane;
  plane.place_m = heel_m;
  plane.place_m.y = middle - grade * 0.5 * length + 0.5 * (low + high);
  plane.normal = glm::normalize(kUp - along * grade - across * bank);
  plane.tilt = rotation_between(kUp, plane.normal);
  return plane;
}

}  // namespace

double height_on(const FootPlane& plane, const vec3& place_m) noexcept {
  const vec3& n = plane.normal;
  return plane.place_m.y -
         (n.x * (place_m.x - plane.place_m.x) + n.z * (place_m.z - plane.place_m.z)) / n.y;
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
  return plane_under({*model.terrain, Placement{}}, leg, place_on(step, piece, fits), yaw_rad,
                     piece);
}

void choose_foothold(const Tick& tick, WalkState& state, const vec3& forward,
                     const vec3& across_m) noexcept {
  const Floor terrain{*tick.model.terrain, tick.placed};
  const Side swing = step_foot(state), stand = other(swing);
  Foothold& landing = state.path.foothold;
  const bool flies = state.clock.stage == Stage::flight,
             first = state.clock.stage == Stage::roll &&
                     (state.clock.tick <= 1 || state.clock.replanned);
  Step step;
  step.from_m = state.foot[stand].plane.place_m;
  step.lift_m = state.foot[swing].plane.place_m;
  step.stands = piece_at(terrain, step.from_m.z);
  step.lifts = piece_at(terrain, step.lift_m.z);
  step.forward = forward;
  step.leg_m = tick.model.leg_length_m;
  const double yaw = state.path.landing_heading_rad;
  const LegBuild& leg = tick.model.leg[swing];
  step.sole = sole_extent(leg, yaw);
  const auto middle = [](const Extent& sole) { return 0.5 * (sole.back_m + sole.front_m); };
  step.middle_m = tick.model.terrain->asked.ask == nullptr
                      ? kForward * middle(step.sole)
                      : forward * middle(sole_extent(leg, yaw - heading_of(forward)));
  const double length =
      step_length<double>(moment_of(tick.model, state), state.gait.length_m[swing].x);
  const AskedStep& asked = state.path.asked;
  const auto wanted = [&] {
    if (asked.is_taken) return vec3(asked.heel_m.x, step.from_m.y, asked.heel_m.z);
    return step.from_m + forward * (length * landing.share) + across_m;
  };
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
    if (first || (state.clock.stage == Stage::roll &&
                  state.clock.tick <= kPieceSettles * state.clock.stage_ticks))
      landing.piece = best_piece(terrain, step, first ? nullptr : &landing.piece);
    const vec3 place = place_on(step, landing.piece, landing.fits);
    state.path.landing_plane =
        plane_under(terrain, tick.model.leg[swing], place, yaw, landing.piece);
  }
  state.path.landing_m = state.path.landing_plane.place_m;
  if (moved) look_ahead(tick, step, across_m, state);
}

namespace {

// --- Slopes --------------------------------------------------------------------------------------

// Angles by which trunks lean: 5 to 6 degrees up a grade of 15 %, 7 to 8 up stairs, and back by 2
// downhill (Leroux, Fung and Barbeau 2002; Nadeau, McFadyen and Malouin 2003).
constexpr double kUphillLean = 8.5 * kDegree, kDownhillLean = 3.0 * kDegree, kHalfLeanGrade = 0.09;
// In legs; a step that is shorter than this is too short for a grade.
constexpr double kShortestRun = 0.2;
constexpr double kSlopeLeanSmoothing = 0.3;
// Share of the data's step; shorter ones tell nothing about the ground.
constexpr double kShortStep = 0.1;
constexpr double kLeastShare = 0.3;  // least share of a step's length that the ground leaves
constexpr double kGroundSmoothing_s = 0.3;
constexpr double kRatioJump_1_s = 2.4;        // greatest rate of the ratio; sticks change it more
                                              // slowly
constexpr double kFirstRatioJump_1_s = 14.4;  // greatest rate of the ratio in a first step

// Lets the ratio change smoothly. If a step changes the tread on which it will end, its ratio
// changes at once; until the flight begins the tables are read for the new length.
void keep_ratio_smooth(const Tick& tick, WalkState& state) noexcept {
  const double ratio = ratio_of_step<double>(tick.model, moment_of(tick.model, state), state);
  const double change = ratio - state.gait.step_ratio;
  state.gait.step_ratio = ratio;
  if (state.clock.stage == Stage::roll && state.clock.tick == 1) {
    state.gait.off_ratio = {};
  } else if (std::abs(change) >
             tick.dt_s * (state.clock.starting ? kFirstRatioJump_1_s : kRatioJump_1_s)) {
    state.gait.off_ratio.x -= change;
  }
  state.gait.off_ratio.advance(
      state.clock.stage == Stage::roll ? state.clock.stage_ticks - state.clock.tick + 1 : 1);
}

}  // namespace

void lean_into_slope(const Tick& tick, WalkState& state) noexcept {
  double lean = 0.0;
  if (state.clock.started) {
    const Side swing = step_foot(state);
    const double rise = state.path.landing_m.y - state.foot[other(swing)].plane.place_m.y,
                 run = std::max(std::abs(state.path.stride_m[swing]),
                                kShortestRun * tick.model.leg_length_m);
    const double grade = (state.clock.backward ? -rise : rise) / run;
    lean = (grade > 0.0 ? kUphillLean : kDownhillLean) * grade / (std::abs(grade) + kHalfLeanGrade);
  }
  state.path.slope_lean_rad.advance(lean, kSlopeLeanSmoothing * tick.model.time_scale, tick.dt_s);
}

// Shortens steps on the ground. Shortened steps roll and rise as short ones do.
void follow_ground(const Tick& tick, WalkState& state) noexcept {
  const Side swing = step_foot(state);
  const double wanted =
      std::abs(step_length<double>(moment_of(tick.model, state), state.gait.length_m[swing].x));
  const double share =
      wanted < kShortStep * tick.model.source_step_m
          ? 1.0
          : std::clamp(std::abs(state.path.stride_m[swing]) / wanted, kLeastShare, 1.0);
  state.gait.ground_share.advance(share, kGroundSmoothing_s * tick.model.time_scale, tick.dt_s);
  keep_ratio_smooth(tick, state);
}

namespace {

// --- The ground that the hips go over ------------------------------------------------------------

// When the hips rise and sink. Up, the knee that lands bent straightens until late single support;
// down, the standing knee holds, and yields from the middle of single support until the landed foot
// has taken the weight (McFadyen & Winter 1988).
constexpr double kRiseLasts = 0.9;                         // share of the step for a rise
constexpr double kSinkBegin = 0.5, kSinkBeginBack = 0.35;  // shares of the flight
constexpr double kSinkEnd = 0.25;                          // share of the roll: end of the sinking
constexpr double kSinkBeginClosing =
    0.15;  // share for a closing step, at whose landing both knees are straight
// The yield of the knee of a foot that lands from a height: kYield legs from great heights, half of
// kYield at a fall of kHalfYield legs, so that the knee bends by 20 to 35 degrees on house stairs.
// The other leg's knee is bent by kBentBefore of it, because a straight knee cannot yield smoothly.
constexpr double kBentBefore = 0.65;
constexpr double kYield = 0.0255, kHalfYield = 0.01;
// A leg is stretched to this share of its length before its foot rises with the hips.
constexpr double kStretch = 0.998, kSoftStretch_m = 0.02;
constexpr double kMostOnToe = 0.5, kSoftOnToe = 0.3;
// Share of the first flight after which a standing foot has risen with the hips.
constexpr double kFirstRise = 0.4;

struct Sinking {
  double ticks = 1.0;
  double share = 0.0;  // share of the ticks that are over
};
Sinking sinking(const WalkState& state, double flight_ticks) noexcept {
  const StepClock& clock = state.clock;
  const double begin = clock.flight_ticks * (clock.closing    ? kSinkBeginClosing
                                             : clock.backward ? kSinkBeginBack
                                                              : kSinkBegin);
  Sinking s;
  s.ticks = clock.flight_ticks - begin + (clock.closing ? 0.0 : kSinkEnd * clock.roll_ticks);
  s.share = std::max(0.0, flight_ticks - begin) / s.ticks;
  return s;
}

// The depth by which the hips yield over a foot that lands from a height of `fall_m`.
double early_yield(const WalkModel& model, double fall_m) noexcept {
  if (fall_m <= 0.0) return 0.0;
  return kYield * model.leg_length_m * fall_m / (fall_m + kHalfYield * model.leg_length_m);
}
// The height by which the next foot lands below the standing one; of its heel or its toe: a foot
// that points down reaches less far.
double fall_ahead(const WalkModel& model, const WalkState& state) noexcept {
  const Side lands = step_foot(state), stands = other(lands);
  const FootPlane &from = state.foot[stands].plane, &to = state.path.landing_plane;
  const auto toe_m = [&](const FootPlane& plane, Side side, double yaw_rad) {
    return height_on(plane, plane.place_m + heading_direction(yaw_rad) * model.leg[side].foot_m);
  };
  return std::max(from.place_m.y - to.place_m.y,
                  toe_m(from, stands, state.foot[stands].lift_yaw_rad) -
                      toe_m(to, lands, state.path.landing_heading_rad));
}

// At a strike: begins the way of the hips from their place to the height over the landed foot.
void begin_base(const WalkModel& model, WalkState& state) noexcept {
  HipsGround& base = state.path.base;
  const FootPlane &landed = state.foot[state.clock.swing].plane,
                  &lifts = state.foot[other(state.clock.swing)].plane;
  if (state.clock.started) {
    const double bent = kBentBefore * early_yield(model, fall_ahead(model, state));
    base.level_m = landed.place_m.y - std::max(base.yield_m, bent);
    const double rise_lasts = state.clock.backward || state.clock.closing ? 1.0 : kRiseLasts;
    base.settle_ticks =
        static_cast<int>(base.yield_m > bent && base.height_m > base.level_m
                             ? kSinkEnd * state.clock.roll_ticks
                             : rise_lasts * (state.clock.roll_ticks + state.clock.flight_ticks));
  } else {
    base.level_m = std::min(landed.place_m.y, lifts.place_m.y);
    base.settle_ticks = state.clock.stage_ticks;
  }
  base.off_m = {base.height_m - base.level_m, base.per_tick_m, base.per_tick2_m};
  base.drop_m = base.yield_m = base.early_m = 0.0;
}

// Plans the depth by which the hips sink until the next landing, and after it.
void plan_drop(const WalkModel& model, WalkState& state) noexcept {
  HipsGround& base = state.path.base;
  base.early_m = early_yield(model, fall_ahead(model, state));
  base.drop_m = base.yield_m = 0.0;
  if (base.early_m == 0.0) return;
  const double share = smootherstep(sinking(state, state.clock.flight_ticks).share);
  base.drop_m = std::max(0.0, base.level_m - state.path.landing_m.y + base.early_m) / share;
  base.yield_m = base.early_m + (1.0 - share) * base.drop_m;
}

// True if the hips wait for the lift-off of the other foot. Upwards, a rear leg that does not roll
// far over its toe would be too short (walking backwards, or when closing a walk).
bool waits_for_flight(const WalkState& state) noexcept {
  const SmoothFade<double>& off = state.path.base.off_m;
  return (state.clock.backward || state.clock.closing) && state.clock.started && off.x < 0.0 &&
         off.v == 0.0 && off.a == 0.0;
}

}  // namespace

void advance_base(const Tick& tick, WalkState& state) noexcept {
  HipsGround& base = state.path.base;
  if (state.clock.stage == Stage::idle) return;
  if (state.clock.stage == Stage::roll && state.clock.tick == 1) begin_base(tick.model, state);
  const bool flies = state.clock.stage == Stage::flight;
  const int begun = state.clock.tick + (flies ? state.clock.roll_ticks : 0);
  if (!flies && waits_for_flight(state)) return;
  base.off_m.advance(base.settle_ticks - begun + 1);
  const Sinking now = sinking(state, flies ? state.clock.tick : 0.0);
  if (now.share == 0.0 && state.clock.started) plan_drop(tick.model, state);
  const double s = now.share, per_tick = s > 0.0 ? 1.0 / now.ticks : 0.0;
  base.height_m = base.level_m + base.off_m.x - base.drop_m * smootherstep(s);
  base.per_tick_m = base.off_m.v - base.drop_m * per_tick * 30.0 * s * s * (1.0 - s) * (1.0 - s);
  base.per_tick2_m =
      base.off_m.a - base.drop_m * per_tick * per_tick * 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s);
}

namespace {

// The rise of a foot over ground of height `base_m`, if the hips are over higher ground.
double rise_with_hips(const WalkModel& model, const WalkState& state, const StridePlan& plan,
                      Side side, double base_m) noexcept {
  const LegBuild& leg = model.leg[side];
  const double higher = state.path.base.height_m - base_m;
  // A foot that lands from a height comes down softly with the hips, which are lower by `early` at
  // its landing.
  double hover = 0.0;
  if (state.foot[side].mode == FootMode::flight)
    hover = 0.5 * state.path.base.early_m *
            smoothstep(0.0, 0.5, moment_of(model, state).flight_progress());
  if (higher <= -2.0 * hover) return 0.0;
  const double knee = model.stand_rad[side][kKneeX] + plan.cell.leg_rad[side][kKneeX];
  const double known = span_of<double>(leg.model, knee);
  const double room = std::max(0.0, kStretch * leg.model.length_m() - known),
               soft = kSoftStretch_m * model.size;
  const double up = std::max(0.0, higher);
  const double rise = soft_positive(higher + hover - room, hover + up * soft / (up + soft));
  // The limit is the height to which a foot on its toe lifts its ankle.
  const double most = glm::length(leg.model.toe_m) + leg.model.toe_m.y;
  return soft_min(rise, kMostOnToe * most, kSoftOnToe * most);
}

// Pitches a foot on its toe so that its ankle rises by `rise_m`.
void pitch_to_rise(const LegBuild& leg, double rise_m, FootState& foot) noexcept {
  if (rise_m == 0.0) return;
  const double length = glm::length(leg.model.toe_m);
  const double flat = asin_of(-leg.model.toe_m.y / length);
  const double sine = sin_cos(std::min(flat + foot.pose.pitch_rad, kPi / 2.0)).sin;
  const double higher = soft_min(sine + rise_m / length, kMostUpright, kSoftUpright);
  const double pitch = std::max(foot.pose.pitch_rad, asin_of(higher) - flat);
  pitch_foot(leg, pitch, foot.pose, foot.mode);
}

}  // namespace

void rise_on_toe(const Tick& tick, WalkState& state, const StridePlan& plan, Side side) noexcept {
  FootState& foot = state.foot[side];
  foot.rise_m = rise_with_hips(tick.model, state, plan, side, foot.base_m);
  // When a walk begins, the standing foot has not risen yet at the lift-off of the other one.
  if (state.clock.starting)
    foot.rise_m *= smootherstep(moment_of(tick.model, state).flight_progress() / kFirstRise);
  pitch_to_rise(tick.model.leg[side], foot.rise_m, foot);
}

namespace {

// --- Flights over the ground between two footholds -----------------------------------------------

constexpr int kProbes = 48;  // number of places along a flight at which the ground is
                             // probed
// Room above the ground; metres at the reference leg, as below.
constexpr double kRoomAbove_m = 0.025;
constexpr double kRoomBeside_m = 0.005, kRoomAhead_m = 0.016, kMostShift_m = 0.25, kRiser_m = 0.01;
constexpr double kLack_m = 0.006, kEasyShift_m = 0.2, kSharper = 1.5;
// Sharpness of the ends. A lift-off stays gentler, because the leg is stretched then.
constexpr double kMostSharp = 0.38;
constexpr int kTries = 4;
// Share of the flight from which on a foot that goes down is over the piece where it lands.
constexpr double kOver = 0.685;
constexpr int kMostRisers = 4, kTautRounds = 24;
constexpr double kTautRoom = 0.5;  // share of kRoomAbove_m that a taut flight keeps
constexpr double kLeastWeight = 1e-6, kLeastLeft_m = 1e-6;
constexpr double kLeastWanted_m = 0.004, kMostGain = 6.0;
constexpr double kRoomSmoothing_s = 0.04;
constexpr double kInPlace_m = 0.1;   // the climb of a shorter flight follows time instead of place
constexpr double kReplan_m = 0.005;  // the flight is planned again if its landing moves farther

// The share of the climb from one plane's height to the other's that a flying foot has completed:
// the share of its way over the ground, or of its time if it flies in place. It is 0 if a riser is
// crossed: then FlightRoom raises the foot.
struct ClimbShare {
  vec3 along_1_m{0.0};
  double by_time = 0.0;
  double at(const vec3& gone_m, double u) const noexcept {
    return glm::dot(gone_m, along_1_m) + by_time * (1.0 - h00(u));
  }
};
ClimbShare climb_share(const WalkModel& model, const FootState& foot, const vec3& way_m) noexcept {
  ClimbShare a;
  if (foot.crosses_riser) return a;
  const double square = way_m.x * way_m.x + way_m.z * way_m.z;
  const double in_place = kInPlace_m * kInPlace_m * model.size * model.size;
  a.along_1_m = vec3(way_m.x, 0.0, way_m.z) / (square + in_place);
  a.by_time = in_place / (square + in_place);
  return a;
}

// The spline from 0 at u = 0 to `end` at u = 1, with slope 0 at both.
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

// A share that is 1 in mid-flight and 0 at its ends.
double in_flight(double u) noexcept {
  return smoothstep(0.0, 0.2, u) * (1.0 - smoothstep(0.8, 1.0, u));
}

// A value wanted at each probe of the flight.
using Wanted = std::array<double, kProbes + 1>;

// The outer knots as shares of their neighbours: smaller shares make the spline's ends gentler.
struct Ends {
  double first = 0.2, last = 0.2;
};

// Each knot is the greatest wanted value within its reach. The outer ones are bounded, so that the
// spline ends gently.
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

// The envelope of values of both signs. If the spline is below them, all of it is multiplied by a
// gain; no knot exceeds `most`.
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

// Sharpens an end if the sideways shift there is too large or was not reached; returns false if
// neither end changed.
bool sharpen(const Wanted& beside, const FlightSpline& shift, double size, Ends& ends) noexcept {
  Ends more = ends;
  for (int i = 1; i < kProbes; ++i) {
    const double got = spline_at(shift, 0.0, static_cast<double>(i) / kProbes);
    const double lack = beside[i] > 0.0 ? beside[i] - got : beside[i] < 0.0 ? got - beside[i] : 0.0;
    if (lack < kLack_m * size && std::abs(beside[i]) < kEasyShift_m * size) continue;
    if (2 * i < kProbes) {
      more.first = std::min(kMostSharp, kSharper * ends.first);
    } else {
      more.last = kSharper * ends.last;
    }
  }
  const bool any = more.first > ends.first || more.last > ends.last;
  ends = more;
  return any;
}

using Sole = std::array<vec3, 5>;  // heel and tip on both sides, and the ball
Sole sole_of(const LegBuild& leg, const FootPose& pose) noexcept {
  const quat foot = foot_rotation<double>(leg, pose);
  const quat toes = foot * toes_turn<double>(leg, pose, -std::max(0.0, pose.pitch_rad));
  const vec3 ball = pose.heel_m + foot * (leg.ball_m - leg.model.heel_m);
  const vec3 toe = pose.heel_m + foot * (leg.model.toe_m - leg.model.heel_m);
  const vec3 tip = toe + toes * (leg.tip_m - leg.model.toe_m);
  const vec3 side = foot * leg.side * leg.half_width_m;
  return {pose.heel_m - side, pose.heel_m + side, ball, tip - side, tip + side};
}

// Height, at p, of the plane through the ground line below the heel that the pose is tilted to.
double base_under(const FlightPoint& point, const vec3& p) noexcept {
  const vec3 n = point.pose.tilt * kUp;
  return point.base_m -
         (n.x * (p.x - point.pose.heel_m.x) + n.z * (p.z - point.pose.heel_m.z)) / n.y;
}

// The shift along z that takes every part of the sole out of a riser that leads up from `height_m`
// at either end of `piece`.
double way_back(const Floor& terrain, const Sole& sole, const Stretch& piece, double height_m,
                double room, double size) noexcept {
  double shift = 0.0;
  for (const vec3& p : sole) {
    const bool ahead_up =
        std::isfinite(piece.to_m) &&
        ground_at(terrain, p.x, piece.to_m + kRiser_m).height_m > height_m + kRiser_m;
    const bool behind_up =
        std::isfinite(piece.from_m) &&
        ground_at(terrain, p.x, piece.from_m - kRiser_m).height_m > height_m + kRiser_m;
    if (ahead_up) shift = std::min(shift, piece.to_m - room - p.z);
    if (behind_up) shift = std::max(shift, piece.from_m + room - p.z);
  }
  return std::clamp(shift, -kMostShift_m * size, kMostShift_m * size);
}

// The climb from lift-off to landing that the spline has to make; 0 if no riser is crossed.
double climb(const WalkState& state, const FootState& foot) noexcept {
  return foot.crosses_riser ? state.path.landing_m.y - height_on(foot.plane, foot.lift_m) : 0.0;
}

// A flight over its ground line, and the values from which its splines are planned.
struct Flight {
  std::array<FlightPoint, kProbes + 1> point;
  std::array<Sole, kProbes + 1> sole;
  Wanted left{};  // share of the way along z that is left, at each probe
  Stretch begin, end;
  double begin_room = 0.0;
  double climb = 0.0;
  // True for a flight that ends on its own piece: it goes beside a riser, not over it.
  bool stays() const noexcept { return begin.from_m == end.from_m; }
};
Flight planned_flight(const Tick& tick, const WalkState& state, Side side) noexcept {
  const WalkModel& model = tick.model;
  const FootState& foot = state.foot[side];
  const Moment at = moment_of(model, state);
  Flight flight;
  for (int i = 0; i <= kProbes; ++i) {
    const double u = static_cast<double>(i) / kProbes;
    const double phase = phase_ahead(model, state, u * state.clock.flight_ticks - state.clock.tick);
    const double share = (state.clock.roll_ticks + u * state.clock.flight_ticks) /
                         (state.clock.roll_ticks + state.clock.flight_ticks);
    StridePlan plan;
    plan_stride<double>(tick, at, state, phase, share, plan);
    flight.point[i] = flight_point<double>(tick, at, state, plan, side, u);
    const double fade = state.foot[side].pitch_fade.at(u * at.stage_ticks);
    pitch_in_flight<double>(model, state, side, u,
                            table_pitch<double>(at, state, plan, side) + fade, fade,
                            flight.point[i]);
    flight.sole[i] = sole_of(model.leg[side], flight.point[i].pose);
    flight.left[i] = state.path.landing_m.z - flight.point[i].pose.heel_m.z;
  }
  flight.begin = piece_at(*model.terrain, foot.plane.place_m.z);
  flight.end = piece_at(*model.terrain, state.path.landing_m.z);
  flight.begin_room = kRoomAhead_m * model.size;  // generous, because the pitch may still change
  for (const vec3& p : flight.sole.front())
    flight.begin_room = std::min(
        {flight.begin_room, 0.7 * (flight.begin.to_m - p.z), 0.7 * (p.z - flight.begin.from_m)});
  flight.climb = climb(state, foot);
  return flight;
}

// The rise of the ground line that lets the sole, moved along z by `shift`, clear the ground.
Wanted wanted_raise(const Tick& tick, const Flight& flight, bool crosses_riser,
                    const FlightSpline& shift) noexcept {
  const Floor terrain{*tick.model.terrain, tick.placed};
  const double above_m = kRoomAbove_m * tick.model.size;
  Wanted above;
  for (int i = 0; i <= kProbes; ++i) {
    const double u = static_cast<double>(i) / kProbes, moved = spline_at(shift, 0.0, u);
    double over = -tick.model.leg_length_m;
    Sole sole = flight.sole[i];
    for (vec3& p : sole) {
      p.z += moved;
      if (flight.stays())
        p.z = std::clamp(p.z, flight.begin.from_m + kBeside_m, flight.begin.to_m - kBeside_m);
    }
    const auto ground = heights_at(terrain, sole);
    for (std::size_t k = 0; k < sole.size(); ++k)
      over = std::max(over, ground[k] - base_under(flight.point[i], flight.sole[i][k]));
    above[i] = crosses_riser ? over + above_m * in_flight(u)
                             : std::max(0.0, over) + std::clamp(over, 0.0, above_m);
  }
  above.front() = 0.0;
  above.back() = flight.climb;
  return above;
}

// In the second half of a flight a shift towards the landing is taken out of `beside` and becomes a
// share of the way that is left. The share only grows, so the foot is over its landing early and
// sinks to it; it never overshoots and comes back.
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

// Plans a flight that stays level or goes up.
void plan_over(const Tick& tick, const WalkState& state, const FootState& foot,
               const Flight& flight, FlightRoom& room) noexcept {
  const double size = tick.model.size;
  const Floor terrain{*tick.model.terrain, tick.placed};
  const Wanted above = wanted_raise(tick, flight, foot.crosses_riser, FlightSpline{});
  Wanted beside{};
  // Start gentle; sharpen until the riser is cleared.
  Ends ends;
  for (int tries = 0; tries < kTries; ++tries) {
    room.raise_m = envelope(above, ends);
    for (int i = 1; i < kProbes; ++i) {
      beside[i] = 0.0;
      const double u = static_cast<double>(i) / kProbes;
      if (!flight.stays() && above[i] <= spline_at(room.raise_m, above.back(), u)) continue;
      beside[i] = 2 * i < kProbes ? way_back(terrain, flight.sole[i], flight.begin,
                                             foot.plane.place_m.y, flight.begin_room, size)
                                  : way_back(terrain, flight.sole[i], flight.end,
                                             state.path.landing_m.y, kRoomBeside_m * size, size);
    }
    Wanted away = beside;
    room.shift_m = lead_in(flight, away);
    const FlightSpline back = wide_envelope(away, kMostShift_m * size);
    for (int k = 0; k < kFlightKnots - 1; ++k) room.shift_m[k] += back[k];
    if (!sharpen(beside, room.shift_m, size, ends)) break;
  }
}

// Smallest advance that moves the sole beyond all ground that is higher than the ground line with
// `raise` and lies before the landing's piece.
double way_on(const Tick& tick, const Flight& flight, int i, double raise) noexcept {
  const Floor terrain{*tick.model.terrain, tick.placed};
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

// The weight of each knot at each probe of the flight.
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

// Lowers the inner knots until the spline is a taut line over the wanted heights, minus some room:
// the envelope alone holds each height for two knots longer than needed. If the spline is too low
// already, it stays there.
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

// True for a flight over risers that all lead down.
bool leads_down(const Tick& tick, const Flight& flight) noexcept {
  if (flight.climb > -kRiser_m) return false;
  const Wanted above = wanted_raise(tick, flight, true, FlightSpline{});
  return *std::max_element(above.begin(), above.end()) < kRoomAbove_m * tick.model.size + kRiser_m;
}

// The advance of a foot over its planned path that brings it over its landing's piece in time: a
// growing share of the way that is left, as in lead_in().
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

// Plans a flight that goes down. Ahead of its own path, the foot sinks as soon as it has passed an
// edge.
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
  room.planned_for_m = state.path.landing_m;
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

GroundLine ground_line_of(const WalkModel& model, const WalkState& state, Side side,
                          const vec3& place_m, double u) noexcept {
  const FootState& foot = state.foot[side];
  const vec3 way = state.path.landing_m - foot.heel_anchor_m;
  const double begin_m = height_on(foot.plane, foot.heel_anchor_m),
               rise = state.path.landing_m.y - begin_m;
  const ClimbShare risen = climb_share(model, foot, way);
  return {begin_m + rise * risen.at(place_m - foot.heel_anchor_m, u), rise / model.leg_length_m};
}

void tilt_in_flight(const WalkState& state, Side side, double gone, FlightPoint& point) noexcept {
  const FootPlane& plane = state.foot[side].plane;
  FootPose& pose = point.pose;
  point.lifted_m = height_on(plane, pose.heel_m) - point.base_m;
  pose.tilt = plane.tilt;
  if (pose.tilt != state.path.landing_plane.tilt) {
    pose.tilt = glm::normalize(pose.tilt * (1.0 - gone) + state.path.landing_plane.tilt * gone);
  }
}

void clear_ground(const Tick& tick, WalkState& state, const StridePlan& plan, Side side, double u,
                  FlightPoint& point) noexcept {
  FootState& foot = state.foot[side];
  FlightRoom& room = foot.room;
  if (glm::distance(room.planned_for_m, state.path.landing_m) > kReplan_m * tick.model.size)
    plan_room(tick, state, side);
  for (int k = 0; k < kFlightKnots - 1; ++k) {
    const double time_s = kRoomSmoothing_s * tick.model.time_scale;
    room.raise[k].advance(room.raise_m[k], time_s, tick.dt_s);
    room.shift[k].advance(room.shift_m[k], time_s, tick.dt_s);
  }
  const auto in_force = [](const Damped<double>& k) { return k.x; };
  const double raise = spline_at(room.raise, climb(state, foot), u, in_force);
  point.base_m += raise;
  point.pose.heel_m += vec3(0.0, raise, spline_at(room.shift, 0.0, u, in_force));
  foot.rise_m = rise_with_hips(tick.model, state, plan, side, point.base_m);
  point.pose.heel_m.y += foot.rise_m;
}

}  // namespace gaitpad
