// Everything that describes one session, live or replayed, and what its files make of it.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "gaitpad/pad_stream.h"
#include "gaitpad/result.h"
#include "gaitpad/simulation.h"
#include "gaitpad/trace.h"

namespace gaitpad {

// A recording of a session holds what the session was made of. What `walk` and `pad.map` leave
// empty is in its replay as the recording says, and in other sessions the default.
//
// FILE|NAME is a path, or the name of a file in the folders of configuration. The caller fills all
// but `recording`.
struct SessionSpec {
  // Who walks, how, and where.
  struct Walk {
    std::string motion;  // FILE|NAME; `procedural` or empty: the built-in walk
    // FILE|NAME, one for each character, at most kMaxWalkers; the shorter of the two lists repeats
    // its last. Empty: one character as in the motion's file, in the style `even`.
    std::vector<std::string> characters, styles;
    std::string terrain;                    // FILE|NAME; empty: flat
    std::string script;                     // FILE with commands at given times
    std::optional<IkMode> ik;               // none: robust
    StickMeans stick = StickMeans::steers;  // until a command says otherwise
    // So many more walk behind the first character, 0 .. kMaxFollowers; none: 0.
    std::optional<int> crowd;
    bool shows_crowd = true;  // frames hold the crowd's poses; false saves their copies in a tick
    // None: in a replay the trace's, else what the motion's description says, else its own. The
    // built-in motion has the adult's whatever stands here.
    std::optional<Pace> pace;
  };
  // Which pad drives, and what its reports mean.
  struct Pad {
    PadWish wish;             // of a live session
    std::string map;          // path of a pad file that goes before config/pads; empty: none
    std::string calibration;  // path of the stick's file; empty: the best fitting one
  };
  // Of a live session alone.
  struct Live {
    std::string record;     // FILE.hid to write the session to; empty: none
    bool keyboard = false;  // a pad that LiveSession::steer() moves, used while no pad is deflected
    // Each so many ticks there is a new LiveSession::latest(), at most kMaxRateHz; 0: there is
    // none.
    int frame_ticks = 1;
    bool report_times = false;  // for LiveSession::take_report_time()
    bool rumble = true;         // a beat at each heel strike, stronger the faster the walk
    std::string stream;    // osc://HOST:PORT or json://HOST:PORT to send the poses to; empty: none
    int stream_fps = 60;   // so many a second, 1 .. kMaxRateHz
    bool forward = false;  // a virtual pad has the driving pad's calibrated state
    // by_hand: no loop thread, ticks run in LiveSession::advance() alone; for pictures and videos.
    enum class Clock { real_time, by_hand } clock = Clock::real_time;
  };
  // Of a replay alone.
  struct Replay {
    static constexpr double kMaxHours = 12.0, kMaxDamagedHours = 1.0;
    std::string trace;               // the recording; empty: the session is live
    Damage damage = Damage::refuse;  // what a damaged line of it means
    // Whether commands and zones may name styles of the user's folder. Without it a replay is the
    // same on every machine.
    bool user_styles = false;
    // A longer one is an error: 40 KB can ask for hours of work. 0 .. 1e6; none: kMaxHours, or
    // kMaxDamagedHours if lines of it were skipped.
    std::optional<double> max_hours;
    std::string out;         // folder for the files that replay() writes; empty: none
    std::optional<int> fps;  // of the poses written, 1 .. the tick rate; none: one pose a tick
    bool gltf = false;       // write pose.glb beside pose.bvh
    int crowd_files = 32;    // of the crowd the first so many get files, too; 0 .. kMaxFollowers
  };

  Walk walk;
  Pad pad;
  Live live;
  Replay replay;
  // Ticks a second, kLeastRateHz .. kMaxRateHz. None: kDefaultRateHz, in a replay the trace's. In a
  // replay a rate that differs from the trace's is an error.
  std::optional<int> rate_hz;
  std::vector<std::string> config_folders;  // config_files.h
  // Set while a recording that holds files is prepared: its path. Styles that no option names, and
  // entries for pads, come from it then instead of from the folders.
  std::string recording;
};

// `SessionSpec: live.stream_fps is 0, outside [1, 10000]`. LiveSession, replay() and
// simulation_config() call it. What files hold is checked when they are read.
std::optional<Error> check(const SessionSpec& spec);

bool is_built_in(const SessionSpec& spec);  // the motion

// What `spec.pad` and the folders of configuration say about pads. Reads files.
Result<PadFiles> load_pad_files(const SessionSpec& spec);

// The simulation that `spec.walk` describes, at this rate and without pads: the caller adds those.
// Reads every file that it names.
Result<SimulationConfig> simulation_config(const SessionSpec& spec, int rate_hz);

}  // namespace gaitpad
