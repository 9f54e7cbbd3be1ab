#include "gaitpad/walk_model.h"

#include "base/ranges.h"
#include "motion/leg_pose.h"
#include "walk/tables.h"

namespace gaitpad {
namespace {

// Limits of a joint's angle in degrees, after AAOS.
struct Limits {
  double min, max;
};

// --- The upper body ------------------------------------------------------------------------------

// Of a left arm; those of a right arm are mirrored in z and y.
constexpr std::array<Limits, kArmDofs> kArmLimits = {
    {{-170, 60}, {-35, 150}, {-90, 80}, {-150, -2}, {-60, 60}, {-25, 35}}};
// World frames of the joints in the data's sample i, with the root at the origin.
JointFrames frames_of_sample(const GaitCycle& cycle, int i) {
  const std::size_t joints = cycle.skeleton.joints.size();
  JointFrames frames;
  forward_kinematics(cycle.skeleton, std::span(cycle.local).subspan(i * joints, joints), frames);
  return frames;
}

quat mean_local(const GaitCycle& cycle, int joint) {
  const std::size_t joints = cycle.skeleton.joints.size();
  return mean_rotation(kCycleSamples, [&](int i) { return cycle.local[i * joints + joint]; });
}

vec3 perpendicular(const vec3& v, const vec3& to) { return v - to * glm::dot(v, to); }

// The hanging axes in the shoulder joint's frame: y along the bone, x along the elbow's hinge. The
// data show the hinge if they bend the elbow; if they hardly do, the hinge is the walker's left.
quat hanging_axes(const GaitCycle& cycle, const ArmChain& joints, const JointFrames& standing) {
  vec3 bone(0.0), hinge(0.0);
  for (int i = 0; i < kCycleSamples; ++i) {
    const JointFrames at = frames_of_sample(cycle, i);
    const quat back = glm::conjugate(at.rotation[joints.shoulder]);
    const vec3& elbow_m = at.position_m[joints.elbow];
    const vec3 upper = glm::normalize(elbow_m - at.position_m[joints.shoulder]);
    const vec3 fore = glm::normalize(at.position_m[joints.wrist] - elbow_m);
    bone += back * upper;
    hinge -= back * glm::cross(upper, fore);
  }
  const vec3 y = -glm::normalize(bone);
  hinge = perpendicular(hinge / double(kCycleSamples), y);
  const vec3 left = perpendicular(glm::conjugate(standing.rotation[joints.shoulder]) * kLeft, y);
  constexpr double kClearHinge = 0.05;  // mean sine of the elbow's bend that shows the hinge
  const bool is_clear = glm::length(hinge) > kClearHinge && glm::dot(hinge, left) > 0.0;
  vec3 x = is_clear ? hinge : left;
  if (glm::length(x) < 1e-3) x = perpendicular(std::abs(y.x) < 0.9 ? kLeft : kUp, y);
  x = glm::normalize(x);
  return from_axes(x, y, glm::cross(x, y));
}

// Middle of the hand: from the wrist towards the joint that it carries, else along the forearm.
vec3 grip_of(const GaitCycle& cycle, const ArmBuild& arm, const JointFrames& standing) {
  vec3 sum(0.0);
  double longest_m = 0.0;
  for (const Joint& joint : cycle.skeleton.joints) {
    if (joint.parent != arm.joints.wrist) continue;
    sum += joint.offset_m;
    longest_m = std::max(longest_m, glm::length(joint.offset_m));
  }
  constexpr double kGrip_m = 0.075;  // of an adult, from the wrist to the middle of the hand
  constexpr double kHandPart = 0.5;  // the same over the length of a short hand
  const double usual_m = kGrip_m * arm.length_m / kReferenceArm_m;
  if (glm::length(sum) < 1e-6) {
    const vec3 fore = standing.position_m[arm.joints.wrist] - standing.position_m[arm.joints.elbow];
    return glm::conjugate(standing.rotation[arm.joints.wrist]) * glm::normalize(fore) * usual_m;
  }
  return glm::normalize(sum) * std::min(usual_m, std::max(kHandPart * longest_m, 0.3 * usual_m));
}

// The angles of the data's arm in one sample; those of the wrist count from its pose in the data.
ArmAngles angles_of(const JointFrames& at, const Skeleton& skeleton, const ArmBuild& arm) {
  const ArmChain& j = arm.joints;
  const quat base = at.rotation[skeleton.joints[j.shoulder].parent] * arm.chest;
  const quat upper = at.rotation[j.shoulder] * arm.hanging;
  const AnglesXzy a = angles_xzy(glm::conjugate(base) * upper);
  const vec3 fore = glm::conjugate(upper) * (at.position_m[j.wrist] - at.position_m[j.elbow]);
  ArmAngles angles{};
  angles[kShoulderX] = a.x, angles[kShoulderZ] = a.z, angles[kShoulderY] = a.y;
  angles[kElbowX] = gaitpad::atan2(-fore.z, -fore.y);
  return angles;
}

void fill_ranges(const GaitCycle& cycle, Side side, const JointFrames& standing, ArmBuild& arm) {
  const ArmAngles rest = angles_of(standing, cycle.skeleton, arm);
  ArmAngles low = rest, high = rest, before = rest;
  double straightest = -1e9;
  for (int i = 0; i < kCycleSamples; ++i) {
    const JointFrames at = frames_of_sample(cycle, i);
    ArmAngles now = angles_of(at, cycle.skeleton, arm);
    for (int d = 0; d < kArmDofs; ++d) {
      now[d] = before[d] + wrapped(now[d] - before[d]);
      low[d] = std::min(low[d], now[d]), high[d] = std::max(high[d], now[d]);
      arm.middle_rad[d] += now[d] / kCycleSamples;
    }
    straightest = std::max(straightest, now[kElbowX]);
    before = now;
  }
  for (int d = 0; d < kArmDofs; ++d) {
    const bool is_mirrored =
        side == kRightSide && (d == kShoulderZ || d == kShoulderY || d == kWristZ);
    const Limits left = kArmLimits[d], own = is_mirrored ? Limits{-left.max, -left.min} : left;
    const double room = d == kElbowX ? 0.0 : 5.0 * kDegree;
    arm.min_rad[d] = std::min(own.min * kDegree, low[d] - room);
    arm.max_rad[d] = std::max(own.max * kDegree, high[d] + room);
  }
  constexpr double kLeastFlexion = 4.0 * kDegree;  // bend that an elbow keeps in a wide swing
  // Of shoulder z: near a right angle x and y are one axis.
  constexpr double kWidestTurn_rad = 1.45;
  const double middle = arm.middle_rad[kElbowX];
  const double room = std::max(0.0, -kLeastFlexion - middle);
  arm.most_elbow_swing = std::max(1.0, room / std::max(1e-3, straightest - middle));
  arm.is_there = std::max(std::abs(low[kShoulderZ]), std::abs(high[kShoulderZ])) < kWidestTurn_rad;
}

ArmBuild arm_build(const GaitCycle& cycle, const ArmChain& joints, Side side,
                   const JointFrames& standing) {
  ArmBuild arm;
  arm.joints = joints;
  if (!joints.is_found() || cycle.skeleton.joints[joints.shoulder].parent < 0) return arm;
  arm.path = path_below(cycle.skeleton, -1, joints.wrist);
  if (arm.path.size() > kMaxBodyPath) return arm;
  arm.swing_shoulder = mean_local(cycle, joints.shoulder);
  arm.swing_elbow = mean_local(cycle, joints.elbow);
  arm.chest = glm::conjugate(standing.rotation[cycle.skeleton.joints[joints.shoulder].parent]);
  arm.length_m =
      glm::distance(standing.position_m[joints.shoulder], standing.position_m[joints.elbow]) +
      glm::distance(standing.position_m[joints.elbow], standing.position_m[joints.wrist]);
  if (!(arm.length_m > 1e-3)) return arm;
  arm.hanging = hanging_axes(cycle, joints, standing);
  arm.grip_m = grip_of(cycle, arm, standing);
  fill_ranges(cycle, side, standing, arm);
  return arm;
}

// Chooses at most kMaxSpineIk of the spine's joints, evenly distributed.
void fill_spine(const GaitCycle& cycle, const std::vector<int>& spine, const JointFrames& standing,
                UpperBodyModel& body) {
  if (spine.size() < 2) return;
  body.spine_path = path_below(cycle.skeleton, -1, spine.back());
  if (body.spine_path.size() > kMaxBodyPath) return;
  const int below = cycle.skeleton.joints[spine.front()].parent;
  body.spine_base = standing.rotation[below];
  const int n = static_cast<int>(std::min<std::size_t>(spine.size(), kMaxSpineIk));
  for (int i = 0; i < n; ++i) {
    const std::size_t at = static_cast<std::size_t>(i) * (spine.size() - 1) / (n - 1);
    body.spine.push_back(
        {spine[at], standing.rotation[spine[at]], static_cast<double>(i) / (n - 1)});
  }
  double arms = 0.0;
  for (const ArmBuild& arm : body.arm) {
    if (!arm.is_there) continue;
    body.neck_m += standing.position_m[arm.joints.shoulder] - standing.position_m[spine.back()];
    arms += 1.0;
  }
  if (arms > 0.0) body.neck_m /= arms;
}

void fill_head(const GaitCycle& cycle, const UpperBodyJoints& joints, const JointFrames& standing,
               UpperBodyModel& body) {
  if (joints.head <= 0) return;
  const std::vector<int> path = path_below(cycle.skeleton, -1, joints.head);
  if (path.size() > kMaxBodyPath) return;
  const int first = joints.neck.empty() ? joints.head : joints.neck.front();
  body.head_path = path;
  body.neck_at = static_cast<int>(std::find(path.begin(), path.end(), first) - path.begin());
  body.head_standing = standing.rotation[joints.head];
  body.chest_standing = standing.rotation[cycle.skeleton.joints[first].parent];
}

// Arms, spine and head of a cycle that has the character's lengths. `leg_ratio`: the character's
// leg over the data's.
UpperBodyModel upper_body_model(const GaitCycle& cycle, double leg_ratio, double pelvis_height_m) {
  UpperBodyModel body;
  JointFrames standing;
  forward_kinematics(cycle.skeleton, cycle.standing_local, standing);
  body.joints = find_upper_body(cycle.skeleton, {cycle.leg[0].joints, cycle.leg[1].joints},
                                cycle.pelvis, standing.position_m);
  const UpperBodyJoints& joints = body.joints;
  body.own_step_s = 0.5 * cycle.duration_s * std::sqrt(std::sqrt(leg_ratio));
  double height_m = 0.0, length_m = 0.0, arms = 0.0;
  for (const Side side : {kLeftSide, kRightSide}) {
    body.arm[side] = arm_build(cycle, joints.arm[side], side, standing);
    if (!body.arm[side].is_there) continue;
    height_m = std::max(height_m, standing.position_m[joints.arm[side].shoulder].y);
    length_m += body.arm[side].length_m;
    arms += 1.0;
  }
  if (arms > 0.0) body.arm_m = length_m / arms;
  body.shoulder_height_m = pelvis_height_m + height_m - standing.position_m[cycle.pelvis].y;
  fill_spine(cycle, joints.spine, standing, body);
  fill_head(cycle, joints, standing, body);
  return body;
}

// --- Legs and tables -----------------------------------------------------------------------------

// Of a leg; hip flexion and dorsiflexion are negative.
constexpr std::array<Limits, kLegDofs> kLegLimits = {
    {{-120, 60}, {-50, 50}, {-70, 70}, {1, 150}, {-60, 75}, {-60, 60}, {-80, 80}}};

IkChain leg_chain(const LegModel& leg) {
  constexpr std::array<vec3, kLegDofs> kAxis = {vec3(1, 0, 0), vec3(0, 0, 1), vec3(0, 1, 0),
                                                vec3(1, 0, 0), vec3(1, 0, 0), vec3(0, 0, 1),
                                                vec3(0, 1, 0)};
  IkChain chain;
  chain.dofs = kLegDofs;
  for (int j = 0; j < kLegDofs; ++j) {
    chain.dof[j].axis = kAxis[j];
    chain.dof[j].min_rad = kLegLimits[j].min * kDegree;
    chain.dof[j].max_rad = kLegLimits[j].max * kDegree;
  }
  chain.dof[kHipY].link_m = vec3(0.0, -leg.thigh_m, 0.0);
  chain.dof[kKneeX].link_m = vec3(0.0, -leg.shank_m, 0.0);
  return chain;
}

// Scales bones below the hips by scale * leg_ratio, all others by scale.
void scale_build(GaitCycle& cycle, double scale, double leg_ratio) {
  for (std::size_t j = 0; j < cycle.skeleton.joints.size(); ++j) {
    Joint& joint = cycle.skeleton.joints[j];
    bool in_leg = false;
    for (const LegModel& leg : cycle.leg) {
      in_leg = in_leg || (static_cast<int>(j) != leg.joints.hip &&
                          is_ancestor(cycle.skeleton, leg.joints.hip, static_cast<int>(j)));
    }
    joint.offset_m *= in_leg ? scale * leg_ratio : scale;
  }
  const double k = scale * leg_ratio;
  for (LegModel& leg : cycle.leg) {
    leg.hip_m *= scale;
    for (double* m : {&leg.thigh_m, &leg.shank_m, &leg.toe_rest_m, &leg.toe_end_rest_m}) *m *= k;
    for (vec3* m : {&leg.heel_m, &leg.toe_m, &leg.toe_end_m}) *m *= k;
  }
}

LegBuild leg_build(const LegModel& model) {
  LegBuild leg;
  leg.model = model;
  leg.chain = leg_chain(model);
  leg.forward = foot_forward(model);
  leg.side = glm::cross(kUp, leg.forward);
  leg.ball_m = vec3(model.toe_m.x, model.heel_m.y, model.toe_m.z);
  leg.tip_m = leg.ball_m + vec3(model.toe_end_m.x, 0.0, model.toe_end_m.z);
  return leg;
}

// Mean place of a standing heel relative to the pelvis' path, over the flat part of support: from
// 0.12 to 0.32 of the cycle after the strike.
vec3 mean_heel(const GaitCycle& source, Side side) {
  vec3 sum(0.0);
  constexpr int kCount = 16;
  for (int i = 0; i < kCount; ++i) {
    const double own = 0.12 + 0.2 * i / kCount;
    const LegSample leg = sample_at(source, own + source.strike[side]).leg[side];
    vec3 heel = leg.ankle_m + leg.foot * source.leg[side].heel_m;
    heel.z += source.stride_m * own;
    sum += heel / static_cast<double>(kCount);
  }
  return sum;
}

// True if a leg has too many joints. The pose is written without heap, so the number of joints
// between two joints of a leg is bounded.
bool has_overlong_leg(const GaitCycle& cycle) {
  for (const LegModel& leg : cycle.leg) {
    const std::array<int, 5> chain = {cycle.pelvis, leg.joints.hip, leg.joints.knee,
                                      leg.joints.ankle, leg.joints.toe};
    for (std::size_t i = 1; i < chain.size(); ++i) {
      const int above = cycle.skeleton.joints[chain[i]].parent;
      if (path_below(cycle.skeleton, chain[i - 1], above).size() > kMaxBetween) return true;
    }
  }
  return false;
}

// A place relative to the pelvis, turned with the pelvis.
vec3 pelvis_turned(const vec3& place_m, double yaw_rad, const vec3& tilt) noexcept {
  return rotation_y(yaw_rad) * (from_rotation_vector(tilt) * place_m);
}

// Scales the pelvis of the motion's stride to the character (StrideScale). The legs keep their
// angles: a wider pelvis turns and rolls less, by `length / pelvis`, and the middle of the hips
// follows its scaled path.
void scale_pelvis(const StrideScale& to, StrideCell& cell) noexcept {
  if (to.length == to.pelvis) {
    cell.pelvis_m *= to.length;
    return;
  }
  const double turns = to.length / to.pelvis;
  const auto hips_m = [&](double share, const vec3& standing_m) {
    vec3 tilt = cell.pelvis_tilt;
    tilt.z = share * (tilt.z + to.stand_roll_rad);
    return pelvis_turned(to.hips_m, share * cell.pelvis_yaw_rad, tilt) - standing_m;
  };
  cell.pelvis_m = to.length * (cell.pelvis_m + hips_m(1.0, to.standing_m[0])) -
                  to.pelvis * hips_m(turns, to.standing_m[1]);
  cell.pelvis_yaw_rad *= turns;
  cell.pelvis_tilt.z *= turns;
}

StrideScale stride_scale(const GaitCycle& cycle, double scale, double ratio) noexcept {
  StrideScale to;
  to.length = ratio;
  to.pelvis = scale;
  to.hips_m = 0.5 * (cycle.leg[0].hip_m + cycle.leg[1].hip_m);
  to.stand_roll_rad = cycle.strides->stand_roll_rad;
  const double turns = ratio / scale;
  to.standing_m = {pelvis_turned(to.hips_m, 0.0, vec3(0.0, 0.0, to.stand_roll_rad)),
                   pelvis_turned(to.hips_m, 0.0, vec3(0.0, 0.0, turns * to.stand_roll_rad))};
  for (int side : {0, 1})
    to.apart_m[side] = vec3(cycle.leg[side].hip_m.x, 0.0, to.hips_m.z) * (scale - ratio);
  return to;
}

// Lays out the legs. Joints between two joints of a leg, and between the pelvis and the hip, keep
// their standing rotation.
void lay_out_legs(WalkModel& model) {
  const Skeleton& skeleton = model.cycle.skeleton;
  for (LegBuild& leg : model.leg) {
    const LegJoints& joints = leg.model.joints;
    int last = model.cycle.pelvis;
    quat standing = model.cycle.pelvis_standing;
    for (int i = 0; const int joint : {joints.hip, joints.knee, joints.ankle, joints.toe}) {
      if (skeleton.joints[joint].is_end_site) break;
      quat between = kIdentity;
      for (int j = skeleton.joints[joint].parent; j != last; j = skeleton.joints[j].parent)
        between = model.cycle.standing_local[j] * between;
      leg.joint[i] = {joint, glm::conjugate(standing * between), leg.model.standing[i]};
      standing = leg.model.standing[i];
      last = joint;
      ++i;
    }
  }
}

// Lists the joints that the data set: those that move, and those that are always the identity.
void list_joints(WalkModel& model) {
  const GaitCycle& cycle = model.cycle;
  const std::size_t joints = cycle.standing_local.size();
  std::array<bool, kMaxJoints> is_set{};
  for (const int j : model.kept) is_set[j] = true;
  for (const LegBuild& leg : model.leg) {
    for (const LegJointFrame& frame : leg.joint) {
      if (frame.joint >= 0) is_set[frame.joint] = true;
    }
  }
  for (std::size_t j = 0; j < joints; ++j) {
    if (is_set[j]) continue;
    bool is_still = cycle.standing_local[j] == kIdentity;
    for (std::size_t i = j; i < cycle.local.size(); i += joints)
      is_still = is_still && cycle.local[i] == kIdentity;
    (is_still ? model.still : model.moving).push_back(static_cast<int>(j));
  }
}

// Keeps the joints above the pelvis, except the legs, as upright as if the pelvis did not roll.
void keep_trunk_upright(double roll_rad, GaitCycle& cycle) {
  const quat& pelvis = cycle.pelvis_standing;
  const quat back = glm::conjugate(pelvis) * rotation_z(-roll_rad) * pelvis;
  for (std::size_t j = 0; j < cycle.skeleton.joints.size(); ++j) {
    const bool is_leg = std::any_of(cycle.leg.begin(), cycle.leg.end(), [&](const LegModel& leg) {
      return is_ancestor(cycle.skeleton, static_cast<int>(j), leg.joints.hip);
    });
    if (cycle.skeleton.joints[j].parent == cycle.pelvis && !is_leg)
      cycle.standing_local[j] = back * cycle.standing_local[j];
  }
}

}  // namespace

std::optional<Error> check(const Character& character) {
  constexpr double kLeast = 0.05, kMost = 20.0;  // factors of the lengths
  const std::string name = character.name + ": ";
  if (auto problem = range_problem(name + "scale", character.scale, kLeast, kMost)) return problem;
  if (auto problem = range_problem(name + "leg_ratio", character.leg_ratio, kLeast, kMost))
    return problem;
  return range_problem(name + "scale times leg_ratio", character.scale * character.leg_ratio,
                       kLeast, kMost);
}

Result<WalkModel> walk_model(const GaitCycle& cycle, const Character& character) {
  if (auto problem = check(character)) return *problem;
  if (auto problem = check(cycle)) return *problem;
  if (!cycle.strides) return Error{cycle.name + ": has no clean strides, see with_clean_strides()"};
  const StrideFamily& strides = *cycle.strides;
  if (strides.table.size() != kStrideRatios || strides.back.size() != kBackRatios)
    return Error{cycle.name + ": its clean strides are not those of with_clean_strides()"};
  if (!character.skeleton.empty()) {
    return Error{character.name + ": a character with a skeleton of its own is not supported yet"};
  }
  if (has_overlong_leg(cycle)) {
    return Error{cycle.name + ": a leg has more than " + std::to_string(kMaxBetween) +
                 " joints between two of hip, knee, ankle and toe"};
  }
  WalkModel model;
  model.cycle = cycle;
  const double ratio = character.scale * character.leg_ratio;
  scale_build(model.cycle, character.scale, character.leg_ratio);
  model.source_leg_length_m = mean_leg_m(cycle);
  model.leg_length_m = model.source_leg_length_m * ratio;
  model.size = model.leg_length_m / kReferenceLeg_m;
  // The fourth root, as gait_limits() scales times.
  model.time_scale = std::sqrt(std::sqrt(model.size));
  for (Side side : {kLeftSide, kRightSide}) {
    model.leg[side] = leg_build(model.cycle.leg[side]);
    model.leg[side].toe_off = fraction(cycle.toe_off[side] - cycle.strike[side]);
    model.leg[side].track_m =
        mean_heel(cycle, side).x * ratio + cycle.leg[side].hip_m.x * (character.scale - ratio);
    model.own_step_m[side] = cycle.step_m[side] * ratio;
  }
  model.share = stage_shares(cycle);
  model.source_step_m = 0.5 * cycle.stride_m * ratio;
  model.stride_scale = stride_scale(cycle, character.scale, ratio);
  const double knee = std::min(strides.stand_rad[0][kKneeX], strides.stand_rad[1][kKneeX]);
  const Stand stand = standing_legs({model.leg[0].model, model.leg[1].model}, knee);
  model.stand_m = stand.pelvis_m;
  model.rest_lead_m = stand.lead_m;
  model.stand_roll_rad = stand.roll_rad;
  model.stand_rad = stand.angles;
  keep_trunk_upright(stand.roll_rad, model.cycle);
  for (const LegModel& leg : model.cycle.leg) {
    const std::vector<int> twist =
        twist_joints(model.cycle.skeleton, model.cycle.pelvis, leg.joints);
    model.kept.insert(model.kept.end(), twist.begin(), twist.end());
  }
  lay_out_legs(model);
  list_joints(model);
  model.body = upper_body_model(model.cycle, ratio, model.stand_m);
  model.tables = build_tables(model);
  return model;
}

StridePlace stride_of(const WalkModel& model, bool backward, double phase, double ratio) noexcept {
  const StrideFamily& family = *model.cycle.strides;
  StridePlace place = stride_at(backward ? family.back : family.table, phase, ratio);
  const StrideScale& to = model.stride_scale;
  for (double* m : {&place.track.stride_m, &place.track.low_m, &place.track.high_m})
    *m *= to.length;
  for (int side : {0, 1}) {
    for (vec3* heel_m : {&place.track.footprint_m[side], &place.cell.foot[side].heel_m})
      *heel_m = *heel_m * to.length + to.apart_m[side];
  }
  scale_pelvis(to, place.cell);
  return place;
}

GaitLimits gait_limits(const WalkModel& model) noexcept {
  if (model.cycle.pace == Pace::adult) return gait_limits(model.leg_length_m);
  return gait_limits(model.leg_length_m, {kOwnStick, model.own_step_m, model.body.own_step_s});
}

std::optional<double> own_stick(const GaitCycle& cycle) noexcept {
  if (cycle.pace == Pace::own) return kOwnStick;
  const double stick =
      cycle.stride_m / cycle.duration_s / gait_limits(mean_leg_m(cycle)).max_speed_m_s;
  return stick <= 1.0 ? std::optional(stick) : std::nullopt;
}

double terrain_scale(const Terrain& terrain, const WalkModel& model) noexcept {
  constexpr double kSpare_m = 0.02;  // room beside the sole, at the reference leg
  const double tread_m = least_tread_m(terrain);
  double scale = 1.0;
  for (const LegBuild& leg : model.leg) {
    const vec3 sole = leg.tip_m - leg.model.heel_m;
    const double needed_m = glm::length(vec2(sole.x, sole.z)) + kSpare_m * model.size;
    if (needed_m <= tread_m) continue;
    scale = std::max({scale, model.size, needed_m / tread_m});
  }
  return scale;
}

}  // namespace gaitpad
