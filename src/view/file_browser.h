// Opens a file without leaving the window: folders, a path to type, the files opened last.
#pragma once
#include <array>
#include <optional>
#include <string>

#include "view/folder_list.h"
#include "view/ui_parts.h"

namespace gaitpad {

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
