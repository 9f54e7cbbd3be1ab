// What somebody may have meant who mistyped a word: a key, a command, an option.
#pragma once
#include <span>
#include <string>
#include <string_view>

namespace gaitpad {

// `; did you mean "replay"?` for a word that nobody knows; empty where no known one differs from it
// by at most two letters.
std::string suggestion(std::string_view unknown, std::span<const std::string> known);

}  // namespace gaitpad
