// The data that a viewer reads of a session: the cast once, a frame whenever it draws, and a sample
// of each tick for graphs. All of it is copied out of the simulation; changing it has no effect on
// one.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gaitpad/simulation.h"
#include "gaitpad/style.h"

namespace gaitpad {

// A character, as far as it stays the same while the session runs.
struct CastMember {
  std::string character, style;  // names of the character and of its style at the beginning
  std::shared_ptr<const WalkModel> model;
  GaitLimits limits;
};
struct CrowdCastMember {
  std::shared_ptr<const WalkModel> model;
  int style = 0;  // index in Cast::styles
};
struct Cast {
  std::string motion;  // name of the motion
  std::shared_ptr<const GaitCycle> source;
  std::vector<CastMember> members;
  std::vector<CrowdCastMember> crowd;                       // members of the crowd whose poses
                                                            // viewers get
  std::shared_ptr<const Terrain> terrain = flat_terrain();  // never null
  std::vector<std::string> styles;                          // names of the styles that a `style`
                                                            // command may name
  std::vector<StyleValues> style_values;                    // the values of these styles, as in
                                                            // their files
  int rate_hz = 240;
};
Cast cast_of(const Simulation& simulation, const SimulationConfig& config);

struct WalkerFrame {
  Pose before, pose;  // poses after the previous tick and after this one
  WalkFrame walk;
  GaitParams params;  // parameters that the tick used
  StyleValues style;  // the chosen style, with the changes made by commands
  int style_index = 0;
  GaitOverrides overrides;
  // The legs' angles in the pose; signs as in gaitpad/limbs.h.
  std::array<LegAngles, 2> angles_rad{};
  double phase = 0.0;     // phase of the source's cycle, 0 .. 1 from the right heel strike
                          // on
  double presence = 0.0;  // share of the source's motion that shows: 0 standing .. 1 walking
  std::int64_t ik_failures = 0;
};

// The pad that drives, in a frame.
struct PadFrame {
  std::uint16_t device = kNoDevice;  // kNoDevice: none has driven so far
  bool is_present = false;
  PadState state;              // uncalibrated state
  Calibration calibration;     // converts `state` to the stick
  std::uint64_t reports = 0;   // number of its reports since the beginning
  std::int64_t untouched = 0;  // number of times that its left stick began to walk untouched
};

struct SessionFrame {
  std::int64_t tick = -1;    // -1: none yet
  std::int64_t time_ns = 0;  // when the tick was due, CLOCK_MONOTONIC; 0 in a replay
  Stick stick;               // the calibrated sticks
  PadFrame pad;
  // Number of presses of each button since the beginning (Pads::presses()), so that none is missed
  // between frames.
  PressCounts presses{};
  SimulationCounts counts;
  IkMode ik = IkMode::robust;  // mode of the walkers' inverse kinematics
  StickMeans stick_means = StickMeans::steers;
  int walker_count = 0;
  std::array<WalkerFrame, kMaxWalkers> walkers;
  FollowerPoses crowd;  // poses of the members in Cast::crowd
};
// Copies only the joints that there are: use a frame for one session only. The first copy of a
// session with a crowd into a frame takes room on the heap; later ones do not.
void copy_frame(const Simulation& simulation, SessionFrame& frame) noexcept;

// One tick of one character, small enough to keep many of them.
struct WalkerSample {
  std::array<std::array<float, 3>, 2> joint_rad{};  // hip flexion, knee flexion, ankle dorsiflexion
  std::array<vec3, 2> heel_m{}, toe_m{};            // places in the world
  std::array<float, 2> heel_above_m{};              // height above the ground below the heel
  std::array<std::int16_t, 2> ik_iterations{};
  std::array<float, 2> ik_error_m{};
  Stage stage = Stage::idle;
  Side swing = kLeftSide;
  std::array<bool, 2> heel_planted{}, toe_planted{};
};
struct TickSample {
  std::int64_t tick = -1;
  int walker_count = 0;
  float stick_x = 0.0f, stick_y = 0.0f;
  float step_us = 0.0f;  // duration of the tick; 0: not measured
  std::array<WalkerSample, kMaxWalkers> walkers;
};
void copy_sample(const Simulation& simulation, TickSample& sample) noexcept;

}  // namespace gaitpad
