#include "motion/cycle_captured.h"

#include <algorithm>
#include <memory>

#include "motion/tracks.h"

namespace gaitpad {
namespace {

// Joint offsets of which some frames may bring their own: the mean over the motion.
std::vector<vec3> mean_offsets(const Motion& motion) {
  std::vector<vec3> offset;
  for (const Joint& joint : motion.skeleton.joints) offset.push_back(joint.offset_m);
  if (motion.frames.front().translation_m.empty()) return offset;
  for (std::size_t j = 0; j < offset.size(); ++j) {
    vec3 sum(0.0);
    for (const MotionFrame& frame : motion.frames) sum += frame.translation_m[j];
    offset[j] = sum / double(motion.frames.size());
  }
  return offset;
}

// The root moves to the pelvis; what else hangs on the joints between them keeps its place beside
// it.
Skeleton rooted_at_pelvis(const Motion& motion) {
  Skeleton skeleton = motion.skeleton;
  const std::vector<vec3> offset = mean_offsets(motion);
  for (std::size_t j = 0; j < offset.size(); ++j) skeleton.joints[j].offset_m = offset[j];
  vec3 to_pelvis(0.0);  // in the frame of `joint`
  for (int joint = motion.pelvis; joint >= 0; joint = skeleton.joints[joint].parent) {
    const int parent = skeleton.joints[joint].parent;
    if (joint != motion.pelvis) to_pelvis = motion.frames.front().local[joint] * to_pelvis;
    to_pelvis += offset[joint];
    skeleton.joints[joint].offset_m = vec3(0.0);
    if (parent < 0) break;
    for (std::size_t k = 0; k < offset.size(); ++k) {
      const bool is_beside = skeleton.joints[k].parent == parent && static_cast<int>(k) != joint;
      if (is_beside) skeleton.joints[k].offset_m = offset[k] - to_pelvis;
    }
  }
  return skeleton;
}

void add_leg(const Skeleton& skeleton, const JointFrames& world, const LegJoints& j,
             CapturedLeg& leg) {
  leg.hip_m.push_back(world.position_m[j.hip]);
  leg.knee_m.push_back(world.position_m[j.knee]);
  leg.ankle_m.push_back(world.position_m[j.ankle]);
  leg.toe_m.push_back(world.position_m[j.toe]);
  leg.toe_end_m.push_back(world.position_m[j.toe_end]);
  leg.hip.push_back(world.rotation[j.hip]);
  leg.above_knee.push_back(world.rotation[skeleton.joints[j.knee].parent]);
  leg.knee.push_back(world.rotation[j.knee]);
  leg.ankle.push_back(world.rotation[j.ankle]);
  leg.toe.push_back(world.rotation[j.toe]);
}

CapturedCycle without_samples(const Motion& motion) {
  CapturedCycle cycle;
  cycle.skeleton = rooted_at_pelvis(motion);
  cycle.pelvis = motion.pelvis;
  cycle.legs = motion.legs;
  return cycle;
}

void add_sample(const PeriodicPose& at, JointFrames& world, CapturedCycle& cycle) {
  Pose pose;
  pose.joint_count = static_cast<int>(cycle.joints());
  std::ranges::copy(at.local, pose.local.begin());
  pose.root_m = at.pelvis_m;
  forward_kinematics(cycle.skeleton, pose, world);
  cycle.local.insert(cycle.local.end(), at.local.begin(), at.local.end());
  cycle.pelvis_m.push_back(at.pelvis_m);
  cycle.pelvis_rotation.push_back(world.rotation[cycle.pelvis]);
  for (int side = 0; side < 2; ++side)
    add_leg(cycle.skeleton, world, cycle.legs[side], cycle.leg[side]);
}

// About the vertical, then about the direction of view: the hips stand level.
quat turned_to_left(const vec3& hips) {
  const double level = std::sqrt(hips.x * hips.x + hips.z * hips.z);
  return rotation_z(-gaitpad::atan2(hips.y, level)) *
         rotation_y(-heading_of(glm::cross(hips, kUp)));
}

}  // namespace

CapturedCycle captured_cycle(const Motion& motion, const PeriodicMotion& periodic, double shift) {
  CapturedCycle cycle = without_samples(motion);
  cycle.duration_s = periodic.duration_s;
  cycle.stride_m = periodic.stride_m;
  const auto world = std::make_unique<JointFrames>();
  for (int i = 0; i < kCycleSamples; ++i) {
    add_sample(pose_at(periodic, shift + double(i) / kCycleSamples), *world, cycle);
  }
  return cycle;
}

CapturedCycle captured_pose(const Motion& motion, const MotionFrame& frame) {
  CapturedCycle cycle = without_samples(motion);
  cycle.duration_s = 1.0;
  const auto world = std::make_unique<JointFrames>();
  forward_kinematics(motion, frame, *world);
  const auto& at = world->position_m;
  const vec3 left = at[motion.legs[kLeftSide].hip] - at[motion.legs[kRightSide].hip];
  PeriodicPose pose{vec3(0.0, at[motion.pelvis].y, 0.0), frame.local};
  pose.local[0] = turned_to_left(left) * frame.local[0];
  for (int i = 0; i < kCycleSamples; ++i) add_sample(pose, *world, cycle);
  return cycle;
}

std::vector<double> ground_speed(const CapturedCycle& cycle, const std::vector<vec3>& point_m) {
  const double step_s = cycle.duration_s / kCycleSamples;
  const vec3 travel = kForward * (2.0 * cycle.stride_m / kCycleSamples);
  std::vector<double> speed;
  for (int i = 0; i < kCycleSamples; ++i) {
    const vec3 moved = point_m[wrapped_index(i + 1)] - point_m[wrapped_index(i - 1)] + travel;
    speed.push_back(glm::length(moved) / (2.0 * step_s));
  }
  return speed;
}

FlatFoot flat_foot(const CapturedCycle& cycle, int side) {
  constexpr double kRatePerS = 14.0;  // so much height above the lowest counts as so much speed
  const CapturedLeg& leg = cycle.leg[side];
  const std::vector<double> ankle = ground_speed(cycle, leg.ankle_m);
  const std::vector<double> toe = ground_speed(cycle, leg.toe_m);
  FlatFoot flat;
  double least = -1.0;
  for (int i = 0; i < kCycleSamples; ++i) {
    double sum = 0.0;
    for (int k = -2 * FlatFoot::reach; k <= 2 * FlatFoot::reach; ++k) {
      const int at = wrapped_index(i + k);
      sum += ankle[at] + toe[at] + kRatePerS * (leg.ankle_m[at].y + leg.toe_m[at].y);
    }
    if (i == 0 || sum < least) {
      least = sum;
      flat.middle = i;
    }
  }
  return flat;
}

quat mean_around(const std::vector<quat>& q, int middle, int reach) {
  const quat centre = q[wrapped_index(middle)];
  quat sum = centre;
  for (int k = -reach; k <= reach; ++k) {
    if (k == 0) continue;
    const quat& other = q[wrapped_index(middle + k)];
    sum = sum + other * (glm::dot(other, centre) < 0.0 ? -1.0 : 1.0);
  }
  return glm::normalize(sum);
}

quat mean_of(const std::vector<quat>& q) { return mean_around(q, 0, kCycleSamples / 2 - 1); }

vec3 mean_around(const std::vector<vec3>& p, int middle, int reach) {
  vec3 sum(0.0);
  for (int k = -reach; k <= reach; ++k) sum += p[wrapped_index(middle + k)];
  return sum / double(2 * reach + 1);
}

}  // namespace gaitpad
