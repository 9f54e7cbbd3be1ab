// The state of a walk between two ticks. V is the number of one walk (float), or a register that
// holds it for several walks side by side. Callers copy and store it; only the walk writes it.
//
// Places are in the *step frame*: the origin is the heel of the standing foot, on the ground; z is
// the direction in which that foot points, x is left, y is up. Numbers stay small, so floats are
// exact to a tenth of a micrometre, and a strike changes the frame once. A step is the roll of the
// foot that has landed (*stand*) and the flight of the other foot (*swing*). Two numbers of a pair
// belong to swing and stand, unless "by Side" says left and right. Rates are per tick; phases are
// in cycles from the right foot's strike in the data. Flags are 1 or 0.
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
// Difference of a value from its plan; the difference's rate and acceleration, per tick.
template <class V>
struct Off {
  V x{}, v{}, a{};
};

// The hips' path in the strides of some footprints, without their oscillation: a line over phase.
template <class V>
struct Path {
  V x_m{}, z_m{};                      // at phase 0
  V per_cycle_x_m{}, per_cycle_z_m{};  // slope
};

// The gait that is asked for; pairs by Side. Whoever steers writes it.
template <class V>
struct Asked {
  V walks{};                                // 1: walk, 0: come to rest
  V length_m[2]{}, time_s[2]{}, lift[2]{};  // StrideParams
  V turn_rad_s{}, bounce{}, sway{};         // GaitParams
  V backward{};  // 1: steps lead backward; a walk that goes the other way first comes to rest
};

template <class V>
struct State {
  Asked<V> asked;
  // The same, smoothed. The turn passes two filters; `turn_goal_rad_s` is between them.
  Smoothed<V> length_m[2], lift[2], turn_goal_rad_s, turn_rad_s, bounce, sway;  // pairs by Side
  Smoothed<V> pace;         // mean step length over the data's
  Smoothed<V> posture;      // share of the data's posture that this pace shows, 0 to 1
  Smoothed<V> lean_rad;     // of the body into a turn, to the left
  Smoothed<V> step_time_s;  // mean of both feet
  // How far chest and head are turned ahead of the pelvis.
  Smoothed<V> chest_ahead_rad, head_ahead_rad;

  // Clock.
  V right_swings{};                // 1: the right foot swings, 0: the left one
  V flies{};                       // 1: in the flight, 0: in the roll
  V backward{};                    // 1: steps lead backward
  V tick{};                        // ticks since the roll or the flight began
  V roll_ticks{}, flight_ticks{};  // their durations
  V step_s{};                      // duration of the step before rounding to ticks
  V late_s{};                      // by which rounding has made the steps too short so far
  V phase{}, phase_rate{};         // of the clock
  V strike_rate{}, end_rate{};     // phase rate at the last strike; at the end of roll or flight

  // Path.
  V heading_rad{};                                // of the body
  V landing_x_m{}, landing_z_m{}, landing_rad{};  // next footprint: heel and direction
  // Distance of the standing footprint, and of the next one, outside the data's track.
  V wider_m{}, next_wider_m{};
  V ratio_behind{};                    // stride length of the last step over the data's
  Path<V> path;                        // to the landing, in the last tick
  Off<V> hips_x_m, hips_z_m;           // of the hips from that path
  V pelvis_x_m[3]{}, pelvis_z_m[3]{};  // in the last tick, and one and two ticks before it

  // Swing foot: its last footprint (heel and direction), and the toe there.
  V print_x_m{}, print_z_m{}, print_rad{}, toe_x_m{}, toe_z_m{};
  // Difference of the heel from its flight in the tables, at lift-off or where the plan changed,
  // and its slope per flight. Both fade during the flight.
  Vec<V> gap_m, gap_slope_m;
  Vec<V> last_heel_m[2];  // one and two ticks ago
  V lift_turn_rad{};      // slope of the yaw at lift-off, per flight
  // The same difference of the pitch, and its slope per tick; the pitch's difference at landing.
  V swing_pitch_rad{}, swing_pitch_rate{}, stand_pitch_rad{};
  V last_pitch_rad[2]{};  // of the swing foot, one and two ticks ago

  // Angles of swing and stand leg less the tables', now and a tick ago. With IkMode::paper they are
  // whole angles (Change::by_paper).
  V leg_rad[2][kLegAngles]{}, last_leg_rad[2][kLegAngles]{};

  // Sine and cosine of half the step frame's heading in the walk's own coordinates.
  V frame_sine{}, frame_cosine{};
};
inline constexpr int kSinkKnots = 16;
inline constexpr float kNever = 1e6f;      // ticks
inline constexpr int kTurnedNumbers = 13;  // of Change::off_turned

// Steps that are not steady: starts, stops and changes of pace. There the hips *lead*: they go
// along a quintic to their place at the next strike, and the tables are read at the phase at which
// they have the pelvis there.
template <class V>
struct Change {
  V stands{};                     // 1: both feet rest
  V starting{}, closing{};        // 1: the first step; the last step
  V shown = V{} + 1.0f;           // share of the tables that is shown, 0 at rest
  V led{}, was_led{};             // 1: hips lead in this step; they did in the last step
  V is_new{}, was_new{};          // 1: the plan has changed since the last tick; since that before
  Off<V> pelvis_x_m, pelvis_z_m;  // place of the leading pelvis, its rate and acceleration
  V phase{}, phase_rate{};        // that are shown
  // Roll of the standing foot where the hips lead: the tick at which it began, the one at which it
  // ends unless the roll ends before, and the pitch's rate at its beginning, per tick. In a flight
  // in which the hips began to lead, `led_from` is less than 0: that tick.
  V led_from{}, led_until = V{} + kNever, led_rate_rad{};

  // Differences that a change of plan leaves and that fade in `off_ticks`: of the phase and of
  // `shown`; of the share by which the step has come over to its own stride, of that stride's
  // ratio, and of the share by which the flying foot's edges follow the flight, at the latest until
  // the strike; of the share of the standing foot's pitch, at the latest until its stage ends.
  Off<V> off_phase, off_shown, off_over, off_ratio, off_edge, off_pitch;
  V off_ticks{};

  // 1: the first step the other way of a walk that does not stand in between. What the tables of
  // both directions differ by: the pelvis' height, yaw and tilt; twist and roll of the standing and
  // the swing foot; both knees; pitch of the standing foot, and of the swing foot if it stood.
  V turns{};
  Off<V> off_turned[kTurnedNumbers];

  // A stop.
  V stops{};          // 1: the walk comes to rest
  V further{};        // 1: one more step comes before the last one
  V length_m[2]{};    // of the steps that are left, by Side
  V rest_ticks{};     // until the hips rest
  V closing_ticks{};  // from the plan of the last step to its strike

  // A walk that goes on after all.
  V resumes{};      // 1: in this step
  V catch_ticks{};  // until hips that have braked are at their place in the tables

  // Sinking before a leg is at its reach: knots of a cubic spline in metres (kSinkKnot_s), the
  // ticks that are left of it, and the sinking that the legs ask for in this tick.
  V sink_m[kSinkKnots]{}, sink_ticks{}, wants_m{};
  Off<V> off_sink;     // by which the plan before differs
  V off_sink_ticks{};  // in which that fades
  // Knees of swing and stand, now and a tick ago; by how much the hips give way to one that is
  // nearly straight, and the ticks in which that fades.
  V knee_rad[2][2]{};
  Off<V> raised_m;
  V raised_ticks{};
  V foreseen_m{};     // sum of both steps' lengths for which that was planned
  V asked_legs[2]{};  // asked for in the last tick: sum of both steps' lengths, and turn, in legs

  // Flight after a change of plan: the share of the flight at which State::gap_m begins to fade,
  // and the share in which it fades.
  V gap_begin{}, gap_lasts = V{} + 0.5f;
  V gap_rad{}, gap_twist_rad{}, gap_roll_rad{};  // the same differences of yaw, twist and roll
  V gap_high_m = V{} + 1.0f;       // height of the heel over the ground line by the new plan
  V gap_loose_rad{};               // width in which the floor's bound on the pitch was rounded
  V gap_share{};                   // share of the flight that was over by the old plan
  V pitch_begin{}, pitch_lasts{};  // ticks of the flight in which the pitch's difference fades

  // A limp, from lift-off on: its share, and the longer step over the step of the flying foot.
  V limp{}, limp_far{};
  V asked_ticks{};          // ticks for which a standing walk has been asked to start
  V stepped_m{};            // step length asked for when the step's landing was settled
  V slowness = V{} + 1.0f;  // factor on the step's times: steps on stairs take longer
  V by_paper{};             // 1: State::leg_rad are whole angles (IkMode::paper)

  // Detail::tables. 1: is asked for. 0 to 1: the pose comes over to it; 1 to 2: it comes back.
  V asks_tables{}, to_tables{};

  // Landing that a program asks for (1: it does): heel and direction; and the part of a push that
  // the hips have not taken yet.
  V is_aimed{}, aim_x_m{}, aim_z_m{}, aim_rad{}, push_x_m_s{}, push_z_m_s{};
};

// Legs whose weights differ (weights.h). Read if a walk of the block has such legs.
template <class V>
struct Weighted {
  V asked{}, acts{};                  // 1: the weights asked for differ; those in force did
  V goal[2][kLegAngles]{};            // weights asked for, by Side
  Smoothed<V> weight[2][kLegAngles];  // the same, smoothed
  // Running means of the angles with even weights, filtered once and twice.
  V lagging_rad[2][kLegAngles]{}, mean_rad[2][kLegAngles]{};
  // Angles that the weights add, now and a tick ago.
  V shift_rad[2][kLegAngles]{}, last_shift_rad[2][kLegAngles]{};
  Smoothed<V> loose[2];  // share by which the foot may leave its planned direction, 0 when flat
};

// Index of each number of UpperBodyParams, in its order; of a pair by Side, of the left one.
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

// The other values of a style. Read if a walk of the block has a style that sets them, or stands.
template <class V>
struct Styled {
  V asked{}, acts{};               // 1: the upper body asked for is not the data's; that in force
  V goal[kBodyNumbers]{};          // UpperBodyParams that are asked for
  Smoothed<V> body[kBodyNumbers];  // the same, smoothed
  // While standing: ticks so far, and the share of breath, sway and glances that is shown; negative
  // where they are mirrored.
  V idle_ticks{}, idle_share{};
  Smoothed<V> low[2];            // share by which a heel is kept down when it would rise
  Smoothed<V> rail_ground_m[2];  // by Side: height of the ground under a rail, in the step frame
};

// A rotation vector whose second difference is bounded (trunk.h), and its change in the last tick,
// in radians; its difference from the goal, which fades in `ticks`.
template <class V>
struct Eased {
  Vec<V> at, rate;
  Off<V> off[3];
  V ticks{};
};
// Chest and head while a walk changes.
template <class V>
struct Poise {
  V acts{};               // 1: they were eased a tick ago
  V unsteady_ticks{};     // until the walk is steady
  Smoothed<V> speed_m_s;  // mean speed
  Smoothed<V> push_rad;   // forward lean of the trunk into a change of speed
  Eased<V> chest, head;
};

// Difference of a height in flight from its plan, and the difference's slope per flight.
template <class V>
struct Gap {
  V x{}, v{};
};
// Slope of a plane along x and along z, metres per metre.
template <class V>
struct Slope {
  V x{}, z{};
};
inline constexpr int kRoomKnots = 7;  // inner knots of a spline over the flight
// A walk on uneven ground; not read on level ground. Heights are in the step frame: above the
// ground at the heel of the standing foot.
template <class V>
struct Footing {
  Slope<V> stand, print, landing;  // ground below the standing foot, the last footprint, the next
  V print_y_m{}, toe_y_m{}, landing_y_m{};  // heights of that footprint, of the toe there, the next
  // Where the foot would land on level ground, and the place for which a foothold was last chosen.
  V level_x_m{}, level_z_m{}, asked_x_m{}, asked_z_m{}, asked_rad{};
  V share = V{} + 1.0f;  // step length on this ground over that on level ground
  V next_rise{};         // height of the step after this one, in legs
  V overhangs{};         // 1: the sole of the landing overhangs an edge

  // The hips over the ground: their height, which follows the ground; the height above the standing
  // foot at which they settle, the difference from it, and the ticks after the strike until then;
  // the way down to the next landing, and the distance below it at the landing and after it.
  Off<V> hips_m;
  V level_m{};
  Off<V> off_m;
  V settle_ticks{}, drop_m{}, early_m{}, yield_m{};

  // After a change of plan: 1 in the next tick; the tick of the flight at which the hips may begin
  // to sink; differences of the flight's plane, of the ground line, of the height above it and of
  // the rise with the hips from the new plan; depth of the heel below the ground line.
  V is_new{}, sink_from{};
  Slope<V> gap_plane;
  Gap<V> gap_line_m, gap_room_m;
  V gap_rise_m{}, gap_under_m{};

  V step_m{}, step_ratio{};           // step along the heading, and its stride over the data's
  Off<V> off_ratio;                   // of the ratio at which the tables are read
  Smoothed<V> left{V{} + 1.0f, V{}};  // share of the lengths asked for that the ground leaves
  Smoothed<V> lean_rad;               // forward lean of the trunk into the slope

  // The swing foot: its rise with the hips, now and one and two ticks ago; the height of its plane
  // at lift-off; 1: it crosses a riser.
  V rise_m{}, last_rise_m[2]{}, lift_y_m{}, crosses{};
  // Splines that keep the flight off the ground, up and away from a riser: the landing for which
  // they were planned, their knots in metres, and the same smoothed.
  Vec<V> room_for_m;
  V raise_m[kRoomKnots]{}, shift_m[kRoomKnots]{};
  Smoothed<V> raise[kRoomKnots], shift[kRoomKnots];
};

// Results of a tick for the report (WalkFrame); no tick reads them. Pairs by Side.
template <class V>
struct Told {
  V steps[2]{}, overhangs{};  // landings so far, and those of them that overhang an edge
  V stride_m[2]{};            // length of each foot's last step
  V step_ticks[2]{};          // of the last step and of the one before it
  V struck{};        // 1: a foot has landed in this tick, whose pose still shows its flight
  V settle_ticks{};  // after the last landing, until the report says that the walk stands
  V pelvis_x_m{}, pelvis_z_m{};  // oscillation of the pelvis about the hips' path: left and ahead
  // The legs' solver: iterations, distance from the goal, and 1 if the goal was not reached.
  V iterations[2]{}, error_m[2]{}, failed[2]{};
};

// The step frame in the walk's own coordinates. Doubles, written at strikes alone.
struct Origin {
  double x_m = 0.0, z_m = 0.0, heading_rad = 0.0, y_m = 0.0;
};

// A block of walks of one build. The alignment is explicit because g++ 12 drops that of register
// types in template arguments.
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
  Stretch piece[kWidth];     // section of uneven ground on which the swing foot lands
  bool is_placed = false;    // true if a walk has a placement other than none
};

}  // namespace gaitpad
