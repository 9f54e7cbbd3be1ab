// The file that stores the window's layout between two starts: open panels, theme, parts of the
// scene. layout.cpp lists its keys; each is optional.
#pragma once
#include <optional>
#include <string>

#include "gaitpad/result.h"
#include "view/ui.h"

namespace gaitpad {

struct Layout {
  UiState state;
  std::string remark;  // why a damaged file was ignored; empty if it was not
};
// Returns the defaults if the path is empty or there is no such file.
Layout load_layout(const std::string& path);
// Writes to a file beside `path` first, so that an error leaves the old file unchanged. Makes the
// folder.
std::optional<Error> save_layout(const std::string& path, const UiState& state);

}  // namespace gaitpad
