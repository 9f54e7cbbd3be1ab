// What the guided calibration shows: a few lines in place on a terminal, else a line for what has
// changed. All of it on standard error.
#pragma once
#include <string>
#include <vector>

#include "gaitpad/report.h"
#include "stick/guide.h"
#include "tools/gaitpad/live_run.h"

namespace gaitpad {

struct ShownPad {
  const DeviceInfo& info;
  bool is_plugged = true;
};

class GuideScreen {
 public:
  StatusLine& line() noexcept { return line_; }
  void toggle_help() noexcept;
  void show(const CalibrationGuide& guide, const ShownPad& pad);

 private:
  void rewrite(const CalibrationGuide& guide, const ShownPad& pad);
  void print_news(const CalibrationGuide& guide, const ShownPad& pad);

  StatusLine line_{2};
  bool has_help_ = false;
  std::int64_t shown_ns_ = 0;
  GuideStep shown_step_ = GuideStep::done;
  // No terminal: as last printed, of each control, then of the plug.
  GuideStep printed_step_ = GuideStep::done;
  std::vector<std::string> printed_;
};

}  // namespace gaitpad
