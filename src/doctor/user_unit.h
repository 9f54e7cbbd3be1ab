// The systemd unit by which a user's session starts this program.
#pragma once
#include <string>
#include <vector>

namespace gaitpad {

// A word of ExecStart=, in quotes. systemd.service(5), "Command lines": `%` and `$` are doubled,
// `"` and a backslash get a backslash, and control characters are written as \xNN.
std::string unit_word(const std::string& word);
// A unit that runs this program (/proc/self/exe) with these arguments, from the user's login on.
std::string user_unit_text(const std::vector<std::string>& arguments);

}  // namespace gaitpad
