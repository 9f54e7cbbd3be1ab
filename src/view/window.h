// The window: shows a live session or a playback and lets a user steer and inspect it.
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/live.h"
#include "gaitpad/result.h"
#include "gaitpad/session_spec.h"
#include "scene/camera.h"
#include "view/ui.h"

namespace gaitpad {

// The state of the window as a test's script sees it.
struct WindowGlance {
  std::int64_t frame = 0;  // the frame that is drawn next
  const SessionFrame& session;
  const Cast& cast;
  const UiState& ui;
  const Camera& camera;
  double pace = 1.0;
  bool is_playback = false, is_browsing = false, is_calibrating = false;
  std::string recording;  // file; empty: none
  std::vector<std::string> messages;
};

struct WindowOptions {
  SessionSpec session;  // live, or a playback if session.replay.trace is not empty
  std::string without_display = "play --no-window walks without one";  // for the error
  std::string program = "gaitpad";  // its name and version, for the report of a self-test
  // Folder of new recordings and pictures, made when missing; empty: the working directory. If the
  // session starts with a recording (session.live.record), its folder is used for the next ones.
  std::string record_folder;
  std::string calibration_folder;  // folder of calibrations (calibration_store.h)
  std::string layout_file;         // stores the layout between starts; empty: not stored
  std::string recent_file;         // stores the recently opened files; empty: not stored
  // Number of frames to draw; 0: until closed, or until the trace ends if pictures are made of one.
  int frames = 0;
  std::string screenshot, video;   // files; each makes a frame last 1/60 s of the session
  std::optional<ThemeName> theme;  // else the remembered theme
  std::vector<Panel> panels;       // open panels, if are_panels_given
  bool are_panels_given = false;
  std::vector<std::string> hidden;  // names of kSceneParts
  bool is_clean = false;            // only the scene: no bars, panels, messages
  // Direction of the camera in degrees: yaw from ahead of the walkers (90: from their left), pitch
  // above the horizon. Empty: the default.
  std::vector<double> camera_deg;
  double scale = 0.0;              // 0: the display's
  int width = 1280, height = 720;  // at scale 1
  bool is_hidden = false;          // draws without a display (SDL's offscreen driver)
  // For tests: called before each frame; may push SDL events.
  std::function<void(const WindowGlance& glance)> script;
  std::function<bool()> is_ended_from_outside;      // Ctrl-C; pictures are then given up
  std::function<void(double share)> show_progress;  // of pictures: share of frames done
  // Commands for the session, for example from standard input.
  std::function<std::vector<std::string>()> take_commands;
};
struct WindowResult {
  RunSummary summary;                // of the last session
  std::optional<LiveStatus> status;  // of the last session; none if it was a playback
  std::int64_t frames = 0;
  double frames_per_second = 0.0;
  std::int64_t first_frame_ns = 0;  // CLOCK_MONOTONIC, when it was handed to the display; 0: none
  bool is_cut_off = false;          // before its pictures were complete: none was written
  std::vector<std::string> remarks;
};
// Call it from the main thread. Error: the session or the window cannot be opened, which is found
// before anything is drawn, or a picture cannot be written.
Result<WindowResult> run_window(const WindowOptions& options);

}  // namespace gaitpad
