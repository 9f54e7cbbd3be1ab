// Terrains as files: config/terrain/*.toml, the grammar stands in config/README.md.
#pragma once
#include <string>
#include <string_view>

#include "gaitpad/terrain.h"

namespace gaitpad {

// A picture that it names is read, too, beside the file.
Result<Terrain> load_terrain(const std::string& path);
// `path` stands in the sentences, and pictures are looked for beside it.
Result<Terrain> parsed_terrain(std::string_view text, const std::string& path);

}  // namespace gaitpad
