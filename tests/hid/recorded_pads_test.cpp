// Reports and descriptors of real devices: the golden pads of tests/data/pads, and recordings that
// stay outside the repository.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "gaitpad/decode.h"
#include "gaitpad/trace.h"
#include "tests/hid/made_pads.h"
#include "tests/shared_data.h"

namespace gaitpad {
namespace {

// ---- Every file of tests/data/pads: a `# = ` line before a report states the state after it: the
// axes that are not 0 (to 0.01), then `buttons` and the pressed ones. To add a pad is to add a
// file.

struct Expected {
  std::array<float, kAxisCount> axis{};
  std::uint32_t buttons = 0;
};

Expected expected_of(const std::string& text) {
  Expected e;
  std::istringstream in(text);
  bool in_buttons = false;
  for (std::string word; in >> word;) {
    if (word == "buttons") {
      in_buttons = true;
    } else if (in_buttons) {
      const auto it = std::find(kButtonNames.begin(), kButtonNames.end(), word);
      if (it == kButtonNames.end()) ADD_FAILURE() << "no button " << word;
      e.buttons |= 1u << (it - kButtonNames.begin());
    } else {
      const auto it = std::find(kAxisNames.begin(), kAxisNames.end(), word);
      if (it == kAxisNames.end()) ADD_FAILURE() << "no axis " << word;
      in >> e.axis[static_cast<std::size_t>(it - kAxisNames.begin())];
    }
  }
  return e;
}

std::vector<Expected> all_expected(const std::string& path) {
  std::vector<Expected> all;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("# =", 0) == 0) all.push_back(expected_of(line.substr(3)));
  }
  return all;
}

void check_pad(const std::string& path, const PadOverrides& overrides) {
  SCOPED_TRACE(path);
  const auto [trace, layout] = recorded_pad(path, overrides);
  EXPECT_TRUE(layout.is_pad);
  const auto expected = all_expected(path);
  ASSERT_EQ(expected.size(), trace.events.size());
  PadState state;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_TRUE(decode(layout, report_of(trace, trace.events[i]), state)) << "report " << i;
    for (int a = 0; a < kAxisCount; ++a) {
      EXPECT_NEAR(state.axis[a], expected[i].axis[a], 0.01)
          << "report " << i << " " << kAxisNames[a];
    }
    EXPECT_EQ(names_of(state.buttons), names_of(expected[i].buttons)) << "report " << i;
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

std::vector<std::string> recordings() {
  std::vector<std::string> names;
  for (const std::string& path : files_in(kPadRecordings, ".hid"))
    names.push_back(std::filesystem::path(path).filename().string());
  return names;
}

TEST(SharedData, EveryFileParsesAndPadsAreToldFromTheRest) {
  GAITPAD_NEEDS(kPadRecordings);
  const std::vector<std::string> no_pads = {"legion_go_shortcuts.hid",
                                            "legion_go_vendor_raw.hid",
                                            "msi_claw_main.hid",
                                            "rog_ally_nkey_paddles.hid",
                                            "steam_controller_vendor.hid",
                                            "steamdeck_controller.rdesc.hid",
                                            "steamdeck_lcd_lizard_mouse.hid"};
  for (const std::string& name : recordings()) {
    const auto [trace, layout] = recorded_pad(kPadRecordings + name, {});
    ASSERT_EQ(trace.devices.size(), 1u) << name;
    const bool expected = std::find(no_pads.begin(), no_pads.end(), name) == no_pads.end();
    EXPECT_EQ(layout.is_pad, expected) << name;
  }
}

TEST(SharedData, EveryReportFitsItsDescriptor) {
  GAITPAD_NEEDS(kPadRecordings);
  for (const std::string& name : recordings()) {
    const auto [trace, layout] = recorded_pad(kPadRecordings + name, {});
    PadState state;
    for (const TraceEvent& event : trace.events) {
      ASSERT_TRUE(decode(layout, report_of(trace, event), state)) << name;
    }
  }
}

TEST(SharedData, EveryRecordingComesBackFromTheWriter) {
  GAITPAD_NEEDS(kPadRecordings);
  for (const std::string& name : recordings()) {
    const auto trace = read_trace(kPadRecordings + name);
    ASSERT_TRUE(trace);
    const auto back = parse_trace(trace_text(*trace), name);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->devices, trace->devices) << name;
    EXPECT_EQ(back->events, trace->events) << name;
    EXPECT_EQ(back->bytes, trace->bytes) << name;
  }
}

// The sizes that the folder's INDEX.md states were found by another parser.
TEST(SharedData, ReportLengthsAgreeWithTheIndex) {
  GAITPAD_NEEDS(kPadRecordings);
  const std::map<std::string, std::vector<std::pair<int, std::uint32_t>>> stated = {
      {"asus_gamepad.rdesc.hid", {{1, 64}, {3, 56}}},
      {"ds4_usb.rdesc.hid", {{1, 504}}},
      {"dualsense_bt.rdesc.hid", {{1, 72}, {0x31, 616}}},
      {"egret.rdesc.hid", {{0, 32}}},
      {"mdmini.rdesc.hid", {{0, 64}}},
      {"neogeo.rdesc.hid", {{0, 168}}},
      {"ps3_dualshock3_usb.rdesc.hid", {{1, 384}}},
      {"psclassic.rdesc.hid", {{0, 16}}},
      {"raptor_mach2_original.rdesc.hid", {{1, 504}}},
      {"saitek_p3600.rdesc.hid", {{1, 48}, {2, 16}}},
      {"xbox_elite2_bt_linux.rdesc.hid", {{1, 304}, {2, 8}, {4, 8}, {10, 88}, {5, 64}}},
      {"xbox_one_s_bt_windows.rdesc.hid", {{1, 120}, {2, 8}, {4, 8}}},
  };
  for (const auto& [name, lengths] : stated) {
    const auto trace = read_trace(kPadRecordings + name);
    ASSERT_TRUE(trace);
    const auto d = parse_descriptor(trace->devices[0].info.descriptor);
    ASSERT_TRUE(d);
    for (const auto& [id, bits] : lengths) {
      const std::size_t bytes = bits / 8 + (d->numbered ? 1 : 0);
      EXPECT_EQ(report_bytes(*d, FieldKind::input, static_cast<std::uint8_t>(id)), bytes)
          << name << " report " << id;
    }
  }
}

// `# ReportID: 1 / X:  129 | Y:  126 | ... | Button: 0  0 ... | 0xff000021: 0 , 0 , ...`: the
// numbers of all fields in order, as hid-recorder decoded them.
std::vector<std::int64_t> recorded_values(const std::string& line) {
  std::vector<std::int64_t> values;
  std::istringstream parts(line.substr(line.find('/') + 1));
  for (std::string part; std::getline(parts, part, '|');) {
    const std::size_t colon = part.find(':');
    if (colon == std::string::npos) continue;
    std::string numbers = part.substr(colon + 1);
    std::replace(numbers.begin(), numbers.end(), ',', ' ');
    std::istringstream in(numbers);
    for (std::int64_t v; in >> v;) values.push_back(v);
  }
  return values;
}

TEST(SharedData, FieldsAgreeWithHidRecordersOwnDecoding) {
  GAITPAD_NEEDS(kPadRecordings);
  const std::string path = kPadRecordings + "dualsense_usb_l1.raw.hid";
  const auto trace = read_trace(path);
  ASSERT_TRUE(trace);
  const auto d = parse_descriptor(trace->devices[0].info.descriptor);
  ASSERT_TRUE(d);
  std::ifstream in(path);
  std::size_t event = 0;
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("# ReportID:", 0) != 0) continue;
    const std::vector<std::int64_t> expected = recorded_values(line);
    ASSERT_LT(event, trace->events.size());
    const Report report = report_of(*trace, trace->events[event++]);
    std::vector<std::int64_t> found;
    for (const Field& f : d->fields) {
      if (f.kind != FieldKind::input || f.report_id != report.bytes[0]) continue;
      found.push_back(field_value(f, {report.bytes.data() + 1, report.size - std::size_t{1}}));
    }
    ASSERT_EQ(found, expected) << "report " << event;
  }
  EXPECT_EQ(event, 962u);
}

struct Recorded {
  const char* file;
  PadButton button;
};

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

// Each recording is named after what its maker's thumb did.
TEST(SharedData, DualSenseRecordingsPressWhatTheirNamesSay) {
  GAITPAD_NEEDS(kPadRecordings);
  for (const auto& [file, button] : {Recorded{"circle", kButtonB},
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

TEST(SharedData, DualSenseSticksAndTriggersMoveAlone) {
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
}

TEST(SharedData, EliteTwoPressesItsFourPaddles) {
  GAITPAD_NEEDS(kPadRecordings);
  const std::uint32_t seen = pressed_in("xbox_elite2_bt_paddles_only.hid");
  for (const PadButton b : {kButtonPaddle1, kButtonPaddle2, kButtonPaddle3, kButtonPaddle4}) {
    EXPECT_TRUE((seen >> b) & 1u) << kButtonNames[b];
  }
}

}  // namespace
}  // namespace gaitpad
