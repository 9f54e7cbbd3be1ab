// A browser for opening files inside the window.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "files/folder_list.h"
#include "view/widgets.h"

namespace gaitpad {

class FileBrowser {
 public:
  // `recent_file` stores the recently opened files; empty: they are not stored.
  explicit FileBrowser(std::string recent_file) : recent_(std::move(recent_file)) {}

  // Opens the folder that was shown last, first the working directory. Recordings and motions of
  // `config_folders` are offered as bundled.
  void open(const std::vector<std::string>& config_folders);
  void close() noexcept { is_open_ = false; }
  bool is_open() const noexcept { return is_open_; }
  void remember(const std::string& path) { recent_.add(path); }

  // Draws the browser over everything else, in the middle of a window of this size. Returns the
  // chosen file and closes; it does not check whether the file can be opened.
  std::optional<std::string> draw(Ui& ui, const ImVec2& window_px);

 private:
  void go_to(std::string folder);
  void enter(const std::string& path);
  void draw_path(Ui& ui);
  void draw_places(Ui& ui);
  struct Place {  // a file or folder that one click opens
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
  int chosen_ = -1;                // index of the chosen entry in the list; -1: none
  std::array<char, 1024> path_{};  // the path as the user types it
  std::string problem_;            // why the path that was typed cannot be opened
  std::optional<std::string> result_;
  RecentFiles recent_;
  std::vector<Place> last_, bundled_;  // recent and bundled files when the browser was opened
};

}  // namespace gaitpad
