// The window: a live session or a playback, drawn, steered and looked into.
#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "session/live.h"
#include "session/replay.h"
#include "view/ui.h"

namespace gaitpad {

struct WindowOptions {
  LiveOptions live;   // its wish too
  std::string trace;  // a playback of this instead
  Damage damage = Damage::refuse;
  bool is_trace_rate_given =
      false;  // live.rate_hz was asked for: an error where a trace says another
  std::string calibration_folder;  // where calibrations are kept (calibration_store.h)
  std::string layout_file;         // remembered from one start to the next; empty: not
  int frames = 0;                  // drawn, then it ends; 0: until it is closed
  std::string screenshot, video;   // files; with either a frame is 1/60 s of the session
  std::optional<ThemeName> theme;  // else the remembered one
  std::vector<Panel> panels;       // with are_panels_given: these and no others are open
  bool are_panels_given = false;
  double scale = 0.0;              // 0: the display's
  int width = 1280, height = 720;  // at scale 1
  // For tests: called before each drawn frame with its number; may push SDL events.
  std::function<void(std::int64_t frame)> script;
  std::function<bool()> is_ended_from_outside;  // Ctrl-C
};
struct WindowResult {
  std::vector<nlohmann::ordered_json> summaries;  // one a character, of the last session
  LiveStatus status;                              // of it
  std::int64_t frames = 0;
  double frames_per_second = 0.0;
  std::vector<std::string> remarks;
};
// From the main thread. Errors before anything is drawn, or where a picture cannot be written.
Result<WindowResult> run_window(const WindowOptions& options);

}  // namespace gaitpad
