// Single keys of standard input: at once and without echo on a terminal, else the first letter of
// each line.
#pragma once
#include <optional>
#include <string>

namespace gaitpad {

// Where standard input is a terminal it is in another mode meanwhile. The mode is put back by the
// destructor, when the process is stopped (Ctrl-Z) or quit (Ctrl-\), and set again when it goes on.
// Ctrl-C stays a signal. At most one at a time.
class TerminalKeys {
 public:
  enum class Earlier { count, forgotten };  // keys that were pressed before
  explicit TerminalKeys(Earlier earlier = Earlier::count);
  ~TerminalKeys();
  TerminalKeys(const TerminalKeys&) = delete;
  TerminalKeys& operator=(const TerminalKeys&) = delete;

  // The next key, '\n' for Enter (or an empty line); none: nothing more for now. Never waits.
  // Arrows and the like are left out.
  std::optional<char> take();
  bool is_at_end() const noexcept { return is_at_end_; }  // of input: no key will come

 private:
  std::optional<char> byte();

  bool is_terminal_ = false;
  bool is_at_end_ = false;
  std::string line_;  // that is not complete
};

}  // namespace gaitpad
