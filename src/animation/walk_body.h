// The upper body of a walk: the data's, but for arms that swing as far as the pace asks, hands and
// head that are to be somewhere, and joints that follow by their weights (equation 5). Nothing in
// here moves pelvis or legs. Internal to the walk.
#pragma once
#include <array>

#include "control/gait_params.h"
#include "motion/skeleton.h"

namespace gaitpad {

struct Tick;
struct WalkModel;
struct WalkState;
enum class IkMode : unsigned char;

// BodyParams are numbers alone, so they can be smoothed one like the other.
using BodyValues = std::array<double, sizeof(BodyParams) / sizeof(double)>;

// Plain, trivially copyable.
struct BodyState {
  BodyParams goal, now;                   // asked for; smoothed
  BodyValues per_s{};                     // rate of `now`
  int unsettled_ticks = 0;                // until `now` is `goal`
  std::array<double, 2> swing{1.0, 1.0};  // factor on the data's arm swing in this tick
  std::array<double, 2> rail_ground_m{};  // smoothed ground under a rail
  std::array<double, 2> rail_ground_m_s{};
};

// Smooths the parameters of the upper body. In paper mode the pace does not act on the arms: the
// data's upper body is left as it is.
void smooth_body(const Tick& tick, IkMode mode, WalkState& state) noexcept;
// On the data's local rotations of this phase, before they fade to a stand.
void swing_arms(const WalkModel& model, const WalkState& state, Pose& pose) noexcept;
// Spine, arms and head of a pose whose legs are done.
void pose_body(const WalkModel& model, const WalkState& state, Pose& pose) noexcept;

}  // namespace gaitpad
