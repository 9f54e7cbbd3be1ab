// A grey picture as heights: PNG of 8 or 16 bits, its samples as they stand in the file.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/result.h"

namespace gaitpad {

inline constexpr int kMaxPictureSide = 1024;

struct HeightPicture {
  int columns = 0, rows = 0;
  std::vector<std::uint16_t> samples;  // from the upper left corner, 0 black .. 65535 white
};
// Files come from strangers: of at most 4 MiB and kMaxPictureSide a side, damage is an error.
// What a file says of gamma and profiles does not count: heights are no colours.
Result<HeightPicture> load_height_picture(const std::string& path);
// The sentences name `name`.
Result<HeightPicture> height_picture(std::string_view png, const std::string& name);

}  // namespace gaitpad
