// What stands in a folder of the files that gaitpad reads, and the files that were opened last.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace gaitpad {

// Which files are listed, of those that the window can open.
enum class FileFilter : std::uint8_t { all, motions, recordings, settings };

struct FolderEntry {
  std::string name;  // the file system's bytes, perhaps not UTF-8
  bool is_folder = false;
  std::string date;  // of a file: when it was written last, "2024-02-29 23:59"; empty: unknown
};
struct FolderList {
  static constexpr std::size_t kMostEntries = 4000;
  std::vector<FolderEntry> entries;  // folders first, then files; by name, ignoring case
  std::string problem;               // why it cannot be read or is shown in part
};

// Leaves out hidden files and those that the filter excludes.
FolderList list_folder(const std::string& folder, FileFilter filter);

// The last files that were opened, newest first, kept in a file from one start to the next. Paths
// that appear twice, no longer exist or have a line break are left out.
class RecentFiles {
 public:
  static constexpr std::size_t kMost = 8;
  // `file`: where they are kept; empty: nowhere.
  explicit RecentFiles(std::string file);
  void add(const std::string& path);
  const std::vector<std::string>& paths() const noexcept { return paths_; }

 private:
  std::string file_;
  std::vector<std::string> paths_;
};

// When a file was written last, in local time, "2024-02-29 23:59"; empty: unknown.
std::string written_on(const std::string& path);

}  // namespace gaitpad
