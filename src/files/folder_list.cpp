#include "files/folder_list.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <system_error>

#include "base/text.h"
#include "system/whole_file.h"

namespace gaitpad {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMostSeen = 100'000;  // most entries of a folder that are read
constexpr std::size_t kMostRecentBytes = 64 * 1024;

bool is_wanted(const std::string& name, FileFilter filter) {
  const std::string ending = lower_case(fs::path(name).extension().string());
  const bool is_motion = ending == ".bvh" || ending == ".amc", is_recording = ending == ".hid",
             is_setting = ending == ".toml";
  switch (filter) {
    case FileFilter::motions:
      return is_motion;
    case FileFilter::recordings:
      return is_recording;
    case FileFilter::settings:
      return is_setting;
    case FileFilter::all:
      break;
  }
  return is_motion || is_recording || is_setting;
}

void sort(std::vector<FolderEntry>& entries) {
  std::sort(entries.begin(), entries.end(), [](const FolderEntry& a, const FolderEntry& b) {
    if (a.is_folder != b.is_folder) return a.is_folder;
    const std::string left = lower_case(a.name), right = lower_case(b.name);
    return left != right ? left < right : a.name < b.name;
  });
}

}  // namespace

FolderList list_folder(const std::string& folder, FileFilter filter) {
  FolderList list;
  std::error_code error;
  fs::directory_iterator it(folder, error), end;
  std::size_t seen = 0;
  for (; !error && it != end && seen < kMostSeen; it.increment(error), ++seen) {
    std::string name = it->path().filename().string();
    if (name.empty() || name.front() == '.') continue;
    std::error_code ignored;  // ignored: a broken link is not a folder
    const bool is_folder = it->is_directory(ignored);
    if (!is_folder && (!is_wanted(name, filter) || !it->is_regular_file(ignored))) continue;
    if (list.entries.size() == FolderList::kMostEntries) break;
    std::string date = is_folder ? "" : written_on(it->path().string());
    list.entries.push_back({std::move(name), is_folder, std::move(date)});
  }
  if (error) {
    list.problem = fmt::format("{}: cannot be read: {}", folder, error.message());
  } else if (it != end) {
    list.problem = fmt::format("{}: has too many entries, only some are shown", folder);
  }
  sort(list.entries);
  return list;
}

RecentFiles::RecentFiles(std::string file) : file_(std::move(file)) {
  if (file_.empty()) return;
  const auto text = file_text(file_, kMostRecentBytes);
  if (!text) return;  // no file has been opened yet
  for (std::size_t begin = 0; begin < text->size() && paths_.size() < kMost;) {
    const std::size_t end = std::min(text->find('\n', begin), text->size());
    std::string path = text->substr(begin, end - begin);
    begin = end + 1;
    std::error_code error;
    const bool is_known = std::count(paths_.begin(), paths_.end(), path) > 0;
    if (!path.empty() && !is_known && fs::is_regular_file(path, error))
      paths_.push_back(std::move(path));
  }
}

void RecentFiles::add(const std::string& path) {
  std::error_code error;
  const std::string whole = fs::absolute(path, error).lexically_normal().string();
  if (error || whole.find('\n') != std::string::npos) return;
  std::erase(paths_, whole);
  paths_.insert(paths_.begin(), whole);
  if (paths_.size() > kMost) paths_.resize(kMost);
  if (file_.empty()) return;
  std::string text;
  for (const std::string& known : paths_) text += known + "\n";
  // An error is not reported: the list is only a convenience.
  static_cast<void>(save_text(file_, text));
}

std::string written_on(const std::string& path) {
  std::error_code error;
  const auto time = std::filesystem::last_write_time(path, error);
  if (error) return {};
  using Seconds = std::chrono::time_point<std::chrono::system_clock, std::chrono::seconds>;
  const auto written =
      std::chrono::floor<std::chrono::seconds>(std::chrono::file_clock::to_sys(time));
  return fmt::format("{:%Y-%m-%d %H:%M}",
                     fmt::localtime(std::chrono::system_clock::to_time_t(Seconds(written))));
}

}  // namespace gaitpad
