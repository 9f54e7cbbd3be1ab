// What commands that run on share: what ends them, lines that they read, and a line that is
// rewritten in place.
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

// Ends at SIGINT, SIGTERM, SIGHUP or when the time given to it is over. To be made before any
// thread starts: the signals are blocked, so that nothing is cut off half-way, and wait here to be
// asked for. Who sends one more than a second after the end has begun does not want to wait: the
// process ends at once. SIGPIPE is ignored: a reader that has gone is a failed write, told like any
// other.
class RunEnd {
 public:
  RunEnd();
  void end_after(double seconds) noexcept;  // from now on; 0: only signals end
  bool is_reached() noexcept;
  // Sleeps until the end, until one of `others` is ready, or for `time`.
  void wait(std::chrono::milliseconds time, std::span<const pollfd> others = {});

 private:
  OwnedFd signals_;
  bool is_reached_ = false;
  std::int64_t end_ns_ = 0;  // 0: none
};

// Lines of standard input, without waiting for them.
class InputLines {
 public:
  pollfd fd() const noexcept { return {is_open_ ? 0 : -1, POLLIN, 0}; }
  std::vector<std::string> take();

 private:
  bool is_open_ = true;
  std::string rest_;  // of a line that is not complete
};

// One line on a terminal, rewritten in place; nothing where `file` is no terminal.
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

// `gaitpad COMMAND: SENTENCE` on standard error, below which a status line may go on.
void print_remarks(std::string_view command, const std::vector<std::string>& remarks,
                   StatusLine* line = nullptr);

}  // namespace gaitpad
