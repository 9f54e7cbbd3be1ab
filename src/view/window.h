// The window: a live session or a playback, drawn, steered and looked into.
#pragma once
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/live.h"
#include "gaitpad/replay.h"
#include "gaitpad/result.h"
#include "view/camera.h"
#include "view/ui.h"

namespace gaitpad {

// What a script of a test sees of the window.
struct WindowGlance {
  std::int64_t frame = 0;  // the number of the one that is drawn next
  const SessionFrame& session;
  const Cast& cast;
  const UiState& ui;
  const Camera& camera;
  double pace = 1.0;
  bool is_playback = false, is_browsing = false, is_calibrating = false;
  std::string recording;  // file, empty: none
  std::vector<std::string> messages;
};

// What can be left out of the scene.
inline constexpr std::array<std::string_view, 5> kScenePartNames = {"trails", "grid", "shadows",
                                                                    "source", "names"};

struct WindowOptions {
  SessionSpec session;             // live, or a playback of session.replay.trace
  std::string calibration_folder;  // where calibrations are kept (calibration_store.h)
  std::string layout_file;         // remembered from one start to the next; empty: not
  std::string recent_file;         // the same of files that were opened
  int frames = 0;                  // drawn, then it ends; 0: until it is closed, or, where pictures
                                   // are made of a trace, until that ends
  std::string screenshot, video;   // files; with either a frame is 1/60 s of the session
  std::optional<ThemeName> theme;  // else the remembered one
  std::vector<Panel> panels;       // with are_panels_given: these and no others are open
  bool are_panels_given = false;
  std::vector<std::string> hidden;  // of kScenePartNames: left out of the scene
  double scale = 0.0;               // 0: the display's
  int width = 1280, height = 720;   // at scale 1
  bool is_hidden = false;           // nobody is to see it: SDL's offscreen driver
  // For tests: called before each drawn frame; may push SDL events.
  std::function<void(const WindowGlance& glance)> script;
  std::function<bool()> is_ended_from_outside;              // Ctrl-C
  std::function<std::vector<std::string>()> take_commands;  // for the session, from outside
};
struct WindowResult {
  RunSummary summary;                // of the last session
  std::optional<LiveStatus> status;  // of it; none: it was a playback
  std::int64_t frames = 0;
  double frames_per_second = 0.0;
  std::vector<std::string> remarks;
};
// From the main thread. Errors before anything is drawn, or where a picture cannot be written.
Result<WindowResult> run_window(const WindowOptions& options);

}  // namespace gaitpad
