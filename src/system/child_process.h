// Runs another program that reads its standard input from this one.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gaitpad/result.h"
#include "system/descriptors.h"

namespace gaitpad {

// True if a folder of PATH has this program.
bool is_in_path(const std::string& program);

// The program is in its own process group, so that Ctrl-C reaches only this program, which can then
// finish the other's work. No signal is blocked in it. What it prints is kept in memory.
class ChildProcess {
 public:
  ChildProcess() = default;
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  ~ChildProcess() { kill(); }

  // Starts words[0], which is looked for in PATH, with the other words as arguments.
  std::optional<Error> start(std::vector<std::string> words);
  // True from start() until wait_for_end().
  bool has_input() const noexcept { return input_.get() >= 0; }
  // Waits until the program has taken the bytes. False: it reads no more.
  bool write(std::span<const std::uint8_t> bytes) noexcept;
  // Ends the program's input and waits for the program's end.
  void wait_for_end() noexcept;
  // Ends the program at once if it runs.
  void kill() noexcept;
  // After wait_for_end(): its exit status; nothing if a signal ended it.
  std::optional<int> exit_status() const noexcept;
  int ending_signal() const noexcept;
  // The last line that the program printed, without its end; empty if it printed nothing.
  std::string last_line() const;

 private:
  OwnedFd input_;     // socket to the program's standard input
  OwnedFd printed_;   // file that receives what the program prints
  int process_ = -1;  // -1: not started, or already waited for
  int status_ = 0;    // as waitpid() gives it
};

}  // namespace gaitpad
