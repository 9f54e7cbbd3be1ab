// Requests of a program beside the stick: a place for the next footprint, and a push.
#include <algorithm>
#include <cmath>

#include "gaitpad/walk.h"
#include "walk/footholds.h"
#include "walk/sound_input.h"
#include "walk/walk.h"
#include "walk/walk_frame.h"

namespace gaitpad {
namespace {

bool rests(const Change<float>& change) noexcept {
  return change.stands != 0.0f || change.stops != 0.0f || change.closing != 0.0f;
}

// True if a program may still change the landing of the running step.
bool is_open_step(const Tables& tables, const Block<1>& block) noexcept {
  const State<float>& state = block.state;
  if (rests(block.change)) return false;
  return state.flies == 0.0f ||
         (tables.terrain == nullptr && state.tick <= kLatestAim * state.flight_ticks);
}

// The landing nearest to `heel` that the swing foot can reach, both in the step frame.
Placement reachable_step(const Tables& tables, const Block<1>& block,
                         const Placement& heel) noexcept {
  // From heel to heel, in legs: feet neither touch nor do a split.
  constexpr double kAhead = 0.95, kBack = 0.45, kLeastAside = 0.07, kMostAside = 0.45;
  constexpr double kMostTurn_rad = 0.7;  // between both feet: about the range of the hip
  const bool right = block.state.right_swings != 0.0f, backward = block.state.backward != 0.0f;
  const double leg_m = tables.leg_m, outwards = right ? -1.0 : 1.0, way = backward ? -1.0 : 1.0,
               most_m = (backward ? tables.most_back_ratio : tables.most_ratio) *
                        own_step_m<float>(tables, right, backward),
               ahead_m = std::min(kAhead * leg_m, most_m);
  const vec3& asked = heel.place_m;
  return {vec3(outwards * std::clamp(outwards * asked.x, kLeastAside * leg_m, kMostAside * leg_m),
               0.0, way * std::clamp(way * asked.z, -kBack * leg_m, ahead_m)),
          std::clamp(wrapped(heel.heading_rad), -kMostTurn_rad, kMostTurn_rad)};
}

void aim(const Placement& heel, Change<float>& change) noexcept {
  change.is_aimed = 1.0f;
  change.aim_x_m = static_cast<float>(heel.place_m.x);
  change.aim_z_m = static_cast<float>(heel.place_m.z);
  change.aim_rad = static_cast<float>(heel.heading_rad);
}

// The step frame in the world.
Placement step_frame(const WalkState& state) noexcept {
  return moved(state.placed, placement_of(state.walk.origin[0]));
}
// A heel of the world in the step frame.
Placement seen_in_step(const WalkState& state, const Placement& heel) noexcept {
  const Placement frame = step_frame(state);
  return {from_world(frame, heel.place_m), heel.heading_rad - frame.heading_rad};
}

}  // namespace

std::optional<Placement> nearest_step(const WalkModel& model, const Placement& heel,
                                      const WalkState& state) noexcept {
  const Tables tables = tables_of(model, state.tick_s);
  // In the tick of a strike the pose still shows the flight, but the step frame has changed.
  if (!is_finite(heel) || state.walk.told.struck != 0.0f || !is_open_step(tables, state.walk))
    return std::nullopt;
  return moved(step_frame(state), reachable_step(tables, state.walk, seen_in_step(state, heel)));
}

bool step_to(const WalkModel& model, const Placement& heel, WalkState& state) noexcept {
  constexpr double kSame_m = 0.001, kSame_rad = 0.1 * kDegree;  // not visible
  const auto near = nearest_step(model, heel, state);
  if (!near || horizontal_length(near->place_m - heel.place_m) > kSame_m ||
      std::abs(wrapped(near->heading_rad - heel.heading_rad)) > kSame_rad)
    return false;
  aim(seen_in_step(state, *near), state.walk.change);
  return true;
}

bool push_walk(const vec3& velocity_m_s, WalkState& state) noexcept {
  Change<float>& change = state.walk.change;
  if (!(horizontal_length(velocity_m_s) <= kMostPush_m_s) || !std::isfinite(velocity_m_s.y) ||
      rests(change))
    return false;
  const vec3 v = from_world({vec3(0.0), step_frame(state).heading_rad}, velocity_m_s);
  change.push_x_m_s += static_cast<float>(v.x);
  change.push_z_m_s += static_cast<float>(v.z);
  return true;
}

void take_push(const Tables& tables, Block<1>& block) noexcept {
  constexpr float kPush_s = 0.05f;  // time constant: hips that take it at once straighten the knee
  constexpr float kLeastPush_m_s = 0.01f;  // a smaller rest is dropped
  State<float>& state = block.state;
  Change<float>& change = block.change;
  float &x_m_s = change.push_x_m_s, &z_m_s = change.push_z_m_s;
  const auto ends = [&] { x_m_s = z_m_s = 0.0f; };
  if (rests(change)) return ends();
  if (change.is_aimed == 0.0f) {
    // The landing of a step is planned in its first tick, so before that there is none to change.
    const bool begins = state.flies == 0.0f && state.tick == 0.0f;
    if (begins || !is_open_step(tables, block)) return;
    // A foot that lands v sqrt(l / g) farther catches a pendulum of the leg's length (Hof 2008).
    const float falls_s = std::sqrt(tables.leg_m / kGravity_m_s2);
    const vec3 caught_m(state.landing_x_m + falls_s * x_m_s, 0.0,
                        state.landing_z_m + falls_s * z_m_s);
    aim(reachable_step(tables, block, {caught_m, state.landing_rad}), change);
  }
  const float share = least(tables.ticks * tables.tick_s / (kPush_s * tables.time_scale), 1.0f);
  const bool led = change.led != 0.0f;
  const auto take = [&](float& push_m_s, Off<float>& hips_m) {
    hips_m.v += share * push_m_s * tables.tick_s;
    push_m_s -= share * push_m_s;
  };
  take(x_m_s, led ? change.pelvis_x_m : state.hips_x_m);
  take(z_m_s, led ? change.pelvis_z_m : state.hips_z_m);
  if (x_m_s * x_m_s + z_m_s * z_m_s < kLeastPush_m_s * kLeastPush_m_s) ends();
}

}  // namespace gaitpad
