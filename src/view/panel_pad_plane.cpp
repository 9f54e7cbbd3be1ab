#include "view/panel_pad_plane.h"

#include <array>
#include <cmath>
#include <numbers>

#include "view/stick_plot.h"

namespace gaitpad {
namespace {

constexpr double kHalfHeight = 1.15;  // of the plane, in fractions of the logical range
constexpr int kCirclePoints = 40, kBandPoints = 12;
constexpr double kTurn = 2.0 * std::numbers::pi;

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

// The edge of a round zone, in raw positions.
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

// Between the two zones the stick counts as straight ahead where its scaled deflection's sideways
// part is below the limit: s sin(angle) <= sideways with s = (r - inner) / (outer - inner).
void draw_sideways(ImDrawList& list, const StickPlane& plane, const StickCalibration& c,
                   ImU32 colour, float width) {
  if (c.shape != ZoneShape::both || !(c.sideways > 0.0) || c.sideways >= 1.0) return;
  const double least = std::asin(c.sideways);
  for (const vec2 sign : {vec2(1, 1), vec2(-1, 1), vec2(1, -1), vec2(-1, -1)}) {
    std::array<ImVec2, kBandPoints + 1> curve;
    for (int i = 0; i <= kBandPoints; ++i) {
      // Dense where it bends, near the inner zone.
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

}  // namespace

void draw_stick_plane(Ui& ui, const ImVec2& min, float side_px, Side side,
                      const StickCalibration& calibration) {
  const StickPlane plane{min, side_px};
  const ImVec2 max{min.x + side_px, min.y + side_px};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(min, max, packed(ui.theme.plot), ui.px(4));
  list.PushClipRect(min, max, true);
  draw_zones(ui, list, plane, calibration);
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

}  // namespace gaitpad
