// The terminal of a guided command: single keys of standard input, and the size of the screen.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gaitpad {

// Opens standard descriptors that the caller has closed. Otherwise a pad or a recording would get
// such a number, and output for the terminal would be written into it. They are opened in the wrong
// direction, so that using them fails as on closed ones.
void hold_standard_descriptors() noexcept;

// Single keys of standard input: on a terminal at once and without echo, else the first letter of
// each line. The terminal's mode is changed meanwhile. It is restored by the destructor and when
// the process is stopped (Ctrl-Z) or quit (Ctrl-\), and changed again when the process continues.
// Ctrl-C still sends a signal. At most one object at a time.
class TerminalKeys {
 public:
  // Whether keys count that were pressed before the object was made.
  enum class Earlier { count, forgotten };
  explicit TerminalKeys(Earlier earlier = Earlier::count);
  ~TerminalKeys();
  TerminalKeys(const TerminalKeys&) = delete;
  TerminalKeys& operator=(const TerminalKeys&) = delete;

  // The next key, '\n' for Enter or an empty line; nothing if none was pressed. Never waits. Skips
  // arrows and other escape sequences.
  std::optional<char> take_key();
  // True at the end of input: there will be no more keys.
  bool is_at_end() const noexcept { return is_at_end_; }

 private:
  std::optional<char> byte();

  bool is_terminal_ = false;
  bool is_at_end_ = false;
  std::string line_;  // the beginning of a line whose end has not arrived
};

// Size of standard error, one column less than the terminal's; 79 x 24 without a terminal.
struct ScreenSize {
  std::size_t columns = 79, rows = 24;
};
ScreenSize screen_size() noexcept;

// Lines of at most `width` characters, broken at blanks.
std::vector<std::string> wrapped_lines(const std::string& text, std::size_t width);

// Breaks the text's lines at blanks to at most `width` characters. A continuation line begins below
// the last column of its line that begins in the left half; a column begins after two blanks.
std::string fitted(std::string_view text, std::size_t width);
// Columns as wide as their widest text, two blanks apart. All rows have the same number of columns.
using TableRow = std::vector<std::string>;
std::string table_text(const std::vector<TableRow>& table);
// Columns of a terminal; nothing if the descriptor is not one.
std::optional<std::size_t> terminal_columns(int descriptor) noexcept;

}  // namespace gaitpad
