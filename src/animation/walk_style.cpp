// What a style asks of the stride: stiff joints and the hips' bounce.
//
// The planted feet fix where the hips go, so a joint that is to flex less cannot do so by itself:
// the pelvis has to give way over the whole stride. The clean strides were solved for that when the
// motion was loaded (StrideWish), and a tick only adds up what is asked for. The weights of
// equation (5) then act on what is left to the inverse kinematics, too.
#include <algorithm>
#include <span>

#include "animation/walk_parts.h"

namespace gaitpad {
namespace {

constexpr double kMostShown = 1.2;  // responses grow with the stride up to here
constexpr double kSoftShown = 0.1;
constexpr std::size_t kAlone = 6;  // wishes of one leg: three joints, two sides
// Of a step's length the ground leaves so little on stairs, and so much where it is nearly level:
// what the responses know of is level ground.
constexpr double kStairs = 0.5, kLevel = 0.95;
// What several wishes ask for together does not bend a knee less than this.
constexpr double kStraightKnee = 1.5 * kDegree;

// How stiff hip, knee and ankle are beside the leg's freest joint: 0 free .. held_back(0) locked.
std::array<double, 3> stiffness(const WalkState& state, int side) noexcept {
  const auto& weight = state.gait.weight[side];
  double largest = 1e-6;
  for (const Damped<double>& w : weight) largest = std::max(largest, w.x);
  const auto of = [&](int dof) { return held_back(std::clamp(weight[dof].x / largest, 0.0, 1.0)); };
  return {of(kHipX), of(kKneeX), of(kAnkleX)};
}

// x, but never beyond `most`: the closer, the less of it. Both at least 0.
double bounded(double x, double most) noexcept {
  const double a = x * x, b = most * most;
  return x == 0.0 ? 0.0 : x * most / std::sqrt(std::sqrt(a * a + b * b));
}

double& granted(WalkState& state, StrideWish wish, int joint = 0) noexcept {
  return state.gait.granted[static_cast<std::size_t>(wish) + joint];
}

}  // namespace

void grant_wishes(IkMode mode, WalkState& state) noexcept {
  const double bounce = state.gait.bounce.x - 1.0;
  granted(state, StrideWish::more_bounce) = std::max(0.0, bounce);
  granted(state, StrideWish::less_bounce) = std::max(0.0, -bounce);
  for (int side : {0, 1})
    granted(state, StrideWish::low_left, side) =
        std::max(0.0, 1.0 - state.gait.flight_height[side].x) / (1.0 - kLowLift);
  if (mode == IkMode::paper) return;
  const std::array<double, 3> left = stiffness(state, kLeftSide),
                              right = stiffness(state, kRightSide);
  for (int k = 0; k < 3; ++k) {
    const double both = std::min(left[k], right[k]);
    granted(state, StrideWish::stiff_hips, k) = both;
    granted(state, StrideWish::stiff_left_hip, k) = left[k] - both;
    granted(state, StrideWish::stiff_right_hip, k) = right[k] - both;
  }
}

void change_stride(const WalkModel& model, const WalkState& state, double ratio,
                   StridePlan& plan) noexcept {
  const std::vector<StrideResponse>& response = model.cycle.strides->response;
  if (state.clock.backward || response.empty()) return;
  StrideWishes wishes = state.gait.granted;
  const double share = plan.shown * soft_min(ratio, kMostShown, kSoftShown) *
                       smoothstep(kStairs, kLevel, state.gait.ground_share.x);
  bool any = false;
  for (double& wish : wishes) any = any || wish != 0.0;
  if (!any) return;
  for (double& wish : wishes) wish *= share;
  // The hips' travel grows with the square of the stride.
  for (const StrideWish wish : {StrideWish::more_bounce, StrideWish::less_bounce})
    wishes[static_cast<std::size_t>(wish)] *= ratio;
  StrideWishes of_pelvis = wishes;
  const auto alone = [](StrideWishes& w) {
    return std::span(w).subspan(static_cast<std::size_t>(StrideWish::stiff_left_hip), kAlone);
  };
  std::ranges::fill(alone(of_pelvis), 0.0);
  StrideChange change = change_at(response, of_pelvis, plan.phase);
  const auto asked = alone(wishes);
  if (std::ranges::any_of(asked, [](double wish) { return wish != 0.0; })) {
    StrideWishes of_leg{};
    std::ranges::copy(asked, alone(of_leg).begin());
    plan.injury = change_at(response, of_leg, plan.phase);
    for (int side : {0, 1}) {
      change.heel_m[side] += plan.injury.heel_m[side];
      change.pitch_rad[side] += plan.injury.pitch_rad[side];
      for (int j = 0; j < kLegDofs; ++j) change.leg_rad[side][j] += plan.injury.leg_rad[side][j];
    }
  }
  const double length = model.stride_scale.length;
  plan.cell.pelvis_m += length * change.pelvis_m;
  for (int side : {0, 1}) {
    plan.heel_m[side] = length * change.heel_m[side];
    plan.cell.foot[side].pitch_rad += change.pitch_rad[side];
    LegAngles& angles = plan.cell.leg_rad[side];
    const double knee = angles[kKneeX];
    for (int j = 0; j < kLegDofs; ++j) angles[j] += change.leg_rad[side][j];
    const double room = knee + model.stand_rad[side][kKneeX] - kStraightKnee;
    if (angles[kKneeX] < knee)
      angles[kKneeX] = knee - bounded(knee - angles[kKneeX], std::max(room, 0.0));
  }
}

}  // namespace gaitpad
