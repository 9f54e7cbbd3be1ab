// One leg by inverse kinematics (section 3.3.2): from where the pelvis and the foot are to be to
// the angles of hip, knee and ankle.
//
// Paper mode takes steps 1-7 to the letter, from the pose of the tick before, with raw weights.
// Robust mode starts from the tables' angles, which know of stiff joints already (walk_style.cpp).
// Six rows hold the whole foot; the knee's swivel, which they leave free, is pulled to the data's.
// What is left to solve for is little, and the weights of equation (5) share it out.
#include "animation/leg_ik.h"
#include "animation/walk_parts.h"

namespace gaitpad {
namespace {

constexpr double kLeastKnee = 1.0 * kDegree;  // where the solver starts: a knee that bends forward
constexpr double kMostDorsiflexion = -38.0 * kDegree, kSoftAnkle = 6.0 * kDegree,
                 kSoftFlying = 12.0 * kDegree;
// Near its limit an ankle is held more and more, and the leg turns outwards instead: with one step
// it would do so in a jerk.
constexpr double kHeldDorsiflexion = -57.0 * kDegree, kSoftHeld = 4.0 * kDegree;
constexpr double kSoftToe = 15.0 * kDegree;
constexpr double kLeastWeight = 0.05;
constexpr double kLeak_per_s = 4.0;   // of the correction on the data's angles
constexpr double kSideLever_m = 0.1;  // third point of the foot, beside the end-effector
constexpr RobustOptions kRobust = {.tolerance_m = 1e-6, .max_tries = 1};
constexpr PaperOptions kPaper = {.tolerance_m = 1e-5};

// The angles that the data show at this phase, fading to a stand.
LegAngles reference(const WalkModel& model, const StridePlan& plan, Side side) noexcept {
  LegAngles angles = model.stand_rad[side];
  for (int j = 0; j < kLegDofs; ++j) angles[j] += plan.cell.leg_rad[side][j];
  angles[kKneeX] = std::max(angles[kKneeX], kLeastKnee);
  return angles;
}

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
FootEnd end_effector(const FootState& foot) noexcept {  // Table I
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

// Always counted from the heel, so that the swivel that the rows leave free does not jump when the
// end-effector changes.
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

// Toes stay level while the heel is the higher end, on the floor and in the air, so they never dig
// in. In the air the change is rounded, on the floor it is exact.
double level_toe(double pitch_rad, double flight_progress) noexcept {
  const double air =
      smoothstep(0.0, 0.2, flight_progress) * (1.0 - smoothstep(0.8, 1.0, flight_progress));
  return -soft_positive(pitch_rad, std::max(1e-9, kSoftToe * air));
}

struct Solve {
  int iterations = 0;
  double error_m = 0.0;
  bool failed = false;
  void add(const IkResult& r) noexcept {
    iterations += r.iterations;
    error_m = r.error_m;
    failed = r.status != IkStatus::converged;
  }
};

struct PosedLeg {
  Solve solve;
  vec3 heel_m{0.0}, toe_m{0.0};  // in the pelvis' frame, from the hip joint
  double pitch_rad = 0.0;        // of the foot
};
// With the foot's frame in the pelvis', from the hip joint.
PosedLeg posed_leg(const Solve& solve, const IkFrame& end, const LegBuild& leg,
                   const Pelvis& pelvis, const FootPose& foot) noexcept {
  return {solve, end.position_m + end.rotation * leg.model.heel_m,
          end.position_m + end.rotation * leg.model.toe_m, foot_pitch(leg, pelvis, foot, end)};
}

// Weights count relative to the leg's largest. The foot's place goes before a locked joint.
LegAngles relative_weights(const WalkState& state, Side side) noexcept {
  double largest = 0.0;
  for (const Damped<double>& w : state.gait.weight[side]) largest = std::max(largest, w.x);
  LegAngles weight;
  weight.fill(1.0);
  if (largest <= 1e-6 * kLeastWeight) return weight;
  for (int j = 0; j < kLegDofs; ++j)
    weight[j] = std::clamp(state.gait.weight[side][j].x / largest, kLeastWeight, 1.0);
  return weight;
}

// Points a flying foot down: as far as the ground allows by its pitch alone, and farther by lifting
// it so that its toe stays at its height.
void point_foot_down(const LegBuild& leg, double more_rad, double flight_progress,
                     FootState& foot) noexcept {
  const double open =
      smoothstep(0.0, 0.2, flight_progress) * (1.0 - smoothstep(0.7, 0.95, flight_progress));
  FootPose& pose = foot.pose;
  const double room = highest_pitch(leg, heel_height(foot), 0.0) - pose.pitch_rad;
  const double allowed = std::min(more_rad, std::max(0.0, room));
  set_pitch(leg, pose.pitch_rad + allowed, pose, FootMode::flight);
  const double toe_m = pose.toe_m.y;
  set_pitch(leg, pose.pitch_rad + open * (more_rad - allowed), pose, FootMode::flight);
  const double lift_m = toe_m - pose.toe_m.y;
  pose.heel_m.y += lift_m;
  pose.toe_m.y += lift_m;
}

// Eases an ankle that bends up too far: in flight the foot points down, in late support the heel
// rises. A foot that has to stand still does neither. Near its limit the ankle is held. False if
// nothing was to be done.
bool ease_ankle(const Tick& tick, WalkState& state, Side side, const Pelvis& pelvis,
                IkAngles& angles, Solve& solve) noexcept {
  const LegBuild& leg = tick.model.leg[side];
  FootState& foot = state.foot[side];
  const bool flies = foot.mode == FootMode::flight;
  double excess =
      soft_positive(kMostDorsiflexion - angles[kAnkleX], flies ? kSoftFlying : kSoftAnkle);
  if (!flies) excess *= foot.mode == FootMode::support ? heel_rise(tick.model, state, side) : 0.0;
  double over = soft_positive(kHeldDorsiflexion - angles[kAnkleX], kSoftHeld);
  if (excess == 0.0 && over == 0.0) return false;
  IkChain chain = leg.chain;
  const LegAngles weight = relative_weights(state, side);
  for (int j = 0; j < kLegDofs; ++j) chain.dof[j].weight = weight[j];
  if (excess != 0.0) {
    if (flies) {
      point_foot_down(leg, excess, flight_progress(state), foot);
    } else {
      set_pitch(leg, foot.pose.pitch_rad + excess, foot.pose, foot.mode);
    }
    solve.add(solve_robust(chain, whole_foot(leg, foot, pelvis).all(), kRobust, angles));
    over = soft_positive(kHeldDorsiflexion - angles[kAnkleX], kSoftHeld);
  }
  if (over > 0.0) {
    chain.dof[kAnkleX].min_rad =
        std::max(chain.dof[kAnkleX].min_rad, angles[kAnkleX] + over * over / (over + kSoftHeld));
    solve.add(solve_robust(chain, whole_foot(leg, foot, pelvis).all(), kRobust, angles));
  }
  return true;
}

// --- Robust mode: several legs side by side, each in a lane
// ----------------------------------------

template <class V>
void set_vector(const vec3& from, int lane, Vec3Of<V>& to) noexcept {
  to.x[lane] = from.x, to.y[lane] = from.y, to.z[lane] = from.z;
}
template <class V>
vec3 vector_of(const Vec3Of<V>& from, int lane) noexcept {
  return {from.x[lane], from.y[lane], from.z[lane]};
}

// Where one leg's solver starts, and what is to be reached.
template <int kWidth>
void set_lane(const PlannedTick& planned, Side side, int lane, LegLanes<kWidth>& lanes) noexcept {
  const Tick& tick = *planned.tick;
  WalkState& state = *planned.state;
  const LegBuild& leg = tick.model.leg[side];
  LegGoals<Row<kWidth>>& goals = lanes.goals;
  // Start from the data's angles plus what the solver had to add a tick ago. That correction
  // leaks away, so the swivel, which no row holds, is pulled to the data's and cannot drift.
  const LegAngles data = reference(tick.model, planned.plan, side);
  const double keep = 1.0 - std::min(1.0, kLeak_per_s * tick.dt_s);
  const LegAngles weight = relative_weights(state, side);
  for (int j = 0; j < kLegDofs; ++j) {
    lanes.angles_rad[j][lane] =
        data[j] + keep * (state.legs.angles_rad[side][j] - state.legs.data_rad[side][j]);
    goals.weight[j][lane] = weight[j];
    goals.min_rad[j][lane] = leg.chain.dof[j].min_rad;
    goals.max_rad[j][lane] = leg.chain.dof[j].max_rad;
  }
  state.legs.data_rad[side] = data;
  // Without the ankle's limit first, so that the knee does not twist.
  goals.min_rad[kAnkleX][lane] = -kPi;
  goals.thigh_m[lane] = leg.model.thigh_m;
  goals.shank_m[lane] = leg.model.shank_m;
  // The rows of whole_foot(): what lies between the foot's points does not turn in its own axes.
  const FootPose& foot = state.foot[side].pose;
  const quat to_pelvis = glm::conjugate(planned.pelvis.rotation),
             rotation = to_pelvis * foot.rotation;
  const vec3 across = glm::cross(leg.line, leg.side), to_toe = leg.model.toe_m - leg.model.heel_m;
  const vec3 heel = to_pelvis * (foot.heel_m - planned.pelvis.hip(leg));
  const vec3 side_axis = rotation * leg.side, along_axis = rotation * leg.line,
             across_axis = glm::cross(along_axis, side_axis);
  set_vector(leg.model.heel_m, lane, goals.point_m[0]);
  set_vector(leg.model.toe_m, lane, goals.point_m[1]);
  set_vector(leg.model.heel_m + leg.side * kSideLever_m, lane, goals.point_m[2]);
  set_vector(side_axis, lane, goals.side);
  set_vector(across_axis, lane, goals.across);
  set_vector(along_axis, lane, goals.along);
  const double sideways = glm::dot(side_axis, heel), up = glm::dot(across_axis, heel);
  goals.goal_m[0][lane] = sideways;
  goals.goal_m[1][lane] = up;
  goals.goal_m[2][lane] = glm::dot(along_axis, heel);
  goals.goal_m[3][lane] = sideways + glm::dot(leg.side, to_toe);
  goals.goal_m[4][lane] = up + glm::dot(across, to_toe);
  goals.goal_m[5][lane] = up;
}

template <int kWidth>
PosedLeg take_lane(const PlannedTick& planned, Side side, int lane,
                   const LegLanes<kWidth>& lanes) noexcept {
  WalkState& state = *planned.state;
  const LegSolution<Row<kWidth>>& solution = lanes.solution;
  const LegBuild& leg = planned.tick->model.leg[side];
  IkAngles angles{};
  for (int j = 0; j < kLegDofs; ++j) angles[j] = lanes.angles_rad[j][lane];
  Solve solve;
  solve.iterations = static_cast<int>(solution.iterations[lane]);
  solve.error_m = std::sqrt(solution.squares[lane]);
  solve.failed = !(solution.squares[lane] <= kRobust.tolerance_m * kRobust.tolerance_m);
  const bool eased = ease_ankle(*planned.tick, state, side, planned.pelvis, angles, solve);
  state.legs.angles_rad[side] = leg_angles(angles);
  const FootPose& foot = state.foot[side].pose;
  if (eased || solve.failed)
    return posed_leg(solve, end_frame(leg.chain, angles), leg, planned.pelvis, foot);
  // The foot is where it was to be.
  return {solve, vector_of(solution.heel_m, lane), vector_of(solution.toe_m, lane), foot.pitch_rad};
}

// Steps 1-7 to the letter for the stage's end-effector alone. While heel and toe both stand or
// land, the other end is a second position goal.
PosedLeg pose_paper(const PlannedTick& planned, Side side) noexcept {
  const Tick& tick = *planned.tick;
  WalkState& state = *planned.state;
  const LegBuild& leg = tick.model.leg[side];
  IkChain chain = leg.chain;
  for (int j = 0; j < kLegDofs; ++j) chain.dof[j].weight = state.gait.weight[side][j].x;
  IkAngles angles = padded(state.legs.angles_rad[side]);
  const FootGoal goal =
      foot_goal(leg, state.foot[side], planned.pelvis, end_effector(state.foot[side]));
  const FootMode foot = state.foot[side].mode;
  const bool both = foot == FootMode::roll ||
                    (foot == FootMode::support && heel_rise(tick.model, state, side) == 0.0);
  Solve solve;
  solve.add(solve_paper(chain, both ? goal.both_ends() : goal.effector(), kPaper, angles));
  state.legs.angles_rad[side] = leg_angles(angles);
  return posed_leg(solve, end_frame(leg.chain, angles), leg, planned.pelvis, state.foot[side].pose);
}

// What the legs of one tick came to: the toes, and what the tick reports.
void report_leg(const PlannedTick& planned, Side side, const PosedLeg& posed) noexcept {
  WalkState& state = *planned.state;
  const Pelvis& pelvis = planned.pelvis;
  const LegBuild& leg = planned.tick->model.leg[side];
  FootState& foot = state.foot[side];
  foot.pose.toe_rad =
      level_toe(posed.pitch_rad, foot.mode == FootMode::flight ? flight_progress(state) : 0.0);
  const vec3 hip = pelvis.hip(leg);
  WalkFrame& frame = state.frame;
  frame.heel_m[side] = hip + pelvis.rotation * posed.heel_m;
  frame.toe_m[side] = hip + pelvis.rotation * posed.toe_m;
  frame.ik_iterations[side] = posed.solve.iterations;
  frame.ik_error_m[side] = posed.solve.error_m;
  frame.ik_failed[side] = posed.solve.failed;
}

template <int kWidth>
void pose_robust(std::span<const PlannedTick> planned) noexcept {
  constexpr std::size_t kTogether = kWidth / 2;
  LegLanes<kWidth> lanes;
  for (; planned.size() >= kTogether; planned = planned.subspan(kTogether)) {
    for (std::size_t lane = 0; lane < 2 * kTogether; ++lane)
      set_lane(planned[lane / 2], Side(lane % 2), static_cast<int>(lane), lanes);
    solve_legs(kRobust, lanes);
    for (std::size_t lane = 0; lane < 2 * kTogether; ++lane) {
      const Side side = Side(lane % 2);
      report_leg(planned[lane / 2], side,
                 take_lane(planned[lane / 2], side, static_cast<int>(lane), lanes));
    }
  }
  if constexpr (kTogether > 1) pose_robust<2>(planned);
}

}  // namespace

void pose_legs(std::span<const PlannedTick> planned, IkMode mode) noexcept {
  if (mode == IkMode::paper) {
    for (const PlannedTick& one : planned) {
      for (Side side : {kLeftSide, kRightSide}) {
        report_leg(one, side, pose_paper(one, side));
      }
    }
  } else if (lanes_in_use() >= 8 && planned.size() > 1) {
    pose_robust<8>(planned);
  } else if (lanes_in_use() >= 4 && planned.size() > 1) {
    pose_robust<4>(planned);
  } else {
    pose_robust<2>(planned);
  }
}

}  // namespace gaitpad
