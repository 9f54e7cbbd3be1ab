#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "view/panel_pad_plane.h"
#include "view/panels.h"

namespace gaitpad {
namespace {

constexpr std::size_t kTrailPlaces = 40;
constexpr double kWaitStep_ms = 0.25;  // of LiveStatus::wait_counts
constexpr std::array<std::string_view, 9> kHatNames = {
    "D-pad up",         "D-pad up right", "D-pad right",
    "D-pad down right", "D-pad down",     "D-pad down left",
    "D-pad left",       "D-pad up left",  ""};

UiMemory::StickPlace place_of(const SessionFrame& frame) {
  const PadState& pad = frame.pad.state;
  const Calibration& c = frame.pad.calibration;
  UiMemory::StickPlace place;
  place.raw[kLeftSide] = in_frame(c.left.frame, {pad.axis[kLeftX], pad.axis[kLeftY]});
  place.raw[kRightSide] = in_frame(c.right.frame, {pad.axis[kRightX], pad.axis[kRightY]});
  place.calibrated = {frame.stick.left, frame.stick.right};
  return place;
}

void keep_trail(Ui& ui) {
  UiMemory& memory = ui.state.memory;
  const std::int64_t tick = ui.in.frame.tick;
  if (tick == memory.stick_tick) return;
  if (tick < memory.stick_tick) memory.stick_trail.clear();
  memory.stick_tick = tick;
  memory.stick_trail.push_back(place_of(ui.in.frame));
  if (memory.stick_trail.size() > kTrailPlaces) {
    memory.stick_trail.erase(memory.stick_trail.begin());
  }
}

void draw_name(Ui& ui) {
  const PadFrame& pad = ui.in.frame.pad;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const bool is_there = pad.is_present && !ui.in.pad_name.empty();
  const std::string rate =
      ui.in.pad_rate_hz > 0.0 ? fmt::format("{:.0f} reports/s", ui.in.pad_rate_hz) : "";
  const float rate_width = text_width(ui.fonts.small, rate);
  std::string name = is_there ? ui.in.pad_name : "no pad: the keyboard walks";
  if (!is_there && !ui.in.pad_name.empty()) name = "unplugged: " + ui.in.pad_name;
  list.AddCircleFilled({at.x + ui.px(4), at.y + ui.px(8)}, ui.px(4),
                       packed(is_there ? ui.theme.good : ui.theme.secondary), 16);
  put_text(list, ui.fonts.small, ui.theme.text, {at.x + ui.px(14), at.y + ui.px(1)}, name,
           width - rate_width - ui.px(20));
  put_text(list, ui.fonts.small, ui.theme.secondary, {at.x + width - rate_width, at.y + ui.px(1)},
           rate, rate_width + 1.0f);
  ImGui::Dummy({width, ui.px(15)});
}

std::string signed_pair(const vec2& v) {
  const auto number = [](double value) {
    return std::isfinite(value) ? fmt::format("{:+.2f}", value) : std::string("-");
  };
  return number(v.x) + "  " + number(v.y);
}

void draw_sticks(Ui& ui) {
  const float width = ImGui::GetContentRegionAvail().x;
  const float side = std::floor(std::min((width - ui.px(10)) / 2.0f, ui.px(106)));
  const float gap = width - 2.0f * side;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const Calibration& c = ui.in.frame.pad.calibration;
  const UiMemory::StickPlace place = place_of(ui.in.frame);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (const Side s : {kLeftSide, kRightSide}) {
    const ImVec2 min{at.x + static_cast<float>(s) * (side + gap), at.y};
    draw_stick_plane(ui, min, side, s, s == kLeftSide ? c.left : c.right);
    const float y = min.y + side + ui.px(3), line = ui.fonts.tick->FontSize + ui.px(2);
    const float label = ui.px(34);
    put_text(list, ui.fonts.tick, ui.theme.tick, {min.x, y}, "raw", label);
    put_text(list, ui.fonts.tick, ui.theme.secondary, {min.x + label, y}, signed_pair(place.raw[s]),
             side - label);
    put_text(list, ui.fonts.tick, ui.theme.tick, {min.x, y + line}, "stick", label);
    put_text(list, ui.fonts.tick, ui.theme.text, {min.x + label, y + line},
             signed_pair(place.calibrated[s]), side - label);
  }
  ImGui::Dummy({width, side + ui.px(6) + 2.0f * (ui.fonts.tick->FontSize + ui.px(2))});
}

void draw_trigger(Ui& ui, const ImVec2& at, float width, std::string_view label, double value) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const double share = std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : 0.0;
  const float label_width = ui.px(40), height = ui.px(7), number = ui.px(26);
  put_text(list, ui.fonts.tick, ui.theme.tick, at, label, label_width);
  const ImVec2 min{at.x + label_width, at.y + ui.px(3)};
  const float room = width - label_width - number;
  list.AddRectFilled(min, {min.x + room, min.y + height}, packed(ui.theme.frame), height / 2.0f);
  if (share > 0.0) {
    list.AddRectFilled(min,
                       {min.x + std::max(height, room * static_cast<float>(share)), min.y + height},
                       packed(ui.theme.left), height / 2.0f);
  }
  put_text(list, ui.fonts.tick, ui.theme.secondary, {at.x + width - number + ui.px(4), at.y},
           fmt::format("{:.2f}", share), number);
}

void draw_triggers(Ui& ui) {
  const PadFrame& pad = ui.in.frame.pad;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float gap = ui.px(10), width = ImGui::GetContentRegionAvail().x;
  const float half = (width - gap) / 2.0f;
  draw_trigger(ui, at, half, "L trigger",
               trigger_position(pad.calibration.left_trigger, pad.state.axis[kLeftTrigger]));
  draw_trigger(ui, {at.x + half + gap, at.y}, half, "R trigger",
               trigger_position(pad.calibration.right_trigger, pad.state.axis[kRightTrigger]));
  ImGui::Dummy({width, ui.px(13)});
}

std::string pressed_names(const PadState& pad) {
  std::string names;
  const auto add = [&names](std::string_view name) {
    if (name.empty()) return;
    if (!names.empty()) names += ", ";
    names += name;
  };
  for (int i = 0; i < kButtonCount; ++i) {
    const auto b = static_cast<PadButton>(i);
    if (pressed(pad, b)) add(button_label(b));
  }
  const bool is_told = pressed(pad, kButtonDpadUp) || pressed(pad, kButtonDpadDown) ||
                       pressed(pad, kButtonDpadLeft) || pressed(pad, kButtonDpadRight);
  if (!is_told) add(kHatNames[std::min<std::size_t>(static_cast<std::size_t>(pad.hat), 8)]);
  return names;
}

void draw_waits(Ui& ui) {
  const LiveStatus& status = *ui.in.status;
  const auto& counts = status.wait_counts;
  const std::int64_t most =
      std::max<std::int64_t>(*std::max_element(counts.begin(), counts.end()), 1);
  value_row(ui, "from report to tick",
            fmt::format("median {:.1f}, most {:.1f} ms", status.wait_us_median / 1000.0,
                        status.wait_us_max / 1000.0));
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = std::round(ui.px(28));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, {at.x + width, at.y + height}, packed(ui.theme.plot), ui.px(3));
  const float bar = width / static_cast<float>(counts.size());
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] <= 0) continue;
    const float share = static_cast<float>(counts[i]) / static_cast<float>(most);
    const float x = at.x + bar * static_cast<float>(i);
    const float top = at.y + height - std::max(share * (height - ui.px(3)), 1.0f);
    list.AddRectFilled({x + 0.5f, top}, {x + bar - 0.5f, at.y + height}, packed(ui.theme.left));
  }
  const double end_ms = kWaitStep_ms * static_cast<double>(counts.size() - 1);
  const float y = at.y + height + ui.px(2);
  const std::string last = fmt::format("{:g} ms and more", end_ms);
  const float last_width = text_width(ui.fonts.tick, last);
  put_text(list, ui.fonts.tick, ui.theme.tick, {at.x, y}, "0 ms", width);
  put_text(list, ui.fonts.tick, ui.theme.tick, {at.x + width - last_width, y}, last, width);
  ImGui::Dummy({width, height + ui.px(13)});
}

}  // namespace

void draw_pad_panel(Ui& ui) {
  keep_trail(ui);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{ui.px(8), ui.px(4)});
  draw_name(ui);
  draw_sticks(ui);
  draw_triggers(ui);
  const std::string names = pressed_names(ui.in.frame.pad.state);
  value_row(ui, "pressed", names.empty() ? "nothing" : names);
  if (ui.in.status != nullptr) draw_waits(ui);
  ImGui::PopStyleVar();
}

}  // namespace gaitpad
