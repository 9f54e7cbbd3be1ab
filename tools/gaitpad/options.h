// Options that several commands share, each declared once, and what the options mean.
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

// --- where the configuration is

// The folders of configuration that there are, the one of this checkout last.
std::vector<std::string> config_folders();
// Why $GAITPAD_CONFIG names no folder of configuration; empty if it does, or is not set.
std::string config_problem();

// --- which pad, and for how long

void add_driver_option(CLI::App& command, PadWish& wish);
void add_pad_options(CLI::App& command, PadWish& wish);  // PAD and --driver
// Whether a certain pad is asked for, not just any.
bool is_choosy(const PadWish& wish);
void add_seconds_option(CLI::App& command, double& seconds);
void add_max_hours_option(CLI::App& command, std::optional<double>& hours);  // of a recording
void add_user_styles_option(CLI::App& command, bool& user_styles);           // of a replay

// --map and --calibration (empty: none), and what config/ says about pads.
Result<PadFiles> pad_files(const std::string& map, const std::string& calibration);

// Tells the user once that no pad has come: after a while, or at the end of the command. Says which
// pads there are and what to do.
class MissingPad {
 public:
  MissingPad(std::string_view command, const PadWish& wish) : command_(command), wish_(wish) {}
  // `plugged`: how many pads have come so far.
  void look(std::int64_t plugged, StatusLine& line);
  void finish(std::int64_t plugged, StatusLine& line);

 private:
  void tell(std::int64_t plugged, std::string_view what, StatusLine& line);

  std::string command_;
  PadWish wish_;
  std::int64_t start_ns_ = now_ns();
  bool is_told_ = false;
};

// --- a session, for play and replay

// --pace own|adult: stands wherever --motion does.
void add_pace_option(CLI::App& command, std::optional<Pace>& pace);
// Sets the folders of configuration, too. `default_rate` is for the help.
void add_session_options(CLI::App& command, SessionSpec& spec, const std::string& default_rate);

// --- parts of the program that this build may not have

// One sentence: what is missing, and which option of CMake builds it.
std::string missing_window();
std::string missing_bench();
// A command that fails with this sentence, whatever its options.
void add_missing_command(CLI::App& app, int& status, const std::string& name,
                         const std::string& description, const std::string& sentence);

}  // namespace gaitpad
