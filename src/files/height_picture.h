// Height pictures: grey PNG files of 8 or 16 bits, with unconverted samples.
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
  std::vector<std::uint16_t> samples;  // heights from the upper left corner, 0 black .. 65535 white
};
// Reads a picture of at most 4 MiB and kMaxPictureSide samples a side. Damage is an error. Gamma
// and colour profiles in the file are ignored, because heights are not colours.
Result<HeightPicture> load_height_picture(const std::string& path);
// Reads a picture from the bytes of a file; errors begin with `name`.
Result<HeightPicture> height_picture(std::string_view png, const std::string& name);

}  // namespace gaitpad
