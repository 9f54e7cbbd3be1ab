// Reports a tick (WalkFrame) from the walk's state and pose.
#pragma once
#include <span>
#include <tuple>

#include "gaitpad/walk.h"
#include "walk/block.h"
#include "walk/tables.h"

namespace gaitpad {

// The numbers from which the root of a walk follows.
struct RootNumbers {
  float heading_rad = 0.0f, pelvis_x_m = 0.0f, pelvis_z_m = 0.0f, beside_x_m = 0.0f,
        beside_z_m = 0.0f;
  Origin origin;
};
template <int kWidth>
RootNumbers root_numbers(const Block<kWidth>& block, int walk) noexcept {
  const auto& [state, told] = std::tie(block.state, block.told);
  return {lane(state.heading_rad, walk),   lane(state.pelvis_x_m[0], walk),
          lane(state.pelvis_z_m[0], walk), lane(told.pelvis_x_m, walk),
          lane(told.pelvis_z_m, walk),     block.origin[walk]};
}
// A step frame in the walk's own coordinates.
inline Placement placement_of(const Origin& origin) noexcept {
  return {vec3(origin.x_m, origin.y_m, origin.z_m), origin.heading_rad};
}
// In the walk's own coordinates: the hips' place on the ground, without the tables' oscillation,
// and the heading.
Placement root_of(const RootNumbers& numbers) noexcept;
inline Placement root_of(const Block<1>& block) noexcept { return root_of(root_numbers(block, 0)); }

// Phase of the data that the pose shows.
float phase_of(const Block<1>& block) noexcept;

// walk_frame() of a pose that is not in a Pose.
WalkFrame frame_of(const WalkModel& model, const WalkState& state, const vec3& root_m,
                   std::span<const quat> local) noexcept;

}  // namespace gaitpad
