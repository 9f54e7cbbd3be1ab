// Tests the requests of panels, and the limits of what they draw.
#include "view/panels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <sstream>
#include <utility>

#include "session/walk_export.h"
#include "ui_fixture.h"
#include "view/history_plots.h"
#include "view/widgets.h"

namespace gaitpad {
namespace {

using Commands = std::vector<std::string>;

// True for a vertex of a letter; the atlas stores lines and surfaces in other rectangles.
bool is_letter(const ImDrawVert& v) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  for (const int place : {atlas.PackIdLines, atlas.PackIdMouseCursors}) {
    const ImFontAtlasCustomRect& r = *atlas.GetCustomRectByIndex(place);
    const float x = v.uv.x * static_cast<float>(atlas.TexWidth);
    const float y = v.uv.y * static_cast<float>(atlas.TexHeight);
    if (x >= r.X && x <= r.X + r.Width && y >= r.Y && y <= r.Y + r.Height) return false;
  }
  return true;
}

// Expects everything inside the area, and letters also inside its margins and beside its scroll
// bar.
void expect_inside(const ImDrawList& list, const UiItem& area, const UiItem* panel, int panels) {
  for (const ImDrawVert& v : list.VtxBuffer) {
    const UiItem& limits = panel != nullptr && is_letter(v) ? *panel : area;
    ASSERT_TRUE(std::isfinite(v.pos.x) && std::isfinite(v.pos.y)) << list._OwnerName;
    ASSERT_GE(v.pos.x, limits.min.x - 1.5f) << list._OwnerName << " panels " << panels;
    ASSERT_LE(v.pos.x, limits.max.x + 1.5f) << list._OwnerName << " panels " << panels;
  }
}

class PanelTest : public UiTest {
 protected:
  // Checks every draw list of an area in ui_items().
  void expect_all_inside(int panels) {
    int seen = 0;
    const ImDrawData* data = ImGui::GetDrawData();
    for (int l = 0; l < data->CmdListsCount; ++l) {
      const ImDrawList& list = *data->CmdLists[l];
      const UiItem* area = find(list._OwnerName);
      if (area == nullptr) continue;
      ++seen;
      const UiItem* panel = nullptr;
      for (const std::string_view name : kPanelNames) {
        const UiItem* item = find("area " + std::string(name));
        if (item != nullptr && std::string(list._OwnerName).ends_with("column") &&
            item->min.x >= area->min.x && item->max.x <= area->max.x)
          panel = item;
      }
      expect_inside(list, *area, panel, panels);
    }
    EXPECT_GE(seen, 1);
  }
  void show(Panel panel) {
    state.is_open.fill(false);
    state.is_open[static_cast<std::size_t>(panel)] = true;
    draw();
  }
  // Presses the mouse on the item at a fraction of its width and holds it.
  UiOutput press_at(const std::string& name, double share) {
    draw();
    const UiItem item = *find(name);
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos = {item.min.x + static_cast<float>(share) * (item.max.x - item.min.x),
                   middle(item).y};
    UiOutput all = draw();
    io.MouseDown[0] = true;
    add(draw(), all);
    return all;
  }
  UiOutput move_to(const std::string& name, double share) {
    const UiItem item = *find(name);
    ImGui::GetIO().MousePos.x = item.min.x + static_cast<float>(share) * (item.max.x - item.min.x);
    return draw();
  }
  UiOutput release() {
    ImGui::GetIO().MouseDown[0] = false;
    return draw();
  }
};

double last_number(const std::string& command) {
  return std::stod(command.substr(command.rfind(' ') + 1));
}

TEST_F(PanelTest, ASliderSendsEachNewValueOnceForTheChosenCharacter) {
  walk();
  state.walker = 1;
  show(Panel::control);
  const GaitRange range = range_of(GaitKey::speed_m_s, cast.members[1].limits);
  const UiOutput first = press_at("slider speed_m_s", 0.5);
  ASSERT_EQ(first.commands.size(), 1u);
  EXPECT_EQ(first.commands[0].rfind("gait 2 speed_m_s ", 0), 0u) << first.commands[0];
  EXPECT_NEAR(last_number(first.commands[0]), 0.5 * (range.min + range.max), 0.02);
  EXPECT_LE(first.commands[0].size(), std::string("gait 2 speed_m_s 0.75").size());
  EXPECT_TRUE(draw().commands.empty());  // the mouse does not move, so no command is sent
  EXPECT_EQ(move_to("slider speed_m_s", 1.0).commands.size(), 1u);
  EXPECT_TRUE(move_to("slider speed_m_s", 1.0).commands.empty());
  EXPECT_TRUE(release().commands.empty());
}

TEST_F(PanelTest, ForAllCharactersACommandNamesNone) {
  walk();
  show(Panel::control);
  const UiOutput out = press_at("slider hip_sway", 0.5);
  ASSERT_EQ(out.commands.size(), 1u);
  EXPECT_EQ(out.commands[0], "gait hip_sway 1.5");
}

TEST_F(PanelTest, ASliderStaysWhereItWasLetGoUntilTheSessionFollows) {
  walk();
  show(Panel::control);
  press_at("slider hip_bounce", 1.0 / 3.0);
  move_to("slider hip_bounce", 0.75);
  release();
  draw();  // the session has not run since the change
  ASSERT_EQ(state.memory.pending.size(), 1u);
  const double asked = state.memory.pending[0].value;
  step(2, {"gait hip_bounce " + std::to_string(asked)});
  draw();
  EXPECT_TRUE(state.memory.pending.empty());
  EXPECT_NEAR(frame->walkers[0].overrides.value[static_cast<std::size_t>(GaitKey::hip_bounce)],
              asked, 1e-9);
}

TEST_F(PanelTest, WhatASessionRefusesIsNotShownForEver) {
  walk();
  show(Panel::control);
  press_at("slider hip_bounce", 0.9);
  release();
  step(240);
  draw();
  EXPECT_TRUE(state.memory.pending.empty());
}

TEST_F(PanelTest, WhatIsOverriddenCanBeGivenBack) {
  start({"even", "stiff_hip"});
  show(Panel::control);
  EXPECT_EQ(find("give back speed_m_s"), nullptr);
  EXPECT_EQ(find("give back all"), nullptr);
  step(5, {"gait 2 speed_m_s 1", "gait 2 flight_right 2"});
  state.walker = 1;
  EXPECT_EQ(click("give back speed_m_s").commands, Commands{"gait 2 speed_m_s stick"});
  EXPECT_EQ(click("give back flight_left").commands, Commands{"gait 2 flight_right stick"});
  EXPECT_EQ(click("give back all").commands, Commands{"gait 2 stick"});
  state.walker = 0;
  draw();
  EXPECT_EQ(find("give back speed_m_s"), nullptr);
}

TEST_F(PanelTest, EveryGaitKeyHasASlider) {
  walk();
  show(Panel::control);
  for (int k = 0; k < kGaitKeys; ++k) {
    const std::string name(info_of(static_cast<GaitKey>(k)).name);
    EXPECT_NE(find("slider " + name), nullptr) << name;
  }
}

TEST_F(PanelTest, EveryStyleKeyOfOneSideAndOfTheWholeHasASlider) {
  open(1280, 3200, 1.0);
  walk();
  show(Panel::style);
  EXPECT_EQ(find("style slider left_hand.carry"), nullptr);
  state.memory.has_axis_weights = state.memory.has_body_keys = true;
  draw();
  int seen = 0;
  for (const StyleKey& key : style_keys()) {
    const std::string table = key.name.substr(0, key.name.find('.'));
    if (table == "legs" || table == "arms" || table == "hands")
      continue;  // such a row has one key for each side
    EXPECT_NE(find("style slider " + key.name), nullptr) << key.name;
    ++seen;
  }
  EXPECT_GE(seen, 23);
}

TEST_F(PanelTest, AStyleIsChosenByItsName) {
  walk();
  state.walker = 2;
  show(Panel::style);
  const UiOutput out = click("style 4");
  EXPECT_EQ(out.commands, Commands{"style 3 limp_left"});
}

TEST_F(PanelTest, AChangedValueGoesBackToTheStylesOwn) {
  open(1280, 1200, 1.0);
  start({"even", "limp_left"});
  state.walker = 1;
  show(Panel::style);
  EXPECT_EQ(find("own left_leg.stride_length"), nullptr);
  step(2, {"set 2 left_leg.stride_length 1.25", "set 2 fatigue 0.5"});
  EXPECT_EQ(click("own left_leg.stride_length").commands,
            Commands{"set 2 left_leg.stride_length 0.5"});
  EXPECT_EQ(click("own all").commands, Commands{"style 2 limp_left"});
}

TEST_F(PanelTest, AStyleSliderSetsTheValueOfItsKey) {
  open(1280, 1200, 1.0);
  walk();
  state.walker = 1;
  show(Panel::style);
  const UiOutput out = press_at("style slider right_leg.weight.knee", 0.5);
  ASSERT_EQ(out.commands.size(), 1u);
  EXPECT_EQ(out.commands[0], "set 2 right_leg.weight.knee 0.5");
}

TEST_F(PanelTest, AStyleIsSavedUnderANameThatFitsAFile) {
  open(1280, 1200, 1.0);
  walk();
  show(Panel::style);
  EXPECT_EQ(find("save style"), nullptr);  // without a name nothing can be saved
  click("style name");
  for (const char c : std::string("../my walk_2")) {
    ImGui::GetIO().AddInputCharacter(static_cast<unsigned>(c));
  }
  draw();
  const UiOutput out = click("save style");
  ASSERT_TRUE(out.save_style);
  EXPECT_EQ(*out.save_style, "my walk_2");
}

TEST_F(PanelTest, APlaybackTakesNoCommands) {
  walk();
  timeline = Timeline{};
  timeline->ticks = 1000;
  for (const Panel panel : {Panel::control, Panel::style}) {
    show(panel);
    draw();
    for (const UiItem& item : ui_items()) EXPECT_EQ(item.name.find("slider"), std::string::npos);
    EXPECT_EQ(find("style 1"), nullptr);
  }
}

TEST_F(PanelTest, TheChosenCharacterIsOneOrAll) {
  walk();
  click("walker 3");
  EXPECT_EQ(state.walker, 2);
  click("walker all");
  EXPECT_EQ(state.walker, -1);
  state.walker = 9;  // a number from an earlier session
  draw();
  EXPECT_EQ(state.walker, -1);
}

bool is_drawn(const std::string& text) { return std::ranges::count(drawn_texts(), text) > 0; }

// The row of `frames.csv` for the tick of a frame, by column.
std::map<std::string, double> file_row(const SessionFrame& frame, int rate_hz) {
  std::string text;
  append_frames_header(text);
  append_frames_row(frame.tick, rate_hz, frame.stick, frame.walkers[0].walk, text);
  std::istringstream lines(text);
  std::string header, row, name, value;
  std::getline(lines, header);
  std::getline(lines, row);
  std::istringstream names(header), values(row);
  std::map<std::string, double> columns;
  while (std::getline(names, name, ',') && std::getline(values, value, ','))
    columns[name] = std::strtod(value.c_str(), nullptr);
  return columns;
}

// On stairs a step is as long as a tread, whatever the stick asks for.
TEST_F(PanelTest, WhatTheWalkDoesIsBesideWhatIsAskedAndIsTheFiles) {
  start({"even"}, 0, "stairs");
  show(Panel::control);
  double least_m_s = 9.0;
  for (int i = 0; i < 40; ++i) {
    step(60, {"gait speed_m_s 1.2"});
    draw();
    const auto file = file_row(*frame, cast.rate_hz);
    const double turn = file.at("turn_rate_rad_s");
    EXPECT_TRUE(is_drawn(fmt::format("now {:.2f}", file.at("speed_m_s")))) << frame->tick;
    EXPECT_TRUE(is_drawn(
        fmt::format("now {:.2f} | {:.2f}", file.at("stride_left_m"), file.at("stride_right_m"))))
        << frame->tick;
    EXPECT_TRUE(is_drawn(fmt::format("now {:.2f}", std::abs(turn) < 0.005 ? 0.0 : turn)));
    EXPECT_TRUE(is_drawn("1.20")) << "the slider shows what is asked";
    if (i > 5) least_m_s = std::min(least_m_s, file.at("speed_m_s"));
  }
  EXPECT_LT(least_m_s, 0.8) << "it was on the stairs";
}

// Plotted heights are above the ground below each heel, high on the stairs as well.
TEST_F(PanelTest, HeelsArePlottedAboveTheGroundBelowThemAsTheFileHasThem) {
  start({"even"}, 0, "stairs");
  double highest_m = 0.0;
  for (int i = 0; i < 300; ++i) {
    step(7, {"gait speed_m_s 1.2"});
    const auto file = file_row(*frame, cast.rate_hz);
    const GraphSpan span = graph_span(history, 0, cast.rate_hz);
    const Plot plot = heel_plot(history, span, 0, theme_of(ThemeName::dark));
    ASSERT_EQ(plot.series.size(), 2u);
    for (const auto& [series, foot] : {std::pair(0, "left"), {1, "right"}}) {
      const double height_m = file.at(fmt::format("{}_heel_y_m", foot)),
                   ground_m = file.at(fmt::format("{}_heel_ground_m", foot));
      EXPECT_NEAR(plot.series[static_cast<std::size_t>(series)].points.back().y,
                  100.0 * (height_m - ground_m), 1e-4);
      highest_m = std::max(highest_m, ground_m);
    }
  }
  EXPECT_GT(highest_m, 0.9) << "it was on the stairs";
}

// With all characters selected, no panel shows the first one's value as if it were common to all.
TEST_F(PanelTest, WhereTheSelectedDifferTheirValuesAreShownAsMixed) {
  open(1280, 3200, 1.0);
  walk();
  const auto is_mixed = [] { return is_drawn("mixed") || is_drawn("L mixed"); };
  for (const Panel panel : {Panel::control, Panel::style}) {
    state.walker = 0;
    show(panel);
    EXPECT_FALSE(is_mixed());
    state.walker = -1;
    draw();
    EXPECT_TRUE(is_mixed()) << "panel " << static_cast<int>(panel);
  }
  // A mixed slider sends the value that it is dragged to, even its minimum.
  const UiOutput out = press_at("style slider left_leg.stride_length", 0.0);
  ASSERT_EQ(out.commands.size(), 1u);
  EXPECT_TRUE(out.commands[0].starts_with("set left_leg.stride_length ")) << out.commands[0];
  release();
  step(120);  // the session has not applied the dragged value
  // Each character returns to the value of its own style.
  step(2, {"set left_leg.stride_length 1.25"});
  draw();
  EXPECT_TRUE(is_drawn("L 1.25"));
  EXPECT_EQ(click("own left_leg.stride_length").commands,
            (Commands{"set 1 left_leg.stride_length 1", "set 2 left_leg.stride_length 1",
                      "set 3 left_leg.stride_length 1", "set 4 left_leg.stride_length 0.5"}));
  EXPECT_EQ(click("own all").commands, (Commands{"style 1 even", "style 2 stiff_hip",
                                                 "style 3 stiff_knee", "style 4 limp_left"}));
}

// Uses malformed names wherever the window shows a name from outside.
void make_hostile(Cast& cast, std::string& pad, std::string& renderer, std::string& source,
                  std::vector<std::string>& messages, std::vector<UiLabel>& labels) {
  const std::string bad = "%s%n%999999d##x###y \xff\xfe\n\t\x01 " + std::string(5000, 'W');
  for (std::string& style : cast.styles) style = bad;
  cast.motion = bad;
  pad = renderer = source = bad;
  messages = {bad, std::string(100000, 'x'), "", "a b " + bad};
  labels = {{{600.0, 300.0}, bad, {}}};
}

struct Look {
  double scale;
  int width, height;
  ThemeName theme;
  bool is_hostile;
};
constexpr Look kLooks[] = {
    {1.0, 1280, 720, ThemeName::dark, false}, {1.0, 1280, 720, ThemeName::dark, true},
    {1.0, 640, 480, ThemeName::light, true},  {1.5, 1920, 1080, ThemeName::light, false},
    {2.0, 2560, 1440, ThemeName::dark, true}, {2.0, 1280, 720, ThemeName::light, false},
    {1.0, 320, 200, ThemeName::dark, true}};

// Reads the draw list: a picture would show nothing, because the scissor cuts off what leaves a
// panel.
TEST_F(PanelTest, NothingLeavesItsPanel) {
  const std::string pad = pad_name;
  for (const Look& look : kLooks) {
    SCOPED_TRACE(std::to_string(look.width) + " at scale " + std::to_string(look.scale));
    open(look.width, look.height, look.scale, look.theme);
    walk();
    status.time_policy = "SCHED_FIFO 50";
    status.overruns = status.standstills = 123456789;
    status.wait_counts.fill(1000000);
    pad_name = renderer = source = pad;
    messages.clear();
    labels.clear();
    if (look.is_hostile) make_hostile(cast, pad_name, renderer, source, messages, labels);
    for (const bool is_playback : {false, true}) {
      timeline.reset();
      if (is_playback) timeline = Timeline{};
      for (int panels = 1; panels <= 64; panels *= 2) {
        for (std::size_t i = 0; i < kPanels; ++i)
          state.is_open[i] = panels == 64 || panels >> i & 1;
        draw();
        draw();
        expect_all_inside(panels);
      }
    }
  }
}

TEST_F(PanelTest, WhatIsNoNumberIsDrawnAsNone) {
  walk();
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  frame->stick.left = frame->stick.right = vec2(kNone);
  frame->pad.state.axis.fill(std::numeric_limits<float>::quiet_NaN());
  frame->walkers[0].walk.ik_error_m = {kNone, kNone};
  frame->walkers[0].params.stride[0].length_m = kNone;
  frame->walkers[0].params.hip_sway = std::numeric_limits<double>::infinity();
  status.tick_us_median = status.wait_us_median = kNone;
  TickSample sample = history[history.size() - 1];
  ++sample.tick;
  sample.step_us = std::numeric_limits<float>::infinity();
  sample.walkers[0].joint_rad[0][0] = std::numeric_limits<float>::quiet_NaN();
  sample.walkers[0].heel_m[0] = vec3(kNone);
  history.add(sample);
  state.is_open.fill(true);
  draw();
  draw();
  const ImDrawData* data = ImGui::GetDrawData();
  for (int l = 0; l < data->CmdListsCount; ++l) {
    for (const ImDrawVert& v : data->CmdLists[l]->VtxBuffer) {
      ASSERT_TRUE(std::isfinite(v.pos.x) && std::isfinite(v.pos.y));
    }
  }
}

TEST_F(PanelTest, BeforeTheFirstTickThereIsNobody) {
  state.is_open.fill(true);
  draw();
  EXPECT_EQ(find("slider speed_m_s"), nullptr);
  EXPECT_NE(find("area control"), nullptr);
}

// A software rasterizer's time grows with the triangles: 45,000 indices take 10 ms.
TEST_F(PanelTest, AllPanelsTogetherAreFewTriangles) {
  walk();
  state.is_open.fill(true);
  draw();
  draw();
  EXPECT_LT(ImGui::GetDrawData()->TotalIdxCount, 60000);
}

}  // namespace
}  // namespace gaitpad
