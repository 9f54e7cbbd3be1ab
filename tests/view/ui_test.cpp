#include "view/ui.h"

#include <cmath>
#include <set>

#include "gaitpad/style.h"
#include "ui_fixture.h"
#include "view/tooltips.h"

namespace gaitpad {
namespace {

using Actions = std::vector<Action>;

const ImVec2 kSizes[] = {{1280, 720}, {1920, 1080}, {640, 480}, {900, 500}, {320, 200}};

TEST_F(UiTest, EachButtonOfTheBarGivesItsAction) {
  walk();
  const std::pair<std::string, Action> buttons[] = {
      {"play", Action::pause},         {"record", Action::record},
      {"open", Action::open_file},     {"calibrate", Action::calibrate},
      {"help", Action::help},          {"panel pad", action_of(0)},
      {"panel control", action_of(1)}, {"panel style", action_of(2)},
      {"panel graphs", action_of(3)},  {"panel solver", action_of(4)},
      {"panel loop", action_of(5)},
  };
  for (const auto& [name, action] : buttons)
    EXPECT_EQ(click(name).actions, Actions{action}) << name;
}

TEST_F(UiTest, EachPanelAsksToBeClosedByItsButtonAndIsGoneWhenItIs) {
  walk();
  for (std::size_t i = 0; i < kPanels; ++i) {
    state.is_open.fill(false);
    state.is_open[i] = true;
    const std::string name(kPanelNames[i]);
    const auto action = action_of(i);
    EXPECT_EQ(click("close " + name).actions, Actions{action}) << name;
    EXPECT_NE(find("area " + name), nullptr);
    state.is_open[i] = false;
    draw();
    EXPECT_EQ(find("area " + name), nullptr);
  }
}

TEST_F(UiTest, APanelThatIsOpenedBelowTheOthersIsScrolledTo) {
  walk();
  state.is_open = {true, true, false, false, false, false};
  draw();
  state.is_open[static_cast<std::size_t>(Panel::style)] = true;
  for (int i = 0; i < 3; ++i) draw();
  EXPECT_NE(find("close style"), nullptr);
  EXPECT_NE(find("style 1"), nullptr);
}

TEST_F(UiTest, WhatABarIsTooNarrowForStandsInItsMenu) {
  open(640, 480, 1.0);
  walk();
  draw();
  EXPECT_EQ(find("panel loop"), nullptr);
  click("menu");
  ASSERT_NE(find("panel loop"), nullptr);
  EXPECT_EQ(click("panel loop").actions, Actions{action_of(5)});
}

TEST_F(UiTest, TheViewMenuSwitchesWhatHasNoKeyAndAsksForWhatHas) {
  walk();
  click("view");
  ASSERT_NE(find("grid"), nullptr);
  EXPECT_GE(find("trails")->min.y, find("view")->max.y) << "the menu is below its button";
  EXPECT_TRUE(click("grid").actions.empty());
  EXPECT_FALSE(state.has_grid);
  EXPECT_EQ(click("trails").actions, Actions{Action::trails});
  EXPECT_EQ(click("theme").actions, Actions{Action::theme});
}

TEST_F(UiTest, HelpTellsOfEveryAction) {
  open(1280, 720, 1.0);
  walk();
  state.is_help_open = true;
  draw();
  for (const ActionInfo& info : actions()) {
    EXPECT_NE(find("help " + std::string(info.name)), nullptr) << info.name;
  }
  EXPECT_NE(find("help walking"), nullptr);
  EXPECT_EQ(click("close help").actions, Actions{Action::help});
}

TEST_F(UiTest, HelpOfASmallWindowScrollsToItsEnd) {
  open(640, 480, 1.0);
  walk();
  state.is_help_open = true;
  draw();
  EXPECT_EQ(find("help quit"), nullptr);
  ImGui::GetIO().MousePos = {300.0f, 300.0f};
  draw();
  for (int i = 0; i < 40; ++i) {
    ImGui::GetIO().MouseWheel = -1.0f;
    draw();
  }
  EXPECT_NE(find("help quit"), nullptr);
}

TEST_F(UiTest, APlaybackIsSoughtWhereItsLineIsClicked) {
  walk();
  draw();
  EXPECT_EQ(find("timeline"), nullptr) << "a live session has none";
  timeline = Timeline{};
  timeline->ticks = 2401;
  draw();
  const UiItem line = *find("timeline");
  const UiOutput out = click_at(middle(line));
  ASSERT_TRUE(out.seek_tick);
  EXPECT_NEAR(static_cast<double>(*out.seek_tick), 1200.0, 6.0);
  EXPECT_EQ(*click_at({line.max.x - 1.0f, middle(line).y}).seek_tick, 2400);
  EXPECT_EQ(*click("to begin").seek_tick, 0);
  EXPECT_EQ(*click("pace 0.25").pace, 0.25);
  EXPECT_TRUE(*click("loop").is_looping);
  EXPECT_EQ(click("timeline play").actions, Actions{Action::pause});
  EXPECT_EQ(click("timeline step").actions, Actions{Action::step});
}

TEST_F(UiTest, MessagesStayUntilTheyAreDismissed) {
  walk();
  messages = {"one", "two", "three", "four", "five", "six"};
  EXPECT_FALSE(draw().dismisses_messages);
  EXPECT_TRUE(click("dismiss").dismisses_messages);
}

TEST_F(UiTest, UnderADialogNothingTakesTheMouse) {
  walk();
  draw();
  is_modal = true;
  for (const char* name : {"play", "close pad", "slider speed_m_s", "walker 2"}) {
    const UiOutput out = click(name);
    EXPECT_TRUE(out.actions.empty()) << name;
    EXPECT_TRUE(out.commands.empty()) << name;
  }
  EXPECT_EQ(state.walker, -1);
}

TEST_F(UiTest, ItemsHaveDifferentNamesLieInTheWindowAndLeaveTheSceneFree) {
  walk();
  state.is_open.fill(true);
  for (const ImVec2& size : kSizes) {
    ImGui::GetIO().DisplaySize = size;
    draw();
    draw();
    std::set<std::string> names;
    const Viewport v =
        scene_viewport(state, false, static_cast<int>(size.x), static_cast<int>(size.y), 1.0);
    for (const UiItem& item : ui_items()) {
      EXPECT_TRUE(names.insert(item.name).second) << item.name;
      EXPECT_GE(item.min.x, 0.0f) << item.name;
      EXPECT_GE(item.min.y, 0.0f) << item.name;
      EXPECT_LE(item.max.x, size.x) << item.name;
      EXPECT_LE(item.max.y, size.y) << item.name;
      EXPECT_TRUE(item.max.x <= v.x || item.min.x >= v.x + v.width || item.max.y <= v.y ||
                  item.min.y >= v.y + v.height)
          << item.name << " at " << size.x << " x " << size.y;
    }
  }
}

TEST_F(UiTest, EveryItemIsExplainedUnderThePointer) {
  walk();
  state.is_open.fill(true);
  state.walker = 1;
  open(2560, 2800, 1.0);
  walk();
  state.is_open.fill(true);
  step(2, {"set 1 fatigue 0.5"});
  for (const bool is_playback : {false, true}) {
    if (is_playback) timeline = Timeline{};
    draw();
    draw();
    int explained = 0;
    for (const UiItem& item : ui_items()) {
      if (item.name.starts_with("area ") || item.name.ends_with(" bar") ||
          item.name.ends_with(" column") || item.name == "cast" || item.name == "status line" ||
          item.name == "messages")
        continue;
      EXPECT_FALSE(tooltip_of(item.name).empty()) << item.name;
      ++explained;
    }
    EXPECT_GT(explained, 30);
  }
  for (const StyleKey& key : style_keys()) {
    EXPECT_FALSE(tooltip_of("style slider " + key.name).empty()) << key.name;
    EXPECT_EQ(words_of_key(key.name).find('_'), std::string::npos) << key.name;
  }
  EXPECT_EQ(words_of_key("fatigue_model.per_100_m"), "tiring per 100 m");
  EXPECT_EQ(words_of_key("trunk.over_left_deg"), "trunk over left, deg");
  EXPECT_EQ(words_of_key("head.x_m"), "head x, m");
}

TEST_F(UiTest, ATooltipComesWhileThePointerRests) {
  walk();
  draw();
  draw();
  ImGui::GetIO().MousePos = middle(*find("calibrate"));
  for (int i = 0; i < 10; ++i) draw();
  const int before = ImGui::GetDrawData()->CmdListsCount;
  for (int i = 0; i < 40; ++i) draw();
  EXPECT_GT(ImGui::GetDrawData()->CmdListsCount, before);
}

// Checks windows of 800 x 500, 1280 x 720 and 1920 x 1080 pixels, with each size of type.
TEST_F(UiTest, NoTextIsCutOff) {
  for (const ImVec2& size : {ImVec2{800, 500}, ImVec2{1280, 720}, ImVec2{1920, 1080}}) {
    for (const bool is_playback : {false, true}) {
      open(static_cast<int>(size.x), static_cast<int>(size.y), 1.0);
      walk();
      step(2, {"gait speed_m_s 1", "set left_leg.stride_length 0.7"});
      state.is_open.fill(true);
      state.memory.has_body_keys = state.memory.has_axis_weights = true;
      timeline.reset();
      if (is_playback) timeline = Timeline{};
      draw();
      draw();
      for (const std::string& text : cut_texts()) {
        ADD_FAILURE() << text << " at " << size.x << " x " << size.y;
      }
    }
  }
}

TEST_F(UiTest, AHintStandsOverTheSceneAlone) {
  walk();
  draw();
  EXPECT_EQ(ImGui::GetBackgroundDrawList()->VtxBuffer.Size, 0);
  hint = "W A S D or plug a pad in; F1: keys";
  draw();
  const ImDrawList& list = *ImGui::GetBackgroundDrawList();
  EXPECT_GT(list.VtxBuffer.Size, 100);
  const Viewport v = scene_viewport(state, false, 1280, 720, 1.0);
  for (const ImDrawVert& vertex : list.VtxBuffer) {
    EXPECT_GE(vertex.pos.x, static_cast<float>(v.x));
    EXPECT_LE(vertex.pos.x, static_cast<float>(v.x + v.width));
    EXPECT_LE(vertex.pos.y, static_cast<float>(v.y + v.height));
  }
  is_modal = true;
  draw();
  EXPECT_EQ(ImGui::GetBackgroundDrawList()->VtxBuffer.Size, 0);
}

TEST_F(UiTest, AButtonLeavesAPlaybackThatALiveSessionWasBefore) {
  walk();
  timeline = Timeline{};
  draw();
  draw();
  EXPECT_EQ(find("leave playback"), nullptr);
  can_leave = true;
  EXPECT_EQ(click("leave playback").actions, Actions{Action::back});
}

TEST_F(UiTest, TheSizeOfTypeIsInTheViewMenu) {
  walk();
  click("view");
  const UiOutput larger = click("type larger");
  ASSERT_TRUE(larger.type_size);
  EXPECT_NEAR(*larger.type_size, 1.1, 1e-9);
  state.type_size = kMostTypeSize;
  draw();
  draw();
  EXPECT_EQ(find("type larger"), nullptr);
}

TEST_F(UiTest, APadWithMotorsHasATestOfThem) {
  walk();
  draw();
  draw();
  EXPECT_EQ(find("rumble"), nullptr);
  can_rumble = true;
  EXPECT_TRUE(click("rumble").rumbles);
}

TEST_F(UiTest, TheChipsStayWhileThePanelsScroll) {
  walk();
  state.is_open.fill(true);
  draw();
  draw();
  const ImVec2 before = find("walker 4")->min;
  ImGui::GetIO().MousePos = {100.0f, 500.0f};
  draw();
  for (int i = 0; i < 20; ++i) {
    ImGui::GetIO().MouseWheel = -1.0f;
    draw();
  }
  ASSERT_NE(find("walker 4"), nullptr);
  EXPECT_EQ(find("walker 4")->min.y, before.y);
  EXPECT_EQ(find("pad picture"), nullptr) << "the panels have scrolled";
}

TEST(UiLayout, ACleanWindowIsTheSceneAlone) {
  UiState state;
  state.is_clean = true;
  const UiLayout l = ui_layout(state, true, 1280, 720, 1.0);
  EXPECT_EQ(l.scene.width, 1280.0f);
  EXPECT_EQ(l.scene.height, 720.0f);
  for (const UiRect& rect : {l.top, l.left, l.right, l.timeline, l.status}) {
    EXPECT_TRUE(rect.is_empty());
  }
}

TEST_F(UiTest, NamesAboveHeadsStayInTheSceneAndApart) {
  walk();
  for (int i = 0; i < 4; ++i) labels.push_back({{600.0 + 10.0 * i, 300.0}, "limp_left", {}});
  labels.push_back({{20.0, 300.0}, "behind a panel", {}});
  labels.push_back({{std::nan(""), 300.0}, "nowhere", {}});
  const Viewport v = scene_viewport(state, false, 1280, 720, 1.0);
  labels.push_back({{v.x + 1.0, v.y + 1.0}, "in a corner", {}});
  labels.push_back({{v.x + v.width - 1.0, v.y + v.height - 1.0}, "in another", {}});
  draw();
  const ImDrawList* list = ImGui::GetBackgroundDrawList();
  ASSERT_GT(list->VtxBuffer.Size, 0);
  float top = 1e9f, bottom = 0.0f;
  for (const ImDrawVert& vertex : list->VtxBuffer) {
    EXPECT_GE(vertex.pos.x, static_cast<float>(v.x) - 1.5f);
    EXPECT_LE(vertex.pos.x, static_cast<float>(v.x + v.width) + 1.5f);
    if (vertex.pos.y < 150.0f || vertex.pos.y > 400.0f) continue;  // skips labels in the corners
    top = std::min(top, vertex.pos.y);
    bottom = std::max(bottom, vertex.pos.y);
  }
  EXPECT_GE(bottom - top, 4 * 20.0f);  // four chips at one place are stacked
}

TEST(UiState, StylesOfEqualNamesAreOneChoice) {
  Cast cast;
  cast.styles = {"even", "limp", "even", "tired"};
  EXPECT_EQ(style_choices(cast), (std::vector<int>{0, 1, 3}));
}

bool is_apart(const UiRect& a, const UiRect& b) {
  return a.is_empty() || b.is_empty() || a.x + a.width <= b.x || b.x + b.width <= a.x ||
         a.y + a.height <= b.y || b.y + b.height <= a.y;
}
double area(const UiRect& r) {
  return r.is_empty() ? 0.0 : static_cast<double>(r.width) * static_cast<double>(r.height);
}

// The parts cover the window without overlaps or gaps.
void expect_tiles(const UiLayout& l, int width, int height) {
  const UiRect all[] = {l.top, l.left, l.right, l.timeline, l.status, l.scene};
  double sum = 0.0;
  for (const UiRect& a : all) {
    sum += area(a);
    for (const UiRect& b : all) {
      if (&a != &b) {
        ASSERT_TRUE(is_apart(a, b)) << width << " x " << height;
      }
    }
  }
  ASSERT_DOUBLE_EQ(sum, static_cast<double>(width) * height) << width << " x " << height;
}

TEST(UiLayout, PartsTileTheWindowWhateverItsSize) {
  for (int panels = 0; panels < 64; ++panels) {
    UiState state;
    for (int i = 0; i < kPanels; ++i) {
      state.is_open[static_cast<std::size_t>(i)] = (panels >> i & 1) != 0;
    }
    for (int width = 1; width < 3000; width += 173) {
      for (int height = 1; height < 1700; height += 131) {
        const double scale = 0.5 + (width * 7 + height * 3) % 8 * 0.5;
        for (const bool has_timeline : {false, true}) {
          expect_tiles(ui_layout(state, has_timeline, width, height, scale), width, height);
        }
      }
    }
  }
}

TEST(UiLayout, ANarrowWindowShowsAllPanelsInOneColumn) {
  UiState state;
  state.is_open.fill(true);
  EXPECT_FALSE(ui_layout(state, false, 1280, 720, 1.0).right.is_empty());
  const UiLayout narrow = ui_layout(state, false, 640, 480, 1.0);
  EXPECT_FALSE(narrow.left.is_empty());
  EXPECT_TRUE(narrow.right.is_empty());
  EXPECT_GT(narrow.scene.width, 300.0f);
}

}  // namespace
}  // namespace gaitpad
