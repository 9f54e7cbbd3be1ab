// What a game asks of a walk beside its stick: a place for the next footprint, and a push.
#include <algorithm>

#include "walk/footholds.h"
#include "walk/walk.h"

namespace gaitpad {
namespace {

// From the world's axes to the step frame's.
vec3 seen_in_step(const Block<1>& block, const vec3& way) noexcept {
  return from_world({vec3(0.0), block.placed[0].heading_rad + block.origin[0].heading_rad}, way);
}

float share_of_flight(const State<float>& state) noexcept {
  return state.flies != 0.0f ? state.tick / state.flight_ticks : 0.0f;
}

}  // namespace

Aim step_to(const Tables& tables, const Placement& place, bool nearest, Block<1>& block) noexcept {
  // From heel to heel, in legs: feet neither touch nor do a split. And how far a foot turns.
  constexpr double kAhead = 0.95, kBack = 0.45, kLeastAside = 0.07, kMostAside = 0.45,
                   kMostTurn_rad = 0.7, kSame = 1e-9;
  const State<float>& state = block.state;
  Change<float>& change = block.change;
  if (change.stands != 0.0f || change.closing != 0.0f || share_of_flight(state) > kSettles)
    return Aim::refused;
  const Origin& origin = block.origin[0];
  const vec3 own = from_world(block.placed[0], place.place_m) - vec3(origin.x_m, 0.0, origin.z_m),
             asked = from_world({vec3(0.0), origin.heading_rad}, own);
  const double rad = wrapped(place.heading_rad - block.placed[0].heading_rad - origin.heading_rad);
  const bool right = state.right_swings != 0.0f;
  const bool backward = state.backward != 0.0f;
  const float most_m = (backward ? tables.most_back_ratio : tables.most_ratio) *
                       own_step_m<float>(tables, right, backward);
  const double leg_m = tables.leg_m, outwards = right ? -1.0 : 1.0, way = backward ? -1.0 : 1.0,
               ahead_m = std::min(kAhead * leg_m, static_cast<double>(most_m)),
               z_m = way * std::clamp(way * asked.z, -kBack * leg_m, ahead_m),
               x_m = outwards *
                     std::clamp(outwards * asked.x, kLeastAside * leg_m, kMostAside * leg_m),
               turn_rad = std::clamp(rad, -kMostTurn_rad, kMostTurn_rad);
  const bool is_there = std::abs(z_m - asked.z) <= kSame && std::abs(x_m - asked.x) <= kSame &&
                        std::abs(turn_rad - rad) <= kSame;
  if (!is_there && !nearest) return Aim::refused;
  change.is_aimed = 1.0f;
  change.aim_x_m = static_cast<float>(x_m), change.aim_z_m = static_cast<float>(z_m);
  change.aim_rad = static_cast<float>(turn_rad);
  return is_there ? Aim::taken : Aim::nearest;
}

bool push(const Tables& tables, const vec3& velocity_m_s, Block<1>& block) noexcept {
  // A pendulum as long as the leg falls v sqrt(l / g) far: there a foot catches it (Hof 2008).
  constexpr double kGravity_m_s2 = 9.81, kMostAside = 0.35, kNearStrike_s = 0.2;
  State<float>& state = block.state;
  Change<float>& change = block.change;
  const float left =
      (state.flies != 0.0f ? 0.0f : state.roll_ticks) + state.flight_ticks - state.tick;
  if (change.stands != 0.0f || left * tables.tick_s < kNearStrike_s) return false;
  const vec3 v = seen_in_step(block, velocity_m_s);
  const auto add = [](double more, float& to) { to += static_cast<float>(more); };
  const double tick_s = tables.tick_s;
  if (change.led != 0.0f) {
    add(v.x * tick_s, change.pelvis_x_m.v), add(v.z * tick_s, change.pelvis_z_m.v);
  } else {
    add(v.x * tick_s, state.hips_x_m.v), add(v.z * tick_s, state.hips_z_m.v);
  }
  const double falls_s = std::sqrt(tables.leg_m / kGravity_m_s2),
               far_m = falls_s * horizontal_length(v), most_m = kMostAside * tables.leg_m,
               share = far_m > most_m ? most_m / far_m : 1.0;
  add(share * falls_s * v.x, change.push_x_m), add(share * falls_s * v.z, change.push_z_m);
  change.push_waits = share_of_flight(state) > kSettles ? 1.0f : 0.0f;
  return true;
}

}  // namespace gaitpad
