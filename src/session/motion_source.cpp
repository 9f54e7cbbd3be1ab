#include "session/motion_source.h"

#include <filesystem>

#include "base/toml_file.h"
#include "motion/load.h"

namespace gaitpad {
namespace {

LegNames leg_names(TomlTable& root, const char* key) {
  LegNames names;
  if (auto leg = root.table(key)) {
    names.hip = leg->string("hip").value_or("");
    names.knee = leg->string("knee").value_or("");
    names.ankle = leg->string("ankle").value_or("");
    names.toe = leg->string("toe").value_or("");
  }
  return names;
}

}  // namespace

Result<Motion> load_motion_source(const std::string& path) {
  if (!path.ends_with(".toml")) return load_motion(path);
  auto file = TomlFile::load(path);
  if (!file) return file.error();
  TomlTable root = file->root();
  root.require("file");
  const std::string motion_file = root.string("file").value_or("");
  LoadOptions options;
  options.metres_per_unit = root.number("metres_per_unit", 1e-6, 1e3).value_or(0.0);
  options.legs = {leg_names(root, "left_leg"), leg_names(root, "right_leg")};
  if (auto problem = file->problem()) return *problem;
  return load_motion((std::filesystem::path(path).parent_path() / motion_file).string(), options);
}

}  // namespace gaitpad
