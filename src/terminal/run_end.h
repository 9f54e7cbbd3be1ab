// What commands share that run until somebody ends them: the end, the lines that they read, and the
// status line that they rewrite in place.
#pragma once
#include <poll.h>

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/posix.h"

namespace gaitpad {

// The end of a command: SIGINT, SIGTERM, SIGHUP, or the time that was given to it. Make it before
// any thread starts: it blocks these signals, so that nothing is cut off half-way, and reads them
// here. A further signal more than a second after the end has begun ends the process at once.
// SIGPIPE is ignored: writing to a reader that has gone is a failed write like any other.
class RunEnd {
 public:
  RunEnd();
  void end_after(double seconds) noexcept;  // from now on; 0: only signals end
  bool is_reached() noexcept;
  // Of a command that was cut off: 128 and the signal that ended it, as shells count; 0: none has.
  int cut_off_status() const noexcept { return signal_ == 0 ? 0 : 128 + signal_; }
  pollfd fd() const noexcept { return {signals_.get(), POLLIN, 0}; }  // of the signals
  // Sleeps until the end, until one of `others` is ready, or for `time`.
  void wait(std::chrono::milliseconds time, std::span<const pollfd> others = {});

 private:
  OwnedFd signals_;
  bool is_reached_ = false;
  int signal_ = 0;
  std::int64_t end_ns_ = 0;  // 0: none
};

// Lines of standard input, without waiting for them.
class InputLines {
 public:
  pollfd fd() const noexcept { return {is_open_ ? 0 : -1, POLLIN, 0}; }
  std::vector<std::string> take_lines();

 private:
  bool is_open_ = true;
  std::string rest_;  // an incomplete line
};

// Lines on a terminal, rewritten in place. Nothing is shown if `file` is not a terminal.
class StatusLine {
 public:
  explicit StatusLine(int file);
  ~StatusLine() { clear(); }
  bool is_terminal() const noexcept { return is_terminal_; }
  void show(std::span<const std::string> lines);
  void show(const std::string& line) { show(std::span(&line, 1)); }
  void clear();  // before anything else is printed

 private:
  void write_all(std::string_view text) const;

  int file_;
  bool is_terminal_;
  std::size_t shown_ = 0;  // lines
};

// How far long work is: percent and the time that is left, on a terminal, from two seconds on.
class Progress {
 public:
  explicit Progress(std::string_view work) : work_(work) {}
  void show(double share);  // 0 .. 1 of the work is done
  void clear() { line_.clear(); }
  double seconds() const;  // since the work began

 private:
  std::string work_;
  StatusLine line_{2};
  std::int64_t start_ns_ = now_ns(), next_ns_ = start_ns_ + 2'000'000'000;
};

}  // namespace gaitpad
