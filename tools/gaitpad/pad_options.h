// What play, record, pads, monitor and decode share: how a user says which pad, and for how long.
#pragma once
#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <string_view>

#include "gaitpad/pad_stream.h"
#include "gaitpad/result.h"
#include "tools/gaitpad/live_run.h"

namespace gaitpad {

void add_driver_option(CLI::App& command, PadWish& wish);
void add_pad_options(CLI::App& command, PadWish& wish);  // PAD and --driver
void add_seconds_option(CLI::App& command, double& seconds);

// --map and --calibration (empty: none) and what config/ says about pads.
Result<PadFiles> pad_files(const std::string& map, const std::string& calibration);

// Says once that there is no pad, what would be one, and what to do, when none has come for a while
// or until the end.
class MissingPad {
 public:
  MissingPad(std::string_view command, const PadWish& wish) : command_(command), wish_(wish) {}
  // `plugged`: how many have come so far.
  void look(std::int64_t plugged, StatusLine& line);
  void finish(std::int64_t plugged, StatusLine& line);

 private:
  void tell(std::int64_t plugged, std::string_view what, StatusLine& line);

  std::string command_;
  PadWish wish_;
  std::int64_t start_ns_ = now_ns();
  bool is_told_ = false;
};

}  // namespace gaitpad
