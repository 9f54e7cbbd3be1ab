// Assertion 23: what becomes of a goal that no pose reaches.
#include <fmt/format.h>

#include <algorithm>

#include "paper/claims.h"

namespace gaitpad {
namespace {

constexpr int kFrames = 60;            // to the goal, and as many there
constexpr double kFar = 1.5;           // legs from the hip: a step that high
constexpr double kMostTurn_rad = kPi;  // a joint of a leg cannot turn further from frame to frame

IkResult solve(const IkChain& chain, const vec3& heel_m, const vec3& goal_m, IkMode mode,
               IkAngles& angles) {
  const auto rows = point_goal(heel_m, goal_m);
  if (mode == IkMode::paper) return solve_paper(chain, rows, {}, angles);
  return solve_robust(chain, rows, {.max_tries = 1}, angles);
}

}  // namespace

std::vector<Claim> reach_claims(const WalkModel& model, IkMode mode) {
  const LegBuild& leg = model.leg[kRightSide];
  IkAngles angles{};
  angles[kHipX] = -4.0 * kDegree, angles[kKneeX] = 8.0 * kDegree, angles[kAnkleX] = -4.0 * kDegree;
  const IkFrame end = end_frame(leg.chain, angles);
  const vec3 start = end.position_m + end.rotation * leg.model.heel_m;
  const vec3 far = glm::normalize(vec3(0.0, 0.5, 1.0)) * (kFar * leg.model.length_m());
  double most = 0.0;
  int broken = 0, flagged = 0, beyond = 0;
  for (int n = 1; n <= 2 * kFrames; ++n) {
    const double share = std::min(1.0, static_cast<double>(n) / kFrames);
    const IkAngles before = angles;
    const IkResult result =
        solve(leg.chain, leg.model.heel_m, start + (far - start) * share, mode, angles);
    for (int j = 0; j < kLegDofs; ++j) {
      const double turn = std::fabs(angles[j] - before[j]);
      broken += !std::isfinite(turn);
      most = std::max(most, turn);
    }
    beyond += n >= kFrames;
    flagged += n >= kFrames && result.status != IkStatus::converged;
  }
  ClaimList list("3.3.2", mode);
  list.add("23 angles that are no number", broken, equal_to(0), "heel to a place 1.5 legs away");
  list.add("23 a joint turns from frame to frame by, rad", most, at_most(kMostTurn_rad),
           mode == IkMode::paper ? "no damping and no limits: windings beside the stretched leg; "
                                   "planar prototype 7062 rad"
                                 : "");
  list.add("23 frames out of reach that are flagged", static_cast<double>(flagged) / beyond,
           equal_to(1.0));
  return list.take();
}

}  // namespace gaitpad
