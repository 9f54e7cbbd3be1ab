// The description of one session, live or replayed, and what its files make of it.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "gaitpad/pad_stream.h"
#include "gaitpad/result.h"
#include "gaitpad/simulation.h"
#include "gaitpad/trace.h"

namespace gaitpad {

// The description of a session, which its recording also holds. Members of `walk` and `pad.map`
// that are empty take the recording's value in its replay, and the default in other sessions.
//
// FILE|NAME is a path, or the name of a file in the folders of configuration. The caller fills all
// members but `recording`.
struct SessionSpec {
  // The characters that walk, their styles, and the ground.
  struct Walk {
    std::string motion;  // FILE|NAME; `procedural` or empty: the built-in walk
    // FILE|NAME for each character, at most kMaxWalkers; the shorter list repeats its last entry.
    // Empty: one character as in the motion's file, in the style `even`.
    std::vector<std::string> characters, styles;
    std::string terrain;       // FILE|NAME; empty: flat
    std::string script;        // FILE with commands at given times; empty: none
    std::optional<IkMode> ik;  // mode of the inverse kinematics; none: robust
    // Meaning of the stick at the beginning; commands change it.
    StickMeans stick = StickMeans::steers;
    // Number of characters that walk behind the first, 0 .. kMaxFollowers; none: 0.
    std::optional<int> crowd;
    bool shows_crowd = true;  // frames hold the crowd's poses; false saves their copies in a tick
    // The gait that the stick scales. None: in a replay the trace's, else what the motion's
    // description says, else the motion's own. The built-in motion always has the adult's.
    std::optional<Pace> pace;
    bool operator==(const Walk&) const = default;
  };
  // The pad that drives, and the files that interpret its reports.
  struct Pad {
    PadSelector selector;     // the pad of a live session
    std::string map;          // path of a pad file that goes before config/pads; empty: none
    std::string calibration;  // path of the calibration file; empty: the best fitting one
  };
  // Members for a live session only.
  struct Live {
    std::string record;  // FILE.hid to write the session to; empty: none
    // Adds a pad that LiveSession::steer() moves, used while no pad is deflected.
    bool keyboard = false;
    // Number of ticks from one LiveSession::latest() to the next, at most kMaxRateHz; 0: it is not
    // called.
    int frame_ticks = 1;
    bool rumble = true;  // the motors beat at each heel strike, more strongly the faster the walk
    // Target of the stream of poses, osc://HOST:PORT or json://HOST:PORT; empty: none.
    std::string stream;
    int stream_fps = 60;   // poses that are sent in a second, 1 .. kMaxRateHz
    bool forward = false;  // makes a virtual pad with the driving pad's calibrated state
    // by_hand: there is no loop thread, and ticks run in LiveSession::advance() only; for pictures
    // and videos.
    enum class Clock { real_time, by_hand } clock = Clock::real_time;
  };
  // Members for a replay only.
  struct Replay {
    static constexpr double kMaxHours = 12.0, kMaxDamagedHours = 1.0;
    std::string trace;               // the recording; empty: the session is live
    Damage damage = Damage::refuse;  // what happens to a damaged line
    // True if commands and zones may name styles of the user's folder. Without it a replay is the
    // same on every machine.
    bool user_styles = false;
    // Longest recording, 0 .. 1e6; a longer one is an error, because 40 KB can ask for hours of
    // work. None: kMaxHours, or kMaxDamagedHours if lines were skipped.
    std::optional<double> max_hours;
    std::string out;  // folder for the files that replay() writes; empty: none
    // Poses that are written in a second, 1 .. the tick rate; none: one pose a tick.
    std::optional<int> fps;
    bool gltf = false;  // writes pose.glb beside pose.bvh
    // Number of the crowd's members that get files as well, 0 .. kMaxFollowers.
    int crowd_files = 32;
  };

  Walk walk;
  Pad pad;
  Live live;
  Replay replay;
  // Ticks a second, kLeastRateHz .. kMaxRateHz. None: kDefaultRateHz, in a replay the trace's. In a
  // replay a rate that differs from the trace's is an error.
  std::optional<int> rate_hz;
  std::vector<std::string> config_folders;  // folders of configuration (config_files.h)
  // The path of a recording with files, set while it is prepared. Styles that no option names, and
  // entries for pads, are then read from the recording instead of the folders.
  std::string recording;
};

// Errors read `SessionSpec: live.stream_fps is 0, outside [1, 10000]`. LiveSession, replay() and
// simulation_config() call it. The contents of files are checked when they are read.
std::optional<Error> check(const SessionSpec& spec);

bool is_built_in(const SessionSpec& spec);  // True if the motion is the built-in one.

// Reads all files about pads that `spec.pad` and the folders of configuration name.
Result<PadFiles> load_pad_files(const SessionSpec& spec);

// The simulation that `spec.walk` describes, at this rate and without pads, which the caller adds.
// Reads every file that `spec.walk` names.
Result<SimulationConfig> simulation_config(const SessionSpec& spec, int rate_hz);

}  // namespace gaitpad
