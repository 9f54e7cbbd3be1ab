// What play and replay --view share: the options of the window.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "view/window.h"

namespace gaitpad {

struct WindowArguments {
  int frames = 0;
  std::string screenshot, video, theme;
  std::vector<std::string> panels;
  double scale = 0.0;
};
// The options that were added, for further rules.
std::vector<CLI::Option*> add_window_options(CLI::App& command, WindowArguments& arguments);

bool makes_pictures(const WindowArguments& arguments);
// What remembers the window from one start to the next is left out where only pictures are made:
// they are the same for everybody. `has_end`: it ends by itself, so nobody needs to see it.
WindowOptions window_options(const WindowArguments& arguments, bool has_end);

}  // namespace gaitpad
