// The window's options, shared by play and replay --view. A program built without its window has
// them as well; using one is an error that says how to build the window.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "terminal/run_end.h"
#include "tools/gaitpad/window_module.h"

namespace gaitpad {

struct WindowArguments {
  int frames = 0;
  std::string screenshot, video, theme;
  std::vector<std::string> panels, hidden;
  std::vector<double> camera_deg;
  double scale = 0.0;
  bool is_clean = false;
};
// Adds the options and returns them, for further rules.
std::vector<CLI::Option*> add_window_options(CLI::App& command, WindowArguments& arguments);

bool makes_pictures(const WindowArguments& arguments);

#ifdef GAITPAD_HAS_WINDOW
// Runs the window until it or the user ends it, shows the progress of pictures on a terminal, and
// prints the window's remarks. Returns the exit status; `result` is set if there was a window.
int show_window(std::string_view command, WindowOptions options, RunEnd& end, WindowResult& result);

// `has_end`: the window closes by itself, so it stays hidden while it makes pictures. Pictures do
// not depend on the window's stored layout, so that they are the same for every user.
WindowOptions window_options(const WindowArguments& arguments, bool has_end);
#endif

}  // namespace gaitpad
