// What the readers of motion files share: a stranger's text, its words and its numbers.
#pragma once
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "gaitpad/result.h"

namespace gaitpad {

inline constexpr long long kMaxFrameJoints = 10'000'000;  // 100 joints: 14 minutes at 120 Hz

inline bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

std::string_view trimmed(std::string_view s);
// The text up to the first blank, which is taken off `rest` together with the blanks around it.
std::string_view take_word(std::string_view& rest);
// What a message shows of a stranger's text: short and printable.
std::string shown(std::string_view s);
std::string lower_case(std::string_view s);  // ASCII

// A whole word as a number within +-1e7 (which keeps all later arithmetic finite), written in any
// usual way; nothing for `nan`, `inf` and what is too large.
std::optional<double> text_number(std::string_view word);

// The whole of a regular file of at most 512 MB. Error: `PATH: cause`.
Result<std::string> motion_file_text(const std::string& path);

// Lines of a text without comments (# to the end), trimmed, with their numbers.
class LineReader {
 public:
  explicit LineReader(std::string_view text);
  // Next line that is not blank; empty at the end.
  std::string_view next();
  int line() const { return line_; }  // of the last one
  std::size_t bytes_left() const { return rest_.size(); }

 private:
  std::string_view rest_;
  int line_ = 0;
};

}  // namespace gaitpad
