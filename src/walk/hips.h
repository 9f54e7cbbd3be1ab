// Third: where the hips are, and the phase that goes with it.
#pragma once
#include "walk/strides.h"

namespace gaitpad::anew {
namespace {

// The hips' path in the strides of some footprints, without their oscillation: a line in phase.
template <class V>
struct Path {
  V x_m{}, z_m{}, per_cycle_x_m{}, per_cycle_z_m{};
};
// To the next landing. `turns`: cycles at the end of the step.
template <class V>
Path<V> path_to(const Landing<V>& landing, const Footprints<V>& prints, const V& turns) noexcept {
  const Vec<V> seen =
      landing.way * Vec<V>{prints.swing_m.x, V{}, prints.swing_m.z + prints.stride_m * turns};
  return {landing.x_m - seen.x, landing.z_m - seen.z, landing.way.sine * prints.stride_m,
          landing.way.cosine * prints.stride_m};
}

// Moves what a value is off its plan by one tick along the quintic that ends in 0 after `ticks`.
template <class V>
void fade(const V& ticks, Off<V>& off) noexcept {
  const V n = most(ticks, all<V>(1.0f)), s = 1.0f / n, p = off.v * n, q = off.a * (0.5f * n * n);
  const V c3 = -10.0f * off.x - 6.0f * p - 3.0f * q, c4 = 15.0f * off.x + 8.0f * p + 3.0f * q,
          c5 = -6.0f * off.x - 3.0f * p - q;
  const auto lasts = ticks > all<V>(1.0f);
  off.x = lasts ? V(off.x + (p + (q + (c3 + (c4 + c5 * s) * s) * s) * s) * s) : V{};
  off.v =
      lasts ? V((p + (2.0f * q + (3.0f * c3 + (4.0f * c4 + 5.0f * c5 * s) * s) * s) * s) * s) : V{};
  off.a =
      lasts ? V((2.0f * q + (6.0f * c3 + (12.0f * c4 + 20.0f * c5 * s) * s) * s) * (s * s)) : V{};
}

template <class V>
struct Hips {
  V x_m{}, z_m{};  // of the pelvis, on the ground
  Way<V> heading;  // of the body
  Footprints<V> behind, ahead;
};

// They follow the stride ahead to the landing. What they are off that path, for the step before was
// another one or the landing has moved, fades until the strike.
template <class V>
Hips<V> move_hips(const Tables& tables, const Time<V>& time, const Landing<V>& landing,
                  const Stride<V>& stride, State<V>& state) noexcept {
  Hips<V> hips;
  hips.behind = footprints_of(tables, time.right, state.ratio_behind);
  hips.ahead = footprints_of(tables, time.right, landing.ratio);
  const V turns = chosen<V>(time.right, 1.0f, 0.0f);
  const Path<V> to = path_to(landing, hips.ahead, turns);
  const V x_m = to.x_m + to.per_cycle_x_m * state.phase,
          z_m = to.z_m + to.per_cycle_z_m * state.phase;
  const auto strikes = both(no(time.flies), state.tick == all<V>(1.0f));
  if (any(strikes)) {
    // From the path past the foot that stands, in the stride behind, at this strike and the two
    // ticks after it.
    const V from_x_m = -hips.behind.stand_m.x - to.x_m, from_z_m = -hips.behind.stand_m.z - to.z_m,
            per_x_m = -to.per_cycle_x_m, per_z_m = hips.behind.stride_m - to.per_cycle_z_m;
    const V ticks = state.roll_ticks, way = time.stage_end - time.step_phase;
    const V v0 = state.strike_rate * ticks, v1 = state.end_rate * ticks,
            c2 = 3.0f * way - 2.0f * v0 - v1, c3 = v0 + v1 - 2.0f * way;
    const auto phase_at = [&](float n) {
      const V s = n / ticks;
      return V(time.step_phase + (v0 + (c2 + c3 * s) * s) * s);
    };
    const V p0 = time.step_phase, p1 = phase_at(1.0f), p2 = phase_at(2.0f),
            rate = 0.5f * (4.0f * p1 - 3.0f * p0 - p2), bend = p0 - 2.0f * p1 + p2;
    const auto begin = [&](const V& from_m, const V& per_m, Off<V>& off) {
      off.x = strikes ? V(from_m + per_m * p0) : off.x;
      off.v = strikes ? V(per_m * rate) : off.v;
      off.a = strikes ? V(per_m * bend) : off.a;
    };
    begin(from_x_m, per_x_m, state.hips_x_m);
    begin(from_z_m, per_z_m, state.hips_z_m);
  }
  // Where the path has moved the hips have not.
  const V was_x_m = state.path_x_m + state.per_cycle_x_m * state.phase,
          was_z_m = state.path_z_m + state.per_cycle_z_m * state.phase;
  state.hips_x_m.x = state.hips_x_m.x + (strikes ? V{} : V(was_x_m - x_m));
  state.hips_z_m.x = state.hips_z_m.x + (strikes ? V{} : V(was_z_m - z_m));
  state.path_x_m = to.x_m, state.path_z_m = to.z_m;
  state.per_cycle_x_m = to.per_cycle_x_m, state.per_cycle_z_m = to.per_cycle_z_m;
  const V ticks = time.to_strike + 1.0f;
  fade(ticks, state.hips_x_m);
  fade(ticks, state.hips_z_m);
  hips.heading = way_of(state.heading_rad);
  const Vec<V> off = hips.heading * stride.pelvis_m;
  hips.x_m = x_m + state.hips_x_m.x + off.x;
  hips.z_m = z_m + state.hips_z_m.x + off.z;
  state.pelvis_x_m = hips.x_m, state.pelvis_z_m = hips.z_m;
  return hips;
}

// The pelvis in the step frame.
template <class V>
struct Pelvis {
  Vec<V> place_m;
  Turn<V> turn;
  Vec<V> hip_m[2];  // joints, from its place; swing and stand
};

template <class V>
Pelvis<V> pelvis_over(const Tables& tables, const Time<V>& time, const Hips<V>& hips,
                      const Stride<V>& stride, const State<V>& state) noexcept {
  // More bounce lets it sink deeper, less keeps it as low as its lowest: no leg has to be longer.
  const V more = state.bounce.x - 1.0f, y = stride.pelvis_m.y,
          stays = more > V{} ? stride.pelvis_high_m : stride.pelvis_low_m;
  const V height_m = tables.stand_m + y + more * (y - stays);
  // In a turn the body leans as a whole, about the ground below the hips.
  V half_sine, half_cosine;
  sin_cos_small(V(0.5f * state.lean_rad.x), half_sine, half_cosine);
  const V left_m = height_m * 2.0f * half_sine * half_cosine;
  Pelvis<V> pelvis;
  pelvis.place_m = {hips.x_m + hips.heading.cosine * left_m,
                    height_m * (1.0f - 2.0f * half_sine * half_sine),
                    hips.z_m - hips.heading.sine * left_m};
  Vec<V> tilt = stride.pelvis_tilt_rad;
  tilt.z = tilt.z + tables.stand_roll_rad;
  V sine, cosine;
  sin_cos_small(V(0.5f * state.sway.x * stride.pelvis_yaw_rad), sine, cosine);
  const Turn<V> lean{half_cosine, V{}, V{}, -half_sine}, sway{cosine, V{}, sine, V{}};
  pelvis.turn = (hips.heading.turn() * lean) * (sway * turn_by(tilt));
  pelvis.hip_m[0] = pelvis.turn * by_side<V>(time.right, tables.leg[0].hip_m, tables.leg[1].hip_m);
  pelvis.hip_m[1] =
      pelvis.turn * by_side<V>(no(time.right), tables.leg[0].hip_m, tables.leg[1].hip_m);
  return pelvis;
}

// A leg reaches so far, of its length: a knee bent by 4 degrees. Lengths in metres at the reference
// leg: what the tables ask for is let through, a turn or the ground may ask for more and more.
inline constexpr float kReach = 0.9994f, kSoftReach_m = 0.006f, kKnown_m = 0.0015f,
                       kWiderReach = 0.6f, kWidestReach_m = 0.06f, kMostSunk_m = 0.34f,
                       kSoftSunk_m = 0.12f;

// Lowers it where a leg is asked for more than the tables know. `ankle_m`: swing and stand.
template <class V>
void sink(const Tables& tables, const Time<V>& time, const Stride<V>& stride,
          const Vec<V> (&ankle_m)[2], Pelvis<V>& pelvis) noexcept {
  const float grown = tables.size;
  V squares{};
  for (int k : {0, 1}) {
    const auto right = k == 0 ? time.right : no(time.right);
    const auto of = [&](float LegBones::*bone) {
      return chosen<V>(right, tables.leg[1].*bone, tables.leg[0].*bone);
    };
    const V a = of(&LegBones::thigh_m), b = of(&LegBones::shank_m),
            knee = stride.leg_rad[k][3] +
                   chosen<V>(right, tables.leg[1].stand_rad[3], tables.leg[0].stand_rad[3]);
    V sine, cosine;
    sin_cos(knee, sine, cosine);
    const V known = root(V(a * a + b * b + 2.0f * a * b * cosine));
    const Vec<V> way = ankle_m[k] - (pelvis.place_m + pelvis.hip_m[k]);
    const V span = root(dot(way, way)), beyond = (span - known) * (1.0f / grown);
    const V soft = grown * (kSoftReach_m + kWiderReach * least(beyond, all<V>(kWidestReach_m)));
    const V times = beyond * (1.0f / kKnown_m), shows = times * times,
            excess = soft_positive(V(span - kReach * (a + b)), soft) * shows / (1.0f + shows),
            upright = most(V(0.3f * span), V(-way.y)) / span, down = excess / upright;
    squares = squares + (beyond > V{} ? V(down * down) : V{});
  }
  const V down_m = root(squares),
          sunk_m = soft_least(down_m, all<V>(kMostSunk_m * grown), all<V>(kSoftSunk_m * grown));
  pelvis.place_m.y = pelvis.place_m.y - sunk_m;
}

}  // namespace
}  // namespace gaitpad::anew
