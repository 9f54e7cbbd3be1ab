// The user interface without a display: ImGui draws into memory, a simulated walk is the input, and
// a mouse clicks on items of ui_items().
#pragma once
#include <gtest/gtest.h>
#include <imgui.h>

#include <string>
#include <vector>

#include "tests/walking_fixture.h"
#include "view/gui.h"
#include "view/ui.h"

namespace gaitpad {

class UiTest : public WalkingTest {
 protected:
  void SetUp() override { open(1280, 720, 1.0); }
  void TearDown() override { close(); }

  // Opens a window of this size in pixels.
  void open(int width, int height, double scale, ThemeName theme = ThemeName::dark) {
    close();
    context_ = ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
    io.DeltaTime = 1.0f / 60.0f;
    io.MousePos = {-1.0f, -1.0f};
    scale_ = scale;
    fonts = load_fonts(scale);
    unsigned char* pixels = nullptr;
    int w = 0, h = 0;
    io.Fonts->GetTexDataAsAlpha8(&pixels, &w, &h);
    state = UiState{};
    state.theme = theme;
    apply_style(theme_of(theme), scale);
  }
  void close() {
    if (context_ != nullptr) ImGui::DestroyContext(context_);
    context_ = nullptr;
  }

  // Starts a session with the paper's four styles, and lets it walk.
  void walk() {
    start({"even", "stiff_hip", "stiff_knee", "limp_left"});
    step(1200, {"gait speed_m_s 1.2"});
  }

  UiOutput draw() {
    UiInput input{*frame, cast, history};
    input.status = timeline ? nullptr : &status;
    input.timeline = timeline ? &*timeline : nullptr;
    input.pad_name = pad_name;
    input.pad_rate_hz = 250.0;
    input.frames_per_second = 30.0;
    input.memory_mib = 100.0;
    input.renderer = renderer;
    input.source = source;
    input.recording = recording;
    input.labels = labels;
    input.messages = messages;
    input.is_modal = is_modal;
    input.hint = hint;
    input.can_leave = can_leave;
    input.can_rumble = can_rumble;
    ImGui::NewFrame();
    UiOutput out = draw_ui(input, theme_of(state.theme), fonts, scale_, state);
    ImGui::Render();
    return out;
  }

  static const UiItem* find(const std::string& name) {
    for (const UiItem& item : ui_items()) {
      if (item.name == name) return &item;
    }
    return nullptr;
  }
  static ImVec2 middle(const UiItem& item) {
    return {(item.min.x + item.max.x) / 2.0f, (item.min.y + item.max.y) / 2.0f};
  }
  // Moves the mouse there, presses and releases; returns the requests of all these frames.
  UiOutput click_at(const ImVec2& place) {
    UiOutput all;
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos = place;
    add(draw(), all);
    io.MouseDown[0] = true;
    add(draw(), all);
    io.MouseDown[0] = false;
    for (int i = 0; i < 3; ++i) add(draw(), all);  // a menu opens one frame later
    return all;
  }
  UiOutput click(const std::string& name) {
    draw();
    draw();  // scroll bars appear one frame later
    const UiItem* item = find(name);
    EXPECT_NE(item, nullptr) << "nothing to click on: " << name;
    return item == nullptr ? UiOutput{} : click_at(middle(*item));
  }
  static void add(const UiOutput& out, UiOutput& all) {
    all.actions.insert(all.actions.end(), out.actions.begin(), out.actions.end());
    all.commands.insert(all.commands.end(), out.commands.begin(), out.commands.end());
    if (out.seek_tick) all.seek_tick = out.seek_tick;
    if (out.pace) all.pace = out.pace;
    if (out.is_looping) all.is_looping = out.is_looping;
    if (out.save_style) all.save_style = out.save_style;
    all.rumbles = all.rumbles || out.rumbles;
    if (out.type_size) all.type_size = out.type_size;
    all.dismisses_messages = all.dismisses_messages || out.dismisses_messages;
  }

  Fonts fonts;
  UiState state;
  LiveStatus status;
  std::optional<Timeline> timeline;
  std::string pad_name = "Wireless Controller", renderer = "llvmpipe", source, recording;
  std::vector<UiLabel> labels;
  std::vector<std::string> messages;
  std::string hint;
  bool is_modal = false, can_leave = false, can_rumble = false;

 private:
  ImGuiContext* context_ = nullptr;
  double scale_ = 1.0;
};

}  // namespace gaitpad
