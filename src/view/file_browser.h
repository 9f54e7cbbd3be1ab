// Files that a person opens or drops: what they are, which session they make, and a browser to find
// them without leaving the window.
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

// Known by its ending; a .toml by its folder (styles, characters, calibration, terrain, motions),
// else by its content. Fails if it is not a file or none of these.
Result<FileKind> kind_of_file(const std::string& path);

// The given options with this file. A style or a character is for walker `walker`, or for all of
// them if that is -1. The new session is not recorded.
SessionSpec with_file(SessionSpec options, const std::string& path, FileKind kind, int walker,
                      int walker_count);

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

class FileBrowser {
 public:
  // `recent_file`: where the last files are kept; empty: nowhere.
  explicit FileBrowser(std::string recent_file) : recent_(std::move(recent_file)) {}

  // In the folder shown last, at first the working directory. `config_folders`: whose recordings
  // and motions are offered as bundled.
  void open(const std::vector<std::string>& config_folders);
  void close() noexcept { is_open_ = false; }
  bool is_open() const noexcept { return is_open_; }
  void remember(const std::string& path) { recent_.add(path); }

  // Draws it over everything else, in the middle of a window of this size. Returns the chosen file,
  // which closes the browser; whether the file can be opened is not checked.
  std::optional<std::string> draw(Ui& ui, const ImVec2& window_px);

 private:
  void go_to(std::string folder);
  void enter(const std::string& path);
  void draw_path(Ui& ui);
  void draw_places(Ui& ui);
  struct Place {  // a file that one click opens
    std::string path, tip;
  };
  void draw_place(Ui& ui, const std::string& id, const Place& place);
  void draw_filters(Ui& ui);
  void draw_entries(Ui& ui, float height_px);
  void draw_buttons(Ui& ui);

  bool is_open_ = false;
  std::string folder_;
  FileFilter filter_ = FileFilter::all;
  FolderList list_;
  int chosen_ = -1;                // in the list
  std::array<char, 1024> path_{};  // as typed
  std::string problem_;            // of the path that was typed
  std::optional<std::string> result_;
  RecentFiles recent_;
  std::vector<Place> last_, bundled_;  // as they were when the browser was opened
};

}  // namespace gaitpad
