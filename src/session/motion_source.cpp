#include "session/motion_source.h"

#include <filesystem>

#include "base/toml_file.h"
#include "motion/keyframe.h"
#include "motion/load.h"
#include "session/config_files.h"

namespace gaitpad {
namespace {

// What stands in the file, under what is given already.
void fill_leg(TomlTable& root, const char* key, LegNames& names) {
  auto leg = root.table(key);
  if (!leg) return;
  const auto fill = [&leg](const char* part, std::string& name) {
    const std::string told = leg->string(part).value_or("");
    if (name.empty()) name = told;
  };
  fill("hip", names.hip);
  fill("knee", names.knee);
  fill("ankle", names.ankle);
  fill("toe", names.toe);
}

}  // namespace

Result<std::string> motion_path(const std::vector<std::string>& folders,
                                const std::string& file_or_name) {
  std::error_code error;
  const bool is_path = file_or_name.find_first_of("./") != std::string::npos ||
                       std::filesystem::exists(file_or_name, error);
  if (is_path) return file_or_name;
  return config_file(folders, "motions", file_or_name);
}

Result<Motion> load_motion_source(const std::string& path, const LoadOptions& given) {
  if (!path.ends_with(".toml")) return load_motion(path, given);
  auto file = TomlFile::load(path);
  if (!file) return file.error();
  if (is_keyframe_file(*file)) return keyframe_motion(*file);
  TomlTable root = file->root();
  root.require("file");
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  const std::string motion_file = root.string("file").value_or("");
  const double unit_m = root.number("metres_per_unit", 1e-6, 1e3).value_or(0.0);
  const double rate_hz = root.number("frame_rate_hz", 1.0, 1e4).value_or(0.0);
  const std::string skeleton = root.string("skeleton").value_or("");
  LoadOptions options = given;
  if (given.metres_per_unit <= 0.0) options.metres_per_unit = unit_m;
  if (given.frame_rate_hz <= 0.0) options.frame_rate_hz = rate_hz;
  if (given.skeleton.empty() && !skeleton.empty()) options.skeleton = (folder / skeleton).string();
  fill_leg(root, "left_leg", options.legs[kLeftSide]);
  fill_leg(root, "right_leg", options.legs[kRightSide]);
  if (auto problem = file->problem()) return *problem;
  return load_motion((folder / motion_file).string(), options);
}

}  // namespace gaitpad
