#include <algorithm>
#include <cmath>

#include "view/ui_parts.h"

namespace gaitpad {
namespace {

constexpr std::size_t kMaxTextBytes = 1024;  // no row shows more; strangers' names may be long

std::string fit(std::string_view text) { return drawable(text.substr(0, kMaxTextBytes)); }

ImVec2 size_of(const ImFont* font, std::string_view text) {
  return font->CalcTextSizeA(font->FontSize, FLT_MAX, 0.0f, text.data(), text.data() + text.size());
}

// The first bytes of it that are no wider than that.
std::string_view fitting(const ImFont* font, std::string_view text, float width) {
  if (width <= 0.0f) return {};
  const char* rest = nullptr;
  font->CalcTextSizeA(font->FontSize, width, 0.0f, text.data(), text.data() + text.size(), &rest);
  return text.substr(0, static_cast<std::size_t>(rest - text.data()));
}

}  // namespace

float text_width(const ImFont* font, std::string_view text) { return size_of(font, text).x; }

void put_text(ImDrawList& list, const ImFont* font, const Colour& colour, const ImVec2& at,
              std::string_view text, float max_width) {
  std::string shown = fit(text);
  if (shown.empty() || !(max_width > 0.0f)) return;
  if (text_width(font, shown) > max_width) {
    const float room = max_width - text_width(font, "...");
    shown = std::string(fitting(font, shown, room));
    if (room >= 0.0f) shown += "...";
  }
  list.AddText(font, font->FontSize, {std::floor(at.x), std::floor(at.y)}, packed(colour),
               shown.data(), shown.data() + shown.size());
}

void text_line(Ui&, const ImFont* font, const Colour& colour, std::string_view text,
               float max_width) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = max_width > 0.0f ? max_width : ImGui::GetContentRegionAvail().x;
  put_text(*ImGui::GetWindowDrawList(), font, colour, at, text, width);
  ImGui::Dummy({std::min(width, text_width(font, fit(text))), font->FontSize});
}

void value_row(Ui& ui, std::string_view label, std::string_view value) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  const ImFont* font = ui.fonts.small;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const std::string shown = fit(value);
  const float value_width = std::min(text_width(font, shown), width * 0.7f);
  put_text(list, font, ui.theme.secondary, at, label, width - value_width - ui.px(8));
  put_text(list, font, ui.theme.text, {at.x + width - value_width, at.y}, shown,
           value_width + 1.0f);
  ImGui::Dummy({width, font->FontSize});
}

std::vector<std::string> text_lines(const ImFont* font, std::string_view text, float width,
                                    int max_lines) {
  std::vector<std::string> lines;
  std::string rest = fit(text);
  while (!rest.empty()) {
    const std::string_view part = fitting(font, rest, width);
    if (part.size() == rest.size() || static_cast<int>(lines.size()) + 1 >= max_lines) {
      lines.push_back(rest);
      break;
    }
    const std::size_t blank = part.rfind(' ');
    std::size_t cut = blank == std::string_view::npos || blank == 0 ? part.size() : blank;
    if (cut == 0) break;  // not even one letter fits
    lines.push_back(rest.substr(0, cut));
    rest.erase(0, rest.find_first_not_of(' ', cut));
  }
  return lines;
}

void note(Ui& ui, std::string_view text, int max_lines) {
  const float width = ImGui::GetContentRegionAvail().x;
  for (const std::string& line : text_lines(ui.fonts.small, text, width, max_lines)) {
    text_line(ui, ui.fonts.small, ui.theme.secondary, line);
  }
}

}  // namespace gaitpad
