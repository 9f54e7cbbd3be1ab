// Lists the files in a folder that gaitpad can open, and the files that were opened last.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace gaitpad {

// The kinds of files that the window can open.
enum class FileFilter : std::uint8_t { all, motions, recordings, settings };

struct FolderEntry {
  std::string name;  // bytes of the file system, possibly not UTF-8
  bool is_folder = false;
  std::string date;  // time of a file's last change, "2024-02-29 23:59"; empty: unknown
};
struct FolderList {
  static constexpr std::size_t kMostEntries = 4000;
  std::vector<FolderEntry> entries;  // folders first, then files; by name, ignoring case
  std::string problem;               // why the folder cannot be read or is incomplete
};

// Lists a folder without hidden files and files that the filter excludes.
FolderList list_folder(const std::string& folder, FileFilter filter);

// The files opened last, newest first, stored in a file between runs. Duplicates, missing files and
// paths with a line break are left out.
class RecentFiles {
 public:
  static constexpr std::size_t kMost = 8;
  // `file`: path of the stored list; empty: it is not stored.
  explicit RecentFiles(std::string file);
  void add(const std::string& path);
  const std::vector<std::string>& paths() const noexcept { return paths_; }

 private:
  std::string file_;
  std::vector<std::string> paths_;
};

// Local time of a file's last change, "2024-02-29 23:59"; empty: unknown.
std::string written_on(const std::string& path);

}  // namespace gaitpad
