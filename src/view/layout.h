// The file that remembers how the window was left: which panels are open, the theme, what the scene
// shows. Its grammar: every key of layout.cpp, each may be absent.
#pragma once
#include <optional>
#include <string>

#include "gaitpad/result.h"
#include "view/ui.h"

namespace gaitpad {

struct Layout {
  UiState state;
  std::string remark;  // one sentence where the file is damaged and was not used, else empty
};
// Defaults where there is no such file, or no path.
Layout load_layout(const std::string& path);
// Written beside `path` first: on error the old file is as it was. Its folder is made.
std::optional<Error> save_layout(const std::string& path, const UiState& state);

}  // namespace gaitpad
