// From what a user asks for (files and names) to a session ready to run.
#pragma once
#include <string>
#include <vector>

#include "gaitpad/result.h"
#include "gaitpad/simulation.h"
#include "gaitpad/trace.h"

namespace gaitpad {

// The options that replay and play share; empty means the default that interface.md states.
struct SessionOptions {
  std::string motion;                   // FILE|NAME, `procedural` or empty: the built-in walk
  std::vector<std::string> characters;  // FILE|NAME
  std::vector<std::string> styles;      // FILE|NAME; a list shorter than the other repeats its last
  std::string terrain;                  // FILE|NAME
  std::string script;                   // FILE, empty: none
  std::string calibration;              // FILE
  std::string map;                      // FILE
  IkMode ik = IkMode::robust;
  std::vector<std::string> config_folders;  // config_files.h
};

// Reads every file. `devices` are the session's, with the calibration that a recording carries;
// sentences about them begin with `source`, the recording's path.
Result<SimulationConfig> simulation_config(const SessionOptions& options,
                                           const std::vector<TraceDevice>& devices,
                                           const std::string& source, int rate_hz);

}  // namespace gaitpad
