// The reason why a pad may not be seen although it is plugged in.
#pragma once
#include <string>

namespace gaitpad {

inline constexpr const char* kNoUdev =
    "udev is not running, so device permissions and types are unknown";

// A sentence with the command that helps; empty if no obstacle is known.
std::string unseen_pad();

}  // namespace gaitpad
