// Draws plots (draw/plot.h) on ImGui's draw lists, always within their box.
#pragma once
#include <imgui.h>

#include <vector>

#include "draw/plot.h"
#include "view/gui.h"

namespace gaitpad {

// Removes points of a line, from left to right, that lie within `tolerance` pixels (vertically) of
// the straight line between the kept points. Each triangle costs time in a software rasterizer.
void thin_out(std::vector<ImVec2>& line, float tolerance);

struct PlotStyle {
  const Theme* theme = nullptr;
  const Fonts* fonts = nullptr;
  float scale = 1.0f;
};
// `min` to `max`: the whole box with its tick labels, in pixels.
void draw_plot(ImDrawList& list, const ImVec2& min, const ImVec2& max, const Plot& plot,
               const PlotStyle& style);

void draw_spans(ImDrawList& list, const ImVec2& min, const ImVec2& max, const SpanPlot& plot,
                const PlotStyle& style);

}  // namespace gaitpad
