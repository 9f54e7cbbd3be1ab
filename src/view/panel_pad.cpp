#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "stick_picture/stick_picture.h"
#include "view/panels.h"
#include "view/widgets.h"

namespace gaitpad {
namespace {

constexpr double kHalfHeight = 1.15;  // half the plane's height, relative to half the logical range
constexpr int kCirclePoints = 40, kBandPoints = 12;
constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kLeastReach = 0.2;  // nearer to the centre no direction is drawn

struct StickPlane {
  ImVec2 min;
  float side = 0.0f;
  ImVec2 pixel(const vec2& p) const noexcept {
    const auto share = [](double v) {
      const double at = std::isfinite(v) ? v / kHalfHeight : 0.0;
      return static_cast<float>(std::clamp(at, -1.2, 1.2)) * 0.5f + 0.5f;
    };
    return {min.x + side * share(p.x), min.y + side * (1.0f - share(p.y))};
  }
};

// The edge of a round zone, in pixels.
std::array<ImVec2, kCirclePoints> zone_edge(const StickPlane& plane, const StickCalibration& c,
                                            double radius) {
  std::array<ImVec2, kCirclePoints> edge;
  for (int i = 0; i < kCirclePoints; ++i) {
    const double angle = kTurn * i / kCirclePoints;
    edge[static_cast<std::size_t>(i)] =
        plane.pixel(raw_of(c, vec2(std::cos(angle), std::sin(angle)) * radius));
  }
  return edge;
}

// Between the zones the stick points straight ahead if s sin(angle) <= sideways, with s = (r -
// inner) / (outer - inner).
void draw_sideways(ImDrawList& list, const StickPlane& plane, const StickCalibration& c,
                   ImU32 colour, float width) {
  if (c.shape != ZoneShape::both || !(c.sideways > 0.0) || c.sideways >= 1.0) return;
  const double least = std::asin(c.sideways);
  for (const vec2 sign : {vec2(1, 1), vec2(-1, 1), vec2(1, -1), vec2(-1, -1)}) {
    std::array<ImVec2, kBandPoints + 1> curve;
    for (int i = 0; i <= kBandPoints; ++i) {
      // More points near the inner zone, where the curve bends.
      const double share = 1.0 - std::pow(1.0 - static_cast<double>(i) / kBandPoints, 2.0);
      const double angle = kTurn / 4.0 + (least - kTurn / 4.0) * share;
      const double r = c.inner + (c.outer - c.inner) * c.sideways / std::sin(angle);
      curve[static_cast<std::size_t>(i)] =
          plane.pixel(raw_of(c, sign * vec2(std::sin(angle), std::cos(angle)) * r));
    }
    list.AddPolyline(curve.data(), kBandPoints + 1, colour, 0, width);
  }
}

void draw_zones(Ui& ui, ImDrawList& list, const StickPlane& plane, const StickCalibration& c) {
  const ImVec2 middle = plane.pixel({0.0, 0.0});
  const ImU32 grid = packed(ui.theme.border);
  list.AddLine({plane.min.x, middle.y}, {plane.min.x + plane.side, middle.y}, grid);
  list.AddLine({middle.x, plane.min.y}, {middle.x, plane.min.y + plane.side}, grid);
  const auto inner = zone_edge(plane, c, c.inner);
  list.AddConvexPolyFilled(inner.data(), kCirclePoints, packed(with_alpha(ui.theme.good, 0.22)));
  list.AddPolyline(inner.data(), kCirclePoints, packed(with_alpha(ui.theme.good, 0.9)),
                   ImDrawFlags_Closed, ui.px(1));
  const auto outer = zone_edge(plane, c, c.outer);
  list.AddPolyline(outer.data(), kCirclePoints, packed(with_alpha(ui.theme.secondary, 0.9)),
                   ImDrawFlags_Closed, ui.px(1.2));
  draw_sideways(list, plane, c, packed(with_alpha(ui.theme.secondary, 0.6)), ui.px(1));
}

void draw_trail(Ui& ui, ImDrawList& list, const StickPlane& plane, Side side) {
  const auto& trail = ui.state.memory.stick_trail;
  for (std::size_t i = 1; i < trail.size(); ++i) {
    const double age = static_cast<double>(i) / static_cast<double>(trail.size());
    list.AddLine(plane.pixel(trail[i - 1].raw[side]), plane.pixel(trail[i].raw[side]),
                 packed(with_alpha(ui.theme.right, 0.55 * age * age)), ui.px(1.4));
    list.AddLine(plane.pixel(trail[i - 1].calibrated[side]), plane.pixel(trail[i].calibrated[side]),
                 packed(with_alpha(ui.theme.left, 0.8 * age * age)), ui.px(1.8));
  }
}

// Draws the outline that was reached in the last ten seconds.
void draw_reached(Ui& ui, ImDrawList& list, const StickPlane& plane, Side side) {
  const ReachedOutline& reached = ui.state.memory.reached[side];
  const auto point = [&](std::size_t k) {
    const double angle = kTurn * static_cast<double>(k) / kCircularityBins;
    return plane.pixel(reached.radius(k) * vec2(std::cos(angle), std::sin(angle)));
  };
  for (std::size_t k = 0; k < kCircularityBins; ++k) {
    const std::size_t next = (k + 1) % kCircularityBins;
    if (std::min(reached.radius(k), reached.radius(next)) < kLeastReach) continue;
    list.AddLine(point(k), point(next), packed(with_alpha(ui.theme.warning, 0.9)), ui.px(1.4));
  }
}

// Draws a square plot of a stick over its zones; `min` is its upper left corner.
void draw_stick_plane(Ui& ui, const ImVec2& min, float side_px, Side side,
                      const StickCalibration& calibration) {
  const StickPlane plane{min, side_px};
  const ImVec2 max{min.x + side_px, min.y + side_px};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(min, max, packed(ui.theme.plot), ui.px(4));
  list.PushClipRect(min, max, true);
  draw_zones(ui, list, plane, calibration);
  draw_reached(ui, list, plane, side);
  draw_trail(ui, list, plane, side);
  const PadState& pad = ui.in.frame.pad.state;
  const vec2 raw =
      in_frame(calibration.frame, side == kLeftSide ? vec2(pad.axis[kLeftX], pad.axis[kLeftY])
                                                    : vec2(pad.axis[kRightX], pad.axis[kRightY]));
  const Stick& stick = ui.in.frame.stick;
  list.AddCircle(plane.pixel(raw), ui.px(4.5), packed(ui.theme.right), 20, ui.px(1.6));
  list.AddCircleFilled(plane.pixel(side == kLeftSide ? stick.left : stick.right), ui.px(3.6),
                       packed(ui.theme.left), 20);
  put_text(list, ui.fonts.tick, ui.theme.tick, {min.x + ui.px(5), min.y + ui.px(3)},
           side == kLeftSide ? "left" : "right", side_px);
  list.PopClipRect();
}

UiMemory::StickPlace place_of(const SessionFrame& frame) {
  const PadState& pad = frame.pad.state;
  const Calibration& c = frame.pad.calibration;
  UiMemory::StickPlace place;
  place.raw[kLeftSide] = in_frame(c.left.frame, {pad.axis[kLeftX], pad.axis[kLeftY]});
  place.raw[kRightSide] = in_frame(c.right.frame, {pad.axis[kRightX], pad.axis[kRightY]});
  place.calibrated = {frame.stick.left, frame.stick.right};
  return place;
}

// A picture of the pad: pressed buttons are lit, sticks lean, triggers fill. Positions are
// fractions of the picture's width, from its upper left corner.

struct PadSpot {
  PadButton button;
  float x, y, radius;
  std::string_view letter;
};
constexpr PadSpot kSpots[] = {
    {kButtonA, 0.735f, 0.250f, 0.026f, "A"},        {kButtonB, 0.790f, 0.195f, 0.026f, "B"},
    {kButtonX, 0.680f, 0.195f, 0.026f, "X"},        {kButtonY, 0.735f, 0.140f, 0.026f, "Y"},
    {kButtonBack, 0.425f, 0.165f, 0.018f, ""},      {kButtonGuide, 0.500f, 0.120f, 0.024f, ""},
    {kButtonStart, 0.575f, 0.165f, 0.018f, ""},     {kButtonDpadUp, 0.385f, 0.265f, 0.021f, ""},
    {kButtonDpadDown, 0.385f, 0.353f, 0.021f, ""},  {kButtonDpadLeft, 0.341f, 0.309f, 0.021f, ""},
    {kButtonDpadRight, 0.429f, 0.309f, 0.021f, ""}, {kButtonMisc1, 0.500f, 0.215f, 0.014f, ""},
    {kButtonTouchpad, 0.500f, 0.165f, 0.018f, ""},  {kButtonPaddle1, 0.640f, 0.425f, 0.016f, ""},
    {kButtonPaddle2, 0.360f, 0.425f, 0.016f, ""},   {kButtonPaddle3, 0.690f, 0.425f, 0.016f, ""},
    {kButtonPaddle4, 0.310f, 0.425f, 0.016f, ""},
};
constexpr float kPictureHeight = 0.47f;  // height as a fraction of the width
constexpr float kStickRadius = 0.062f;

// True for buttons that few pads have; they are drawn only while pressed.
bool is_rare(PadButton button) noexcept { return button > kButtonDpadRight; }

bool is_lit(const PadState& pad, PadButton button) noexcept {
  if (pressed(pad, button)) return true;
  // The hat's direction in eighths of a turn, clockwise from up; 8: none.
  const auto hat = static_cast<int>(pad.hat);
  switch (button) {
    case kButtonDpadUp:
      return hat == 7 || hat == 0 || hat == 1;
    case kButtonDpadRight:
      return hat >= 1 && hat <= 3;
    case kButtonDpadDown:
      return hat >= 3 && hat <= 5;
    case kButtonDpadLeft:
      return hat >= 5 && hat <= 7;
    default:
      return false;
  }
}

void draw_body(Ui& ui, ImDrawList& list, const ImVec2& at, float w) {
  const ImU32 body = packed(ui.theme.frame), edge = packed(ui.theme.edge);
  for (const float x : {0.24f, 0.76f})
    list.AddCircleFilled({at.x + x * w, at.y + 0.31f * w}, 0.145f * w, body, 32);
  list.AddRectFilled({at.x + 0.20f * w, at.y + 0.07f * w}, {at.x + 0.80f * w, at.y + 0.37f * w},
                     body, 0.10f * w);
  list.AddRectFilled({at.x + 0.30f * w, at.y + 0.30f * w}, {at.x + 0.70f * w, at.y + 0.40f * w},
                     body, 0.04f * w);
  list.AddLine({at.x + 0.30f * w, at.y + 0.07f * w}, {at.x + 0.70f * w, at.y + 0.07f * w}, edge);
}

// Draws the shoulder buttons, and the triggers above them, filled by their deflection.
void draw_shoulders(Ui& ui, ImDrawList& list, const ImVec2& at, float w) {
  const PadFrame& pad = ui.in.frame.pad;
  for (const Side side : {kLeftSide, kRightSide}) {
    const bool is_left_one = side == kLeftSide;
    const float x = at.x + (is_left_one ? 0.21f : 0.65f) * w, width = 0.14f * w;
    const bool is_on = pressed(pad.state, is_left_one ? kButtonLeftShoulder : kButtonRightShoulder);
    list.AddRectFilled({x, at.y + 0.045f * w}, {x + width, at.y + 0.068f * w},
                       packed(is_on ? ui.theme.left : ui.theme.frame), 0.01f * w);
    const double pull =
        is_left_one
            ? trigger_position(pad.calibration.left_trigger, pad.state.axis[kLeftTrigger])
            : trigger_position(pad.calibration.right_trigger, pad.state.axis[kRightTrigger]);
    const float share = std::isfinite(pull) ? static_cast<float>(std::clamp(pull, 0.0, 1.0)) : 0.0f;
    list.AddRectFilled({x, at.y}, {x + width, at.y + 0.036f * w}, packed(ui.theme.frame),
                       0.01f * w);
    if (share > 0.0f)
      list.AddRectFilled({x, at.y}, {x + width * share, at.y + 0.036f * w}, packed(ui.theme.left),
                         0.01f * w);
  }
}

// Draws the words of buttons that are too small for a letter, as most pads engrave them.
void draw_pad_words(Ui& ui, ImDrawList& list, const ImVec2& at, float w) {
  const auto word = [&](std::string_view text, float x, float y, float align) {
    const float width = text_width(ui.fonts.tick, text);
    put_text(list, ui.fonts.tick, ui.theme.secondary, {at.x + x * w - align * width, at.y + y * w},
             text, width + 1.0f);
  };
  const float line = ui.fonts.tick->FontSize / w;
  word("LT", 0.195f, 0.018f - 0.6f * line, 1.0f);
  word("LB", 0.195f, 0.056f - 0.4f * line, 1.0f);
  word("RT", 0.805f, 0.018f - 0.6f * line, 0.0f);
  word("RB", 0.805f, 0.056f - 0.4f * line, 0.0f);
  word("back", 0.425f, 0.190f, 0.5f);
  word("start", 0.575f, 0.190f, 0.5f);
}

void draw_leaning_stick(Ui& ui, ImDrawList& list, const ImVec2& middle, float w, const vec2& raw,
                        bool is_pressed) {
  const float r = kStickRadius * w;
  list.AddCircleFilled(middle, r, packed(ui.theme.plot), 28);
  const auto lean = [](double v) {
    return std::isfinite(v) ? static_cast<float>(std::clamp(v, -1.0, 1.0)) : 0.0f;
  };
  const ImVec2 cap{middle.x + 0.45f * r * lean(raw.x), middle.y - 0.45f * r * lean(raw.y)};
  const bool is_pushed = std::hypot(raw.x, raw.y) > 0.15;
  list.AddCircleFilled(cap, 0.62f * r, packed(is_pressed ? ui.theme.left : ui.theme.secondary), 24);
  if (is_pushed) list.AddCircle(cap, 0.62f * r, packed(ui.theme.left), 24, ui.px(1.8));
}

void draw_pad_picture(Ui& ui) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, w = std::min(width, ui.px(250));
  const ImVec2 corner{at.x + (width - w) / 2.0f, at.y};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const PadState& pad = ui.in.frame.pad.state;
  draw_body(ui, list, corner, w);
  draw_shoulders(ui, list, corner, w);
  draw_pad_words(ui, list, corner, w);
  const UiMemory::StickPlace place = place_of(ui.in.frame);
  draw_leaning_stick(ui, list, {corner.x + 0.265f * w, corner.y + 0.195f * w}, w,
                     place.raw[kLeftSide], pressed(pad, kButtonLeftStick));
  draw_leaning_stick(ui, list, {corner.x + 0.615f * w, corner.y + 0.309f * w}, w,
                     place.raw[kRightSide], pressed(pad, kButtonRightStick));
  for (const PadSpot& spot : kSpots) {
    const bool is_on = is_lit(pad, spot.button);
    if (!is_on && is_rare(spot.button)) continue;
    const ImVec2 middle{corner.x + spot.x * w, corner.y + spot.y * w};
    list.AddCircleFilled(middle, spot.radius * w, packed(is_on ? ui.theme.left : ui.theme.plot),
                         20);
    const float text = text_width(ui.fonts.tick, spot.letter);
    put_text(list, ui.fonts.tick, is_on ? ui.theme.plot : ui.theme.secondary,
             {middle.x - text / 2.0f, middle.y - ui.fonts.tick->FontSize / 2.0f}, spot.letter,
             text + 1.0f);
  }
  ImGui::Dummy({width, w * kPictureHeight});
  keep_picture(ui, "pad picture", corner, {corner.x + w, corner.y + w * kPictureHeight});
}

constexpr std::size_t kTrailPlaces = 40;
constexpr double kWaitStep_ms = 0.25;  // width of a bar of the histogram LiveStatus::wait_counts
constexpr std::array<std::string_view, 9> kHatNames = {
    "D-pad up",         "D-pad up right", "D-pad right",
    "D-pad down right", "D-pad down",     "D-pad down left",
    "D-pad left",       "D-pad up left",  ""};

void keep_trail(Ui& ui) {
  UiMemory& memory = ui.state.memory;
  const std::int64_t tick = ui.in.frame.tick;
  if (tick == memory.stick_tick) return;
  if (tick < memory.stick_tick) {
    memory.stick_trail.clear();
    memory.reached = {};
  }
  memory.stick_tick = tick;
  const UiMemory::StickPlace now = place_of(ui.in.frame);
  const UiMemory::StickPlace before = memory.stick_trail.empty() ? now : memory.stick_trail.back();
  for (const Side side : {kLeftSide, kRightSide})
    memory.reached[side].add(before.raw[side], now.raw[side], tick, ui.in.cast.rate_hz);
  memory.stick_trail.push_back(now);
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
  std::string name = is_there ? ui.in.pad_name : "no pad; W A S D walk";
  if (!is_there && !ui.in.pad_name.empty()) name = "unplugged: " + ui.in.pad_name;
  list.AddCircleFilled({at.x + ui.px(4), at.y + ui.px(8)}, ui.px(4),
                       packed(is_there ? ui.theme.good : ui.theme.secondary), 16);
  const float room = width - rate_width - ui.px(20);
  const float height = ui.px(15);
  float y = at.y;
  for (const std::string& line : text_lines(ui.fonts.small, name, room, 2)) {
    put_text(list, ui.fonts.small, ui.theme.text, {at.x + ui.px(14), y + ui.px(1)}, line, room);
    y += height;
  }
  put_text(list, ui.fonts.small, ui.theme.secondary, {at.x + width - rate_width, at.y + ui.px(1)},
           rate, rate_width + 1.0f);
  ImGui::Dummy({width, std::max(y - at.y, height)});
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
    keep_picture(ui, s == kLeftSide ? "pad stick left" : "pad stick right", min,
                 {min.x + side, min.y + side});
    const float y = min.y + side + ui.px(3), line = ui.fonts.tick->FontSize + ui.px(2);
    const float label = ui.px(34);
    put_text(list, ui.fonts.tick, ui.theme.tick, {min.x, y}, "raw", label);
    put_text(list, ui.fonts.tick, ui.theme.secondary, {min.x + label, y}, signed_pair(place.raw[s]),
             side - label);
    put_text(list, ui.fonts.tick, ui.theme.tick, {min.x, y + line}, "stick", label);
    put_text(list, ui.fonts.tick, ui.theme.text, {min.x + label, y + line},
             signed_pair(place.calibrated[s]), side - label);
    const auto error = ui.state.memory.reached[s].error();
    put_text(list, ui.fonts.tick, ui.theme.tick, {min.x, y + 2.0f * line}, "circle", label);
    put_text(list, ui.fonts.tick, error ? ui.theme.text : ui.theme.secondary,
             {min.x + label, y + 2.0f * line},
             error ? fmt::format("{:.1f} % off", *error) : "trace the rim", side - label);
  }
  ImGui::Dummy({width, side + ui.px(6) + 3.0f * (ui.fonts.tick->FontSize + ui.px(2))});
}

void draw_trigger(Ui& ui, const ImVec2& at, float width, std::string_view label, double value) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const double share = std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : 0.0;
  const float label_width = std::max(ui.px(40), text_width(ui.fonts.tick, label) + ui.px(4));
  const float height = ui.px(7), number = text_width(ui.fonts.tick, "0.00") + ui.px(4);
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
           fmt::format("{:.2f}", share), number - ui.px(3));
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
  value_row(ui, "report to tick, ms",
            fmt::format("median {:.1f}, most {:.1f}", status.wait_us_median / 1000.0,
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
  keep_picture(ui, "graph waits", at, {at.x + width, at.y + height});
}

}  // namespace

void draw_pad_panel(Ui& ui) {
  keep_trail(ui);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{ui.px(8), ui.px(4)});
  draw_name(ui);
  draw_pad_picture(ui);
  draw_sticks(ui);
  draw_triggers(ui);
  const std::string names = pressed_names(ui.in.frame.pad.state);
  value_row(ui, "pressed", names.empty() ? "nothing" : names);
  if (ui.in.can_rumble) {
    ButtonLook look;
    look.height = std::round(ui.px(22));
    look.width = ImGui::GetContentRegionAvail().x;
    if (button(ui, "rumble", "Test the rumble", look)) ui.out.rumbles = true;
  }
  if (ui.in.status != nullptr) draw_waits(ui);
  ImGui::PopStyleVar();
}

}  // namespace gaitpad
