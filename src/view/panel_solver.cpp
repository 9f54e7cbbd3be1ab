#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "view/graph_data.h"
#include "view/panels.h"

namespace gaitpad {
namespace {

// A table: name, then for each leg iterations and error; failures since the beginning.
struct Columns {
  float name, iterations, error, failures, width;
};
Columns columns_of(const Ui& ui, float width) {
  return {0.0f, std::round(width * 0.36f), std::round(width * 0.55f), std::round(width * 0.84f),
          width - ui.px(2)};
}

std::string pair_text(const std::array<std::string, 2>& legs) { return legs[0] + " | " + legs[1]; }

void draw_walker(Ui& ui, int index) {
  const WalkerFrame& walker = ui.in.frame.walkers[static_cast<std::size_t>(index)];
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  const Columns c = columns_of(ui, width);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImFont* font = ui.fonts.small;
  list.AddRectFilled({at.x, at.y + ui.px(1)}, {at.x + ui.px(3), at.y + ui.px(13)},
                     packed(walker_colour(ui, index)));
  put_text(list, font, ui.theme.text, {at.x + ui.px(8), at.y}, walker_name(ui, index),
           c.iterations - ui.px(14));
  std::array<std::string, 2> iterations, errors;
  bool is_failing = false;
  for (const Side side : {kLeftSide, kRightSide}) {
    iterations[side] = fmt::format("{}", walker.walk.ik_iterations[side]);
    errors[side] = fmt::format("{:.2f}", walker.walk.ik_error_m[side] * 1000.0);
    if (walker.walk.ik_failed[side]) errors[side] += "!";
    is_failing = is_failing || walker.walk.ik_failed[side];
  }
  put_text(list, font, ui.theme.text, {at.x + c.iterations, at.y}, pair_text(iterations),
           c.error - c.iterations - ui.px(4));
  put_text(list, font, is_failing ? ui.theme.warning : ui.theme.text, {at.x + c.error, at.y},
           pair_text(errors), c.failures - c.error - ui.px(4));
  put_text(list, font, walker.ik_failures > 0 ? ui.theme.warning : ui.theme.secondary,
           {at.x + c.failures, at.y}, fmt::format("{}", walker.ik_failures), c.width - c.failures);
  ImGui::Dummy({width, font->FontSize + ui.px(2)});
}

void draw_table(Ui& ui) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  const Columns c = columns_of(ui, width);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto head = [&](float x, float end, std::string_view text) {
    put_text(list, ui.fonts.tick, ui.theme.tick, {at.x + x, at.y}, text, end - x - ui.px(4));
  };
  head(c.name, c.iterations, "left | right leg");
  head(c.iterations, c.error, "iterations");
  head(c.error, c.failures, "error, mm");
  head(c.failures, c.width + ui.px(4), "failed");
  ImGui::Dummy({width, ui.fonts.tick->FontSize + ui.px(2)});
  for (int i = 0; i < ui.in.frame.walker_count; ++i) draw_walker(ui, i);
}

void draw_graph(Ui& ui, std::string_view title, const Plot& plot) {
  text_line(ui, ui.fonts.small, ui.theme.text, title);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 max{at.x + ImGui::GetContentRegionAvail().x, at.y + std::round(ui.px(70))};
  if (ImGui::IsRectVisible(at, max)) {
    draw_plot(*ImGui::GetWindowDrawList(), at, max, plot, ui.plot_style());
  }
  ImGui::Dummy({max.x - at.x, max.y - at.y});
}

}  // namespace

void draw_solver_panel(Ui& ui) {
  const int walker = ui.walker();
  if (walker < 0) return note(ui, "nobody walks yet");
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{ui.px(8), ui.px(4)});
  draw_table(ui);
  const GraphSpan span = graph_span(ui.in.history, walker, ui.in.cast.rate_hz);
  draw_graph(ui, "Iterations of a tick", iteration_plot(ui.in.history, span, walker, ui.theme));
  draw_graph(ui, "Error left (mm)", error_plot(ui.in.history, span, walker, ui.theme));
  if (ui.in.status != nullptr) {
    const double legs = 2.0 * std::max(ui.in.frame.walker_count, 1);
    value_row(ui, "a tick takes",
              fmt::format("median {:.0f}, most {:.0f} us", ui.in.status->tick_us_median,
                          ui.in.status->tick_us_max));
    value_row(ui, "a leg's share, at most",
              fmt::format("{:.1f} us", ui.in.status->tick_us_median / legs));
  }
  ImGui::PopStyleVar();
}

}  // namespace gaitpad
