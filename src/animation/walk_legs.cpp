// Legs that are solved one at a time (section 3.3.2): in paper mode, and where an ankle bends too
// far. walk_figure.h has the legs that are solved side by side.
//
// Paper mode takes steps 1-7 to the letter, from the pose of the tick before, with raw weights.
#include "animation/walk_figure.h"

namespace gaitpad {
namespace {

constexpr PaperOptions kPaper = {.tolerance_m = 1e-5};

IkAngles padded(const LegAngles& angles) noexcept {
  IkAngles all{};
  std::copy(angles.begin(), angles.end(), all.begin());
  return all;
}
LegAngles leg_angles(const IkAngles& all) noexcept {
  LegAngles angles;
  std::copy_n(all.begin(), kLegDofs, angles.begin());
  return angles;
}

// Rows that hold the whole foot: three of the end-effector (the paper's half Jacobian), two of the
// foot's other end, one of a point beside the end-effector. Their directions are the foot's own
// axes, so every row is well conditioned; the height of a steep foot's other end would not be.
struct FootGoal {
  std::array<IkRow, 6> rows;
  std::span<const IkRow> effector() const noexcept { return {rows.data(), 3}; }
  std::span<const IkRow> both_ends() const noexcept { return {rows.data(), 5}; }
  std::span<const IkRow> all() const noexcept { return rows; }
};

enum class FootEnd { heel, toe };
FootEnd end_effector(const FootState& foot) noexcept {  // the stage decides, as in Table I
  return foot.mode == FootMode::support ? FootEnd::toe : FootEnd::heel;
}

FootGoal foot_goal(const LegBuild& leg, const FootState& foot, const Pelvis& pelvis,
                   FootEnd end) noexcept {
  const bool on_toe = end == FootEnd::toe;
  const quat to_pelvis = glm::conjugate(pelvis.rotation);
  const quat rotation = to_pelvis * foot.pose.rotation;
  const vec3 hip = pelvis.hip(leg);
  const vec3 effector = to_pelvis * ((on_toe ? foot.pose.toe_m : foot.pose.heel_m) - hip);
  const vec3 effector_point = on_toe ? leg.model.toe_m : leg.model.heel_m;
  const vec3 other_point = on_toe ? leg.model.heel_m : leg.model.toe_m;
  const vec3 side = rotation * leg.side, along = rotation * leg.line,
             across = glm::cross(along, side);
  const vec3 other = effector + rotation * (other_point - effector_point);
  const vec3 beside_point = effector_point + leg.side * kSideLever_m;
  const vec3 beside = effector + side * kSideLever_m;
  return {{IkRow{effector_point, side, glm::dot(side, effector)},
           IkRow{effector_point, across, glm::dot(across, effector)},
           IkRow{effector_point, along, glm::dot(along, effector)},
           IkRow{other_point, side, glm::dot(side, other)},
           IkRow{other_point, across, glm::dot(across, other)},
           IkRow{beside_point, across, glm::dot(across, beside)}}};
}

// The foot's goals, always counted from the heel, so that the swivel that the rows leave free does
// not jump when the end-effector changes.
FootGoal whole_foot(const LegBuild& leg, const FootState& foot, const Pelvis& pelvis) noexcept {
  return foot_goal(leg, foot, pelvis, FootEnd::heel);
}

double foot_pitch(const LegBuild& leg, const Pelvis& pelvis, const FootPose& pose,
                  const IkFrame& end) noexcept {
  const vec3 line = glm::conjugate(pose.yaw) *
                    (glm::conjugate(pose.tilt) *
                     (pelvis.rotation * (end.rotation * (leg.model.toe_m - leg.model.heel_m))));
  return leg.elevation_rad - atan2(line.y, glm::dot(line, leg.forward));
}

void add(const IkResult& r, PosedLeg& solved) noexcept {
  solved.iterations += r.iterations;
  solved.squares = r.error_m * r.error_m;
  solved.failed = r.status != IkStatus::converged;
}

// Heel, toe and pitch at these angles.
PosedLeg posed_leg(PosedLeg solved, const IkAngles& angles, const LegBuild& leg,
                   const Pelvis& pelvis, const FootPose& foot) noexcept {
  const IkFrame end = end_frame(leg.chain, angles);
  solved.heel_m = pelvis.place(leg, end.position_m + end.rotation * leg.model.heel_m);
  solved.toe_m = pelvis.place(leg, end.position_m + end.rotation * leg.model.toe_m);
  solved.pitch_rad = foot_pitch(leg, pelvis, foot, end);
  return solved;
}

// Points a flying foot down: as far as the ground allows by its pitch alone, and farther by lifting
// it so that its toe stays at its height.
void point_foot_down(const LegBuild& leg, double more_rad, double flight_progress,
                     FootState& foot) noexcept {
  const double open =
      smoothstep(0.0, 0.2, flight_progress) * (1.0 - smoothstep(0.7, 0.95, flight_progress));
  FootPose& pose = foot.pose;
  // Height of the heel over the plane that the foot is planned on.
  const double heel_m = (pose.heel_m.y - foot.base_m) * foot.plane.normal.y;
  const double room = highest_pitch<double>(leg, heel_m, 0.0) - pose.pitch_rad;
  const double allowed = std::min(more_rad, std::max(0.0, room));
  pitch_foot(leg, pose.pitch_rad + allowed, pose, FootMode::flight);
  const double toe_m = pose.toe_m.y;
  pitch_foot(leg, pose.pitch_rad + open * (more_rad - allowed), pose, FootMode::flight);
  const double lift_m = toe_m - pose.toe_m.y;
  pose.heel_m.y += lift_m;
  pose.toe_m.y += lift_m;
}

// The share to which the first step's ankle is eased. A start begins in the middle of a step, at
// which the heels of a walk have risen already. An ankle that stairs bend up far while standing
// would jump to that, so its easing grows with the roll.
double share_of_start(const StepClock& clock) noexcept {
  if (!clock.starting || clock.stage != Stage::roll) return 1.0;
  return smoothstep(0.0, 1.0, double(clock.tick) / clock.stage_ticks);
}

// Eases an ankle that bends up too far: in flight the foot points down, in late support the heel
// rises. A foot that has to stand still does neither. Near its limit the ankle is held. False if
// nothing had to be done.
bool ease_ankle(const Tick& tick, WalkState& state, Side side, const Pelvis& pelvis,
                IkAngles& angles, PosedLeg& solve) noexcept {
  const LegBuild& leg = tick.model.leg[side];
  FootState& foot = state.foot[side];
  const bool flies = foot.mode == FootMode::flight;
  double excess =
      soft_positive(kMostDorsiflexion - angles[kAnkleX], flies ? kSoftFlying : kSoftAnkle);
  if (!flies)
    excess *= foot.mode == FootMode::support
                  ? heel_rise<double>(tick.model, moment_of(tick.model, state), side) *
                        share_of_start(state.clock)
                  : 0.0;
  double over = soft_positive(kHeldDorsiflexion - angles[kAnkleX], kSoftHeld);
  if (excess == 0.0 && over == 0.0) return false;
  IkChain chain = leg.chain;
  if (excess != 0.0) {
    if (flies) {
      point_foot_down(leg, excess, moment_of(tick.model, state).flight_progress(), foot);
    } else {
      pitch_foot(leg, foot.pose.pitch_rad + excess, foot.pose, foot.mode);
    }
    add(solve_robust(chain, whole_foot(leg, foot, pelvis).all(), kRobust, angles), solve);
    over = soft_positive(kHeldDorsiflexion - angles[kAnkleX], kSoftHeld);
  }
  if (over > 0.0) {
    chain.dof[kAnkleX].min_rad =
        std::max(chain.dof[kAnkleX].min_rad, angles[kAnkleX] + over * over / (over + kSoftHeld));
    add(solve_robust(chain, whole_foot(leg, foot, pelvis).all(), kRobust, angles), solve);
  }
  return true;
}

}  // namespace

// Steps 1-7, followed literally, for the stage's end-effector alone. While heel and toe both stand
// or land, the other end is a second position goal.
PosedLeg pose_paper(const Tick& tick, WalkState& state, const Pelvis& pelvis, Side side) noexcept {
  const LegBuild& leg = tick.model.leg[side];
  const FootState& foot = state.foot[side];
  IkChain chain = leg.chain;
  for (int j = 0; j < kLegDofs; ++j) chain.dof[j].weight = state.gait.weight[side][j].x;
  IkAngles angles = padded(state.legs.angles_rad[side]);
  const FootGoal goal = foot_goal(leg, foot, pelvis, end_effector(foot));
  const bool both = foot.mode == FootMode::roll ||
                    (foot.mode == FootMode::support &&
                     heel_rise<double>(tick.model, moment_of(tick.model, state), side) == 0.0);
  PosedLeg solve;
  add(solve_paper(chain, both ? goal.both_ends() : goal.effector(), kPaper, angles), solve);
  state.legs.even_rad[side] = state.legs.angles_rad[side] = leg_angles(angles);
  return posed_leg(solve, angles, leg, pelvis, foot.pose);
}

PosedLeg mended_leg(const Tick& tick, WalkState& state, const Pelvis& pelvis, Side side,
                    PosedLeg solved) noexcept {
  IkAngles angles = padded(state.legs.even_rad[side]);
  const bool eased = ease_ankle(tick, state, side, pelvis, angles, solved);
  if (!eased && solved.failed == 0.0) return solved;
  state.legs.even_rad[side] = leg_angles(angles);
  const FootState& foot = state.foot[side];
  return posed_leg(solved, angles, tick.model.leg[side], pelvis, foot.pose);
}

}  // namespace gaitpad
