#include "view/file_browser.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <imgui.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>
#include <vector>

#include "base/files.h"
#include "base/text.h"
#include "gaitpad/calibration.h"
#include "gaitpad/config_files.h"
#include "gaitpad/motion_file.h"
#include "gaitpad/style.h"
#include "gaitpad/walk_model.h"
#include "view/widgets.h"

namespace gaitpad {
namespace fs = std::filesystem;
namespace {

constexpr const char* kWhatOpens =
    "motions (.bvh, .amc), recordings (.hid), and .toml files of styles, characters, calibrations, "
    "terrains and motions can be opened";

std::optional<FileKind> kind_of_folder(const fs::path& path) {
  const std::string folder = path.parent_path().filename().string();
  if (folder == "styles") return FileKind::style;
  if (folder == "characters") return FileKind::character;
  if (folder == "calibration") return FileKind::calibration;
  if (folder == "terrain") return FileKind::terrain;
  if (folder == "motions") return FileKind::motion;
  return std::nullopt;
}

// Tries each kind of .toml file and takes the one that loads without error.
Result<FileKind> kind_of_content(const std::string& path) {
  std::vector<FileKind> kinds;
  std::string problem;
  const auto look = [&](FileKind kind, const auto& loaded) {
    if (loaded) kinds.push_back(kind);
    if (!loaded && problem.empty()) problem = loaded.error().message;
  };
  look(FileKind::style, load_style(path));
  look(FileKind::character, load_character(path));
  look(FileKind::calibration, load_calibration_file(path));
  look(FileKind::terrain, load_terrain(path));
  if (kinds.empty()) look(FileKind::motion, load_motion_source(path));
  if (kinds.size() == 1) return kinds.front();
  if (!kinds.empty()) {
    return Error{path +
                 ": could be a style, a character or a terrain; put it into a folder named styles, "
                 "characters or terrain"};
  }
  return Error{
      fmt::format("{}: is not a style, character, calibration, terrain or motion; as a style: {}",
                  path, problem)};
}

// Sets item `n` of `count` in the list, which repeats its last item up to there; a negative `n`
// replaces the whole list.
void put(std::vector<std::string>& list, const std::string& path, int n, int count) {
  if (n < 0 || list.empty() || n >= count) {
    list = {path};
    return;
  }
  const std::string last = list.back();
  list.resize(static_cast<std::size_t>(count), last);
  list[static_cast<std::size_t>(n)] = path;
}

constexpr std::size_t kMostSeen = 100'000;  // entries of a folder that are read
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
  std::ranges::sort(entries, [](const FolderEntry& a, const FolderEntry& b) {
    if (a.is_folder != b.is_folder) return a.is_folder;
    const std::string left = lower_case(a.name), right = lower_case(b.name);
    return left != right ? left < right : a.name < b.name;
  });
}

std::string date_of(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return {};
  return fmt::format("{:%Y-%m-%d %H:%M}", fmt::localtime(status.st_mtime));
}

constexpr double kBrowserWidth = 780.0, kBrowserHeight = 520.0;  // at scale 1
constexpr std::pair<FileFilter, const char*> kFilters[] = {{FileFilter::all, "All"},
                                                           {FileFilter::motions, "Motions"},
                                                           {FileFilter::recordings, "Recordings"},
                                                           {FileFilter::settings, "Settings"}};

std::string home_folder() {
  const char* home = std::getenv("HOME");
  return home != nullptr && *home == '/' ? home : "/";
}

}  // namespace

Result<FileKind> kind_of_file(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) return Error{path + ": there is no such file"};
  if (fs::is_directory(status)) return Error{path + ": is a folder; " + kWhatOpens};
  if (!fs::is_regular_file(status)) return Error{path + ": is not a regular file"};
  const std::string ending = lower_case(fs::path(path).extension().string());
  if (ending == ".bvh" || ending == ".amc") return FileKind::motion;
  if (ending == ".hid") return FileKind::recording;
  if (ending != ".toml") return Error{path + ": cannot be opened: " + kWhatOpens};
  if (const auto kind = kind_of_folder(fs::absolute(path, error))) return *kind;
  return kind_of_content(path);
}

SessionSpec with_file(SessionSpec options, const std::string& path, FileKind kind, int walker,
                      int walker_count) {
  SessionSpec::Walk& walk = options.walk;
  options.live.record.clear();
  switch (kind) {
    case FileKind::motion:
      walk.motion = path;
      break;
    case FileKind::character:
      // Without a list every style has the motion's own character.
      if (walk.characters.empty() && walker >= 0) walk.characters = {"as_in_motion_file"};
      put(walk.characters, path, walker, walker_count);
      break;
    case FileKind::style:
      if (walk.styles.empty() && walker >= 0) walk.styles = {"even"};
      put(walk.styles, path, walker, walker_count);
      break;
    case FileKind::calibration:
      options.pad.calibration = path;
      break;
    case FileKind::terrain:
      walk.terrain = path;
      break;
    case FileKind::recording:
      options.replay.trace = path;
      options.rate_hz.reset();
      break;
  }
  return options;
}

FolderList list_folder(const std::string& folder, FileFilter filter) {
  FolderList list;
  std::error_code error;
  fs::directory_iterator it(folder, error), end;
  std::size_t seen = 0;
  for (; !error && it != end && seen < kMostSeen; it.increment(error), ++seen) {
    std::string name = it->path().filename().string();
    if (name.empty() || name.front() == '.') continue;
    std::error_code ignored;  // a broken link is not a folder
    const bool is_folder = it->is_directory(ignored);
    if (!is_folder && (!is_wanted(name, filter) || !it->is_regular_file(ignored))) continue;
    if (list.entries.size() == FolderList::kMostEntries) break;
    std::string date = is_folder ? "" : date_of(it->path());
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
  if (!text) return;  // no file was opened so far
  for (std::size_t begin = 0; begin < text->size() && paths_.size() < kMost;) {
    const std::size_t end = std::min(text->find('\n', begin), text->size());
    std::string path = text->substr(begin, end - begin);
    begin = end + 1;
    std::error_code error;
    const bool is_known = std::ranges::count(paths_, path) > 0;
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
  // Not reported: the list is a convenience.
  static_cast<void>(save_text(file_, text));
}

void FileBrowser::open(const std::vector<std::string>& config_folders) {
  is_open_ = true;
  last_.clear();
  for (const std::string& path : recent_.paths())
    last_.push_back({path, fmt::format("{}  {}", drawable(path), date_of(path))});
  bundled_.clear();
  for (const auto& files :
       {config_files(config_folders, "traces", ".hid"), config_files(config_folders, "motions")}) {
    for (const std::string& path : files) {
      const std::string summary = config_summary(path);
      bundled_.push_back({path, summary.empty() ? drawable(path) : summary + "."});
    }
  }
  problem_.clear();
  std::error_code error;
  if (folder_.empty()) folder_ = fs::current_path(error).string();
  go_to(folder_);
}

void FileBrowser::go_to(std::string folder) {
  folder_ = folder.empty() ? "/" : std::move(folder);
  list_ = list_folder(folder_, filter_);
  chosen_ = -1;
  const std::size_t size = std::min(folder_.size(), path_.size() - 1);
  std::memcpy(path_.data(), folder_.data(), size);
  path_[size] = '\0';
}

// Enters a folder; any other existing path is the result.
void FileBrowser::enter(const std::string& path) {
  problem_.clear();
  std::error_code error;
  if (fs::is_directory(path, error)) {
    go_to(fs::path(path).lexically_normal().string());
  } else if (fs::exists(path, error)) {
    result_ = path;
  } else {
    problem_ = path + ": there is no such file";
  }
}

void FileBrowser::draw_path(Ui& ui) {
  ImGui::PushFont(ui.fonts.body);
  const float up_px = button_width(ui, "Up", {}) + ImGui::GetStyle().ItemSpacing.x;
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - up_px);
  const bool is_entered =
      ImGui::InputText("##path", path_.data(), path_.size(), ImGuiInputTextFlags_EnterReturnsTrue);
  keep_item("browser path");
  ImGui::PopFont();
  if (is_entered && path_[0] != '\0') {
    const fs::path typed = path_.data();
    enter(typed.is_absolute() ? typed.string() : (fs::path(folder_) / typed).string());
  }
  ImGui::SameLine();
  if (button(ui, "browser up", "Up")) go_to(fs::path(folder_).parent_path().string());
}

void FileBrowser::draw_place(Ui& ui, const std::string& id, const Place& place) {
  ImGui::PushID(id.c_str());
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const bool is_clicked = ImGui::Selectable("##place");
  keep_item(id);
  put_text(*ImGui::GetWindowDrawList(), ui.fonts.small, ui.theme.text, at,
           fs::path(place.path).filename().string(), ImGui::GetItemRectSize().x);
  show_tip(ui, place.tip);
  ImGui::PopID();
  if (is_clicked) enter(place.path);
}

void FileBrowser::draw_places(Ui& ui) {
  text_line(ui, ui.fonts.small, ui.theme.secondary, "Opened last");
  int number = 0;
  for (const Place& place : last_)
    draw_place(ui, fmt::format("browser recent {}", number++), place);
  if (number == 0) text_line(ui, ui.fonts.small, ui.theme.tick, "nothing yet");
  ImGui::Dummy({1.0f, ui.px(6)});
  text_line(ui, ui.fonts.small, ui.theme.secondary, "Bundled");
  number = 0;
  for (const Place& place : bundled_)
    draw_place(ui, fmt::format("browser bundled {}", number++), place);
}

void FileBrowser::draw_filters(Ui& ui) {
  for (const auto& [filter, name] : kFilters) {
    if (filter != FileFilter::all) ImGui::SameLine();
    ButtonLook look;
    look.is_on = filter == filter_;
    if (!button(ui, fmt::format("browser filter {}", name), name, look)) continue;
    filter_ = filter;
    go_to(folder_);
  }
}

void FileBrowser::draw_entries(Ui& ui, float height_px) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(ui.px(10), ui.px(8)));
  ImGui::PushStyleColor(ImGuiCol_ChildBg, imgui_colour(ui.theme.plot));
  ImGui::BeginChild("entries", ImVec2(0.0f, height_px), false,
                    ImGuiWindowFlags_AlwaysUseWindowPadding);
  ImGui::PushFont(ui.fonts.body);
  std::optional<std::string> entered;
  ImGuiListClipper clipper;  // draws only the visible ones of thousands of rows
  clipper.Begin(static_cast<int>(list_.entries.size()));
  while (clipper.Step()) {
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      const FolderEntry& entry = list_.entries[static_cast<std::size_t>(i)];
      ImGui::PushID(i);
      const ImVec2 at = ImGui::GetCursorScreenPos();
      if (ImGui::Selectable("##entry", i == chosen_, ImGuiSelectableFlags_AllowDoubleClick)) {
        // A double click counts only if both clicks hit the same entry: after the first one the
        // list may be that of another folder.
        const bool is_second = chosen_ == i && ImGui::IsMouseDoubleClicked(0);
        chosen_ = i;
        const bool is_wanted = entry.is_folder || is_second;
        if (is_wanted) entered = (fs::path(folder_) / entry.name).string();
      }
      keep_item("browser entry " + drawable(entry.name));
      const Colour& colour = entry.is_folder ? ui.theme.secondary : ui.theme.text;
      const float width = ImGui::GetItemRectSize().x;
      const float date = text_width(ui.fonts.small, entry.date);
      put_text(*ImGui::GetWindowDrawList(), ui.fonts.body, colour, at,
               entry.is_folder ? entry.name + "/" : entry.name, width - date - ui.px(12));
      put_text(*ImGui::GetWindowDrawList(), ui.fonts.small, ui.theme.secondary,
               {at.x + width - date - ui.px(4), at.y + ui.px(2)}, entry.date, date + 1.0f);
      ImGui::PopID();
    }
  }
  if (list_.entries.empty() && list_.problem.empty())
    text_line(ui, ui.fonts.small, ui.theme.tick, "no files here that the window can open");
  ImGui::PopFont();
  ImGui::EndChild();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar();
  if (entered) enter(*entered);
}

void FileBrowser::draw_buttons(Ui& ui) {
  const bool can_open = chosen_ >= 0 && chosen_ < static_cast<int>(list_.entries.size());
  ButtonLook open;
  open.is_primary = true;
  open.is_enabled = can_open;
  if (button(ui, "browser open", "Open", open) && can_open) {
    const std::string& name = list_.entries[static_cast<std::size_t>(chosen_)].name;
    enter((fs::path(folder_) / name).string());
  }
  ImGui::SameLine();
  if (button(ui, "browser cancel", "Cancel")) close();
  ImGui::SameLine();
  if (button(ui, "browser home", "Home")) go_to(home_folder());
  const std::string& told = problem_.empty() ? list_.problem : problem_;
  if (told.empty()) return;
  ImGui::SameLine();
  text_line(ui, ui.fonts.small, ui.theme.warning, told);
}

std::optional<std::string> FileBrowser::draw(Ui& ui, const ImVec2& window_px) {
  result_.reset();
  begin_modal(ui, "browser", kBrowserWidth, kBrowserHeight, window_px);
  text_line(ui, ui.fonts.title, ui.theme.text, "Open a file");
  draw_path(ui);
  draw_filters(ui);
  const float below_px = ImGui::GetFrameHeightWithSpacing() + ui.px(10);
  const float height_px = ImGui::GetContentRegionAvail().y - below_px;
  ImGui::BeginChild("places", ImVec2(ui.px(170), height_px));
  draw_places(ui);
  ImGui::EndChild();
  ImGui::SameLine();
  draw_entries(ui, height_px);
  draw_buttons(ui);
  end_modal();
  if (result_) close();
  return std::exchange(result_, std::nullopt);
}

}  // namespace gaitpad
