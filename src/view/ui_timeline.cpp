#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "view/ui_bars.h"

namespace gaitpad {
namespace {

constexpr std::array<double, 5> kPaces = {0.1, 0.25, 0.5, 1.0, 2.0};
constexpr float kFullWidth = 980.0f;  // at scale 1; below it two rows and one button for the pace

constexpr float kTrackWithSeconds = 28.0f;

std::string clock_text(double seconds) {
  const auto ms = static_cast<std::int64_t>(std::max(seconds, 0.0) * 1000.0 + 0.5);
  return fmt::format("{:02d}:{:02d}.{:03d}", ms / 60000, ms / 1000 % 60, ms % 1000);
}

double seconds_of(const Ui& ui, std::int64_t tick) {
  return static_cast<double>(tick) / std::max(ui.in.cast.rate_hz, 1);
}

std::int64_t last_tick(const UiTimeline& timeline) {
  return std::max<std::int64_t>(timeline.ticks - 1, 0);
}

struct Track {
  UiRect rect;  // window pixels; the line lies in its middle
  std::int64_t last = 0;
  float x_of(std::int64_t tick) const noexcept {
    const double share = last > 0 ? static_cast<double>(tick) / static_cast<double>(last) : 0.0;
    return rect.x + static_cast<float>(std::clamp(share, 0.0, 1.0)) * rect.width;
  }
  std::int64_t tick_at(float x) const noexcept {
    const double share = rect.width > 0.0f ? (x - rect.x) / rect.width : 0.0;
    return std::llround(std::clamp(share, 0.0, 1.0) * static_cast<double>(last));
  }
};

void draw_seconds(Ui& ui, const Track& track) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const double end_s = seconds_of(ui, track.last);
  const int steps = static_cast<int>(track.rect.width / ui.px(80));
  const double step = nice_step(end_s, std::max(steps, 1));
  for (const double s : nice_ticks(0.0, end_s, std::max(steps, 1))) {
    const float x = track.x_of(std::llround(s * ui.in.cast.rate_hz));
    const std::string text = tick_text(s, step) + " s";
    const float width = text_width(ui.fonts.tick, text);
    const float left = std::clamp(x - width / 2.0f, track.rect.x - ui.px(4),
                                  track.rect.x + track.rect.width - width + ui.px(4));
    put_text(list, ui.fonts.tick, ui.theme.tick, {left, track.rect.y - ui.px(7)}, text,
             width + 1.0f);
    list.AddLine({x, track.rect.y + ui.px(7)}, {x, track.rect.y + ui.px(12)},
                 packed(ui.theme.tick));
  }
}

// Below the line; their words where the mouse is.
void draw_marks(Ui& ui, const Track& track, float y) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const float r = ui.px(4.5);
  const PlaybackMark* pointed = nullptr;
  float last_x = -1e9f;
  for (const PlaybackMark& mark : ui.in.timeline->marks) {
    const float x = track.x_of(mark.tick);
    if (std::abs(mouse.x - x) <= r * 1.5f && std::abs(mouse.y - (y + r * 1.6f)) <= r * 2.0f) {
      pointed = &mark;
    }
    if (x - last_x < 1.0f) continue;  // a thousand marks in one place are one
    last_x = x;
    list.AddTriangleFilled({x - r, y + 2.6f * r}, {x + r, y + 2.6f * r}, {x, y + r},
                           packed(ui.theme.warning));
  }
  if (pointed == nullptr || ui.in.is_modal) return;
  ImGui::BeginTooltip();
  const std::string text =
      fmt::format("{}  {}", clock_text(seconds_of(ui, pointed->tick)), pointed->text);
  text_line(ui, ui.fonts.small, ui.theme.text, text,
            std::min(ui.px(360), text_width(ui.fonts.small, drawable(text)) + 1.0f));
  ImGui::EndTooltip();
}

void draw_track(Ui& ui, const UiRect& rect) {
  const UiTimeline& timeline = *ui.in.timeline;
  const Track track{rect, last_tick(timeline)};
  const float reach = ui.px(8);
  ImGui::SetCursorScreenPos({rect.x - reach, rect.y});
  ImGui::InvisibleButton("timeline", {rect.width + 2.0f * reach, rect.height});
  keep_item("timeline");
  std::int64_t shown = timeline.tick;
  if (ImGui::IsItemActive() && track.last > 0) {
    shown = track.tick_at(ImGui::GetIO().MousePos.x);
    if (shown != timeline.tick) ui.out.seek_tick = shown;
  }
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float y = std::round(rect.y + rect.height / 2.0f), half = ui.px(3);
  if (rect.height >= ui.px(kTrackWithSeconds)) draw_seconds(ui, track);
  list.AddRectFilled({rect.x, y - half}, {rect.x + rect.width, y + half}, packed(ui.theme.frame),
                     half);
  const float x = track.x_of(shown);
  list.AddRectFilled({rect.x, y - half}, {x, y + half}, packed(ui.theme.accent), half);
  draw_marks(ui, track, y);
  list.AddCircleFilled({x, y}, ui.px(7), packed(ui.theme.left), 20);
  list.AddCircleFilled({x, y}, ui.px(5), packed(rgb(0xffffff)), 20);
}

void icon_button(Ui& ui, std::string_view id, Icon icon, const ImVec2& at,
                 const ButtonLook& look = {}) {
  ButtonLook full = look;
  full.icon = icon;
  full.width = std::round(ui.px(30));
  ImGui::SetCursorScreenPos(at);
  if (!button(ui, id, "", full)) return;
  if (id == "to begin") ui.out.seek_tick = 0;
  if (id == "timeline play") ui.out.actions.push_back(Action::pause);
  if (id == "timeline step") ui.out.actions.push_back(Action::step);
  if (id == "loop") ui.out.is_looping = !ui.in.timeline->is_looping;
}

// Buttons and where it is; the x behind them.
float draw_transport(Ui& ui, float x, float y) {
  const UiTimeline& timeline = *ui.in.timeline;
  ButtonLook primary;
  primary.is_primary = true;
  icon_button(ui, "to begin", Icon::to_begin, {x, y});
  icon_button(ui, "timeline play", timeline.pace > 0.0 ? Icon::pause : Icon::play,
              {x + ui.px(36), y}, primary);
  icon_button(ui, "timeline step", Icon::step, {x + ui.px(72), y});
  const float text_x = x + ui.px(114);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  put_text(list, ui.fonts.heading, ui.theme.text, {text_x, y - ui.px(4)},
           clock_text(seconds_of(ui, timeline.tick)), ui.px(96));
  const std::string place = fmt::format("tick {} / {}{}", timeline.tick, last_tick(timeline),
                                        timeline.is_computing ? " ..." : "");
  put_text(list, ui.fonts.small, ui.theme.secondary, {text_x, y + ui.px(14)}, place, ui.px(128));
  return text_x + ui.px(136);
}

std::string pace_text(double pace) { return fmt::format("{:g}x", pace); }

// The next in the list, for the one button of a narrow window.
double pace_after(double pace) {
  const auto next = std::upper_bound(kPaces.begin(), kPaces.end(), pace + 1e-9);
  return next == kPaces.end() ? kPaces.front() : *next;
}

void draw_paces(Ui& ui, float x, float y) {
  for (const double pace : kPaces) {
    ButtonLook look;
    look.width = std::round(ui.px(44));
    look.is_on = ui.in.timeline->pace == pace;
    ImGui::SetCursorScreenPos({x, y});
    if (button(ui, fmt::format("pace {:g}", pace), pace_text(pace), look)) ui.out.pace = pace;
    x += look.width + std::round(ui.px(4));
  }
}

}  // namespace

void draw_timeline(Ui& ui, const UiRect& rect) {
  if (rect.is_empty()) return;
  begin_area(ui, "timeline bar", rect, ui.theme.bar, {14.0f, 6.0f},
             ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  const bool is_full = rect.width >= ui.px(kFullWidth);
  const float y = rect.y + std::round(ui.px(is_full ? 19 : 7));
  const float left = draw_transport(ui, rect.x + ui.px(14), y);
  const float loop = std::round(ui.px(30));
  ButtonLook looping;
  looping.is_on = ui.in.timeline->is_looping;
  const float right = rect.x + rect.width - ui.px(14);
  if (is_full) {
    const float paces = ui.px(48) * static_cast<float>(kPaces.size());
    draw_paces(ui, right - paces, y);
    icon_button(ui, "loop", Icon::loop, {right - paces - loop - ui.px(8), y}, looping);
    const float end = right - paces - loop - ui.px(34);
    draw_track(ui, {left + ui.px(10), rect.y + ui.px(16), end - left - ui.px(10), ui.px(32)});
  } else {
    icon_button(ui, "loop", Icon::loop, {right - loop, y}, looping);
    ImGui::SetCursorScreenPos({right - loop - ui.px(60), y});
    ButtonLook look;
    look.width = std::round(ui.px(52));
    if (button(ui, "pace", pace_text(ui.in.timeline->pace), look)) {
      ui.out.pace = pace_after(ui.in.timeline->pace);
    }
    draw_track(ui, {rect.x + ui.px(22), rect.y + ui.px(38), rect.width - ui.px(44), ui.px(22)});
  }
  end_area();
}

}  // namespace gaitpad
