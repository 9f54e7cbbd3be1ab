// The file that remembers the window from one start to the next: open panels, theme, parts of the
// scene. Its keys are those of layout.cpp; each may be absent.
#pragma once
#include <optional>
#include <string>

#include "gaitpad/result.h"
#include "view/ui.h"

namespace gaitpad {

struct Layout {
  UiState state;
  std::string remark;  // why a damaged file was not used; else empty
};
// Returns the defaults if the path is empty or there is no such file.
Layout load_layout(const std::string& path);
// Writes beside `path` first, so that on error the old file is unchanged. Makes the folder.
std::optional<Error> save_layout(const std::string& path, const UiState& state);

}  // namespace gaitpad
