// The sub-commands of gaitpad. Each function adds its command to `app`. The chosen command runs
// while the arguments are parsed and sets `status`, the exit status: 0 done, 1 failed. Wrong usage,
// 2, is main's.
#pragma once
#include <CLI/CLI.hpp>

namespace gaitpad {

void add_play(CLI::App& app, int& status);
void add_replay(CLI::App& app, int& status);
void add_record(CLI::App& app, int& status);
void add_pads(CLI::App& app, int& status);
void add_doctor(CLI::App& app, int& status);
void add_decode(CLI::App& app, int& status);
void add_monitor(CLI::App& app, int& status);
void add_calibrate(CLI::App& app, int& status);
void add_motion(CLI::App& app, int& status);
void add_ik(CLI::App& app, int& status);
void add_figures(CLI::App& app, int& status);
void add_bench(CLI::App& app, int& status);

}  // namespace gaitpad
