// A file that somebody opens or drops: what it is, and the session that it makes.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gaitpad/result.h"
#include "view/show.h"
#include "view/widgets.h"

namespace gaitpad {

enum class FileKind { motion, character, style, calibration, terrain, recording };

// By its ending; a .toml by the folder that it stands in (styles, characters, calibration,
// terrain, motions), else by what stands in it. Error where it is no file or none of these.
Result<FileKind> kind_of_file(const std::string& path);

// The show that runs, with this file. A style or a character is for walker `walker`, -1: for all.
// Nothing is recorded in it.
ShowOptions with_file(ShowOptions options, const std::string& path, FileKind kind, int walker,
                      int walker_count);

// What a folder holds, for the file browser: bounded, and what cannot be read is told.

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

// Opens a file without leaving the window: folders, a path to type, the files opened last.

class FileBrowser {
 public:
  // `recent_file`: where the last files are remembered; empty: they are not.
  explicit FileBrowser(std::string recent_file) : recent_(std::move(recent_file)) {}

  void open();  // where it was closed, at first in the working directory
  void close() noexcept { is_open_ = false; }
  bool is_open() const noexcept { return is_open_; }
  void remember(const std::string& path) { recent_.add(path); }

  // Over everything else, in the middle of a window of this size. The file that was chosen, which
  // closes it; whether it can be opened is not known here.
  std::optional<std::string> draw(Ui& ui, const ImVec2& window_px);

 private:
  void go_to(std::string folder);
  void enter(const std::string& path);
  void draw_path(Ui& ui);
  void draw_places(Ui& ui);
  void draw_filters(Ui& ui);
  void draw_entries(Ui& ui, float height_px);
  void draw_buttons(Ui& ui);

  bool is_open_ = false;
  std::string folder_;
  FileFilter filter_ = FileFilter::all;
  FolderList list_;
  int chosen_ = -1;                // in the list
  std::array<char, 1024> path_{};  // as typed
  std::string problem_;            // with what was typed
  std::optional<std::string> result_;
  RecentFiles recent_;
};

}  // namespace gaitpad
