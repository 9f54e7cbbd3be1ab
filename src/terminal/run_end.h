// Shared by commands that run until the user ends them: the end, lines of input, and the status
// line that is rewritten in place.
#pragma once
#include <poll.h>

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "system/clock.h"
#include "system/end_signals.h"
#include "system/terminal_mode.h"

namespace gaitpad {

// The end of a command: SIGINT, SIGTERM, SIGHUP, or a time limit. Make it before any thread starts:
// it blocks these signals, so that no work is cut off, and reads them (EndSignals). Another signal
// more than a second after the first ends the process at once.
class RunEnd {
 public:
  // Ends the command this number of seconds after this call; 0: only signals end it.
  void end_after(double seconds) noexcept;
  bool is_reached() noexcept;
  // Exit status of an interrupted command: 128 + signal, as in shells; 0: no signal came.
  int cut_off_status() const noexcept { return signal_ == 0 ? 0 : 128 + signal_; }
  // Readable when a signal has arrived.
  pollfd fd() const noexcept { return {signals_.fd(), POLLIN, 0}; }
  // Sleeps until the end, until one of `others` is ready, or for `time`.
  void wait(std::chrono::milliseconds time, std::span<const pollfd> others = {});

 private:
  EndSignals signals_;
  bool is_reached_ = false;
  int signal_ = 0;
  std::int64_t end_ns_ = 0;  // time of the end; 0: there is no limit
};

// Reads lines of standard input without waiting.
class InputLines {
 public:
  pollfd fd() const noexcept { return {is_open_ ? 0 : -1, POLLIN, 0}; }
  std::vector<std::string> take_lines();

 private:
  bool is_open_ = true;
  std::string rest_;  // the beginning of a line whose end has not arrived
};

// Lines on a terminal, rewritten in place. Shows nothing if `file` is not a terminal.
class StatusLine {
 public:
  explicit StatusLine(int file) : file_(file), is_terminal_(gaitpad::is_terminal(file)) {}
  ~StatusLine() { clear(); }
  bool is_terminal() const noexcept { return is_terminal_; }
  void show(std::span<const std::string> lines);
  void show(const std::string& line) { show(std::span(&line, 1)); }
  void clear();  // Erases the lines; call it before other output.

 private:
  int file_;
  bool is_terminal_;
  std::size_t shown_ = 0;  // number of lines on the terminal now
};

// Progress of long work: percent and remaining time, on a terminal, after two seconds.
class Progress {
 public:
  explicit Progress(std::string_view work) : work_(work) {}
  void show(double share);  // Shows the share of the work that is done, 0 .. 1.
  void clear() { line_.clear(); }
  double seconds() const;  // The time since the work began.

 private:
  std::string work_;
  StatusLine line_{2};
  std::int64_t start_ns_ = now_ns(), next_ns_ = start_ns_ + 2'000'000'000;
};

}  // namespace gaitpad
