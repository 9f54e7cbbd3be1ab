// gaitpad replay TRACE --to uinput|uhid|FILE.evemu: plays a recording to other programs.
#pragma once
#include <string>

#include "gaitpad/session_spec.h"

namespace gaitpad {

inline constexpr const char* kReplayCommand = "replay";

struct ReplayTo {
  // `uinput`, `uhid`, or a path that ends with .evemu; empty: the option is not given.
  std::string target;
  double delay_s = 1.0;  // time from the creation of the device to its first report
};
// Explains why `target` is invalid; empty if it is valid.
std::string target_problem(const std::string& target);
// Plays spec.replay.trace in real time into the kernel, or writes it as a file. Returns the exit
// status.
int replay_to(const SessionSpec& spec, const ReplayTo& to);

}  // namespace gaitpad
