#include "session/file_kind.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <vector>

#include "base/text.h"
#include "gaitpad/calibration.h"
#include "gaitpad/config_files.h"
#include "gaitpad/motion_file.h"
#include "gaitpad/style.h"
#include "gaitpad/walk_model.h"

namespace gaitpad {
namespace fs = std::filesystem;
namespace {

constexpr const char* kWhatOpens =
    "motions (.bvh, .amc), recordings (.hid), and .toml files of styles, characters, calibrations, "
    "terrains and motions can be opened";

std::optional<FileKind> kind_of_folder(const fs::path& path) {
  const std::string folder = path.parent_path().filename().string();
  if (folder == "styles") return FileKind::style;
  if (folder == "characters") return FileKind::character;
  if (folder == "calibration") return FileKind::calibration;
  if (folder == "terrain") return FileKind::terrain;
  if (folder == "motions") return FileKind::motion;
  return std::nullopt;
}

// Tries each kind of .toml file and takes the one that loads without error.
Result<FileKind> kind_of_content(const std::string& path) {
  std::vector<FileKind> kinds;
  std::string problem;
  const auto look = [&](FileKind kind, const auto& loaded) {
    if (loaded) kinds.push_back(kind);
    if (!loaded && problem.empty()) problem = loaded.error().message;
  };
  look(FileKind::style, load_style(path));
  look(FileKind::character, load_character(path));
  look(FileKind::calibration, load_calibration_file(path));
  look(FileKind::terrain, load_terrain(path));
  if (kinds.empty()) look(FileKind::motion, load_motion_source(path));
  if (kinds.size() == 1) return kinds.front();
  if (!kinds.empty()) {
    return Error{path +
                 ": could be a style, a character or a terrain; put it into a folder named styles, "
                 "characters or terrain"};
  }
  return Error{
      fmt::format("{}: is not a style, character, calibration, terrain or motion; as a style: {}",
                  path, problem)};
}

// Sets item `n` of `count`; a shorter list is first extended with its last item. If `n` is not in
// [0, count) or the list is empty, `path` replaces the whole list.
void put(std::vector<std::string>& list, const std::string& path, int n, int count) {
  if (n < 0 || list.empty() || n >= count) {
    list = {path};
    return;
  }
  const std::string last = list.back();
  list.resize(static_cast<std::size_t>(count), last);
  list[static_cast<std::size_t>(n)] = path;
}

}  // namespace

Result<FileKind> kind_of_file(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) return Error{path + ": there is no such file"};
  if (fs::is_directory(status)) return Error{path + ": is a folder; " + kWhatOpens};
  if (!fs::is_regular_file(status)) return Error{path + ": is not a regular file"};
  const std::string ending = lower_case(fs::path(path).extension().string());
  if (ending == ".bvh" || ending == ".amc") return FileKind::motion;
  if (ending == ".hid") return FileKind::recording;
  if (ending != ".toml") return Error{path + ": cannot be opened: " + kWhatOpens};
  if (const auto kind = kind_of_folder(fs::absolute(path, error))) return *kind;
  return kind_of_content(path);
}

SessionSpec with_file(SessionSpec options, const std::string& path, FileKind kind, int walker,
                      int walker_count) {
  SessionSpec::Walk& walk = options.walk;
  options.live.record.clear();
  switch (kind) {
    case FileKind::motion:
      walk.motion = path;
      break;
    case FileKind::character:
      // Without a list every style has the motion's own character.
      if (walk.characters.empty() && walker >= 0) walk.characters = {"as_in_motion_file"};
      put(walk.characters, path, walker, walker_count);
      break;
    case FileKind::style:
      if (walk.styles.empty() && walker >= 0) walk.styles = {"even"};
      put(walk.styles, path, walker, walker_count);
      break;
    case FileKind::calibration:
      options.pad.calibration = path;
      break;
    case FileKind::terrain:
      walk.terrain = path;
      break;
    case FileKind::recording:
      options.replay.trace = path;
      options.rate_hz.reset();
      break;
  }
  return options;
}

}  // namespace gaitpad
