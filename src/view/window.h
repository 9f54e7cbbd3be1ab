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
  std::int64_t frame = 0;  // number of the frame that is drawn next
  const SessionFrame& session;
  const Cast& cast;
  const UiState& ui;
  const Camera& camera;
  double pace = 1.0;
  bool is_playback = false, is_browsing = false, is_calibrating = false;
  std::string recording;  // the file that is being recorded; empty: none
  std::vector<std::string> messages;
};

struct WindowOptions {
  SessionSpec session;  // a live session, or a playback if session.replay.trace is not empty
  // Advice without a display, for the error.
  std::string without_display = "play --no-window walks without one";
  std::string program = "gaitpad";  // the program's name and version, for the report of a self-test
  // Folder of new recordings and pictures, made when missing; empty: the working directory. If the
  // session starts with a recording (session.live.record), its folder is used for the next ones.
  std::string record_folder;
  std::string calibration_folder;  // folder of calibrations (calibration_store.h)
  std::string layout_file;         // file of the layout between starts; empty: it is not stored
  std::string recent_file;         // file of the recently opened files; empty: they are not stored
  // Number of frames to draw; 0: until closed, or until the trace ends if pictures are made of one.
  int frames = 0;
  // Files of pictures; each makes a frame last 1/60 s of the session.
  std::string screenshot, video;
  std::optional<ThemeName> theme;  // none: the theme of the last start
  std::vector<Panel> panels;       // the panels that are open, if are_panels_given
  bool are_panels_given = false;
  std::vector<std::string> hidden;  // names of kSceneParts that are not drawn
  bool is_clean = false;            // only the scene is drawn: no bars, panels, messages
  // Direction of the camera in degrees: yaw from ahead of the walkers (90: from their left), pitch
  // above the horizon. Empty: the default.
  std::vector<double> camera_deg;
  double scale = 0.0;              // factor on sizes; 0: the display's
  int width = 1280, height = 720;  // size in pixels at scale 1
  bool is_hidden = false;          // draws without a display (SDL's offscreen driver)
  // For tests: called before each frame; may push SDL events.
  std::function<void(const WindowGlance& glance)> script;
  // True after Ctrl-C; pictures that are not complete are then given up.
  std::function<bool()> is_ended_from_outside;
  // Called while pictures are made, with the share of frames that are done.
  std::function<void(double share)> show_progress;
  // Commands for the session, for example from standard input.
  std::function<std::vector<std::string>()> take_commands;
};
struct WindowResult {
  RunSummary summary;                // the summary of the last session
  std::optional<LiveStatus> status;  // status of the last session; none if it was a playback
  std::int64_t frames = 0;
  double frames_per_second = 0.0;
  // When the first frame was handed to the display, by CLOCK_MONOTONIC; 0: none was.
  std::int64_t first_frame_ns = 0;
  bool is_cut_off = false;  // ended before the pictures were complete, so none was written
  std::vector<std::string> remarks;
};
// Call it from the main thread. Error: the session or the window cannot be opened, which is found
// before anything is drawn, or a picture cannot be written.
Result<WindowResult> run_window(const WindowOptions& options);

}  // namespace gaitpad
