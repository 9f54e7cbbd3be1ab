// The results of a session: numbers of the whole run and of each character. run_summary() fills all
// of them.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "gaitpad/session_frame.h"
#include "gaitpad/simulation.h"

namespace gaitpad {

// The results of one character. Pairs are left, right.
struct WalkerSummary {
  std::string character;                 // name of the character
  std::string motion;                    // name of the motion
  double metres_per_unit = 0.0;          // unit of the motion's file
  double leg_length_m = 0.0;             // length of the character's leg
  double source_leg_length_m = 0.0;      // length of the motion's leg
  std::array<std::string, 2> toe_joint;  // names of the joints that the legs end in
  std::array<std::string, 2> ankle_joint;
  std::array<vec3, 2> heel_offset_m{};  // place of the heel in the ankle joint's frame
  std::array<double, 2> toe_rest_m{};   // height of the toe joint above the floor when standing
  std::array<int, 2> steps{};
  std::string style;             // name of the style at the end
  double fatigue = 0.0;          // fatigue at the end, 0..1
  std::int64_t ik_failures = 0;  // number of failures, one for each leg and tick
  double distance_m = 0.0;       // distance on the ground, along the path of the hips
  bool operator==(const WalkerSummary&) const = default;
};

struct RunSummary {
  std::string motion;     // name of the chosen motion
  Pace pace = Pace::own;  // pace of the walk; adult for the built-in motion
  int rate_hz = 0;
  std::uint64_t pose_hash = 0;  // hash of the bits of every pose of every character in every tick
  std::string terrain;          // name of the terrain
  // Scale of the terrain; above 1 it was enlarged, so that the feet fit its treads.
  double terrain_scale = 1.0;
  std::int64_t ticks = 0;
  std::int64_t reports = 0;        // number of input reports, sound or not
  std::int64_t bad_reports = 0;    // number of reports that do not fit their descriptor
  std::int64_t bad_commands = 0;   // number of commands that could not be carried out
  std::int64_t damaged_lines = 0;  // number of lines of the trace that were skipped
  // Number of reports that are missing in the session's recording, which is then inexact.
  std::int64_t recording_lost = 0;
  int crowd = 0;  // number of characters that walked behind the first one
  std::vector<WalkerSummary> walkers;
  bool operator==(const RunSummary&) const = default;
};
// `cast` is the cast of the simulation.
RunSummary run_summary(const Simulation& simulation, const Cast& cast);

}  // namespace gaitpad
