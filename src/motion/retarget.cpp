// A walk on another skeleton with two legs. Meredith & Maddock 2005, section 3.2: motions are
// retargeted by the ratio of the leg lengths.
//
// Legs have the same degrees of freedom in all walks, so their angles are copied and only lengths
// scale. Above the legs skeletons differ: spines and necks have other numbers of joints, arms have
// twist joints, standing poses are T poses. So each joint of the character gets a counterpart in
// the source, the character takes the source's standing pose, and from there each joint turns in
// the world like its counterpart.
#include <algorithm>
#include <memory>

#include "base/numeric.h"
#include "gaitpad/anatomy.h"
#include "gaitpad/gait_cycle.h"
#include "gaitpad/motion.h"
#include "motion/captured_cycle.h"
#include "motion/leg_pose.h"

namespace gaitpad {
namespace {

// --- Which joint follows which -------------------------------------------------------------------

// - Arms by their parts: collar bone, upper arm, forearm, hand. Twist joints between them rest, and
//   a part that one of the two lacks is left out.
// - Spine and neck as chains: of n joints that follow m, the k-th (from 1) turns as the source does
//   k m / n of the way up its chain. So chest and head turn as the source's do.
// - Fingers and all else above the legs: joints of equal names. The others rest.
// Stand for the joint that a bone points to in the standing pose.
enum Aim : int {
  kNoAim = -1,
  kChildren = -2,   // the mean place of the joint's children
  kAsItStood = -3,  // the joint keeps its standing rotation
};

struct Counterpart {
  int lower = -1, upper = -1;  // joints of the source; -1: none, this joint rests
  double share = 0.0;          // share of the way from the lower joint to the upper one
  int aim = kNoAim;            // a joint or an Aim
  vec3 direction{0.0};         // of the bone in the source's standing pose; unused without an aim
};
using UpperBodyMatch = std::vector<Counterpart>;  // the counterpart of each joint of the character

std::vector<vec3> standing_places(const GaitCycle& cycle) {
  const auto world = std::make_unique<JointFrames>();
  forward_kinematics(cycle.skeleton, cycle.standing_local, *world);
  const auto& at = world->position_m;
  return {at.begin(), at.begin() + static_cast<std::ptrdiff_t>(cycle.skeleton.joints.size())};
}

// The anatomy of one cycle's skeleton, and its joints' places in the standing pose.
struct BodyPlan {
  const GaitCycle& cycle;
  std::vector<vec3> at;
  UpperBodyJoints joints;
  std::vector<int> neck;  // joints of the neck; the last one is the head
  explicit BodyPlan(const GaitCycle& c)
      : cycle(c),
        at(standing_places(c)),
        joints(find_upper_body(c.skeleton, {c.leg[0].joints, c.leg[1].joints}, c.pelvis, at)),
        neck(joints.neck) {
    if (joints.head >= 0) neck.push_back(joints.head);
  }
  const std::string& name(int joint) const { return cycle.skeleton.joints[joint].name; }
  int chest() const { return joints.spine.empty() ? cycle.pelvis : joints.spine.back(); }
  bool is_in_leg(int joint) const {
    return is_ancestor(cycle.skeleton, cycle.leg[0].joints.hip, joint) ||
           is_ancestor(cycle.skeleton, cycle.leg[1].joints.hip, joint);
  }
  bool is_upper(int joint) const {
    return !is_in_leg(joint) && !is_ancestor(cycle.skeleton, joint, cycle.pelvis);
  }
  // Mean place of a joint's children; its own place if it has none.
  vec3 below(int joint) const {
    const std::vector<int> children = children_of(cycle.skeleton, joint);
    vec3 sum(0.0);
    for (const int child : children) sum += at[child];
    return children.empty() ? at[joint] : sum / double(children.size());
  }
};

// The only child of a joint; -1 if there are none or several.
int only_child(const BodyPlan& part, int joint) {
  const std::vector<int> children = children_of(part.cycle.skeleton, joint);
  return children.size() == 1 ? children.front() : -1;
}

class Matcher {
 public:
  Matcher(const GaitCycle& source, const GaitCycle& character)
      : from_(source), to_(character), match_(character.skeleton.joints.size()) {}

  UpperBodyMatch matched() {
    match_chain(from_.joints.spine, to_.joints.spine, from_.cycle.pelvis);
    match_chain(from_.neck, to_.neck, from_.chest());
    for (int side = 0; side < 2; ++side) match_arm(from_.joints.arm[side], to_.joints.arm[side]);
    match_names();
    aim_chain(from_.joints.spine, to_.joints.spine, first(from_.neck), first(to_.neck));
    aim_chain(from_.neck, to_.neck, -1, -1);
    return std::move(match_);
  }

 private:
  static int first(const std::vector<int>& chain) { return chain.empty() ? -1 : chain.front(); }

  void match_chain(const std::vector<int>& from, const std::vector<int>& to, int below) {
    for (std::size_t k = 1; k <= to.size(); ++k) {
      // Whole numbers, so that equal chains match exactly.
      const std::size_t lower = k * from.size() / to.size(), rest = k * from.size() % to.size();
      const auto joint = [&](std::size_t i) { return i == 0 ? below : from[i - 1]; };
      match_[to[k - 1]] = {joint(lower), joint(lower + (rest > 0)), double(rest) / to.size()};
    }
  }

  void match(int from, int to) {
    if (from < 0 || to < 0 || to_.cycle.skeleton.joints[to].is_end_site) return;
    Counterpart& follows = match_[to];
    follows.lower = follows.upper = from, follows.share = 0.0;
  }

  void match_arm(const ArmChain& from, const ArmChain& to) {
    if (!from.is_found() || !to.is_found()) return;
    match(from.collar, to.collar);
    match(from.shoulder, to.shoulder);
    match(from.elbow, to.elbow);
    match(from.wrist, to.wrist);
    if (from.collar >= 0 && to.collar >= 0 && from_.name(from.collar) == to_.name(to.collar))
      aim(from.collar, from.shoulder, to.collar, to.shoulder);
    aim(from.shoulder, from.elbow, to.shoulder, to.elbow);
    aim(from.elbow, from.wrist, to.elbow, to.wrist);
    match_[to.wrist].aim = kChildren;
    match_[to.wrist].direction = from_.below(from.wrist) - from_.at[from.wrist];
  }

  void aim(int from, int from_end, int to, int to_end) {
    match_[to].aim = to_end;
    match_[to].direction = from_.at[from_end] - from_.at[from];
  }

  // Aims a chain as a whole from its first joint, or bone by bone if both chains have equal names.
  // `from_end`, `to_end`: the joint after the chain, or -1.
  void aim_chain(const std::vector<int>& from, const std::vector<int>& to, int from_end,
                 int to_end) {
    if (from.empty() || to.empty()) return;
    const bool is_same = std::equal(from.begin(), from.end(), to.begin(), to.end(),
                                    [this](int f, int t) { return from_.name(f) == to_.name(t); });
    if (is_same) {
      for (std::size_t k = 0; k + 1 < from.size(); ++k) aim(from[k], from[k + 1], to[k], to[k + 1]);
      if (from_end >= 0 && to_end >= 0) aim(from.back(), from_end, to.back(), to_end);
      if (from_end < 0) aim_at_only_child(from.back(), to.back());
      return;
    }
    // The head keeps its standing rotation, so it looks ahead with any bend of the neck.
    if (from_end < 0) match_[to.back()].aim = kAsItStood;
    const int last_from = from_end >= 0 ? from_end : from.back();
    const int last_to = to_end >= 0 ? to_end : to.back();
    if (last_from != from.front() && last_to != to.front())
      aim(from.front(), last_from, to.front(), last_to);
  }

  void aim_at_only_child(int from, int to) {
    const int from_child = only_child(from_, from), to_child = only_child(to_, to);
    if (from_child >= 0 && to_child >= 0) aim(from, from_child, to, to_child);
  }

  static bool is_part(const BodyPlan& part, int joint) {
    std::vector<int> parts = part.joints.spine;
    parts.insert(parts.end(), part.neck.begin(), part.neck.end());
    for (const ArmChain& arm : part.joints.arm)
      parts.insert(parts.end(), {arm.collar, arm.shoulder, arm.elbow, arm.wrist});
    return std::find(parts.begin(), parts.end(), joint) != parts.end();
  }

  void match_names() {
    const auto& joints = to_.cycle.skeleton.joints;
    for (int joint = 0; joint < static_cast<int>(joints.size()); ++joint) {
      const int same = from_.cycle.skeleton.find(joints[joint].name);
      if (same < 0 || is_part(to_, joint) || is_part(from_, same)) continue;
      if (!to_.is_upper(joint) || !from_.is_upper(same)) continue;
      match(same, joint);
      aim_at_only_child(same, joint);
    }
  }

  BodyPlan from_, to_;
  UpperBodyMatch match_;
};

// --- Standing as the source stands ---------------------------------------------------------------

// Vector from a joint to the end of its bone in the standing pose, in the joint's frame.
vec3 bone_of(const GaitCycle& cycle, int joint, int end) {
  if (end == kChildren) {
    vec3 sum(0.0);
    for (const int child : children_of(cycle.skeleton, joint))
      sum += cycle.skeleton.joints[child].offset_m;
    return sum;
  }
  return link(cycle.skeleton, cycle.standing_local, joint, end);
}

// Turns the character's bones to the directions of the source's standing pose: the arms of a T pose
// come down. Arms and hands turn bone by bone. Backs are curved in different ways, so spine and
// neck turn as a whole and the head keeps its rotation. Spines, necks and collar bones with equal
// names turn bone by bone.
void stand_alike(const UpperBodyMatch& match, GaitCycle& character) {
  constexpr double kLeastBone_m = 1e-4;
  const auto& joints = character.skeleton.joints;
  const auto stood = world_rotations(character.skeleton, character.standing_local);
  std::vector<quat> world = stood;
  for (std::size_t j = 1; j < joints.size(); ++j) {
    const quat above = world[joints[j].parent];
    world[j] = above * character.standing_local[j];
    const auto& [lower, upper, share, aim, wanted] = match[j];
    if (aim == kNoAim) continue;
    if (aim == kAsItStood) {
      world[j] = stood[j];
    } else {
      const vec3 bone = world[j] * bone_of(character, static_cast<int>(j), aim);
      if (glm::length(bone) < kLeastBone_m || glm::length(wanted) < kLeastBone_m) continue;
      world[j] = rotation_between(glm::normalize(bone), glm::normalize(wanted)) * world[j];
    }
    character.standing_local[j] = glm::normalize(glm::conjugate(above) * world[j]);
  }
}

// --- The character's build and standing pose -----------------------------------------------------

constexpr double kMostToeOut = 45.0 * kDegree;  // of a standing foot; a wider one is turned forward

// The frame with the lowest score.
template <class Score>
const MotionFrame& best_frame(const Motion& motion, Score score) {
  const auto world = std::make_unique<JointFrames>();
  return motion.frames[lowest(0, static_cast<int>(motion.frames.size()) - 1, [&](int f) {
    forward_kinematics(motion, motion.frames[f], *world);
    return score(world->position_m);
  })];
}

using Places = std::array<vec3, kMaxJoints>;
double foot_height_m(const Places& at, const LegJoints& leg) {
  return at[leg.ankle].y + at[leg.toe].y;
}

// The frame in which both feet are lowest and both legs longest.
const MotionFrame& standing_frame(const Motion& motion) {
  return best_frame(motion, [&](const Places& at) {
    double score = 0.0;
    for (const LegJoints& leg : motion.legs) {
      score += foot_height_m(at, leg) - glm::distance(at[leg.hip], at[leg.ankle]);
    }
    return score;
  });
}

// Takes the standing rotation of a foot from the frame in which it is lowest, hence flat. If it
// then points more than kMostToeOut aside, it is turned forward.
void take_over_foot(const Motion& motion, Side side, CapturedLeg& leg) {
  const LegJoints& j = motion.legs[side];
  const auto& frame = best_frame(motion, [&j](const Places& at) { return foot_height_m(at, j); });
  const CapturedLeg flat = captured_pose(motion, frame).leg[side];
  const double out_rad = heading_of(flat.toe_m.front() - flat.ankle_m.front());
  const quat turn = std::abs(out_rad) > kMostToeOut ? rotation_y(-out_rad) : kIdentity;
  leg.ankle.assign(kCycleSamples, turn * flat.ankle.front());
  leg.toe.assign(kCycleSamples, turn * flat.toe.front());
}

// Measures the body on the character's own walk if it has one, otherwise on the frame in which it
// stands straightest.
Result<GaitCycle> body_of(const Motion& character) {
  if (Result<GaitCycle> own_walk = gait_cycle(character)) return own_walk;
  CapturedCycle pose = captured_pose(character, standing_frame(character));
  for (const Side side : {kLeftSide, kRightSide}) take_over_foot(character, side, pose.leg[side]);
  GaitCycle body;
  const Result<double> floor_m = build_standing(pose, body);
  if (!floor_m) return Error{character.name + ": " + floor_m.error().message};
  return body;
}

// --- The walk ------------------------------------------------------------------------------------

vec3 mean_hip_m(const GaitCycle& cycle) { return 0.5 * (cycle.leg[0].hip_m + cycle.leg[1].hip_m); }

double mean_ankle_height_m(const GaitCycle& cycle) {
  return -0.5 * (cycle.leg[0].heel_m.y + cycle.leg[1].heel_m.y);
}

// The source's walk on another body, its times and lengths scaled by the ratio of leg lengths.
GaitCycle on_body(const GaitCycle& source, double ratio, const GaitCycle& body) {
  GaitCycle out = source;
  out.skeleton = body.skeleton;
  out.pelvis = body.pelvis;
  out.pelvis_standing = body.pelvis_standing;
  out.leg = body.leg;
  out.standing_local = body.standing_local;
  out.strides.reset();
  out.duration_s *= std::sqrt(std::sqrt(ratio));  // scaled as all step times are
  out.stride_m *= ratio;
  for (int side = 0; side < 2; ++side) {
    out.step_m[side] = source.step_m[side] * ratio;
    out.track_m[side] =
        source.track_m[side] * ratio + out.leg[side].hip_m.x - source.leg[side].hip_m.x * ratio;
  }
  return out;
}

// Hips and heels follow the source's paths scaled by `ratio`. Feet keep the source's scaled
// distance beside the hips.
void take_over_samples(const GaitCycle& source, double ratio, GaitCycle& out) {
  const vec3 from_hips = mean_hip_m(source), to_hips = mean_hip_m(out);
  // The hips stand no higher than the shorter leg reaches.
  const double shorter_m = mean_leg_m(out) - std::min(out.leg[0].length_m(), out.leg[1].length_m());
  const double higher_m =
      mean_ankle_height_m(out) - ratio * mean_ankle_height_m(source) - shorter_m;
  vec3 middle(0.0);
  for (CycleSample& at : out.samples) {
    at.pelvis_m = ratio * (at.pelvis_m + at.pelvis * from_hips) - at.pelvis * to_hips;
    at.pelvis_m.y += higher_m;
    middle += vec3(at.pelvis_m.x, 0.0, at.pelvis_m.z) / double(kCycleSamples);
    for (int side = 0; side < 2; ++side) {
      const LegModel &from = source.leg[side], &to = out.leg[side];
      LegSample& leg = at.leg[side];
      leg.ankle_m = ratio * (leg.ankle_m + leg.foot * from.heel_m) - leg.foot * to.heel_m;
      leg.ankle_m.x += to.hip_m.x - ratio * from.hip_m.x;
    }
  }
  for (CycleSample& at : out.samples) {
    at.pelvis_m -= middle;
    for (LegSample& leg : at.leg) leg.ankle_m -= middle;
  }
}

// Fills the local rotations of sample i. Each joint that has a counterpart turns in the world, away
// from `standing`, as its counterpart turns away from the source's standing pose. Both standing
// poses already match. `turn` holds the turns of the source's joints.
void pose_sample(const UpperBodyMatch& match, const std::vector<quat>& turn,
                 const std::vector<quat>& standing, int i, GaitCycle& out) {
  const int joints = static_cast<int>(standing.size());
  const CycleSample& at = out.samples[i];
  quat* local = out.local.data() + i * joints;
  std::vector<quat> world(joints, kIdentity);
  for (int j = 0; j < joints; ++j) {
    const int parent = out.skeleton.joints[j].parent;
    const quat above = parent < 0 ? kIdentity : world[parent];
    world[j] = above * out.standing_local[j];
    if (j == out.pelvis) world[j] = at.pelvis * out.pelvis_standing;
    const Counterpart& from = match[j];
    if (from.lower >= 0 && from.share > 0.0)
      world[j] = nlerp(turn[from.lower], turn[from.upper], from.share) * standing[j];
    else if (from.lower >= 0)
      world[j] = turn[from.lower] * standing[j];
    local[j] = glm::normalize(glm::conjugate(above) * world[j]);
  }
  for (int side = 0; side < 2; ++side) {
    set_leg_locals(out.skeleton, out.leg[side], pose_of(out, side, at), local);
  }
  for (int j = 0; i > 0 && j < joints; ++j) local[j] = nearer(local[j], local[j - joints]);
}

}  // namespace

double mean_leg_m(const GaitCycle& cycle) noexcept {
  return 0.5 * (cycle.leg[0].length_m() + cycle.leg[1].length_m());
}

Result<GaitCycle> cycle_on_skeleton(const GaitCycle& source, const Motion& character) {
  if (auto problem = check(source)) return *problem;
  if (auto problem = check(character)) return *problem;
  if (!has_legs(character)) return Error{character.name + ": legs are not set, see find_legs()"};
  const Result<GaitCycle> body = body_of(character);
  if (!body) return body.error();
  const double ratio = mean_leg_m(*body) / mean_leg_m(source);
  GaitCycle out = on_body(source, ratio, *body);
  take_over_samples(source, ratio, out);
  const UpperBodyMatch match = Matcher(source, out).matched();
  stand_alike(match, out);
  const std::vector<quat> stood = world_rotations(source.skeleton, source.standing_local),
                          standing = world_rotations(out.skeleton, out.standing_local);
  out.local.assign(kCycleSamples * standing.size(), kIdentity);
  for (int i = 0; i < kCycleSamples; ++i) {
    std::vector<quat> turn = world_rotations(
        source.skeleton, std::span(source.local).subspan(i * stood.size(), stood.size()));
    for (std::size_t j = 0; j < stood.size(); ++j) turn[j] = turn[j] * glm::conjugate(stood[j]);
    pose_sample(match, turn, standing, i, out);
  }
  return out;
}

}  // namespace gaitpad
