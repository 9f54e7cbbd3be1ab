#include "gaitpad/config_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "base/suggestion.h"
#include "base/text.h"
#include "files/input_files.h"
#include "system/whole_file.h"

namespace gaitpad {

namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxNameBytes = 48;
// Most bytes of a file whose summary is read; a motion's file may contain poses.
constexpr std::size_t kMaxSummaryFileBytes = 64 << 20;

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-' || c == ' ';
}

Result<std::string> style_file_name(const std::string& given) {
  std::string name(trimmed(given, " "));
  if (name.empty()) return Error{"a style needs a name"};
  if (name.size() > kMaxNameBytes || !std::all_of(name.begin(), name.end(), is_plain)) {
    return Error{fmt::format("a style's name has at most {} letters, digits, blanks, _ and -",
                             kMaxNameBytes)};
  }
  return name;
}

}  // namespace

std::string user_config_folder() {
  const auto is_absolute = [](const char* path) { return path != nullptr && *path == '/'; };
  const char* config = std::getenv("XDG_CONFIG_HOME");
  const char* home = std::getenv("HOME");
  if (is_absolute(config)) return std::string(config) + "/gaitpad";
  return is_absolute(home) ? std::string(home) + "/.config/gaitpad" : "";
}

std::vector<std::string> config_folders(const std::string& built_in) {
  std::vector<fs::path> candidates;
  if (const char* own = std::getenv("GAITPAD_CONFIG"); own != nullptr && *own != '\0') {
    candidates.emplace_back(own);
  }
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  if (!program.empty()) {
    const fs::path beside = program.parent_path().parent_path();
    candidates.push_back(beside / "share" / "gaitpad");
    candidates.push_back(beside / "config");
  }
  if (!built_in.empty()) candidates.emplace_back(built_in);
  if (const std::string user = user_config_folder(); !user.empty()) candidates.emplace_back(user);

  std::vector<std::string> folders;
  for (const fs::path& candidate : candidates) {
    if (fs::is_directory(candidate, ignored)) folders.push_back(candidate.string());
  }
  return folders;
}

std::vector<std::string> config_files(const std::vector<std::string>& folders,
                                      const std::string& kind, std::string_view ending) {
  std::map<std::string, std::string> by_name;
  for (const std::string& folder : folders) {
    for (const std::string& path : inputs_in((fs::path(folder) / kind).string())) {
      if (fs::path(path).extension() == ending) by_name.emplace(config_name(path), path);
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
  std::vector<std::string> known;
  for (const std::string& path : config_files(folders, kind)) {
    if (config_name(path) == file_or_name) return path;
    known.push_back(config_name(path));
  }
  std::string meant = suggestion(file_or_name, known);
  if (known.empty()) meant = " (none found; set GAITPAD_CONFIG to the config folder)";
  if (meant.empty()) meant = fmt::format(" (known: {})", fmt::join(known, ", "));
  return Error{fmt::format("there is no \"{}\" in config/{}{}", file_or_name, kind, meant)};
}

std::string config_name(const std::string& path) { return fs::path(path).stem().string(); }

std::string config_summary(const std::string& path) {
  const auto text = file_text(path, kMaxSummaryFileBytes);
  if (!text) return {};
  std::string comment;
  std::string_view rest = *text;
  if (rest.starts_with("V:")) take_line(rest);  // the first line of a recording
  for (; rest.starts_with('#');) {
    const std::string_view line = trimmed(take_line(rest), "# \t\r");
    if (line.empty()) break;
    if (!comment.empty()) comment += ' ';
    comment += line;
  }
  // Drop references in brackets, because their points do not end the sentence.
  for (auto open = comment.find(" ("); open != std::string::npos; open = comment.find(" (")) {
    const auto close = comment.find(')', open);
    comment.erase(open, close == std::string::npos ? close : close + 1 - open);
  }
  std::string sentence = comment.substr(0, comment.find(". "));
  if (sentence.ends_with('.')) sentence.pop_back();
  return printable(sentence);
}

Result<std::string> save_style(const std::vector<std::string>& config_folders,
                               const std::string& name, const StyleValues& values) {
  if (auto problem = check(values)) return *problem;
  const auto plain = style_file_name(name);
  if (!plain) return plain.error();
  const std::string user = user_config_folder();
  if (user.empty())
    return Error{"neither XDG_CONFIG_HOME nor HOME names a folder for styles of your own"};
  std::vector<std::string> others = config_folders;
  std::erase(others, user);
  for (const std::string& path : config_files(others, "styles")) {
    if (config_name(path) != *plain) continue;
    return Error{
        fmt::format("there is a style \"{}\" already ({}): choose another name", *plain, path)};
  }
  Style style;
  static_cast<StyleValues&>(style) = values;
  style.name = *plain;
  const std::string path = fmt::format("{}/styles/{}.toml", user, *plain);
  if (auto problem = save_text(path, style_text(style))) return *problem;
  return path;
}

}  // namespace gaitpad
