// Suggestions for a mistyped key, command or option.
#pragma once
#include <span>
#include <string>
#include <string_view>

namespace gaitpad {

// `; did you mean "replay"?` for an unknown word; empty if no known word is within an edit distance
// of two letters.
std::string suggestion(std::string_view unknown, std::span<const std::string> known);

}  // namespace gaitpad
