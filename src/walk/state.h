// All that a walk remembers between two ticks. Numbers of W walks stand side by side and stay so.
//
// Places are in the *step frame*: its origin is the heel of the foot that stands, on the ground,
// its z axis where that foot points, x to the left, y up. So the standing foot needs no numbers,
// floats are exact to a tenth of a micrometre wherever a walk goes, and a strike is one change of
// frame. A step is the roll of the foot that has landed (*stand*) and the flight of the other one
// (*swing*). Rates are per tick, phases in cycles from the right foot's strike in the data.
#pragma once
#include "walk/lanes.h"

namespace gaitpad::anew {

inline constexpr int kLegAngles = 7;  // hip x, z, y; knee; ankle x, z, y

// A value and its rate, per second.
template <class V>
struct Smoothed {
  V x{}, v{};
};
// What a value differs by from its plan, and the difference's rate and acceleration, per tick.
template <class V>
struct Off {
  V x{}, v{}, a{};
};

// What is asked for; by Side: the left foot's, the right foot's. Written by whoever steers.
template <class V>
struct Asked {
  V walks{};                                // 1: walk, else come to rest
  V length_m[2]{}, time_s[2]{}, lift[2]{};  // StrideParams
  V turn_rad_s{}, bounce{}, sway{};
};

template <class V>
struct State {
  Asked<V> asked;
  // The same, smoothed; the mean step over the data's, and how much of the data's posture that
  // shows (0 .. 1); the body's lean into a turn, to the left; the mean step time.
  Smoothed<V> length_m[2], lift[2], turn_goal_rad_s, turn_rad_s, bounce, sway;
  Smoothed<V> pace, posture, lean_rad, step_time_s;

  // How far chest and head are turned ahead of the pelvis.
  Smoothed<V> chest_ahead_rad, head_ahead_rad;

  // Clock.
  V right_swings{}, flies{};       // 1 or 0
  V tick{};                        // in the roll or the flight
  V roll_ticks{}, flight_ticks{};  // that they last
  V step_s{}, late_s{};            // of the step, unrounded; what the steps so far were too short
  V phase{}, phase_rate{};         // now
  V strike_rate{}, end_rate{};     // at the last strike; at the end of roll or flight

  // Path.
  V heading_rad{};
  V landing_x_m{}, landing_z_m{}, landing_rad{};  // the coming footprint
  V wider_m{}, next_wider_m{};      // how far beside the data's track this and the coming one are
  V ratio_behind{}, ratio_ahead{};  // of the last step's stride, and of this one's, over the data's
  // The tables' path of the hips to that landing at phase 0, and its way per cycle, a tick ago.
  V path_x_m{}, path_z_m{}, per_cycle_x_m{}, per_cycle_z_m{};
  Off<V> hips_x_m, hips_z_m;           // from that path
  V pelvis_x_m[3]{}, pelvis_z_m[3]{};  // in the last tick, and one and two before it

  // Swing foot: its last footprint and where its toe stands there.
  V print_x_m{}, print_z_m{}, print_rad{}, toe_x_m{}, toe_z_m{};
  // Its heel at lift-off, and the slope per flight, less the tables'; both fade in the flight.
  // Where it was one and two ticks ago. The yaw's slope per flight.
  Vec<V> gap_m, gap_slope_m, last_heel_m[2];
  V lift_turn_rad{};
  // Pitches at lift-off and landing less the tables', and the former's slope per tick.
  V swing_pitch_rad{}, swing_pitch_rate{}, stand_pitch_rad{};
  V last_pitch_rad[2]{};

  // Legs, swing and stand: their angles less the tables', now and a tick ago.
  V leg_rad[2][kLegAngles]{}, last_leg_rad[2][kLegAngles]{};

  // Turn of the step frame in the world, half of it.
  V frame_sine{}, frame_cosine{};
};
// A first step, or one whose pace is another one than that of the step before: the hips go to their
// place at the coming strike along a quintic, and the phase at which the tables are read follows
// them.
template <class V>
struct Change {
  V stands{}, starting{}, closing{};  // 1 or 0: both feet rest; the first step; the last one
  V shown = V{} + 1.0f;               // how much of the tables: 0 at rest
  V led{}, was_led{};                 // 1 or 0: this step, and the one before it
  Off<V> pelvis_x_m, pelvis_z_m;      // where the pelvis is, while it leads and a tick after
  V phase{}, phase_rate{};            // that are shown
  Off<V> off_phase;                   // from the phase found; fades in off_ticks
  V off_ticks{};
  V asked_ticks{};  // how long one that stands has been asked to walk
};

// Legs whose weights differ (weights.h); read where any walk of a block has such.
template <class V>
struct Weighted {
  // 1 or 0: the style has weights that differ; such were in force a tick ago. By Side: what is
  // asked for, and the same smoothed.
  V asked{}, acts{};
  V goal[2][kLegAngles]{};
  Smoothed<V> weight[2][kLegAngles];
  // Swing and stand: the running means of the even angles, filtered once and twice; what the
  // weights add to those, now and a tick ago; how loose the foot is after standing flat.
  V lagging_rad[2][kLegAngles]{}, mean_rad[2][kLegAngles]{};
  V shift_rad[2][kLegAngles]{}, last_shift_rad[2][kLegAngles]{};
  Smoothed<V> loose[2];
};

// Numbers of UpperBodyParams, in its order: of those by Side the left one's first.
enum BodyNumber : int {
  kArmSwing = 0,
  kArmOut_deg = 2,
  kArmWeight = 4,
  kSpineWeight = 16,
  kLean_deg = 18,
  kOverLeft_deg = 19,
  kOverRight_deg = 20,
  kHand = 21,
  kLook = 35,
  kLookYaw_deg = 36,
  kLookPitch_deg = 37,
  kLookAt = 38,
  kLead = 42,
  kIdle = 43,
  kBodyNumbers = 44
};

// What else a style asks for; read where any walk of a block has such.
template <class V>
struct Styled {
  // 1 or 0: the style's upper body is not the data's; it was not in the last tick. What it is to
  // be, and the same smoothed.
  V asked{}, acts{};
  V goal[kBodyNumbers]{};
  Smoothed<V> body[kBodyNumbers];
  // Of one who stands: ticks, and how much of breath, sway and glances shows.
  V idle_ticks{}, idle_share{};
  // Swing and stand: how low a foot's heel is kept where it would rise.
  Smoothed<V> low[2];
};

template <class V>
inline constexpr int kStateNumbers = (sizeof(State<V>) + sizeof(Change<V>) + sizeof(Weighted<V>) +
                                      sizeof(Styled<V>)) /
                                     sizeof(V);
static_assert(sizeof(State<float>) <= 512);

// The step frame in the world. Doubles, written at strikes alone.
struct Origin {
  double x_m = 0.0, z_m = 0.0, heading_rad = 0.0;
};

// A block of walks of one build. Aligned here, for g++ 12 forgets that of registers in a template's
// arguments.
template <int kWidth>
struct alignas(64) Block {
  State<Floats<kWidth>> state;
  Change<Floats<kWidth>> change;
  Weighted<Floats<kWidth>> weighted;
  Styled<Floats<kWidth>> styled;
  Origin origin[kWidth];
};

}  // namespace gaitpad::anew
