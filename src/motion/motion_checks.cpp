// Checks motions and gait cycles that a caller has filled in.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "base/ranges.h"
#include "gaitpad/gait_cycle.h"

namespace gaitpad {
namespace {

using Problem = std::optional<Error>;

bool is_finite(const vec3& v) noexcept { return std::isfinite(v.x + v.y + v.z); }
bool is_rotation(const quat& q) noexcept { return std::abs(glm::dot(q, q) - 1.0) < 1e-3; }

Problem count_problem(const std::string& what, std::size_t is, std::size_t should) {
  if (is == should) return std::nullopt;
  return Error{what + ": there are " + std::to_string(is) + ", not " + std::to_string(should)};
}

Problem skeleton_problem(const std::string& name, const Skeleton& skeleton) {
  const std::size_t joints = skeleton.joints.size();
  if (auto problem = range_problem(name + ": the number of joints", double(joints), 1, kMaxJoints))
    return problem;
  for (std::size_t j = 0; j < joints; ++j) {
    const Joint& joint = skeleton.joints[j];
    const std::string what = name + ": joints[" + std::to_string(j) + "].";
    const double last = j == 0 ? -1.0 : double(j) - 1.0;
    if (auto problem = range_problem(what + "parent", joint.parent, j == 0 ? -1.0 : 0.0, last))
      return problem;
    if (!is_finite(joint.offset_m)) return Error{what + "offset_m is not finite"};
  }
  return std::nullopt;
}

std::array<int, 5> joints_of(const LegJoints& leg) noexcept {
  return {leg.hip, leg.knee, leg.ankle, leg.toe, leg.toe_end};
}

// `least`: -1 if the joint may be unset.
Problem joint_problem(const std::string& what, int joint, int least, std::size_t joints) {
  return range_problem(what, joint, least, double(joints) - 1.0);
}
Problem leg_problem(const std::string& name, int side, const LegJoints& leg, int least,
                    std::size_t joints) {
  constexpr std::array kNames = {"hip", "knee", "ankle", "toe", "toe_end"};
  const std::string what = name + "[" + std::to_string(side) + "].";
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (auto problem = joint_problem(what + kNames[i], joints_of(leg)[i], least, joints))
      return problem;
  }
  return std::nullopt;
}

Problem rotations_problem(const std::string& what, std::span<const quat> rotations) {
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    if (!is_rotation(rotations[i]))
      return Error{what + "[" + std::to_string(i) + "] is no rotation: its length is not 1"};
  }
  return std::nullopt;
}

}  // namespace

bool has_legs(const Motion& motion) noexcept {
  return std::ranges::all_of(
      motion.legs, [](const LegJoints& leg) { return std::ranges::min(joints_of(leg)) >= 0; });
}

Problem check(const Motion& motion) {
  const std::string& name = motion.name;
  Problem problem = skeleton_problem(name, motion.skeleton);
  if (problem) return problem;
  const std::size_t joints = motion.skeleton.joints.size();
  if (motion.frames.empty()) return Error{name + ": has no frames"};
  if ((problem = range_problem(name + ": frame_time_s", motion.frame_time_s, 1e-5, 10.0)) ||
      (problem = joint_problem(name + ": pelvis", motion.pelvis, 0, joints)) ||
      (problem = leg_problem(name + ": legs", 0, motion.legs[0], -1, joints)) ||
      (problem = leg_problem(name + ": legs", 1, motion.legs[1], -1, joints)))
    return problem;
  for (std::size_t i = 0; i < motion.frames.size(); ++i) {
    const MotionFrame& frame = motion.frames[i];
    const std::string what = name + ": frames[" + std::to_string(i) + "].";
    if (!is_finite(frame.root_m)) return Error{what + "root_m is not finite"};
    if ((problem = count_problem(what + "local", frame.local.size(), joints)) ||
        (problem = rotations_problem(what + "local", frame.local)))
      return problem;
    if (frame.translation_m.empty()) continue;
    if ((problem = count_problem(what + "translation_m", frame.translation_m.size(), joints)))
      return problem;
    if (!std::ranges::all_of(frame.translation_m, is_finite))
      return Error{what + "translation_m is not finite"};
  }
  return std::nullopt;
}

Problem check(const GaitCycle& cycle) {
  const std::string& name = cycle.name;
  const std::size_t joints = cycle.skeleton.joints.size();
  Problem problem;
  if ((problem = skeleton_problem(name, cycle.skeleton)) ||
      (problem = joint_problem(name + ": pelvis", cycle.pelvis, 0, joints)) ||
      (problem = count_problem(name + ": samples", cycle.samples.size(), kCycleSamples)) ||
      (problem = count_problem(name + ": local", cycle.local.size(), kCycleSamples * joints)) ||
      (problem = count_problem(name + ": standing_local", cycle.standing_local.size(), joints)) ||
      (problem = rotations_problem(name + ": local", cycle.local)) ||
      (problem = rotations_problem(name + ": standing_local", cycle.standing_local)) ||
      (problem = rotations_problem(name + ": pelvis_standing", {&cycle.pelvis_standing, 1})))
    return problem;
  for (const int side : {0, 1}) {
    const LegModel& leg = cycle.leg[side];
    const std::string what = name + ": leg[" + std::to_string(side) + "].";
    if ((problem = leg_problem(name + ": leg", side, leg.joints, 0, joints)) ||
        (problem = range_problem(what + "thigh_m", leg.thigh_m, 1e-3, 1e3)) ||
        (problem = range_problem(what + "shank_m", leg.shank_m, 1e-3, 1e3)) ||
        (problem = rotations_problem(what + "standing", leg.standing)))
      return problem;
    for (const vec3& m : {leg.hip_m, leg.heel_m, leg.toe_m, leg.toe_end_m}) {
      if (!is_finite(m)) return Error{what + "hip_m, heel_m, toe_m or toe_end_m is not finite"};
    }
  }
  if ((problem = range_problem(name + ": duration_s", cycle.duration_s, 0.05, 60.0)))
    return problem;
  return range_problem(name + ": stride_m", cycle.stride_m, 1e-3, 1e3);
}

}  // namespace gaitpad
