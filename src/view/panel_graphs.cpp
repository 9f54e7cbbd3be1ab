#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/shown_number.h"
#include "session/script.h"
#include "view/history_plots.h"
#include "view/panels.h"
#include "view/widgets.h"

namespace gaitpad {
namespace {

constexpr std::array<std::string_view, kShownJointCount> kJointNames = {
    "Hip flexion", "Knee flexion", "Ankle dorsiflexion"};
constexpr std::array<std::string_view, kShownJointCount> kGraphs = {"graph hip", "graph knee",
                                                                    "graph ankle"};
constexpr std::array<double, kShownJointCount> kLeastSpan_deg = {20.0, 30.0, 10.0};

// Draws a plot's title, and at the right the latest values of its curves.
void draw_title(Ui& ui, std::string_view title, std::string_view unit, const Plot& plot,
                int decimals) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const std::string text = fmt::format("{} ({})", title, unit);
  put_text(list, ui.fonts.small, ui.theme.text, at, text, width);
  struct Value {
    std::string text;
    Colour colour;
  };
  std::vector<Value> values;
  float needed = 0.0f;
  const float gap = ui.px(8);
  for (const PlotSeries& series : plot.series) {
    if (series.points.empty() || !std::isfinite(series.points.back().y)) continue;
    values.push_back({fmt::format("{}{}{}", series.letter, series.letter.empty() ? "" : ": ",
                                  shown_number(series.points.back().y, decimals)),
                      with_alpha(series.colour, 1.0)});
    needed += text_width(ui.fonts.tick, values.back().text) + gap;
  }
  const float room = width - text_width(ui.fonts.small, text);
  // The selected curve's value only, or the number of curves.
  if (values.size() > 1 && needed > room) {
    const auto one = static_cast<std::size_t>(std::max(ui.state.walker, 0));
    const Value& shown = values[std::min(one, values.size() - 1)];
    values = {{fmt::format("{}  of {}", shown.text, values.size()), shown.colour}};
  }
  float x = at.x + width;
  for (std::size_t i = values.size(); i-- > 0;) {
    x -= text_width(ui.fonts.tick, values[i].text);
    put_text(list, ui.fonts.tick, values[i].colour, {x, at.y + ui.px(1)}, values[i].text, width);
    x -= gap;
  }
}

// Reserves a box over the column's width and draws into it if it is visible. `name`: its name in
// ui_items().
template <class Draw>
void draw_box(Ui& ui, std::string_view name, double height_px, Draw draw) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 max{at.x + ImGui::GetContentRegionAvail().x, at.y + std::round(ui.px(height_px))};
  if (ImGui::IsRectVisible(at, max)) draw(*ImGui::GetWindowDrawList(), at, max);
  ImGui::Dummy({max.x - at.x, max.y - at.y});
  keep_picture(ui, name, at, max);
}

void draw_plot_box(Ui& ui, std::string_view name, const Plot& plot, double height_px) {
  draw_box(ui, name, height_px, [&](ImDrawList& list, const ImVec2& min, const ImVec2& max) {
    draw_plot(list, min, max, plot, ui.plot_style());
  });
}

// Draws a plot below its title and the latest values.
void draw_graph(Ui& ui, std::string_view name, std::string_view title, std::string_view unit,
                const Plot& plot, int decimals, double height_px) {
  draw_title(ui, title, unit, plot, decimals);
  ImGui::Dummy({1.0f, ui.fonts.small->FontSize});
  draw_plot_box(ui, name, plot, height_px);
}

void draw_leg_choice(Ui& ui) {
  const float gap = std::round(ui.px(6)), width = ImGui::GetContentRegionAvail().x;
  const float cell = std::round(ui.px(58));
  const ImVec2 at = ImGui::GetCursorScreenPos();
  put_text(*ImGui::GetWindowDrawList(), ui.fonts.small, ui.theme.secondary, {at.x, at.y + ui.px(4)},
           "last two cycles (s)", width - 2.0f * cell - 2.0f * gap);
  for (const Side side : {kLeftSide, kRightSide}) {
    ButtonLook look;
    look.width = cell;
    look.height = std::round(ui.px(22));
    look.is_on = ui.state.graph_leg == side;
    ImGui::SetCursorScreenPos({at.x + width - cell * (2.0f - static_cast<float>(side)) -
                                   gap * (1.0f - static_cast<float>(side)),
                               at.y});
    if (button(ui, side == kLeftSide ? "leg left" : "leg right",
               side == kLeftSide ? "left" : "right", look)) {
      ui.state.graph_leg = side;
    }
  }
  ImGui::SetCursorScreenPos({at.x, at.y + std::round(ui.px(26))});
}

// Draws the number of each curve's character.
void draw_names(Ui& ui) {
  const int count = ui.in.frame.walker_count;
  if (count <= 1) return;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  float widest = 0.0f;
  for (int i = 0; i < count; ++i)
    widest = std::max(widest, text_width(ui.fonts.tick, walker_name(ui, i)) + ui.px(20));
  const int columns = std::max(1, std::min(count, static_cast<int>(width / widest)));
  const float cell = width / static_cast<float>(columns), row = ui.px(15);
  for (int i = 0; i < count; ++i) {
    const ImVec2 place{at.x + cell * static_cast<float>(i % columns),
                       at.y + row * static_cast<float>(i / columns)};
    const float middle = place.y + ui.fonts.tick->FontSize / 2.0f + ui.px(1);
    list.AddLine({place.x, middle}, {place.x + ui.px(9), middle}, packed(walker_colour(ui, i)),
                 ui.px(2.5));
    put_text(list, ui.fonts.tick, ui.theme.secondary, {place.x + ui.px(13), place.y},
             walker_name(ui, i), cell - ui.px(16));
  }
  const int rows = (count + columns - 1) / columns;
  ImGui::Dummy({width, row * static_cast<float>(rows)});
}

void draw_mark_words(Ui& ui) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float r = ui.px(3.2), y = at.y + ui.fonts.tick->FontSize / 2.0f + ui.px(1);
  const ImU32 colour = packed(ui.theme.text);
  float x = at.x + ui.px(30);
  const auto word = [&](std::string_view text) {
    put_text(list, ui.fonts.tick, ui.theme.secondary, {x + ui.px(8), at.y}, text,
             at.x + width - x - ui.px(8));
    x += text_width(ui.fonts.tick, text) + ui.px(24);
  };
  list.AddTriangleFilled({x - r, y + r}, {x + r, y + r}, {x, y - r}, colour);
  word("lift");
  list.AddCircleFilled({x, y}, r, colour, 12);
  word("peak");
  list.AddTriangleFilled({x - r, y - r}, {x, y + r}, {x + r, y - r}, colour);
  word("landing");
  ImGui::Dummy({width, ui.fonts.tick->FontSize + ui.px(2)});
}

void draw_feet(Ui& ui, const GraphSpan& span, int walker) {
  draw_graph(ui, "graph heel", "Heel above its ground", "cm",
             heel_plot(ui.in.history, span, walker, ui.theme), 1, 84.0);
  draw_mark_words(ui);
  text_line(ui, ui.fonts.small, ui.theme.text, "Stage and planted points");
  const SpanPlot plot = stage_plot(ui.in.history, span, walker, ui.theme);
  draw_box(ui, "graph stages", 100.0, [&](ImDrawList& list, const ImVec2& min, const ImVec2& max) {
    draw_spans(list, min, max, plot, ui.plot_style());
  });
  note(ui, "F flight, R roll, each of the left or right foot", 1);
}

// Draws iterations and error of each leg, and the failures since the start. The numbers get the
// width that they need in this font, the names the rest.
void draw_table(Ui& ui) {
  ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, ImVec2{ui.px(3), ui.px(1)});
  const bool is_begun = ImGui::BeginTable("legs", 4);
  ImGui::PopStyleVar();
  if (!is_begun) return;
  const auto cell = [&ui](const ImFont* font, const Colour& colour, std::string_view text) {
    ImGui::TableNextColumn();
    text_line(ui, font, colour, text);
  };
  ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch);
  for (const float width :
       {text_width(ui.fonts.tick, "iterations"), text_width(ui.fonts.small, "0.00 | 0.00"),
        text_width(ui.fonts.tick, "failed")})
    ImGui::TableSetupColumn("number", ImGuiTableColumnFlags_WidthFixed, width + 1.0f);
  for (const char* head : {"left | right leg", "iterations", "error, mm", "failed"})
    cell(ui.fonts.tick, ui.theme.tick, head);
  for (int i = 0; i < ui.in.frame.walker_count; ++i) {
    const WalkerFrame& walker = ui.in.frame.walkers[static_cast<std::size_t>(i)];
    const WalkFrame& walk = walker.walk;
    const auto error = [&walk](Side side) {
      return fmt::format("{:.2f}{}", walk.ik_error_m[side] * 1000.0,
                         walk.ik_failed[side] ? "!" : "");
    };
    const bool is_failing = walk.ik_failed[kLeftSide] || walk.ik_failed[kRightSide];
    ImGui::TableNextColumn();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::GetWindowDrawList()->AddRectFilled(
        {at.x, at.y + ui.px(1)}, {at.x + ui.px(3), at.y + ui.px(13)}, packed(walker_colour(ui, i)));
    ImGui::SetCursorScreenPos({at.x + ui.px(8), at.y});
    text_line(ui, ui.fonts.small, ui.theme.text, walker_name(ui, i));
    cell(ui.fonts.small, ui.theme.text,
         fmt::format("{} | {}", walk.ik_iterations[kLeftSide], walk.ik_iterations[kRightSide]));
    cell(ui.fonts.small, is_failing ? ui.theme.warning : ui.theme.text,
         fmt::format("{} | {}", error(kLeftSide), error(kRightSide)));
    cell(ui.fonts.small, walker.ik_failures > 0 ? ui.theme.warning : ui.theme.secondary,
         fmt::format("{}", walker.ik_failures));
  }
  ImGui::EndTable();
}

// Draws the active solver, live and recorded, and the difference.
void draw_mode(Ui& ui) {
  const float gap = std::round(ui.px(6)), width = ImGui::GetContentRegionAvail().x;
  ButtonLook look;
  look.width = std::floor((width - gap) / 2.0f);
  look.height = std::round(ui.px(22));
  look.is_enabled = ui.is_live();
  for (const IkMode mode : {IkMode::paper, IkMode::robust}) {
    look.is_on = ui.in.frame.ik == mode;
    if (mode == IkMode::robust) ImGui::SameLine(0.0f, gap);
    if (button(ui, mode == IkMode::paper ? "ik paper" : "ik robust",
               kIkNames[static_cast<std::size_t>(mode)], look))
      ui.out.commands.push_back(fmt::format("ik {}", kIkNames[static_cast<std::size_t>(mode)]));
  }
  note(
      ui,
      ui.in.frame.ik == IkMode::paper
          ? "The paper's steps 1 to 7 and equation (5) with raw weights, without limits of joints."
          : "Damped and within the limits of joints; only ratios of weights count, and a weight of "
            "0.2 takes 2 iterations where the paper's takes 16.",
      4);
}

void draw_tick_times(Ui& ui) {
  text_line(
      ui, ui.fonts.small, ui.theme.text,
      fmt::format("Time of a tick (ms), of {:.2f} ms", 1000.0 / std::max(ui.in.cast.rate_hz, 1)));
  draw_plot_box(ui, "graph ticks", tick_time_plot(ui.in.history, ui.in.cast.rate_hz, ui.theme),
                84.0);
}

// Shows a count that should be 0; a larger one is marked with '!' and a note.
void count_row(Ui& ui, std::string_view label, std::int64_t count,
               std::string_view note_text = {}) {
  std::string value = fmt::format("{}", count);
  if (count > 0 && !note_text.empty()) value += fmt::format(" ({})", note_text);
  value_row(ui, count > 0 ? fmt::format("! {}", label) : std::string(label), value);
}

void draw_live(Ui& ui, const LiveStatus& status) {
  value_row(ui, "ticks", fmt::format("{} at {} Hz", status.ticks, ui.in.cast.rate_hz));
  const double share = status.ticks > 0 ? 1000.0 * static_cast<double>(status.overruns) /
                                              static_cast<double>(status.ticks)
                                        : 0.0;
  count_row(ui, "more than a tick late", status.overruns, fmt::format("{:.2f} in 1000", share));
  value_row(ui, "tick, median and most",
            fmt::format("{:.0f}, {:.0f} us", status.tick_us_median, status.tick_us_max));
  if (status.frame_us_p99 > 0.0) {
    value_row(ui, "stick to frame, p50 and p99",
              fmt::format("{:.1f}, {:.1f} ms", status.frame_us_p50 / 1000.0,
                          status.frame_us_p99 / 1000.0));
  }
  count_row(ui, "program stood still", status.standstills);
  count_row(ui, "ticks took too long", status.overloads);
  value_row(ui, "clock set forward by", fmt::format("{:.1f} s", status.skipped_s));
  value_row(ui, "scheduled as", status.time_policy.empty() ? "-" : status.time_policy);
  count_row(ui, "reports lost", status.pads.lost);
  value_row(ui, "plugged, unplugged",
            fmt::format("{}, {}", status.pads.plugged, status.pads.unplugged));
  count_row(ui, "missed by the recording", status.recording_lost);
}

}  // namespace

void draw_graphs_panel(Ui& ui) {
  const int walker = ui.walker();
  if (walker < 0) return note(ui, "no character yet");
  const GraphSpan span = graph_span(ui.in.history, walker, ui.in.cast.rate_hz);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{ui.px(8), ui.px(3)});
  draw_leg_choice(ui);
  draw_names(ui);
  for (std::size_t joint = 0; joint < kShownJointCount; ++joint) {
    Plot plot = joint_plot(ui.in.history, span, ui.state.graph_leg, joint, ui.theme,
                           ui.state.walker, kLeastSpan_deg[joint]);
    plot.has_x_ticks = joint + 1 == kShownJointCount;
    draw_graph(ui, kGraphs[joint], kJointNames[joint], "\u00b0", plot, 0,
               plot.has_x_ticks ? 92.0 : 78.0);
  }
  draw_feet(ui, span, walker);
  ImGui::PopStyleVar();
}

void draw_solver_panel(Ui& ui) {
  const int walker = ui.walker();
  if (walker < 0) return note(ui, "no character yet");
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{ui.px(8), ui.px(4)});
  draw_mode(ui);
  draw_table(ui);
  const GraphSpan span = graph_span(ui.in.history, walker, ui.in.cast.rate_hz);
  text_line(ui, ui.fonts.small, ui.theme.text, "Iterations of a tick");
  draw_plot_box(ui, "graph iterations", iteration_plot(ui.in.history, span, walker, ui.theme),
                70.0);
  text_line(ui, ui.fonts.small, ui.theme.text, "Remaining error (mm)");
  draw_plot_box(ui, "graph error", error_plot(ui.in.history, span, walker, ui.theme), 70.0);
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

void draw_loop_panel(Ui& ui) {
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{ui.px(8), ui.px(4)});
  if (ui.is_live()) draw_tick_times(ui);
  if (ui.in.status != nullptr) {
    draw_live(ui, *ui.in.status);
  } else {
    value_row(ui, "ticks", fmt::format("{} at {} Hz", ui.in.frame.tick + 1, ui.in.cast.rate_hz));
    note(ui, "a playback computes its ticks ahead, so they have no time of their own");
  }
  const SimulationCounts& counts = ui.in.frame.counts;
  value_row(ui, "reports", fmt::format("{}", counts.reports));
  count_row(ui, "bad reports", counts.bad_reports);
  value_row(ui, "commands", fmt::format("{}", counts.commands));
  count_row(ui, "refused commands", counts.bad_commands);
  if (ui.in.memory_mib > 0.0) {
    value_row(ui, "memory of the program", fmt::format("{:.0f} MiB", ui.in.memory_mib));
  }
  ImGui::PopStyleVar();
}

}  // namespace gaitpad
