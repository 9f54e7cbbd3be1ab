// The terminal that a guided command talks to: single keys of standard input, and the room on the
// screen.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gaitpad {

// Single keys of standard input: on a terminal at once and without echo, else the first letter of
// each line. The terminal is in another mode meanwhile; the mode is restored by the destructor,
// when the process is stopped (Ctrl-Z) or quit (Ctrl-\), and set again when the process continues.
// Ctrl-C stays a signal. At most one object at a time.
class TerminalKeys {
 public:
  enum class Earlier { count, forgotten };  // keys that were pressed before
  explicit TerminalKeys(Earlier earlier = Earlier::count);
  ~TerminalKeys();
  TerminalKeys(const TerminalKeys&) = delete;
  TerminalKeys& operator=(const TerminalKeys&) = delete;

  // The next key, '\n' for Enter or an empty line; nothing if there is none now. Never waits.
  // Arrows and other escape sequences are left out.
  std::optional<char> take_key();
  bool is_at_end() const noexcept { return is_at_end_; }  // of input: no key will come

 private:
  std::optional<char> byte();

  bool is_terminal_ = false;
  bool is_at_end_ = false;
  std::string line_;  // an incomplete line
};

// Of standard error, one column less than there is; 79 x 24 if it is no terminal.
struct ScreenSize {
  std::size_t columns = 79, rows = 24;
};
ScreenSize screen_size() noexcept;

// Lines of at most `width` characters, broken at blanks.
std::vector<std::string> wrapped_lines(const std::string& text, std::size_t width);

// The text with its lines broken at blanks to at most `width` characters. What goes on stands below
// the last column that begins in the left half: a column has two blanks before it.
std::string fitted(std::string_view text, std::size_t width);
// Columns of a terminal; nothing if the descriptor is none.
std::optional<std::size_t> terminal_columns(int descriptor) noexcept;

}  // namespace gaitpad
