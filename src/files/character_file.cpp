#include <filesystem>

#include "files/toml_file.h"
#include "gaitpad/walk_model.h"

namespace gaitpad {

Result<Character> load_character(const std::string& path) {
  constexpr double kLeastFactor = 0.3, kMostFactor = 3.0;
  auto file = TomlFile::load(path);
  if (!file) return file.error();
  TomlTable root = file->root();
  Character character;
  const std::filesystem::path place(path);
  character.name = root.string("name").value_or(place.stem().string());
  character.scale = root.number("scale", kLeastFactor, kMostFactor).value_or(1.0);
  character.leg_ratio = root.number("leg_ratio", kLeastFactor, kMostFactor).value_or(1.0);
  if (const auto skeleton = root.string("skeleton")) {
    if (skeleton->empty()) root.reject("skeleton", "the path of the skeleton is empty");
    character.skeleton = (place.parent_path() / *skeleton).string();
  }
  if (character.name.empty()) root.reject("name", "the name is empty");
  if (auto problem = file->problem()) return *problem;
  return character;
}

}  // namespace gaitpad
