// Recordings and descriptors of real devices, which stay outside the repository.
#include "tests/shared_data.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "gaitpad/decode.h"
#include "gaitpad/trace.h"
#include "tests/hid/made_pads.h"

namespace gaitpad {
namespace {

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
    const auto trace = read_trace(kPadRecordings + name);
    ASSERT_TRUE(trace) << trace.error().message;
    ASSERT_EQ(trace->devices.size(), 1u) << name;
    const auto layout = pad_layout(trace->devices[0].info, {});
    ASSERT_TRUE(layout) << name << ": " << layout.error().message;
    const bool expected = std::find(no_pads.begin(), no_pads.end(), name) == no_pads.end();
    EXPECT_EQ(layout->is_pad, expected) << name;
  }
}

TEST(SharedData, EveryReportFitsItsDescriptor) {
  GAITPAD_NEEDS(kPadRecordings);
  for (const std::string& name : recordings()) {
    const auto trace = read_trace(kPadRecordings + name);
    ASSERT_TRUE(trace);
    const auto layout = pad_layout(trace->devices[0].info, {});
    ASSERT_TRUE(layout);
    PadState state;
    for (const TraceEvent& event : trace->events) {
      ASSERT_TRUE(decode(*layout, report_of(*trace, event), state)) << name;
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

// Each recording is named after what its maker's thumb did.
TEST(SharedData, DualSenseRecordingsPressWhatTheirNamesSay) {
  GAITPAD_NEEDS(kPadRecordings);
  const PadOverrides overrides = shipped_pads();
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
    const auto trace = read_trace(kPadRecordings + "dualsense_usb_" + file + ".hid");
    ASSERT_TRUE(trace) << trace.error().message;
    const auto layout = pad_layout(trace->devices[0].info, overrides);
    ASSERT_TRUE(layout);
    PadState state;
    std::uint32_t seen = 0;
    for (const TraceEvent& event : trace->events) {
      ASSERT_TRUE(decode(*layout, report_of(*trace, event), state));
      seen |= state.buttons;
    }
    EXPECT_EQ(seen, 1u << button) << file;
  }
}

// The largest and smallest position of each axis in a recording.
std::array<std::pair<float, float>, kAxisCount> extremes(const std::string& file) {
  std::array<std::pair<float, float>, kAxisCount> range{};
  const auto trace = read_trace(kPadRecordings + file);
  const auto layout = pad_layout(trace->devices[0].info, shipped_pads());
  PadState state;
  for (const TraceEvent& event : trace->events) {
    decode(*layout, report_of(*trace, event), state);
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
  const auto trace = read_trace(kPadRecordings + "xbox_elite2_bt_paddles_only.hid");
  ASSERT_TRUE(trace);
  const auto layout = pad_layout(trace->devices[0].info, shipped_pads());
  PadState state;
  std::uint32_t seen = 0;
  for (const TraceEvent& event : trace->events) {
    ASSERT_TRUE(decode(*layout, report_of(*trace, event), state));
    seen |= state.buttons;
  }
  for (const PadButton b : {kButtonPaddle1, kButtonPaddle2, kButtonPaddle3, kButtonPaddle4}) {
    EXPECT_TRUE((seen >> b) & 1u) << kButtonNames[b];
  }
}

}  // namespace
}  // namespace gaitpad
