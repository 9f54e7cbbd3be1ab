#include "view/file_browser.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>
#include <vector>

#include "gaitpad/config_files.h"
#include "view/widgets.h"

namespace gaitpad {
namespace fs = std::filesystem;
namespace {

constexpr double kBrowserWidth = 780.0, kBrowserHeight = 520.0;  // the browser's size at scale 1
constexpr std::pair<FileFilter, const char*> kFilters[] = {{FileFilter::all, "All"},
                                                           {FileFilter::motions, "Motions"},
                                                           {FileFilter::recordings, "Recordings"},
                                                           {FileFilter::settings, "Settings"}};

std::string home_folder() {
  const char* home = std::getenv("HOME");
  return home != nullptr && *home == '/' ? home : "/";
}

}  // namespace

void FileBrowser::open(const std::vector<std::string>& config_folders) {
  is_open_ = true;
  last_.clear();
  for (const std::string& path : recent_.paths())
    last_.push_back({path, fmt::format("{}  {}", drawable(path), written_on(path))});
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

// Enters a folder; any other existing path becomes the result.
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
  ImGuiListClipper clipper;  // draws only the visible rows of thousands
  clipper.Begin(static_cast<int>(list_.entries.size()));
  while (clipper.Step()) {
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      const FolderEntry& entry = list_.entries[static_cast<std::size_t>(i)];
      ImGui::PushID(i);
      const ImVec2 at = ImGui::GetCursorScreenPos();
      if (ImGui::Selectable("##entry", i == chosen_, ImGuiSelectableFlags_AllowDoubleClick)) {
        // Both clicks of a double click must hit the same entry: the first one may have opened
        // another folder.
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
