#include "view/plot.h"

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace gaitpad {
namespace {

constexpr double kLeftGutterPixels = 30.0, kRightGutterPixels = 14.0, kTickRowPixels = 14.0;
constexpr float kTolerancePixels = 0.15f;  // a difference that is invisible at any scale
constexpr double kTickSpacePixels = 18.0, kTickWidthPixels = 46.0;

// The part of a plot's box that holds the curves.
struct PlotArea {
  ImVec2 min, max;
  PlotRange x, y;
  float width() const noexcept { return max.x - min.x; }
  float height() const noexcept { return max.y - min.y; }
  float px(double value) const noexcept {
    const double share = (value - x.min) / (x.max - x.min);
    return min.x + static_cast<float>(std::clamp(share, -0.1, 1.1)) * width();
  }
  float py(double value) const noexcept {
    const double share = (value - y.min) / (y.max - y.min);
    return max.y - static_cast<float>(std::clamp(share, -0.1, 1.1)) * height();
  }
};

enum class TextPlace { left, centre, right };

float label_width(const PlotStyle& style, const std::string& text) {
  const ImFont* font = style.fonts->tick;
  return font->CalcTextSizeA(font->FontSize, FLT_MAX, 0.0f, text.data(), text.data() + text.size())
      .x;
}

void tick_label(ImDrawList& list, const PlotStyle& style, ImVec2 at, TextPlace place,
                const std::string& text, const Colour& colour) {
  const ImFont* font = style.fonts->tick;
  const float width = label_width(style, text);
  if (place == TextPlace::centre) at.x -= width / 2.0f;
  if (place == TextPlace::right) at.x -= width;
  list.AddText(font, font->FontSize, {std::floor(at.x), std::floor(at.y)}, packed(colour),
               text.data(), text.data() + text.size());
}

int y_steps(float height, float scale) {
  return std::max(1, static_cast<int>(height / (kTickSpacePixels * scale)));
}

// Width of the space left of the area, enough for the longest number.
float left_gutter(const Plot& plot, float height, const PlotStyle& style) {
  const int steps = y_steps(height, style.scale);
  float width = static_cast<float>(kLeftGutterPixels) * style.scale;
  for (const PlotTick& tick : plot_ticks(plot.y, steps)) {
    width = std::max(width, label_width(style, tick.text) + 6.0f * style.scale);
  }
  return std::ceil(width);
}

void draw_y_axis(ImDrawList& list, const PlotArea& area, const PlotStyle& style) {
  const int steps = y_steps(area.height(), style.scale);
  const float half = style.fonts->tick->FontSize / 2.0f;
  for (const PlotTick& tick : plot_ticks(area.y, steps)) {
    const float y = std::round(area.py(tick.value));
    list.AddLine({area.min.x, y}, {area.max.x, y},
                 packed(faint(style.theme->border, tick.value == 0.0 ? 1.0 : 0.6)));
    const float text_y = std::clamp(y - half, area.min.y - half * 0.5f, area.max.y - half * 1.5f);
    tick_label(list, style, {area.min.x - 5.0f * style.scale, text_y}, TextPlace::right, tick.text,
               style.theme->tick);
  }
}

void draw_x_axis(ImDrawList& list, const PlotArea& area, const PlotStyle& style, bool has_labels) {
  const int steps = std::max(1, static_cast<int>(area.width() / (kTickWidthPixels * style.scale)));
  for (const PlotTick& tick : plot_ticks(area.x, steps)) {
    const float x = std::round(area.px(tick.value));
    list.AddLine({x, area.min.y}, {x, area.max.y}, packed(faint(style.theme->border, 0.6)));
    if (!has_labels) continue;
    const float edge = 10.0f * style.scale;
    const float text_x = std::clamp(x, area.min.x + edge, area.max.x - edge * 0.2f);
    tick_label(list, style, {text_x, area.max.y + 2.0f * style.scale}, TextPlace::centre, tick.text,
               style.theme->tick);
  }
}

void draw_curve(ImDrawList& list, const PlotArea& area, const PlotSeries& series, float scale) {
  static thread_local std::vector<PlotPoint> shown;
  static thread_local std::vector<ImVec2> pixels;
  decimate(series.points, area.x, static_cast<int>(area.width()), shown);
  // ImGui draws lines of whole pixels with a texture, which takes a third of the triangles.
  const float width = std::max(1.0f, std::round(static_cast<float>(series.width_px) * scale));
  const auto flush = [&] {
    thin_out(pixels, kTolerancePixels);
    if (pixels.size() > 1) {
      list.AddPolyline(pixels.data(), static_cast<int>(pixels.size()), packed(series.colour), 0,
                       width);
    }
    pixels.clear();
  };
  pixels.clear();
  for (const PlotPoint& p : shown) {
    if (!std::isfinite(p.y)) {
      flush();
    } else {
      pixels.emplace_back(area.px(p.x), area.py(p.y));
    }
  }
  flush();
}

void draw_mark(ImDrawList& list, const PlotArea& area, const PlotMark& mark, float scale) {
  if (!std::isfinite(mark.place.x) || !std::isfinite(mark.place.y)) return;
  const ImVec2 p{area.px(mark.place.x), area.py(mark.place.y)};
  const float r = 3.6f * scale;
  const ImU32 colour = packed(mark.colour);
  switch (mark.shape) {
    case PlotMark::Shape::up:
      list.AddTriangleFilled({p.x - r, p.y + r}, {p.x + r, p.y + r}, {p.x, p.y - r}, colour);
      return;
    case PlotMark::Shape::down:
      list.AddTriangleFilled({p.x - r, p.y - r}, {p.x, p.y + r}, {p.x + r, p.y - r}, colour);
      return;
    case PlotMark::Shape::dot:
      list.AddCircleFilled(p, r, colour, 12);
      return;
  }
}

struct EndLabel {
  float y = 0.0f;
  const PlotSeries* series = nullptr;
};

// Draws letters at the curves' ends, moved apart to avoid overlaps; none if there is no room.
void draw_ends(ImDrawList& list, const PlotArea& area, const Plot& plot, const PlotStyle& style) {
  std::vector<EndLabel> ends;
  for (const PlotSeries& series : plot.series) {
    if (series.points.empty() || !std::isfinite(series.points.back().y)) continue;
    const PlotPoint& end = series.points.back();
    const ImVec2 p{area.px(end.x), std::clamp(area.py(end.y), area.min.y, area.max.y)};
    list.AddCircleFilled(p, 2.6f * style.scale, packed(series.colour), 12);
    ends.push_back({p.y, &series});
  }
  std::stable_sort(ends.begin(), ends.end(),
                   [](const EndLabel& a, const EndLabel& b) { return a.y < b.y; });
  constexpr float kClosest = 0.8f;  // least distance of two letters, in heights of a line
  const float line = style.fonts->tick->FontSize;
  const float height = std::min(line, area.height() / static_cast<float>(ends.size()));
  if (height < kClosest * line) return;
  const float bottom = area.max.y - line * 0.4f;
  for (std::size_t i = 1; i < ends.size(); ++i) {
    ends[i].y = std::max(ends[i].y, ends[i - 1].y + height);
  }
  for (std::size_t i = ends.size(); i-- > 0;) {
    const float limit = i + 1 < ends.size() ? ends[i + 1].y - height : bottom;
    ends[i].y = std::min(ends[i].y, limit);
  }
  for (const EndLabel& end : ends) {
    tick_label(list, style, {area.max.x + 5.0f * style.scale, end.y - line / 2.0f}, TextPlace::left,
               end.series->letter, faint(end.series->colour, 1.0));
  }
}

bool is_drawn(const Plot& plot) noexcept {
  return plot.x.max > plot.x.min && plot.y.max > plot.y.min &&
         std::any_of(plot.series.begin(), plot.series.end(),
                     [](const PlotSeries& s) { return s.points.size() > 1; });
}

void draw_nothing(ImDrawList& list, const PlotArea& area, const std::string& text,
                  const PlotStyle& style) {
  tick_label(list, style,
             {(area.min.x + area.max.x) / 2.0f,
              (area.min.y + area.max.y - style.fonts->tick->FontSize) / 2.0f},
             TextPlace::centre, text, style.theme->tick);
}

}  // namespace

// For each kept point, narrows the range of slopes of lines that pass all later points within the
// tolerance; the first point outside the range is kept next.
void thin_out(std::vector<ImVec2>& line, float tolerance) {
  if (line.size() < 3) return;
  std::size_t kept = 1;
  ImVec2 anchor = line[0];
  float low = -FLT_MAX, high = FLT_MAX;
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    const ImVec2 here = line[i], next = line[i + 1];
    const float dx = here.x - anchor.x, next_dx = next.x - anchor.x;
    if (dx > 0.0f) {
      low = std::max(low, (here.y - tolerance - anchor.y) / dx);
      high = std::min(high, (here.y + tolerance - anchor.y) / dx);
    }
    const float slope = next_dx > 0.0f ? (next.y - anchor.y) / next_dx : FLT_MAX;
    if (dx > 0.0f && slope >= low && slope <= high) continue;
    line[kept++] = anchor = here;
    low = -FLT_MAX;
    high = FLT_MAX;
  }
  line[kept++] = line.back();
  line.resize(kept);
}

void draw_plot(ImDrawList& list, const ImVec2& min, const ImVec2& max, const Plot& plot,
               const PlotStyle& style) {
  const float scale = style.scale;
  const float tick_row = plot.has_x_ticks ? static_cast<float>(kTickRowPixels) * scale : 0.0f;
  const PlotArea area{{min.x + left_gutter(plot, max.y - min.y - tick_row, style), min.y},
                      {max.x - static_cast<float>(kRightGutterPixels) * scale, max.y - tick_row},
                      plot.x,
                      plot.y};
  if (area.width() < 8.0f || area.height() < 8.0f) return;
  list.AddRectFilled(area.min, area.max, packed(style.theme->plot), 3.0f * scale);
  if (!is_drawn(plot)) return draw_nothing(list, area, plot.nothing, style);
  list.PushClipRect(area.min, area.max, true);
  for (const PlotBand& band : plot.bands) {
    list.AddRectFilled({area.px(band.from), area.min.y}, {area.px(band.to), area.max.y},
                       packed(band.colour));
  }
  list.PopClipRect();
  draw_y_axis(list, area, style);
  draw_x_axis(list, area, style, plot.has_x_ticks);
  list.PushClipRect(area.min, area.max, true);
  for (const PlotSeries& series : plot.series) draw_curve(list, area, series, scale);
  for (const PlotMark& mark : plot.marks) draw_mark(list, area, mark, scale);
  list.PopClipRect();
  draw_ends(list, area, plot, style);
}

void draw_spans(ImDrawList& list, const ImVec2& min, const ImVec2& max, const SpanPlot& plot,
                const PlotStyle& style) {
  const float scale = style.scale;
  const PlotArea area{{min.x + 46.0f * scale, min.y},
                      {max.x - static_cast<float>(kRightGutterPixels) * scale,
                       max.y - static_cast<float>(kTickRowPixels) * scale},
                      plot.x,
                      {}};
  if (plot.rows.empty() || area.width() < 8.0f || area.height() < 8.0f) return;
  list.AddRectFilled(area.min, area.max, packed(style.theme->plot), 3.0f * scale);
  if (!(plot.x.max > plot.x.min)) return draw_nothing(list, area, "nothing yet", style);
  const float row = area.height() / static_cast<float>(plot.rows.size());
  const ImFont* font = style.fonts->tick;
  draw_x_axis(list, area, style, true);
  for (std::size_t i = 0; i < plot.rows.size(); ++i) {
    const float top = area.min.y + row * static_cast<float>(i);
    const float text_y = top + (row - font->FontSize) / 2.0f;
    tick_label(list, style, {area.min.x - 5.0f * scale, text_y}, TextPlace::right,
               plot.rows[i].label, style.theme->tick);
    for (const SpanRow::Part& part : plot.rows[i].parts) {
      const float from = std::max(area.px(part.from), area.min.x);
      const float to = std::min(area.px(part.to), area.max.x);
      if (!(to > from)) continue;
      list.AddRectFilled({from, top + 2.0f * scale}, {to, top + row - 2.0f * scale},
                         packed(part.colour), 2.0f * scale);
      const float width = label_width(style, part.letter);
      if (part.letter.empty() || width + 4.0f * scale > to - from) continue;
      tick_label(list, style, {(from + to) / 2.0f, text_y}, TextPlace::centre, part.letter,
                 style.theme->text);
    }
  }
}

}  // namespace gaitpad
