#include "hid/evdev_layout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "gaitpad/decode.h"
#include "gaitpad/trace.h"
#include "tests/hid/made_pads.h"
#include "tests/shared_data.h"

namespace gaitpad {
namespace {

// A node as a kernel driver makes it, read through layout and decoder.
class Node {
 public:
  Node(EvdevAbilities abilities, std::uint16_t vendor, std::uint16_t product, std::uint16_t version,
       std::vector<std::uint8_t> own_descriptor = {})
      : abilities_(std::move(abilities)), stated_(evdev_layout(abilities_, own_descriptor)) {
    info_.driver = "evdev";
    info_.vendor = vendor;
    info_.product = product;
    info_.version = version;
    info_.descriptor = stated_.descriptor;
    layout_ = value_of(pad_layout(info_, shipped_pads()));
    for (const EvdevAxis& a : abilities_.axes) {
      state_.axis[a.code] = static_cast<std::int32_t>((std::int64_t{a.min} + a.max) / 2);
    }
  }
  void set_axis(std::uint16_t code, std::int32_t value) { state_.axis[code] = value; }
  void set_key(std::uint16_t code, bool is_pressed) { state_.keys[code] = is_pressed; }
  const PadLayout& layout() const { return layout_; }
  const EvdevLayout& stated() const { return stated_; }
  PadState state() {
    Report report;
    put_state(stated_, state_, report);
    EXPECT_TRUE(decode(layout_, report, pad_));
    return pad_;
  }
  // The buttons that one key presses.
  std::uint32_t buttons_of(std::uint16_t code) {
    set_key(code, true);
    const std::uint32_t buttons = state().buttons;
    set_key(code, false);
    return buttons;
  }

 private:
  EvdevAbilities abilities_;
  EvdevLayout stated_;
  DeviceInfo info_;
  PadLayout layout_;
  EvdevState state_;
  PadState pad_;
};

constexpr std::uint32_t bit(PadButton b) { return 1u << b; }

void expect_sticks(Node& node, std::int32_t min, std::int32_t max) {
  const std::uint16_t codes[] = {0, 1, 3, 4};
  const PadAxis axes[] = {kLeftX, kLeftY, kRightX, kRightY};
  for (int i = 0; i < 4; ++i) {
    const float sign = i % 2 == 1 ? -1.0f : 1.0f;  // evdev's y grows downwards
    node.set_axis(codes[i], max);
    EXPECT_FLOAT_EQ(node.state().axis[axes[i]], sign) << kAxisNames[axes[i]];
    node.set_axis(codes[i], min);
    EXPECT_FLOAT_EQ(node.state().axis[axes[i]], -sign) << kAxisNames[axes[i]];
    node.set_axis(codes[i], (max + min) / 2);
    EXPECT_NEAR(node.state().axis[axes[i]], 0.0f, 0.005f);
  }
}

void expect_triggers(Node& node, std::int32_t max) {
  node.set_axis(2, max);
  node.set_axis(5, 0);
  EXPECT_FLOAT_EQ(node.state().axis[kLeftTrigger], 1.0f);
  EXPECT_FLOAT_EQ(node.state().axis[kRightTrigger], 0.0f);
  node.set_axis(2, 0);
  node.set_axis(5, max);
  EXPECT_FLOAT_EQ(node.state().axis[kLeftTrigger], 0.0f);
  EXPECT_FLOAT_EQ(node.state().axis[kRightTrigger], 1.0f);
}

void expect_hat(Node& node) {
  const Hat kHats[3][3] = {{Hat::up_left, Hat::up, Hat::up_right},
                           {Hat::left, Hat::released, Hat::right},
                           {Hat::down_left, Hat::down, Hat::down_right}};
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      node.set_axis(0x10, x);
      node.set_axis(0x11, y);
      EXPECT_EQ(node.state().hat, kHats[y + 1][x + 1]);
    }
  }
}

void expect_common_buttons(Node& node) {
  const std::pair<std::uint16_t, PadButton> kCommon[] = {{0x130, kButtonA},
                                                         {0x131, kButtonB},
                                                         {0x136, kButtonLeftShoulder},
                                                         {0x137, kButtonRightShoulder},
                                                         {0x13a, kButtonBack},
                                                         {0x13b, kButtonStart},
                                                         {0x13c, kButtonGuide},
                                                         {0x13d, kButtonLeftStick},
                                                         {0x13e, kButtonRightStick}};
  for (const auto& [code, button] : kCommon) EXPECT_EQ(node.buttons_of(code), bit(button)) << code;
}

TEST(EvdevLayout, AnXboxPadOnXpadIsNamedByItsPrintedLetters) {
  Node node(xpad_node(), 0x045e, 0x028e, 0x0114);
  EXPECT_TRUE(node.layout().is_pad);
  expect_sticks(node, -32768, 32767);
  expect_triggers(node, 255);
  expect_hat(node);
  node.set_axis(0x10, 0);
  node.set_axis(0x11, 0);
  expect_common_buttons(node);
  EXPECT_EQ(node.buttons_of(0x133), bit(kButtonX));  // BTN_X
  EXPECT_EQ(node.buttons_of(0x134), bit(kButtonY));  // BTN_Y
}

TEST(EvdevLayout, PaddlesOfAnElitePadAreCountedAsSdlDoes) {
  EvdevAbilities abilities = xpad_node();
  for (std::uint16_t code = 0x2c4; code <= 0x2c7; ++code) abilities.keys.push_back(code);
  Node node(abilities, 0x045e, 0x0b00, 0x0500);
  EXPECT_EQ(node.buttons_of(0x2c4), bit(kButtonPaddle1));
  EXPECT_EQ(node.buttons_of(0x2c5), bit(kButtonPaddle3));
  EXPECT_EQ(node.buttons_of(0x2c6), bit(kButtonPaddle2));
  EXPECT_EQ(node.buttons_of(0x2c7), bit(kButtonPaddle4));
  EXPECT_EQ(node.buttons_of(0x133), bit(kButtonX));
}

TEST(EvdevLayout, SonyPadsOnTheirKernelDriverHaveNorthOnTop) {
  for (const std::uint16_t product : {0x09cc, 0x0ce6, 0x05c4}) {
    Node node(playstation_node(), 0x054c, product, 0x8111);
    expect_sticks(node, 0, 255);
    expect_triggers(node, 255);
    expect_hat(node);
    node.set_axis(0x10, 0);
    node.set_axis(0x11, 0);
    expect_common_buttons(node);
    EXPECT_EQ(node.buttons_of(0x133), bit(kButtonY));  // BTN_NORTH
    EXPECT_EQ(node.buttons_of(0x134), bit(kButtonX));  // BTN_WEST
    EXPECT_FALSE(node.layout().streams);
  }
}

TEST(EvdevLayout, SwitchPadsOnTheirKernelDriverHaveNorthOnTopAndDigitalTriggers) {
  Node node(nintendo_node(), 0x057e, 0x2009, 0x8111);
  expect_sticks(node, -32767, 32767);
  expect_hat(node);
  node.set_axis(0x10, 0);
  node.set_axis(0x11, 0);
  expect_common_buttons(node);
  EXPECT_EQ(node.buttons_of(0x133), bit(kButtonY));
  EXPECT_EQ(node.buttons_of(0x134), bit(kButtonX));
  EXPECT_EQ(node.buttons_of(0x135), bit(kButtonMisc1));  // capture
  node.set_key(0x138, true);
  EXPECT_FLOAT_EQ(node.state().axis[kLeftTrigger], 1.0f);
  node.set_key(0x139, true);
  EXPECT_FLOAT_EQ(node.state().axis[kRightTrigger], 1.0f);
  EXPECT_FALSE(node.layout().streams);
}

TEST(EvdevLayout, DpadKeysAreADpad) {
  EvdevAbilities abilities = playstation_node();
  abilities.axes.resize(6);  // hid-sony's DualShock 3 has no hat
  for (std::uint16_t code = 0x220; code <= 0x223; ++code) abilities.keys.push_back(code);
  Node node(abilities, 0x054c, 0x0268, 0x8111);
  EXPECT_EQ(node.buttons_of(0x220), bit(kButtonDpadUp));
  EXPECT_EQ(node.buttons_of(0x221), bit(kButtonDpadDown));
  EXPECT_EQ(node.buttons_of(0x222), bit(kButtonDpadLeft));
  EXPECT_EQ(node.buttons_of(0x223), bit(kButtonDpadRight));
}

TEST(EvdevLayout, AJoystickIsStatedAsOne) {
  EvdevAbilities abilities;
  abilities.axes = {{0, 0, 1023}, {1, 0, 1023}, {5, 0, 255}, {6, 0, 255}};
  for (std::uint16_t code = 0x120; code < 0x12c; ++code) abilities.keys.push_back(code);
  Node node(abilities, 0x046d, 0xc215, 0x0110);
  ASSERT_EQ(node.layout().descriptor.applications.size(), 1u);
  EXPECT_EQ(node.layout().descriptor.applications[0], usage::kJoystick);
  EXPECT_TRUE(node.layout().is_pad);
  node.set_axis(0, 1023);
  node.set_axis(5, 0);  // its twist
  EXPECT_FLOAT_EQ(node.state().axis[kLeftX], 1.0f);
  EXPECT_FLOAT_EQ(node.state().axis[kRightX], -1.0f);
}

TEST(EvdevLayout, AxesOfWidestRangesAndValuesOutsideThem) {
  constexpr std::int32_t kLowest = std::numeric_limits<std::int32_t>::min(),
                         kHighest = std::numeric_limits<std::int32_t>::max();
  Node node({{{0, kLowest, kHighest}, {1, 0, kHighest}, {3, -100, 100}, {4, 5, 5}}, {0x130}},
            0x1209, 1, 1);
  node.set_axis(0, kLowest);
  EXPECT_FLOAT_EQ(node.state().axis[kLeftX], -1.0f);
  node.set_axis(0, kHighest);
  EXPECT_FLOAT_EQ(node.state().axis[kLeftX], 1.0f);
  node.set_axis(1, -1);  // uninitialised, below its range
  EXPECT_FLOAT_EQ(node.state().axis[kLeftY], 1.0f);
  node.set_axis(1, kHighest);
  EXPECT_FLOAT_EQ(node.state().axis[kLeftY], -1.0f);
  node.set_axis(3, 32767);
  EXPECT_FLOAT_EQ(node.state().axis[kRightX], 1.0f);
  node.set_axis(4, 77);  // no range: no position
  EXPECT_FLOAT_EQ(node.state().axis[kRightY], 0.0f);
}

TEST(EvdevLayout, WhateverANodeClaimsItIsADescriptorAndAShortReport) {
  EvdevAbilities all, gaps;
  for (std::uint16_t code = 0; code < 0x400; ++code) {
    if (code <= 0x50) all.axes.push_back({code, std::numeric_limits<std::int32_t>::min(), 70000});
    all.keys.push_back(code);
    if (code % 3 != 2) gaps.keys.push_back(code);
  }
  gaps.axes = all.axes;
  for (const EvdevAbilities& abilities : {all, gaps, EvdevAbilities{}}) {
    const EvdevLayout layout = evdev_layout(abilities, {});
    const auto parsed = parse_descriptor(layout.descriptor);
    ASSERT_TRUE(parsed) << parsed.error().message;
    EXPECT_EQ(report_bytes(*parsed, FieldKind::input, 0), layout.report_bytes);
    EXPECT_LE(layout.report_bytes, kMaxReportBytes);
    EvdevState state;
    state.keys.set();
    Report report;
    put_state(layout, state, report);
    EXPECT_EQ(report.size, layout.report_bytes);
  }
}

TEST(EvdevLayout, EveryCodeStandsWhereTheDescriptorSaysSo) {
  EvdevAbilities abilities = playstation_node();
  abilities.axes.push_back({0x12, -1, 1});  // a second hat
  abilities.axes.push_back({0x13, -1, 1});
  abilities.axes.push_back({0x28, 0, 70000});
  abilities.keys.insert(abilities.keys.begin(), {30, 158, 172, 240});
  abilities.keys.push_back(0x2ff);
  const EvdevLayout layout = evdev_layout(abilities, {});
  const auto parsed = parse_descriptor(layout.descriptor);
  ASSERT_TRUE(parsed) << parsed.error().message;
  const auto codes = evdev_codes(*parsed, StatedBy::evdev_driver);
  ASSERT_EQ(parsed->fields.size(), layout.fields.size());
  for (std::size_t i = 0; i < codes.size(); ++i) {
    EXPECT_EQ(codes[i], layout.fields[i].code) << i;
    EXPECT_EQ(parsed->fields[i].bit_offset, layout.fields[i].bit_offset) << i;
    EXPECT_EQ(parsed->fields[i].bit_size, layout.fields[i].bit_size) << i;
  }
}

// What hid-input makes of a HID pad's reports when no special driver arranges it.
class HidInput {
 public:
  explicit HidInput(const std::vector<std::uint8_t>& descriptor)
      : descriptor_(*parse_descriptor(descriptor)), codes_(evdev_codes(descriptor_)) {
    std::array<std::optional<EvdevAxis>, evdev::kAbsMax + 1> axes;
    std::bitset<evdev::kKeyMax + 1> keys;
    for (std::size_t i = 0; i < codes_.size(); ++i) {
      if (!codes_[i]) continue;
      const Field& f = descriptor_.fields[i];
      const std::uint16_t code = codes_[i]->code;
      if (codes_[i]->type == EvdevType::key) {
        keys.set(code);
      } else if (code == evdev::kAbsHat0X) {
        axes[code] = {code, -1, 1};
        axes[code + 1] = {static_cast<std::uint16_t>(code + 1), -1, 1};
      } else {
        axes[code] = {code, static_cast<std::int32_t>(f.logical_min),
                      static_cast<std::int32_t>(f.logical_max)};
      }
    }
    for (const auto& a : axes) {
      if (a) abilities_.axes.push_back(*a);
    }
    for (std::uint16_t code = 0; code < keys.size(); ++code) {
      if (keys[code]) abilities_.keys.push_back(code);
    }
  }
  const EvdevAbilities& abilities() const { return abilities_; }

  void take(const Report& report, EvdevState& state) const {
    const std::size_t skip = descriptor_.numbered ? 1 : 0;
    const std::span<const std::uint8_t> data(report.bytes.data() + skip, report.size - skip);
    for (std::size_t i = 0; i < codes_.size(); ++i) {
      const Field& f = descriptor_.fields[i];
      if (!codes_[i] || (descriptor_.numbered && f.report_id != report.bytes[0])) continue;
      const std::int64_t value = field_value(f, data);
      const std::uint16_t code = codes_[i]->code;
      if (codes_[i]->type == EvdevType::key) {
        state.keys[code] = value != 0;
      } else if (code == evdev::kAbsHat0X) {
        take_hat(f, value, state);
      } else {
        state.axis[code] = static_cast<std::int32_t>(value);
      }
    }
  }

 private:
  static void take_hat(const Field& f, std::int64_t value, EvdevState& state) {
    constexpr std::int32_t kX[] = {0, 0, 1, 1, 1, 0, -1, -1, -1};
    constexpr std::int32_t kY[] = {0, -1, -1, 0, 1, 1, 1, 0, -1};
    std::int64_t direction = (value - f.logical_min) * 8 / (f.logical_max - f.logical_min + 1) + 1;
    if (value < f.logical_min || direction < 0 || direction > 8) direction = 0;
    state.axis[evdev::kAbsHat0X] = kX[direction];
    state.axis[evdev::kAbsHat0X + 1] = kY[direction];
  }
  ReportDescriptor descriptor_;
  std::vector<std::optional<EvdevCode>> codes_;
  EvdevAbilities abilities_;
};

// Bits on a vendor page, which hid-input leaves out.
constexpr std::uint32_t kPaddles =
    bit(kButtonPaddle1) | bit(kButtonPaddle2) | bit(kButtonPaddle3) | bit(kButtonPaddle4);

// Reports that the descriptor is untrue about: the kernel would read something else.
bool is_replaced(const PadLayout& layout, const Report& report) {
  return std::any_of(layout.reports.begin(), layout.reports.end(), [&](const ReportLayout& r) {
    return std::find(r.exact_sizes.begin(), r.exact_sizes.end(), report.size) !=
           r.exact_sizes.end();
  });
}

// The same entry of config/pads, or none, must give the same state through both nodes of a pad.
void expect_same_through_evdev(const std::string& path, const PadOverrides& overrides,
                               int& compared) {
  SCOPED_TRACE(path);
  const auto trace = read_trace(path);
  ASSERT_TRUE(trace) << trace.error().message;
  DeviceInfo info = trace->devices[0].info;
  const auto raw_layout = pad_layout(info, overrides);
  ASSERT_TRUE(raw_layout);
  const HidInput kernel(info.descriptor);
  const EvdevLayout stated = evdev_layout(kernel.abilities(), info.descriptor);
  info.driver = "evdev";
  info.version = 0x0111;
  info.descriptor = stated.descriptor;
  const auto layout = pad_layout(info, overrides);
  ASSERT_TRUE(layout) << layout.error().message;
  if (layout->override_origin != raw_layout->override_origin) return;
  ++compared;
  EvdevState state;
  PadState raw, through;
  for (const TraceEvent& event : trace->events) {
    const Report report = report_of(*trace, event);
    if (report.size < 2 || is_replaced(*raw_layout, report)) continue;
    if (!decode(*raw_layout, report, raw)) continue;
    kernel.take(report, state);
    Report evdev_report;
    put_state(stated, state, evdev_report);
    ASSERT_TRUE(decode(*layout, evdev_report, through));
    for (int a = 0; a < kAxisCount; ++a) {
      EXPECT_NEAR(through.axis[a], raw.axis[a], 1e-6f) << kAxisNames[a];
    }
    EXPECT_EQ(through.buttons & ~kPaddles, raw.buttons & ~kPaddles);
    EXPECT_EQ(through.hat, raw.hat);
  }
}

TEST(EvdevLayout, AHidPadIsTheSameThroughHidrawAndThroughEvdev) {
  const PadOverrides overrides = shipped_pads();
  int compared = 0;
  for (const std::string& path : files_in(kGoldenPads, ".hid"))
    expect_same_through_evdev(path, overrides, compared);
  EXPECT_GE(compared, 8);
}

}  // namespace
}  // namespace gaitpad
