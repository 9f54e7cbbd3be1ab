// Explanations of buttons, sliders and graphs under the pointer.
#pragma once
#include <string>
#include <string_view>

namespace gaitpad {

// Tooltip of an item of ui_items(), by its name; empty if there is none.
std::string tooltip_of(std::string_view item);

// A style's key or a gait parameter in words: "fatigue_model.per_100_m" is "tiring per 100 m".
std::string words_of_key(std::string_view key);

}  // namespace gaitpad
