// All that a walk remembers between two ticks. V is a number of one walk (float), or a register of
// those of several walks side by side. Callers copy and keep it; the walk alone writes it.
//
// Places are in the *step frame*: its origin is the heel of the foot that stands, on the ground,
// its z axis where that foot points, x to the left, y up. So the standing foot needs no numbers,
// floats are exact to a tenth of a micrometre wherever a walk goes, and a strike is one change of
// frame. A step is the roll of the foot that has landed (*stand*) and the flight of the other one
// (*swing*). Rates are per tick, phases in cycles from the right foot's strike in the data.
#pragma once
#include "gaitpad/placement.h"
#include "gaitpad/terrain.h"

namespace gaitpad {

// A number of each of kWidth walks.
template <int kWidth>
struct FloatsOf;
template <>
struct FloatsOf<1> {
  using Type = float;
};
template <int kWidth>
using Floats = typename FloatsOf<kWidth>::Type;

template <class V>
struct Vec {
  V x{}, y{}, z{};
};

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
  V backward{};  // 1: steps lead backward; where a walk goes the other way it comes to rest first
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
  V backward{};                    // 1: its steps lead backward
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
inline constexpr int kSinkKnots = 16;
inline constexpr float kNever = 1e6f;  // ticks

// A first step, or one whose pace is another one than that of the step before: the hips go to their
// place at the coming strike along a quintic, and the phase at which the tables are read follows
// them.
template <class V>
struct Change {
  V stands{}, starting{}, closing{};  // 1 or 0: both feet rest; the first step; the last one
  V shown = V{} + 1.0f;               // how much of the tables: 0 at rest
  V led{}, was_led{};                 // 1 or 0: this step, and the one before it
  V is_new{}, was_new{};              // 1: the plan has changed since the last tick; before that
  // Of a roll: the tick from which on the hips lead, the ticks after which it was to end before its
  // plan changed, and the rate of what its pitch was off then. Of a flight that they have led from
  // its middle on, led_from is -1.
  V led_from{}, led_until = V{} + kNever, led_rate_rad{};
  Off<V> pelvis_x_m, pelvis_z_m;  // where the pelvis is, while it leads and a tick after
  V phase{}, phase_rate{};        // that are shown
  // What a changed plan has left, of the phase and of what shows: fades in off_ticks. The same, at
  // the latest until the strike, of how far the step has come over to its own stride and of this
  // stride's ratio; at the latest until the lift-off, of how much pitch the standing foot has; of
  // how far the flying foot's edges have come over to its own phase.
  Off<V> off_phase, off_shown, off_over, off_ratio, off_pitch, off_edge;
  V off_ticks{};
  // Of a stop: 1 or 0; the steps that are left before the last one, 1 or 0, and the lengths of both
  // feet's; until the hips rest, and how long the last step took from its plan on.
  V stops{}, further{}, length_m[2]{}, rest_ticks{}, closing_ticks{};
  // How far hips sink before a leg is at its reach, as knots of a cubic spline (kSinkKnot_s), and
  // the ticks that are left of it; how far a leg at its reach wants them to sink in this tick.
  V sink_m[kSinkKnots]{}, sink_ticks{}, wants_m{};
  V foreseen_m{};  // both steps' lengths that were asked for when that was found
  V asked_m{};     // the same of the last tick; a turn counts as a way of a metre a rad/s
  // Of a walk that goes on after all: 1 or 0: in this step; until its hips are where they ought to
  // be.
  V resumes{}, catch_ticks{};
  // Of a flight: from where on, and over how much of it, its gap fades; the gaps of yaw, twist
  // and roll, how high the heel was to be there, and how loosely its pitch was bounded; the ticks
  // from and over which its pitch's does, if its plan has changed.
  V gap_begin{}, gap_lasts = V{} + 0.5f, gap_rad{}, gap_twist_rad{}, gap_roll_rad{};
  V gap_high_m = V{} + 1.0f, gap_loose_rad{};
  V gap_share{};  // how much of the flight was over by the plan before it changed
  V pitch_begin{}, pitch_lasts{};
  // Of a flight with a limp, from its lift-off on: how much of it shows, and the longer one of both
  // feet's steps over the flying one's.
  V limp{}, limp_far{};
  V asked_ticks{};          // how long one that stands has been asked to walk
  V stepped_m{};            // the length that was asked for when the running step's landing settled
  V slowness = V{} + 1.0f;  // factor on the step's times: on stairs steps take longer
  V by_paper{};             // 1: State::leg_rad are whole angles, as IkMode::paper solves them
  // What is asked of the coming landing, 1: it is to be here; and a push that the hips have not
  // taken yet.
  V is_aimed{}, aim_x_m{}, aim_z_m{}, aim_rad{}, push_x_m_s{}, push_z_m_s{};
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
  Smoothed<V> rail_ground_m[2];  // by Side: of the ground under a rail, over the step frame
};

// A turn whose second difference is bounded (trunk.h): in this tick, and since the one before; what
// it is off its goal, which fades in `ticks`.
template <class V>
struct Eased {
  Vec<V> at, rate;
  Off<V> off[3];
  V ticks{};
};
// How chest and head are carried while a walk changes.
template <class V>
struct Poise {
  V acts{};                         // 1 or 0: they were eased a tick ago
  V unsteady_ticks{};               // until the walk is steady
  Smoothed<V> speed_m_s, push_rad;  // mean speed; lean into another one, forwards
  Eased<V> chest, head;
};

// What a flight's height differs by from its plan, and the difference's slope per flight.
template <class V>
struct Gap {
  V x{}, v{};
};
// How a plane rises along x and along z.
template <class V>
struct Slope {
  V x{}, z{};
};
// What uneven ground makes of a walk; a walk on level ground does not read it. Heights are over the
// step frame: over the ground at the heel of the foot that stands.
inline constexpr int kRoomKnots = 7;  // inner ones of a spline over the flight
template <class V>
struct Footing {
  // The planes of the foot that stands, of the other one's last footprint, and of the landing.
  Slope<V> stand, print, landing;
  V print_y_m{}, toe_y_m{}, landing_y_m{};
  // Where the foot would land if the ground were level, and for which such place the landing was
  // chosen last; the share of the step's length that a slope leaves; the rise of the step after
  // this one, in legs; 1: the sole overhangs an edge.
  V level_x_m{}, level_z_m{}, level_rad{}, asked_x_m{}, asked_z_m{}, asked_rad{};
  V share = V{} + 1.0f, next_rise{}, overhangs{};
  // The ground that the hips go over, per tick; where it settles over the standing foot, what it is
  // still off, and how long after the strike; how far it then sinks to the next landing, and how
  // far below that one it is, at it and after it.
  Off<V> hips_m;
  V level_m{};
  Off<V> off_m;
  V settle_ticks{}, drop_m{}, early_m{}, yield_m{};
  // Of a step whose plan has changed: 1 in the next tick; from which tick of the flight on the hips
  // may sink; what the flight's plane, the ground line, what is above it to keep clear and the
  // rise with the hips were off the new ones, and how far the heel was below the line.
  V is_new{}, sink_from{};
  Slope<V> gap_plane;
  Gap<V> gap_line_m, gap_room_m;
  V gap_rise_m{}, gap_under_m{};
  // The step along the heading, its ratio, and what the tables' ratio is off it; the share of the
  // wanted lengths that the ground leaves; the trunk's lean into the slope, forwards.
  V step_m{}, step_ratio{};
  Off<V> off_ratio;
  Smoothed<V> left{V{} + 1.0f, V{}}, lean_rad;
  // The swinging foot: how far it rises with the hips, and did one and two ticks ago; its plane's
  // height where its heel lifted off; 1: it crosses a riser. What keeps it off the ground: splines
  // up, and away from a riser, planned for a landing; the same, smoothed and in force.
  V rise_m{}, last_rise_m[2]{}, lift_y_m{}, crosses{};
  Vec<V> room_for_m;
  V raise_m[kRoomKnots]{}, shift_m[kRoomKnots]{};
  Smoothed<V> raise[kRoomKnots], shift[kRoomKnots];
};

// What a tick leaves for the report (WalkFrame). No tick reads it. By Side.
template <class V>
struct Told {
  // Landings so far, of which so many overhang an edge; the length of each foot's last step; ticks
  // of the last step and of the one before it.
  V steps[2]{}, overhangs{}, stride_m[2]{}, step_ticks[2]{};
  V struck{};        // 1: a foot has landed in this tick, which still shows its flight
  V settle_ticks{};  // after the last landing, until the report says that the walk stands
  // Where the pelvis is beside the hips' even way, to the left and ahead.
  V pelvis_x_m{}, pelvis_z_m{};
  // The legs' solves: iterations, the last one's error, 1: it did not reach its goal.
  V iterations[2]{}, error_m[2]{}, failed[2]{};
};

// The step frame in the walk's own coordinates. Doubles, written at strikes alone.
struct Origin {
  double x_m = 0.0, z_m = 0.0, heading_rad = 0.0, y_m = 0.0;
};

// A block of walks of one build. Aligned here, for g++ 12 forgets that of registers in a template's
// arguments.
template <int kWidth>
struct alignas(kWidth == 1 ? alignof(double) : 64) Block {
  State<Floats<kWidth>> state;
  Change<Floats<kWidth>> change;
  Weighted<Floats<kWidth>> weighted;
  Styled<Floats<kWidth>> styled;
  Footing<Floats<kWidth>> footing;
  Poise<Floats<kWidth>> poise;
  Told<Floats<kWidth>> told;
  Origin origin[kWidth];
  Placement placed[kWidth];  // of the walk's own coordinates in the world
  Stretch piece[kWidth];     // of uneven ground: where the swinging foot lands
  bool is_placed = false;    // a walk of them is placed
};

}  // namespace gaitpad
