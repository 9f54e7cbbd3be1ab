// The parts of posing an upper body, in the order in which walk_body.cpp calls them. Internal to
// it.
#pragma once
#include <vector>

#include "animation/walk.h"

namespace gaitpad {

inline constexpr double kEvenBodySpread = 1e-9;  // weights closer than this are even
inline constexpr double kBodyHold = 0.8;         // of a change that a locked joint does not follow

// How much of its change a joint of relative weight `w` leaves to the others.
inline double held_back(double w) noexcept { return kBodyHold * (1.0 - (w * w) * (w * w)); }

// World frames of the joints of a path that begins at the root; other entries stay as they are.
void carry_path(const Skeleton& skeleton, const std::vector<int>& path, const Pose& pose,
                JointFrames& world) noexcept;
// A rotation a part of the way to another one, the short way.
quat between(const quat& from, const quat& to, double share) noexcept;

// Where each hand is before anything is done to it, for those whose arm is there.
using HandPlaces = std::array<vec3, 2>;

// --- walk_body_spine.cpp
bool is_spine_even(const BodyParams& now) noexcept;
void pose_spine(const BodyModel& body, const Skeleton& skeleton, const SpineWeights& weight,
                Pose& pose, JointFrames& world) noexcept;
// --- walk_body_arm.cpp
bool is_arm_free(const BodyParams& now, Side side) noexcept;  // swings, with even weights
vec3 hand_place(const ArmBuild& arm, const JointFrames& world) noexcept;
struct Shoulders {
  vec3 middle_m{0.0};        // between them
  quat upright = kIdentity;  // turned with them about the vertical
};
Shoulders shoulders_of(const WalkModel& model, const JointFrames& world) noexcept;
// `own_m`: where the hand is in the data.
void pose_arm(const WalkModel& model, const WalkState& state, Side side, const Shoulders& shoulders,
              const vec3& own_m, Pose& pose, JointFrames& world) noexcept;
// --- walk_body_head.cpp
bool is_head_free(const HeadParams& head) noexcept;
void pose_head(const WalkModel& model, const WalkState& state, Pose& pose,
               JointFrames& world) noexcept;

}  // namespace gaitpad
