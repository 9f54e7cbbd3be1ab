// Recordings of sticks whose truth is known: what the analysis must find again.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "stick/stick_track.h"

namespace gaitpad {

enum class Gate { circle, square, ellipse };  // square: of half side `reach_x`, corners and all

// A stick as it is, and how it is moved. All positions raw; the stick's own zero is `centre`.
struct MadeStick {
  vec2 centre{0.0};
  vec2 sigma{0.0};       // Gaussian, of each report
  double hysteresis = 0.0;  // it comes to rest half of this towards the side it was let go from
  vec2 drift_per_s{0.0};
  Gate gate = Gate::circle;
  double reach_x = 1.0, reach_y = 1.0;  // of the gate about `centre`; circle: reach_x
  int bits = 0;               // of the logical range -1..1; 0: not quantised
  double rate_hz = 250.0, jitter_ms = 0.0;
  double drop_chance = 0.0;   // a report is lost
  double spike_chance = 0.0;  // a report shows another place
  StickFrame frame;           // raw axes swapped and inverted: in_frame(frame, raw) is the truth
  bool reports_changes_only = false;
  std::uint32_t seed = 1;
};

// Reports of the clean session: rest, then `releases` pushes to the rim from different directions
// with a rest of `rest_s` after each, then `turns` full circles, one a second and a half, then
// pushes held half a second forward, right, back, left, then rest.
StickTrack made_track(const MadeStick& stick, int releases = 8, double rest_s = 0.6,
                      double turns = 3.0);
// Radius of the gate about `centre` in a direction, without noise.
double gate_radius(const MadeStick& stick, double angle_rad);
// By the formula, of the gate without noise, densely sampled.
double true_circularity_error(const MadeStick& stick);

}  // namespace gaitpad
