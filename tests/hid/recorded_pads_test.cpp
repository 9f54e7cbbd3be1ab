// Reports and descriptors of real devices: the golden pads of tests/data/pads, and recordings that
// stay outside the repository.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "gaitpad/decode.h"
#include "gaitpad/trace.h"
#include "tests/hid/made_pads.h"
#include "tests/shared_data.h"

namespace gaitpad {
namespace {

// ---- Every file of tests/data/pads: a `# = ` line before a report states the state after it: the
// axes that are not 0 (to 0.01), then `buttons` and the pressed ones. To add a pad is to add a
// file.

void check_pad(const std::string& path, const PadOverrides& overrides) {
  SCOPED_TRACE(path);
  const auto [trace, layout] = recorded_pad(path, overrides);
  EXPECT_TRUE(layout.is_pad);
  std::vector<std::string> expected;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);)
    if (line.rfind("# =", 0) == 0) expected.push_back(line.substr(3));
  ASSERT_EQ(expected.size(), trace.events.size());
  PadState state;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_TRUE(decode(layout, report_of(trace, trace.events[i]), state)) << "report " << i;
    expect_state(state, expected[i]);
  }
}

TEST(GoldenPads, EveryReportDecodesAsThePadsMakerMeantIt) {
  const PadOverrides overrides = shipped_pads();
  int pads = 0;
  for (const std::string& path : files_in(kGoldenPads, ".hid")) {
    check_pad(path, overrides);
    ++pads;
  }
  EXPECT_GE(pads, 12);
}

// ---- Recordings outside the repository

TEST(SharedData, EveryFileIsReadItsPadsAreToldFromTheRestAndTheWriterGivesItBack) {
  GAITPAD_NEEDS(kPadRecordings);
  const std::vector<std::string> no_pads = {"legion_go_shortcuts.hid",
                                            "legion_go_vendor_raw.hid",
                                            "msi_claw_main.hid",
                                            "rog_ally_nkey_paddles.hid",
                                            "steam_controller_vendor.hid",
                                            "steamdeck_controller.rdesc.hid",
                                            "steamdeck_lcd_lizard_mouse.hid"};
  for (const std::string& path : files_in(kPadRecordings, ".hid")) {
    const std::string name = std::filesystem::path(path).filename().string();
    SCOPED_TRACE(name);
    const auto [trace, layout] = recorded_pad(path, {});
    ASSERT_EQ(trace.devices.size(), 1u);
    const bool expected = std::find(no_pads.begin(), no_pads.end(), name) == no_pads.end();
    EXPECT_EQ(layout.is_pad, expected);
    PadState state;
    for (const TraceEvent& event : trace.events)
      ASSERT_TRUE(decode(layout, report_of(trace, event), state));
    const auto back = parse_trace(trace_text(trace), name);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->devices, trace.devices);
    EXPECT_EQ(back->events, trace.events);
    EXPECT_EQ(back->bytes, trace.bytes);
  }
}

// All buttons that were pressed in a recording.
std::uint32_t pressed_in(const std::string& file) {
  const auto [trace, layout] = recorded_pad(kPadRecordings + file, shipped_pads());
  PadState state;
  std::uint32_t seen = 0;
  for (const TraceEvent& event : trace.events) {
    EXPECT_TRUE(decode(layout, report_of(trace, event), state));
    seen |= state.buttons;
  }
  return seen;
}

// Each recording is named after its control.
TEST(SharedData, RecordingsPressWhatTheirNamesSay) {
  GAITPAD_NEEDS(kPadRecordings);
  for (const auto& [file, button] : {std::pair("circle", kButtonB),
                                     {"x", kButtonA},
                                     {"square", kButtonX},
                                     {"start", kButtonStart},
                                     {"l1.raw", kButtonLeftShoulder},
                                     {"r1", kButtonRightShoulder},
                                     {"l3", kButtonLeftStick},
                                     {"dpad_up", kButtonDpadUp},
                                     {"dpad_down", kButtonDpadDown},
                                     {"dpad_left", kButtonDpadLeft},
                                     {"dpad_right", kButtonDpadRight}}) {
    EXPECT_EQ(pressed_in(std::string("dualsense_usb_") + file + ".hid"), 1u << button) << file;
  }
  for (const PadButton b : {kButtonPaddle1, kButtonPaddle2, kButtonPaddle3, kButtonPaddle4})
    EXPECT_TRUE((pressed_in("xbox_elite2_bt_paddles_only.hid") >> b) & 1u) << kButtonNames[b];
}

// The largest and smallest position of each axis in a recording.
std::array<std::pair<float, float>, kAxisCount> extremes(const std::string& file) {
  std::array<std::pair<float, float>, kAxisCount> range{};
  const auto [trace, layout] = recorded_pad(kPadRecordings + file, shipped_pads());
  PadState state;
  for (const TraceEvent& event : trace.events) {
    decode(layout, report_of(trace, event), state);
    for (int a = 0; a < kAxisCount; ++a) {
      range[a].first = std::min(range[a].first, state.axis[a]);
      range[a].second = std::max(range[a].second, state.axis[a]);
    }
  }
  return range;
}

TEST(SharedData, SticksAndTriggersMoveAlone) {
  GAITPAD_NEEDS(kPadRecordings);
  const auto is_still = [](std::pair<float, float> r) {
    return r.first > -0.15f && r.second < 0.15f;
  };
  const auto is_full = [](std::pair<float, float> r) {
    return r.first < -0.95f && r.second > 0.95f;
  };
  auto r = extremes("dualsense_usb_left_stick.hid");
  EXPECT_TRUE(is_full(r[kLeftX]) && is_full(r[kLeftY]));
  EXPECT_TRUE(is_still(r[kRightX]) && is_still(r[kRightY]) && is_still(r[kLeftTrigger]));
  r = extremes("dualsense_usb_right_stick.hid");
  EXPECT_TRUE(is_full(r[kRightX]) && is_full(r[kRightY]));
  EXPECT_TRUE(is_still(r[kLeftX]) && is_still(r[kLeftY]) && is_still(r[kRightTrigger]));
  r = extremes("dualsense_usb_l2.hid");
  EXPECT_GT(r[kLeftTrigger].second, 0.9f);
  EXPECT_TRUE(is_still(r[kRightTrigger]) && is_still(r[kRightX]));
  r = extremes("dualsense_usb_r2.hid");
  EXPECT_GT(r[kRightTrigger].second, 0.9f);
  EXPECT_TRUE(is_still(r[kLeftTrigger]));
  EXPECT_GT(extremes("steam_controller_vendor.hid")[kLeftX].second, 0.5f);
  EXPECT_NE(pressed_in("steam_controller_vendor.hid"), 0u);
}

}  // namespace
}  // namespace gaitpad
