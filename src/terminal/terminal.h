// The terminal of a guided command: single keys of standard input, the size of the screen, and text
// that fits it.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "system/terminal_mode.h"

namespace gaitpad {

// Single keys of standard input: on a terminal at once and without echo, else the first letter of
// each line. At most one object at a time (SingleKeyMode).
class TerminalKeys {
 public:
  using Earlier = SingleKeyMode::Earlier;
  explicit TerminalKeys(Earlier earlier = Earlier::count) : mode_(earlier) {}

  // The next key, '\n' for Enter or an empty line; nothing if none was pressed. Never waits. Skips
  // arrows and other escape sequences.
  std::optional<char> take_key();
  // True at the end of input: there will be no more keys.
  bool is_at_end() const noexcept { return is_at_end_; }

 private:
  std::optional<char> byte();

  SingleKeyMode mode_;
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
