// A walker whose hands, elbows and gaze are looked at, and styles of the upper body.
#pragma once
#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "animation/made_walker.h"
#include "gaitpad/anatomy.h"
#include "gaitpad/style.h"
#include "gaitpad/walk.h"

namespace gaitpad {

inline StyleValues style(std::initializer_list<std::pair<const char*, double>> values) {
  StyleValues s;
  for (const auto& [key, value] : values) EXPECT_TRUE(set_value(s, key, value)) << key;
  return s;
}

class MadeBody : public MadeWalker {
 public:
  using MadeWalker::MadeWalker;

  void step(const StyleValues& style, double forward, double sideways = 0.0) {
    walk(1, style, forward, sideways);
  }
  void walk(int ticks, const StyleValues& style, double forward, double sideways = 0.0) {
    MadeWalker::walk(sideways, forward, ticks, style);
    forward_kinematics(model().cycle.skeleton, pose(), *world_);
  }
  // A pace given by hand: steps of `length_m` in `time_s`.
  void pace(int ticks, double length_m, double time_s) {
    GaitParams params;
    params.walking = true;
    for (StrideParams& stride : params.stride) stride = {length_m, time_s, 1.0};
    MadeWalker::walk(params, ticks);
    forward_kinematics(model().cycle.skeleton, pose(), *world_);
  }
  vec3 hand(Side side) const {
    const ArmBuild& arm = model().body.arm[side];
    return at(arm.joints.wrist) + world_->rotation[arm.joints.wrist] * arm.grip_m;
  }
  vec3 shoulders() const { return 0.5 * (shoulder(kLeftSide) + shoulder(kRightSide)); }
  vec3 shoulder(Side side) const { return at(model().body.arm[side].joints.shoulder); }
  vec3 at(int joint) const { return world_->position_m[joint]; }
  vec3 gaze() const {
    const int head = model().body.head_path.back();
    return world_->rotation[head] * glm::conjugate(model().body.head_standing) * kForward;
  }
  double elbow(Side side) const {  // degrees, 0 straight
    const ArmChain& j = model().body.arm[side].joints;
    const vec3 upper = at(j.elbow) - at(j.shoulder), fore = at(j.wrist) - at(j.elbow);
    return gaitpad::acos(glm::dot(glm::normalize(upper), glm::normalize(fore))) / kDegree;
  }
  // Of the upper arm against the walker's vertical, forward positive.
  double swing(Side side) const {
    const ArmChain& j = model().body.arm[side].joints;
    const vec3 upper = rotation_y(-state().heading_rad) * (at(j.elbow) - at(j.shoulder));
    return gaitpad::atan2(upper.z, -upper.y) / kDegree;
  }

 private:
  std::unique_ptr<JointFrames> world_ = std::make_unique<JointFrames>();
};

}  // namespace gaitpad
