// The words and numbers of a line, as `.hid` files and other line-based texts have them.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/result.h"

namespace gaitpad {

// The words of a line, separated by blanks and tabs.
class Words {
 public:
  explicit Words(std::string_view text) : rest_(text) {}
  std::string_view next();  // The next line; empty at the end.
  std::string_view rest() const { return rest_; }
  bool at_end();

 private:
  void skip_blanks();
  std::string_view rest_;
};

std::optional<std::int64_t> decimal(std::string_view text, std::int64_t max);
std::optional<std::uint32_t> hexadecimal(std::string_view text, std::uint32_t max);
// `SECONDS.MICROSECONDS`, six digits after the point, in microseconds.
std::optional<std::int64_t> microseconds(std::string_view text);
// `LENGTH b0 b1 ...`: appends the bytes. Returns the cause, and leaves `out` as it was, if length
// and bytes do not fit together or there are more than `max_bytes`.
std::optional<std::string> append_bytes(Words& words, std::size_t max_bytes,
                                        std::vector<std::uint8_t>& out);

}  // namespace gaitpad
