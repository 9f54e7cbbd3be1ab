#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "view/graph_data.h"
#include "view/panels.h"

namespace gaitpad {
namespace {

void draw_tick_times(Ui& ui) {
  const Plot plot = tick_time_plot(ui.in.history, ui.in.cast.rate_hz, ui.theme);
  text_line(
      ui, ui.fonts.small, ui.theme.text,
      fmt::format("Time of a tick (ms), of {:.2f} ms", 1000.0 / std::max(ui.in.cast.rate_hz, 1)));
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 max{at.x + ImGui::GetContentRegionAvail().x, at.y + std::round(ui.px(84))};
  if (ImGui::IsRectVisible(at, max)) {
    draw_plot(*ImGui::GetWindowDrawList(), at, max, plot, ui.plot_style());
  }
  ImGui::Dummy({max.x - at.x, max.y - at.y});
}

// What should be 0 and is not: in another colour, and with a word.
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
  count_row(ui, "standstills", status.standstills);
  count_row(ui, "too slow for the time", status.overloads);
  value_row(ui, "skipped by these", fmt::format("{:.1f} s", status.skipped_s));
  value_row(ui, "scheduled as", status.time_policy.empty() ? "-" : status.time_policy);
  count_row(ui, "reports lost", status.pads.lost);
  value_row(ui, "plugged, unplugged",
            fmt::format("{}, {}", status.pads.plugged, status.pads.unplugged));
  count_row(ui, "missed by the recording", status.recording_lost);
}

}  // namespace

void draw_loop_panel(Ui& ui) {
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{ui.px(8), ui.px(4)});
  if (ui.is_live()) draw_tick_times(ui);
  if (ui.in.status != nullptr) {
    draw_live(ui, *ui.in.status);
  } else {
    value_row(ui, "ticks", fmt::format("{} at {} Hz", ui.in.frame.tick + 1, ui.in.cast.rate_hz));
    note(ui, "a playback is computed as it is looked at: no tick has a time of its own");
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
