// A standing character breathes, sways over its feet, and looks round now and then. All of it
// follows from the ticks of the stand, so a replay stands the same; it begins some time after the
// feet are at rest and ends while a walk begins. Planted feet stay where they are: hips move over
// them.
#include <cstdint>

#include "animation/walk_parts.h"
#include "gaitpad/curve.h"

namespace gaitpad {
namespace {

constexpr double kBeginsAfter_s = 1.0, kBegins_s = 2.0, kEnds_s = 0.8;
// Rate of the breath, 14 a minute (people at rest: 12 to 18), and the angle by which each breath
// raises the trunk.
constexpr double kBreath_Hz = 0.235, kBreath_rad = 0.6 * kDegree;
// Sways of quiet stance: 3 to 5 mm (standard deviation of the centre of pressure, Winter 1995),
// below 0.5 Hz.
struct Sway {
  double size_m, rate_Hz, begin_rad;
};
constexpr Sway kAside[] = {{0.0035, 0.13, 0.0}, {0.0020, 0.31, 1.0}};
constexpr Sway kAhead[] = {{0.0030, 0.19, 2.0}, {0.0015, 0.43, 0.5}};
// A glance every seven seconds: when it begins, how far it goes, how long it is held.
constexpr double kGlanceEvery_s = 7.0, kGlanceFirst_s = 1.0, kGlanceLast_s = 3.5;
constexpr double kGlanceTurns_s = 0.6, kGlanceBack_s = 0.7, kHeldLeast_s = 0.6, kHeldMost_s = 1.6;
constexpr double kLeastGlance = 8.0 * kDegree, kMostGlance = 26.0 * kDegree,
                 kMostNod = 6.0 * kDegree;

double swings(std::span<const Sway> of, double time_s) noexcept {
  double sum = 0.0;
  for (const Sway& sway : of)
    sum += sway.size_m * sin_cos(2.0 * kPi * sway.rate_Hz * time_s + sway.begin_rad).sin;
  return sum;
}

// A random number in [0, 1): number `which` of this glance. By splitmix64, so that successive
// numbers are unrelated.
double drawn(std::uint64_t glance, std::uint64_t which) noexcept {
  std::uint64_t bits = (4 * glance + which + 1) * 0x9e3779b97f4a7c15u;
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((bits ^ (bits >> 31)) >> 11) * 0x1p-53;
}

void glance(double time_s, double amount, double outwards, IdleState& idle) noexcept {
  const double number = std::floor(time_s / kGlanceEvery_s);
  const auto n = static_cast<std::uint64_t>(number);
  const double begins_s = mix(kGlanceFirst_s, kGlanceLast_s, drawn(n, 0)),
               held_s = mix(kHeldLeast_s, kHeldMost_s, drawn(n, 1)),
               since_s = time_s - number * kGlanceEvery_s - begins_s;
  const double turned = smootherstep(since_s / kGlanceTurns_s) *
                        (1.0 - smootherstep((since_s - kGlanceTurns_s - held_s) / kGlanceBack_s));
  const double to = 2.0 * drawn(n, 2) - 1.0;
  const double far = mix(kLeastGlance, kMostGlance, std::abs(to));
  idle.glance_rad = amount * turned * outwards * (to < 0.0 ? -far : far);
  idle.nod_rad = amount * turned * kMostNod * (drawn(n, 3) - 0.3);
}

}  // namespace

void advance_idle(const Tick& tick, WalkState& state) noexcept {
  IdleState& idle = state.idle;
  const bool stands = state.clock.stage == Stage::idle && tick.mode != IkMode::paper;
  const double time_s = idle.ticks * tick.dt_s;
  const double change = !stands                    ? -tick.dt_s / kEnds_s
                        : time_s >= kBeginsAfter_s ? tick.dt_s / kBegins_s
                                                   : 0.0;
  idle.share = std::clamp(idle.share + change, 0.0, 1.0);
  idle.ticks = stands || idle.share > 0.0 ? idle.ticks + 1 : 0;
  const double amount = smootherstep(idle.share) * state.body.now.idle;
  if (amount == 0.0) {
    idle.breath_rad = idle.glance_rad = idle.nod_rad = 0.0;
    state.path.sway_m = vec3(0.0);
    return;
  }
  const double breath = 0.5 - 0.5 * sin_cos(2.0 * kPi * kBreath_Hz * time_s).cos;
  idle.breath_rad = amount * kBreath_rad * breath;
  // After a mirrored walk the stand is mirrored as well: the foot that landed last tells the side.
  const double outwards = state.clock.swing == kLeftSide ? 1.0 : -1.0;
  glance(time_s, amount, outwards, idle);
  const double size_m = amount * tick.model.size;
  const vec3 forward = heading_direction(state.path.heading_rad);
  state.path.sway_m = forward * (size_m * swings(kAhead, time_s)) +
                      glm::cross(kUp, forward) * (size_m * outwards * swings(kAside, time_s));
}

}  // namespace gaitpad
