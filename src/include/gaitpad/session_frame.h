// What a viewer needs of a session: the cast once, a frame whenever it draws, a sample of each tick
// for its graphs. All of it is copied out of the simulation, nothing of it steers one.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gaitpad/simulation.h"
#include "gaitpad/style.h"

namespace gaitpad {

// What does not change while a session runs.
struct CastMember {
  std::string character, style;  // names; the style is that of the beginning
  std::shared_ptr<const WalkModel> model;
  GaitLimits limits;
};
struct Cast {
  std::string motion;  // its name
  std::shared_ptr<const GaitCycle> source;
  std::vector<CastMember> members;
  std::shared_ptr<const Terrain> terrain = flat_terrain();  // never null
  std::vector<std::string> styles;                          // all that a `style` command may name
  std::vector<StyleValues> style_values;                    // of these, as their files have them
  int rate_hz = 240;
};
Cast cast_of(const Simulation& simulation, const SimulationConfig& config);

struct WalkerFrame {
  Pose before, pose;  // after the tick before and after this one
  WalkFrame walk;
  GaitParams params;  // that the tick used
  StyleValues style;  // in force, changes made by commands included
  int style_index = 0;
  GaitOverrides overrides;
  std::array<LegAngles, 2> angles_rad{};  // posed; signs as in base/leg.h
  double phase = 0.0;            // of the source's cycle, 0 .. 1 from the right foot's strike on
  double presence = 0.0;         // 0 standing .. 1 walking: how much of the source shows
  std::array<vec3, 2> lift_m{};  // heel where the running or last flight began, world
  vec3 landing_m{0.0};           // heel where the running or last step is to land, world
  std::int64_t ik_failures = 0;
};

// Of the driving pad.
struct PadFrame {
  std::uint16_t device = kNoDevice;  // kNoDevice: none has driven so far
  bool is_present = false;
  PadState state;             // uncalibrated
  Calibration calibration;    // by which the stick was made of it
  std::uint64_t reports = 0;  // of it since the beginning
};

struct SessionFrame {
  std::int64_t tick = -1;    // -1: none yet
  std::int64_t time_ns = 0;  // CLOCK_MONOTONIC, when the tick was due; 0 where nothing is live
  Stick stick;               // calibrated
  PadFrame pad;
  // Presses of each button of the driving pad since the beginning: none is missed between frames.
  std::array<std::uint32_t, kButtonCount> presses{};
  SimulationCounts counts;
  int walker_count = 0;
  std::array<WalkerFrame, kMaxWalkers> walkers;
};
// Of joints only as many as there are are copied: `frame` is to be used again for the same session.
void copy_frame(const Simulation& simulation, SessionFrame& frame) noexcept;

// One tick of one character, small: for graphs.
struct WalkerSample {
  std::array<std::array<float, 3>, 2> joint_rad{};  // hip flexion, knee flexion, ankle dorsiflexion
  std::array<vec3, 2> heel_m{}, toe_m{};            // world
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
  float step_us = 0.0f;  // what the tick took; 0 where it is not measured
  std::array<WalkerSample, kMaxWalkers> walkers;
};
void copy_sample(const Simulation& simulation, TickSample& sample) noexcept;

}  // namespace gaitpad
