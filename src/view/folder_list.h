// What a folder holds, for the file browser: bounded, and what cannot be read is told.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace gaitpad {

// Files by what the window can open.
enum class FileFilter : std::uint8_t { all, motions, recordings, settings };

struct FolderEntry {
  std::string name;  // the file system's bytes, which may be no UTF-8
  bool is_folder = false;
};
struct FolderList {
  static constexpr std::size_t kMostEntries = 4000;
  std::vector<FolderEntry> entries;  // folders first, then files, each by name without case
  std::string problem;               // one sentence: it cannot be read, or is shown in part
};

// Hidden ones are left out, and files that the filter does not name.
FolderList list_folder(const std::string& folder, FileFilter filter);

// The last files that were opened, newest first, from one start to the next. A path that stands
// there twice, or no longer exists, or has a line break, is left out.
class RecentFiles {
 public:
  static constexpr std::size_t kMost = 8;
  // `file`: where they are kept; empty: not.
  explicit RecentFiles(std::string file);
  void add(const std::string& path);
  const std::vector<std::string>& paths() const noexcept { return paths_; }

 private:
  std::string file_;
  std::vector<std::string> paths_;
};

}  // namespace gaitpad
