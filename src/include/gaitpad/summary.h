// What a session came to: numbers of the whole run and of each character. run_summary() fills all.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "gaitpad/session_frame.h"
#include "gaitpad/simulation.h"

namespace gaitpad {

// One character. Pairs are left, right.
struct WalkerSummary {
  std::string character;                 // name
  std::string motion;                    // name
  double metres_per_unit = 0.0;          // of the motion's file
  double leg_length_m = 0.0;             // of the character
  double source_leg_length_m = 0.0;      // of the motion
  std::array<std::string, 2> toe_joint;  // names of the joints that the legs end in
  std::array<std::string, 2> ankle_joint;
  std::array<vec3, 2> heel_offset_m{};  // the heel in the frame of the ankle joint
  std::array<double, 2> toe_rest_m{};   // height of the toe joint above the floor when standing
  std::array<int, 2> steps{};
  std::string style;             // name, at the end
  double fatigue = 0.0;          // at the end, 0..1
  std::int64_t ik_failures = 0;  // legs times ticks
  double distance_m = 0.0;       // on the ground, along the path of the hips
  bool operator==(const WalkerSummary&) const = default;
};

struct RunSummary {
  std::string motion;     // name of the one that was chosen
  Pace pace = Pace::own;  // in force: the built-in motion has the adult's
  int rate_hz = 0;
  std::uint64_t pose_hash = 0;  // over the bits of every pose of every character in every tick
  std::string terrain;          // name
  double terrain_scale = 1.0;   // above 1: enlarged, so that the feet fit its treads
  std::int64_t ticks = 0;
  std::int64_t reports = 0;         // input reports, sound or not
  std::int64_t bad_reports = 0;     // that their device cannot send
  std::int64_t bad_commands = 0;    // that could not be obeyed
  std::int64_t damaged_lines = 0;   // of the trace, skipped
  std::int64_t recording_lost = 0;  // reports missing in the session's recording: it is inexact
  int crowd = 0;                    // so many more walked behind the first
  std::vector<WalkerSummary> walkers;
  bool operator==(const RunSummary&) const = default;
};
// `cast` is that of the simulation.
RunSummary run_summary(const Simulation& simulation, const Cast& cast);

}  // namespace gaitpad
