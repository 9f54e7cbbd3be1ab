// The options of the window, which play and replay --view share. A program that was built without
// its window has them, too: using one is an error that says how to build it.
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
// Returns the options that were added, for further rules.
std::vector<CLI::Option*> add_window_options(CLI::App& command, WindowArguments& arguments);

bool makes_pictures(const WindowArguments& arguments);

#ifdef GAITPAD_HAS_WINDOW
// Runs the window until its own end or the user's, who sees on a terminal how far pictures are, and
// prints what it remarks. Returns the exit status; `result` is the window's if there was one.
int show_window(std::string_view command, WindowOptions options, RunEnd& end, WindowResult& result);

// `has_end`: the window closes by itself, so nobody needs to see it while it makes pictures.
// Pictures are the same for everybody: what the window remembers from its last start does not count
// for them.
WindowOptions window_options(const WindowArguments& arguments, bool has_end);
#endif

}  // namespace gaitpad
