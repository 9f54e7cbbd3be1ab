#include "session/config_files.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <map>

#include "session/user_files.h"

namespace gaitpad {
namespace fs = std::filesystem;

std::vector<std::string> config_folders(const std::string& built_in) {
  std::vector<fs::path> candidates;
  if (const char* own = std::getenv("GAITPAD_CONFIG"); own != nullptr && *own != '\0') {
    candidates.emplace_back(own);
  }
  if (const std::string user = user_config_folder(); !user.empty()) candidates.emplace_back(user);
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  if (!program.empty()) {
    const fs::path beside = program.parent_path().parent_path();
    candidates.push_back(beside / "share" / "gaitpad");
    candidates.push_back(beside / "config");
  }
  if (!built_in.empty()) candidates.emplace_back(built_in);

  std::vector<std::string> folders;
  for (const fs::path& candidate : candidates) {
    if (fs::is_directory(candidate, ignored)) folders.push_back(candidate.string());
  }
  return folders;
}

std::vector<std::string> config_files(const std::vector<std::string>& folders,
                                      const std::string& kind) {
  std::map<std::string, std::string> by_name;
  for (const std::string& folder : folders) {
    std::error_code error;
    for (fs::directory_iterator it(fs::path(folder) / kind, error), end; !error && it != end;
         it.increment(error)) {
      if (it->path().extension() == ".toml") {
        by_name.emplace(config_name(it->path().string()), it->path().string());
      }
    }
  }
  std::vector<std::string> files;
  for (auto& [name, path] : by_name) files.push_back(std::move(path));
  return files;
}

Result<std::string> config_file(const std::vector<std::string>& folders, const std::string& kind,
                                const std::string& file_or_name) {
  if (file_or_name.find('/') != std::string::npos || file_or_name.ends_with(".toml")) {
    return file_or_name;
  }
  std::string known;
  for (const std::string& path : config_files(folders, kind)) {
    if (config_name(path) == file_or_name) return path;
    known += (known.empty() ? "" : ", ") + config_name(path);
  }
  if (known.empty()) known = "none found; set GAITPAD_CONFIG to the config folder";
  return Error{
      fmt::format("there is no \"{}\" in config/{} (known: {})", file_or_name, kind, known)};
}

std::string config_name(const std::string& path) { return fs::path(path).stem().string(); }

}  // namespace gaitpad
