// One walk in the caller's memory. Crowds use the same tick.
#include "gaitpad/walk.h"

#include "walk/pose.h"
#include "walk/sound_input.h"
#include "walk/steer.h"
#include "walk/walk.h"
#include "walk/walk_frame.h"

namespace gaitpad {
namespace {

// Moves a walk on by `parts` ticks.
void advance_by(const Tables& tables, IkMode mode, int parts, WalkState& state,
                Pose& pose) noexcept {
  pose.joint_count = tables.joints;
  quat* const local = pose.local.data();
  vec3* const root_m = &pose.root_m;
  const Poses poses{&local, &root_m, 1};
  place(state.placed, 0, state.walk);
  for (int part = 0; part < parts; ++part) advance(tables, mode, state.walk, poses);
}

}  // namespace

WalkState standing(const WalkModel& model, const vec3& place_m, Pose& pose) noexcept {
  return standing(model, place_m, 0.0, pose);
}

WalkState standing(const WalkModel& model, const vec3& place_m, double heading_rad,
                   Pose& pose) noexcept {
  WalkState state;
  const double yaw_rad = wrapped(mended_place(heading_rad, state)),
               x_m = mended_place(place_m.x, state), z_m = mended_place(place_m.z, state);
  const Tables tables = tables_of(model, state.tick_s);
  stand(tables, {x_m, z_m, yaw_rad}, state.walk);
  advance_by(tables, IkMode::robust, 1, state, pose);
  state.root = state.root_before = root_of(state.walk);
  return state;
}

void advance(const WalkModel& model, const GaitParams& params, IkMode mode, double dt_s,
             WalkState& state, Pose& pose) noexcept {
  if (!is_sound(params))
    return advance(model, mended_params(params, state), mode, dt_s, state, pose);
  if (!is_sound_tick(dt_s)) dt_s = state.tick_s, ++state.bad_inputs;
  if (!is_sound(state.detail)) state.detail = detail_of(state.walk), ++state.bad_inputs;
  state.tick_s = dt_s;
  const int parts = tick_parts(dt_s);
  const Tables tables = tables_of(model, dt_s / parts);
  set_detail(state.detail, 0, state.walk);
  ask(params, state.walk);
  advance_by(tables, mode, parts, state, pose);
  state.root_before = state.root;
  state.root = root_of(state.walk);
}

double presence(const WalkState& state) noexcept {
  const float shown = state.walk.change.shown, posture = state.walk.state.posture.x;
  return std::clamp(shown, 0.0f, 1.0f) * std::clamp(posture, 0.0f, 1.0f);
}

double shown_phase(const WalkState& state) noexcept { return phase_of(state.walk); }

}  // namespace gaitpad
