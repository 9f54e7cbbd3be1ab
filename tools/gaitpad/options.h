// Options that several commands share, each declared once, and their interpretation.
#pragma once
#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/pad_stream.h"
#include "gaitpad/result.h"
#include "gaitpad/session_spec.h"
#include "terminal/run_end.h"

namespace gaitpad {

// --- the configuration

// The existing folders of configuration, this checkout's last.
std::vector<std::string> config_folders();
// Explains why $GAITPAD_CONFIG is not a folder of configuration; empty if it is, or is not set.
std::string config_problem();

// --- the pad, and the time

void add_driver_option(CLI::App& command, PadSelector& selector);
void add_pad_options(CLI::App& command, PadSelector& selector);  // Adds PAD and --driver.
// True if a certain pad is asked for, not just any.
bool is_choosy(const PadSelector& selector);
void add_seconds_option(CLI::App& command, double& seconds);
// Adds --max-hours, for commands that read recordings.
void add_max_hours_option(CLI::App& command, std::optional<double>& hours);
// Adds --user-styles, for commands that replay.
void add_user_styles_option(CLI::App& command, bool& user_styles);

// Reads the files of --map and --calibration (empty: none), and the pad files of config/.
Result<PadFiles> pad_files(const std::string& map, const std::string& calibration);

// Tells the user once that no pad has come, after some time or at the end of the command, and lists
// the pads of the system and what to do.
class MissingPad {
 public:
  MissingPad(std::string_view command, const PadSelector& selector)
      : command_(command), selector_(selector) {}
  // `plugged`: number of pads that have come so far.
  void look(std::int64_t plugged, StatusLine& line);
  void finish(std::int64_t plugged, StatusLine& line);

 private:
  void tell(std::int64_t plugged, std::string_view what, StatusLine& line);

  std::string command_;
  PadSelector selector_;
  std::int64_t start_ns_ = now_ns();
  bool is_told_ = false;
};

// --- a session, for play and replay

// Adds --pace own|adult, for all commands with --motion.
void add_pace_option(CLI::App& command, std::optional<Pace>& pace);
// Adds the options of a session and sets the folders of configuration. `default_rate` is for the
// help.
void add_session_options(CLI::App& command, SessionSpec& spec, const std::string& default_rate);

// --- optional parts of this build

// Sentences that name the missing part of the program and the option of CMake that builds it.
std::string missing_window();
std::string missing_bench();
// Adds a command that fails with this sentence, whatever its options are.
void add_missing_command(CLI::App& app, int& status, const std::string& name,
                         const std::string& description, const std::string& sentence);

}  // namespace gaitpad
