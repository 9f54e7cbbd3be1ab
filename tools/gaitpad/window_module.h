// The drawing parts of the program: the window, pictures of sticks, plots and the paper's figures.
// They are in a module, gaitpad-window.so beside the program or in lib/gaitpad, because loading it
// with SDL, OpenGL and cairo takes longer than replaying a recording. Program and module are built
// and installed together.
#pragma once
#ifdef GAITPAD_HAS_WINDOW
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "check/trace_check.h"
#include "gaitpad/gait_cycle.h"
#include "gaitpad/result.h"
#include "stick_picture/stick_picture.h"
#include "view/window.h"

namespace gaitpad {

struct FiguresArguments {
  std::string folder, motion;
  std::optional<Pace> pace;
  bool as_json = false;
};

struct CrowdCurve {  // a curve of `bench --plot`
  std::string name;
  unsigned colour = 0;
  bool is_dashed = false;
  // Number of characters, and ns for a character in a tick.
  std::vector<std::pair<double, double>> points;
};

struct WindowModule {
  const char* version = nullptr;  // version of the program that the module was built with
  Result<WindowResult> (*run_window)(const WindowOptions& options) = nullptr;
  std::optional<Error> (*write_stick_picture)(const std::string& path, const std::string& heading,
                                              std::span<const StickPicture> sticks) = nullptr;
  std::optional<Error> (*write_comparison)(const std::string& path, const std::string& heading,
                                           std::span<const ComparedStick> sticks) = nullptr;
  // Draws both curves of a joint in which `check` found a difference.
  std::optional<Error> (*draw_curves)(const JointCurves& curves, const std::string& title,
                                      const std::string& path) = nullptr;
  std::optional<Error> (*draw_crowd)(const std::vector<CrowdCurve>& curves,
                                     const std::string& processor,
                                     const std::string& path) = nullptr;
  int (*run_figures)(const FiguresArguments& arguments) = nullptr;  // Returns the exit status.
};

// Loads the module at the first call. Error: the module is missing, damaged or of another version.
Result<const WindowModule*> window_module();

}  // namespace gaitpad
#endif
