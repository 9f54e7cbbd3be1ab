// The drawings of the program's commands, inside the window's module.
#pragma once
#include "tools/gaitpad/window_module.h"

namespace gaitpad {

std::optional<Error> draw_curves(const JointCurves& curves, const std::string& title,
                                 const std::string& path);
std::optional<Error> draw_crowd(const std::vector<CrowdCurve>& curves, const std::string& processor,
                                const std::string& path);
int run_figures(const FiguresArguments& arguments);

}  // namespace gaitpad
