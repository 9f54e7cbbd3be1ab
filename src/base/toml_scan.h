// Looks over a TOML text before toml++ parses it, for what toml++ would not survive or misplace.
#pragma once
#include <string_view>

namespace gaitpad {

// A dotted key nests a table a dot, and toml++ frees nested tables by recursion.
inline constexpr int kMaxKeyParts = 16;

// The line, from 1, of the first key with more parts; 0 where there is none. Strings and comments
// are skipped as TOML says, so far as the text is valid; toml++ itself stops where it is not.
int line_of_overlong_key(std::string_view text);
// The line of the first character beyond ASCII that stands in no string and no comment, where
// TOML 1.0 has none (a mark of byte order at the very beginning is let through); 0 where there is
// none. toml++ takes some of them for white space by way of undefined behaviour.
int line_of_stray_character(std::string_view text);
// The line of the first byte that is no UTF-8; 0 where there is none. (toml++ names the line where
// it began to read ahead.)
int line_of_invalid_utf8(std::string_view text);

}  // namespace gaitpad
