// The sub-commands of gaitpad. Each function adds its command to `app`. The chosen command runs
// while the arguments are parsed and sets `status`, the exit status: 0 done, 1 failed. main handles
// wrong usage, 2.
#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gaitpad/result.h"

namespace gaitpad {

void add_play(CLI::App& app, int& status);
void add_replay(CLI::App& app, int& status);
void add_record(CLI::App& app, int& status);
void add_pads(CLI::App& app, int& status);
void add_doctor(CLI::App& app, int& status);
void add_decode(CLI::App& app, int& status);
void add_monitor(CLI::App& app, int& status);
void add_calibrate(CLI::App& app, int& status);
void add_forward(CLI::App& app, int& status);
void add_selftest(CLI::App& app, int& status);
void add_motion(CLI::App& app, int& status);
void add_ik(CLI::App& app, int& status);
void add_figures(CLI::App& app, int& status);
void add_bench(CLI::App& app, int& status);
void add_list(CLI::App& app, int& status);
void add_map(CLI::App& app, int& status);
void add_check(CLI::App& app, int& status);

// Prints completions for shells and packages, from the commands of `app`; no help lists this
// function's command.
void print_completions(const CLI::App& app, std::vector<std::string> words);
std::optional<Error> write_manual(const CLI::App& app, const std::string& folder);

}  // namespace gaitpad
