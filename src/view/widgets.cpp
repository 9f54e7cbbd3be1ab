#include "view/widgets.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/shown_number.h"
#include "view/tooltips.h"

namespace gaitpad {
namespace {

// Longer text is cut; it is longer than any visible row.
constexpr std::size_t kMaxTextBytes = 1024;

std::string fit(std::string_view text) { return drawable(text.substr(0, kMaxTextBytes)); }

ImVec2 size_of(const ImFont* font, std::string_view text) {
  return font->CalcTextSizeA(font->FontSize, FLT_MAX, 0.0f, text.data(), text.data() + text.size());
}

// The longest beginning of the text that fits the width.
std::string_view fitting(const ImFont* font, std::string_view text, float width) {
  if (width <= 0.0f) return {};
  const char* rest = nullptr;
  font->CalcTextSizeA(font->FontSize, width, 0.0f, text.data(), text.data() + text.size(), &rest);
  return text.substr(0, static_cast<std::size_t>(rest - text.data()));
}

// State of the last drawn frame; only one window draws, on one thread.
std::vector<UiItem> items;
std::vector<std::string> cut, drawn;
std::vector<std::string> focusable;  // names of items in drawing order, also of those out of sight

void keep(std::string_view name, const ImVec2& min, const ImVec2& max, const ImRect& clip) {
  ImRect rect(min, max);
  rect.ClipWithFull(clip);
  if (rect.GetWidth() < 1.0f || rect.GetHeight() < 1.0f) return;
  items.push_back({std::string(name), rect.Min, rect.Max});
}

void draw_button_back(Ui& ui, const ImVec2& min, const ImVec2& max, const ButtonLook& look) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float rounding = ui.px(5);
  const bool is_chosen = look.is_on && !look.is_primary;
  Colour back = look.is_primary || look.is_on ? ui.theme.accent : ui.theme.frame;
  back.alpha = (is_chosen ? kChosenShare : 1.0) * (look.is_enabled ? 1.0 : 0.5);
  list.AddRectFilled(min, max, packed(back), rounding);
  if (look.is_enabled && ImGui::IsItemHovered()) {
    const double strength = ImGui::IsItemActive() ? 0.18 : 0.08;
    list.AddRectFilled(min, max, packed(with_alpha(ui.theme.text, strength)), rounding);
  }
  const Colour& edge = is_chosen ? ui.theme.left : ui.theme.edge;
  if (!look.is_primary)
    list.AddRect(min, max, packed(with_alpha(edge, look.is_enabled ? 1.0 : 0.5)), rounding, 0,
                 ui.px(1));
}

// Draws icon or dot, then the label, centred on the button.
void draw_button_face(Ui& ui, const ImVec2& min, const ImVec2& max, std::string_view label,
                      const ButtonLook& look) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const bool is_low = look.height > 0.0f && look.height < ui.px(20);
  const ImFont* font = is_low ? ui.fonts.small : ui.fonts.body;
  const Colour text =
      with_alpha(look.is_primary ? rgb(0xffffff) : ui.theme.text, look.is_enabled ? 1.0 : 0.45);
  const float front = (look.icon != Icon::none && !label.empty() ? ui.px(16) : 0.0f) +
                      (look.dot ? ui.px(14) : 0.0f);
  const float room = max.x - min.x - ui.px(8) - front;
  const float content = std::min(text_width(font, label), room);
  float x = (min.x + max.x - content - front) / 2.0f;
  const float middle = (min.y + max.y) / 2.0f;
  if (look.icon != Icon::none) {
    const float r = ui.px(4.5);
    draw_icon(list, look.icon, {label.empty() ? (min.x + max.x) / 2.0f : x + r, middle}, r,
              packed(look.icon == Icon::record ? ui.theme.bad : text));
  }
  if (look.dot) list.AddCircleFilled({x + ui.px(4), middle}, ui.px(4), packed(*look.dot), 16);
  put_text(list, font, text, {x + front, middle - font->FontSize / 2.0f}, label, content + 1.0f);
}

// Ticks until a moved slider shows the session's value again; a command takes effect earlier.
constexpr std::int64_t kPendingTicks = 60;
constexpr double kKnobPixels = 5.0;  // half a knob's width, and the slider's margin

double value_under_mouse(Ui& ui, float left, float right, const SliderLook& look) {
  const float margin = ui.px(kKnobPixels);
  const float share = (ImGui::GetIO().MousePos.x - left - margin) / (right - left - 2.0f * margin);
  const double value =
      look.min + std::clamp(static_cast<double>(share), 0.0, 1.0) * (look.max - look.min);
  const double unit = std::pow(10.0, look.decimals);
  return std::clamp(std::round(value * unit) / unit, look.min, look.max);
}

// Draws the number in the middle, or beside the knob if the knob would cover it.
void draw_number(Ui& ui, const ImVec2& min, const ImVec2& max, float knob, double value,
                 const SliderLook& look) {
  std::string text = look.is_mixed ? "mixed" : tick_text(value, std::pow(10.0, -look.decimals));
  if (!look.letter.empty()) text = fmt::format("{} {}", look.letter, text);
  const ImFont* font = ui.fonts.small;
  const float width = text_width(font, text), room = ui.px(7);
  const float middle = (min.x + max.x) / 2.0f;
  float x = middle - width / 2.0f;
  if (knob < middle) {
    x = std::max(x, knob + room);
  } else {
    x = std::min(x, knob - room - width);
  }
  put_text(*ImGui::GetWindowDrawList(), font, ui.theme.text,
           {x, (min.y + max.y - font->FontSize) / 2.0f}, text, max.x - x);
}

void draw_notch(Ui& ui, float x, const ImVec2& min, const ImVec2& max) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float r = ui.px(3), h = ui.px(4.2);
  const ImU32 colour = packed(ui.theme.text);
  list.AddTriangleFilled({x - r, min.y}, {x, min.y + h}, {x + r, min.y}, colour);
  list.AddTriangleFilled({x - r, max.y}, {x + r, max.y}, {x, max.y - h}, colour);
}

void draw_slider(Ui& ui, const ImVec2& min, const ImVec2& max, double value,
                 const SliderLook& look) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const double span = look.max - look.min;
  const float margin = ui.px(kKnobPixels);
  const auto place = [&](double at) {
    const double share = span > 0.0 ? std::clamp((at - look.min) / span, 0.0, 1.0) : 0.0;
    return min.x + margin + static_cast<float>(share) * (max.x - min.x - 2.0f * margin);
  };
  const double strength = look.is_enabled ? 1.0 : 0.55;
  list.AddRectFilled(min, max, packed(ui.theme.frame), ui.px(4));
  const float grab = look.is_mixed ? min.x : place(value);
  if (!look.is_mixed) {
    list.AddRectFilled(min, {grab, max.y}, packed(with_alpha(ui.theme.accent, 0.45 * strength)),
                       ui.px(4));
    if (look.mark && std::isfinite(*look.mark) && *look.mark != value)
      draw_notch(ui, place(*look.mark), min, max);
    const bool is_hot = ImGui::IsItemHovered() || ImGui::IsItemActive();
    const Colour& knob = is_hot && look.is_enabled ? ui.theme.text : ui.theme.left;
    list.AddRectFilled({grab - ui.px(3.5), min.y + ui.px(2)}, {grab + ui.px(3.5), max.y - ui.px(2)},
                       packed(with_alpha(knob, strength)), ui.px(3));
  }
  const Colour& edge = look.is_changed ? ui.theme.warning : ui.theme.edge;
  list.AddRect(min, max, packed(with_alpha(edge, strength)), ui.px(4), 0,
               ui.px(look.is_changed ? 1.4 : 1.0));
  draw_number(ui, min, max, grab, value, look);
}

constexpr float kRest_s = 0.45;       // time that the pointer rests before the tip appears
constexpr double kTipPixels = 300.0;  // greatest width of a tip

constexpr double kVeil = 0.55;
constexpr double kRoom = 24.0;  // least distance from a box to the window's edges, at scale 1
// Height that a box leaves to the messages above it, if both fit.
constexpr double kMessages = 104.0;

}  // namespace

std::string signed_pair(const vec2& v) {
  return signed_number(v.x, 2) + "  " + signed_number(v.y, 2);
}

float text_width(const ImFont* font, std::string_view text) { return size_of(font, text).x; }

void put_text(ImDrawList& list, const ImFont* font, const Colour& colour, const ImVec2& at,
              std::string_view text, float max_width) {
  std::string shown = fit(text);
  if (shown.empty() || !(max_width > 0.0f)) return;
  if (text_width(font, shown) > max_width) {
    cut.push_back(shown);
    const float room = max_width - text_width(font, "...");
    shown = std::string(fitting(font, shown, room));
    if (room >= 0.0f) shown += "...";
  }
  list.AddText(font, font->FontSize, {std::floor(at.x), std::floor(at.y)}, packed(colour),
               shown.data(), shown.data() + shown.size());
  drawn.push_back(std::move(shown));
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
  const float label_width = text_width(font, label), value_width = text_width(font, shown);
  const bool has_two = label_width + value_width + ui.px(8) > width;
  const float y = has_two ? at.y + font->FontSize + ui.px(2) : at.y;
  put_text(list, font, ui.theme.secondary, at, label, has_two ? width : label_width + 1.0f);
  put_text(list, font, ui.theme.text, {at.x + std::max(width - value_width, 0.0f), y}, shown,
           std::min(value_width, width) + 1.0f);
  ImGui::Dummy({width, y + font->FontSize - at.y});
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
    if (cut == 0) break;  // there is no room for even one letter
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

void progress_bar(Ui& ui, double done) {
  const float width = ImGui::GetContentRegionAvail().x, height = ui.px(10), round = ui.px(5);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, {at.x + width, at.y + height}, packed(ui.theme.frame), round);
  if (done > 0.0) {
    const float filled = std::max(width * static_cast<float>(std::min(done, 1.0)), height);
    list.AddRectFilled(at, {at.x + filled, at.y + height},
                       packed(done >= 1.0 ? ui.theme.good : ui.theme.accent), round);
  }
  ImGui::Dummy({width, ui.px(16)});
}

int Ui::walker() const noexcept {
  if (in.frame.walker_count <= 0) return -1;
  return state.walker >= 0 && state.walker < in.frame.walker_count ? state.walker : 0;
}

std::span<const WalkerFrame> Ui::selected() const noexcept {
  const int first = walker();
  if (first < 0) return {};
  const bool is_one = state.walker >= 0;
  return std::span(in.frame.walkers)
      .subspan(static_cast<std::size_t>(first),
               is_one ? 1 : static_cast<std::size_t>(in.frame.walker_count));
}

void clear_items() {
  items.clear();
  cut.clear();
  drawn.clear();
  focusable.clear();
}

void keep_area(std::string_view name, const ImVec2& min, const ImVec2& max) {
  ImRect clip = ImGui::GetCurrentWindow()->Rect();
  clip.ClipWithFull(ImRect({0.0f, 0.0f}, ImGui::GetIO().DisplaySize));
  keep(name, min, max, clip);
}

void keep_item(std::string_view name, const ImVec2& min, const ImVec2& max) {
  keep(name, min, max, ImGui::GetCurrentWindow()->ClipRect);
}

void keep_item(std::string_view name) {
  keep_item(name, ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
}

const std::vector<UiItem>& ui_items() noexcept { return items; }
const std::vector<std::string>& drawn_texts() noexcept { return drawn; }
const std::vector<std::string>& cut_texts() noexcept { return cut; }

bool is_focused(Ui& ui, std::string_view name) {
  ImGuiWindow& window = *ImGui::GetCurrentWindow();
  const bool is_in_menu = (window.Flags & ImGuiWindowFlags_Popup) != 0;
  // Items behind an open box or menu cannot be focused.
  const bool is_behind = (window.RootWindow->Flags & ImGuiWindowFlags_NoMouseInputs) != 0;
  if (is_behind || is_menu_open() != is_in_menu) return false;
  focusable.emplace_back(name);
  if (ui.state.memory.focus != name) return false;
  const ImVec2 min = ImGui::GetItemRectMin(), max = ImGui::GetItemRectMax();
  const float out = ui.px(2);
  window.DrawList->AddRect({min.x - out, min.y - out}, {max.x + out, max.y + out},
                           packed(ui.theme.left), ui.px(6), 0, ui.px(2));
  if (!window.InnerRect.Contains(ImRect(min, max)) && ui.state.memory.is_focus_new)
    ImGui::SetScrollHereY(0.5f);
  return true;
}

bool is_typed(const Ui& ui, SDL_Keycode key) {
  if (key == SDLK_RETURN && !ui.state.memory.focus.empty()) return false;
  return std::ranges::count(ui.in.keys, key) > 0;
}

void move_focus(const UiInput& input, UiMemory& memory) {
  memory.is_focus_new = false;
  const int steps = input.navigation.steps;
  if (focusable.empty() || (memory.focus.empty() && steps == 0)) return;
  const auto at = std::ranges::find(focusable, memory.focus);
  const auto count = static_cast<std::ptrdiff_t>(focusable.size());
  std::ptrdiff_t next = at - focusable.begin() + steps;
  if (at == focusable.end()) next = steps < 0 ? count - 1 : 0;
  std::string wanted = focusable[static_cast<std::size_t>(((next % count) + count) % count)];
  memory.is_focus_new = wanted != memory.focus;
  memory.focus = std::move(wanted);
}

namespace {

// True if the pointer rests on the last widget.
bool is_rested_on() {
  if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled) || ImGui::IsItemActive())
    return false;
  return ImGui::GetCurrentContext()->HoveredIdTimer >= kRest_s;
}

// Draws a card with the text at the pointer.
void draw_tip(Ui& ui, std::string_view text) {
  if (text.empty()) return;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{ui.px(10), ui.px(7)});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{0.0f, ui.px(2)});
  ImGui::BeginTooltip();
  for (const std::string& line : text_lines(ui.fonts.small, text, ui.px(kTipPixels), 4)) {
    const float width = std::min(text_width(ui.fonts.small, line) + 1.0f, ui.px(kTipPixels));
    text_line(ui, ui.fonts.small, ui.theme.text, line, width);
  }
  ImGui::EndTooltip();
  ImGui::PopStyleVar(2);
}

}  // namespace

void show_tip(Ui& ui, std::string_view text) {
  if (is_rested_on()) draw_tip(ui, text);
}

void explain(Ui& ui, std::string_view item) {
  if (is_rested_on()) draw_tip(ui, tooltip_of(item));
}

void keep_picture(Ui& ui, std::string_view name, const ImVec2& min, const ImVec2& max) {
  keep_item(name, min, max);
  const ImGuiIO& io = ImGui::GetIO();
  // A picture has no ImGui id and so no hover time: explain it while the mouse is still.
  const bool is_still = io.MouseDelta.x == 0.0f && io.MouseDelta.y == 0.0f && !io.MouseDown[0];
  if (is_still && ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(min, max))
    draw_tip(ui, tooltip_of(name));
}

void draw_icon(ImDrawList& list, Icon icon, const ImVec2& m, float r, ImU32 colour) {
  switch (icon) {
    case Icon::none:
      return;
    case Icon::play:
      list.AddTriangleFilled({m.x - 0.7f * r, m.y - r}, {m.x + r, m.y}, {m.x - 0.7f * r, m.y + r},
                             colour);
      return;
    case Icon::pause:
      list.AddRectFilled({m.x - 0.8f * r, m.y - r}, {m.x - 0.2f * r, m.y + r}, colour);
      list.AddRectFilled({m.x + 0.2f * r, m.y - r}, {m.x + 0.8f * r, m.y + r}, colour);
      return;
    case Icon::record:
      list.AddCircleFilled(m, r, colour, 16);
      return;
    case Icon::stop:
      list.AddRectFilled({m.x - 0.8f * r, m.y - 0.8f * r}, {m.x + 0.8f * r, m.y + 0.8f * r},
                         colour);
      return;
    case Icon::close:
      list.AddLine({m.x - r, m.y - r}, {m.x + r, m.y + r}, colour, 0.32f * r + 0.5f);
      list.AddLine({m.x - r, m.y + r}, {m.x + r, m.y - r}, colour, 0.32f * r + 0.5f);
      return;
    case Icon::to_begin:
      list.AddRectFilled({m.x - r, m.y - r}, {m.x - 0.6f * r, m.y + r}, colour);
      list.AddTriangleFilled({m.x + r, m.y - r}, {m.x - 0.5f * r, m.y}, {m.x + r, m.y + r}, colour);
      return;
    case Icon::step:
      list.AddTriangleFilled({m.x - r, m.y - r}, {m.x + 0.5f * r, m.y}, {m.x - r, m.y + r}, colour);
      list.AddRectFilled({m.x + 0.6f * r, m.y - r}, {m.x + r, m.y + r}, colour);
      return;
    case Icon::loop:
      list.PathArcTo(m, 0.85f * r, 0.6f, 5.6f, 16);
      list.PathStroke(colour, 0, 0.3f * r);
      list.AddTriangleFilled({m.x + 0.3f * r, m.y - 0.5f * r}, {m.x + 1.2f * r, m.y - 0.7f * r},
                             {m.x + 0.8f * r, m.y + 0.2f * r}, colour);
      return;
  }
}

float button_width(const Ui& ui, std::string_view label, const ButtonLook& look) {
  if (look.width > 0.0f) return look.width;
  float width = text_width(ui.fonts.body, label) + ui.px(20);
  if (look.icon != Icon::none) width += label.empty() ? ui.px(8) : ui.px(16);
  if (look.dot) width += ui.px(14);
  return std::ceil(width);
}

bool button(Ui& ui, std::string_view id, std::string_view label, const ButtonLook& look) {
  const float height = look.height > 0.0f ? look.height : std::round(ui.px(26));
  ImGui::PushID(id.data(), id.data() + id.size());
  ImGui::BeginDisabled(!look.is_enabled);
  const bool is_pressed = ImGui::InvisibleButton("b", {button_width(ui, label, look), height});
  ImGui::EndDisabled();
  ImGui::PopID();
  if (look.is_enabled) keep_item(id);
  const ImVec2 min = ImGui::GetItemRectMin(), max = ImGui::GetItemRectMax();
  draw_button_back(ui, min, max, look);
  draw_button_face(ui, min, max, label, look);
  const bool is_reached = look.is_enabled && is_focused(ui, id);
  explain(ui, id);
  return is_pressed || (is_reached && ui.in.navigation.press);
}

void send(Ui& ui, std::string_view verb, std::string_view rest) {
  if (ui.state.walker >= 0) {
    ui.out.commands.push_back(fmt::format("{} {} {}", verb, ui.state.walker + 1, rest));
  } else {
    ui.out.commands.push_back(fmt::format("{} {}", verb, rest));
  }
}

void send(Ui& ui, std::string_view verb, std::string_view key, double value) {
  send(ui, verb, fmt::format("{} {}", key, value));
}

Colour walker_colour(const Ui& ui, int walker) {
  return series_colour(ui.theme, static_cast<std::size_t>(std::max(walker, 0)));
}

std::string style_name(const Ui& ui, int style_index) {
  const auto& styles = ui.in.cast.styles;
  if (style_index < 0 || style_index >= static_cast<int>(styles.size())) return "?";
  return styles[static_cast<std::size_t>(style_index)];
}

std::string walker_name(const Ui& ui, int walker) {
  if (walker < 0 || walker >= ui.in.frame.walker_count) return "nobody";
  const WalkerFrame& frame = ui.in.frame.walkers[static_cast<std::size_t>(walker)];
  return fmt::format("{} {}", walker + 1, style_name(ui, frame.style_index));
}

bool slider(Ui& ui, std::string_view id, double& value, const SliderLook& look) {
  const float width = look.width > 0.0f ? look.width : ImGui::GetContentRegionAvail().x;
  if (!std::isfinite(value)) value = look.min;
  ImGui::PushID(id.data(), id.data() + id.size());
  ImGui::BeginDisabled(!look.is_enabled);
  ImGui::InvisibleButton("s", {std::max(width, ui.px(20)), std::round(ui.px(19))});
  const bool is_held = ImGui::IsItemActive();
  const bool is_taken = ImGui::IsItemActivated();
  ImGui::EndDisabled();
  ImGui::PopID();
  if (look.is_enabled) keep_item(id);
  const ImVec2 min = ImGui::GetItemRectMin(), max = ImGui::GetItemRectMax();
  double& held = ui.state.memory.held;  // the value that was last requested in this drag
  if (is_taken) held = look.is_mixed ? std::numeric_limits<double>::quiet_NaN() : value;
  bool is_moved = false;
  if (is_held && look.max > look.min) {
    const double wanted = value_under_mouse(ui, min.x, max.x, look);
    is_moved = wanted != held;
    held = value = wanted;
  }
  const bool is_reached = look.is_enabled && is_focused(ui, id);
  if (is_reached && ui.in.navigation.sideways != 0 && look.max > look.min) {
    constexpr double kKeySteps = 40.0;  // key presses that move a slider from end to end
    const double unit = std::pow(10.0, look.decimals);
    const double step = std::max((look.max - look.min) / kKeySteps, 1.0 / unit);
    const double wanted = std::round((value + ui.in.navigation.sideways * step) * unit) / unit;
    value = std::clamp(wanted, look.min, look.max);
    is_moved = true;
  }
  draw_slider(ui, min, max, value, look);
  explain(ui, id);
  return is_moved;
}

std::optional<double> pending_value(Ui& ui, const std::string& name, std::optional<double> value) {
  auto& pending = ui.state.memory.pending;
  const std::int64_t now = ui.in.frame.tick;
  std::erase_if(pending, [&](const UiMemory::PendingValue& w) {
    return now < w.tick || now > w.tick + kPendingTicks ||
           (w.name == name && w.walker == ui.state.walker && w.value == value && now > w.tick);
  });
  for (const UiMemory::PendingValue& w : pending) {
    if (w.name == name && w.walker == ui.state.walker) return w.value;
  }
  return value;
}

void remember_pending(Ui& ui, const std::string& name, double value) {
  auto& pending = ui.state.memory.pending;
  std::erase_if(pending, [&](const UiMemory::PendingValue& w) {
    return w.name == name && w.walker == ui.state.walker;
  });
  pending.push_back({name, ui.state.walker, value, ui.in.frame.tick});
}

void forget_pending(Ui& ui, const std::string& name) {
  std::erase_if(ui.state.memory.pending,
                [&](const UiMemory::PendingValue& w) { return name.empty() || w.name == name; });
}

void open_menu(const char* name) {
  const ImVec2 place(ImGui::GetItemRectMin().x, ImGui::GetItemRectMax().y);
  ImGui::OpenPopup(name);
  // Dear ImGui opens it at the pointer, where it hides the button. It still keeps it in the window.
  ImGui::GetCurrentContext()->OpenPopupStack.back().OpenPopupPos = place;
}

bool is_menu_open() noexcept { return ImGui::GetCurrentContext()->OpenPopupStack.Size > 0; }

void close_menus() noexcept {
  if (is_menu_open()) ImGui::ClosePopupToLevel(0, false);
}

ImVec2 begin_modal(Ui& ui, const char* id, double width, double height, const ImVec2& window_px) {
  const float room = ui.px(kRoom);
  const ImVec2 size(std::min(ui.px(width), std::max(window_px.x - room, room)),
                    std::min(ui.px(height), std::max(window_px.y - room, room)));
  const float middle = (window_px.y - size.y) / 2, lowest = window_px.y - size.y - room / 2;
  const float top = std::max(middle, std::min(ui.px(kMessages), lowest));
  const ImVec2 at(std::round((window_px.x - size.x) / 2), std::round(top));
  const ImVec2 end(at.x + size.x, at.y + size.y);
  ImGui::SetNextWindowPos(at);
  ImGui::SetNextWindowSize(size);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(ui.px(20), ui.px(16)));
  ImGui::Begin(id, nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
  if (ImGui::IsWindowAppearing()) ImGui::SetWindowFocus();
  // Draw in this window: a separate one would take the focus from a text field.
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRectFullScreen();
  const Colour veil = with_alpha(ui.theme.window, kVeil);
  list.AddRectFilled(ImVec2(0, 0), window_px, packed(veil));
  list.AddRectFilled(at, end, packed(ui.theme.panel), ui.px(8));
  list.AddRect(at, end, packed(ui.theme.border), ui.px(8), 0, ui.px(1));
  list.PopClipRect();
  keep_item(fmt::format("area {}", id), at, end);
  return size;
}

void end_modal() {
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace gaitpad
