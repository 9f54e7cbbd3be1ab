#include "session/pad_setup.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <filesystem>
#include <fstream>

#include "tests/session/made_session.h"

namespace gaitpad {
namespace {

namespace fs = std::filesystem;

class PadSetup : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        (fs::temp_directory_path() / ("gaitpad_pad_setup_" + std::to_string(::getpid()))).string();
    fs::create_directories(folder_ + "/calibration");
    fs::create_directories(folder_ + "/pads");
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ + "/" + name) << text;
    return folder_ + "/" + name;
  }
  PadFiles files(const std::string& map = "", const std::string& calibration = "") const {
    auto loaded = load_pad_files({folder_}, map, calibration);
    EXPECT_TRUE(loaded) << loaded.error().message;
    return loaded ? *loaded : PadFiles();
  }
  // As a replay of the recording gets it: through text, with the same files but --calibration.
  Calibration replayed(const PadFiles& all, const TraceDevice& device) const {
    Trace trace;
    trace.devices = {device};
    auto read = parse_trace(trace_text(trace), "a recording");
    EXPECT_TRUE(read) << read.error().message;
    PadFiles others = all;
    others.calibration.reset();
    auto config = pad_config(others, read->devices.front(), "a recording");
    EXPECT_TRUE(config) << config.error().message;
    return config->calibration;
  }

  std::string folder_;
};

bool is_bit_identical(const StickCalibration& a, const StickCalibration& b) {
  const auto same = [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  };
  return same(a.x.min, b.x.min) && same(a.x.centre, b.x.centre) && same(a.x.max, b.x.max) &&
         same(a.y.min, b.y.min) && same(a.y.centre, b.y.centre) && same(a.y.max, b.y.max) &&
         a.shape == b.shape && same(a.inner, b.inner) && same(a.outer, b.outer) &&
         same(a.sideways, b.sideways) && same(a.curve, b.curve);
}

constexpr FactorySticks kFactory = {.left_x = {-0.7123456789012345, 1.0 / 30, 0.81},
                                    .left_y = {-0.8, -0.02, 0.79},
                                    .right_x = {-0.75, 0.01, 0.75},
                                    .right_y = {-0.75, -0.0, 0.75}};

TEST_F(PadSetup, AReplayHasTheCalibrationOfTheLiveSessionBitByBit) {
  write("calibration/a.toml", "devices = ['*:*']\n[left]\ninner = 0.1234567890123456789\n");
  const std::string by_hand =
      write("own.toml", "name = 'my \\\"own\\\"\\nfile'\n[right]\nx = { centre = -0.0 }\n");
  for (const std::string& calibration : {std::string(), by_hand}) {
    for (const auto& factory : {std::optional<FactorySticks>(), std::optional(kFactory)}) {
      const PadFiles all = files("", calibration);
      auto recorded = recorded_device(all, made_pad(), factory);
      ASSERT_TRUE(recorded) << recorded.error().message;
      auto live = pad_config(all, *recorded, "live");
      ASSERT_TRUE(live) << live.error().message;
      const Calibration again = replayed(all, *recorded);
      EXPECT_TRUE(is_bit_identical(live->calibration.left, again.left));
      EXPECT_TRUE(is_bit_identical(live->calibration.right, again.right));
    }
  }
}

TEST_F(PadSetup, FactorySticksComeBeforeTheModelsFileAndKeepItsZones) {
  write("calibration/a.toml",
        "devices = ['1209:0001']\n[left]\ninner = 0.3\nx = { min = -0.5, max = 0.5 }\n");
  auto recorded = recorded_device(files(), made_pad(), kFactory);
  ASSERT_TRUE(recorded);
  const Calibration calibration = replayed(files(), *recorded);
  EXPECT_EQ(calibration.left.inner, 0.3);
  EXPECT_EQ(calibration.left.x.centre, 1.0 / 30);
  EXPECT_EQ(calibration.left.x.min, -0.7123456789012345);
  EXPECT_EQ(calibration.right.y.max, 0.75);
}

TEST_F(PadSetup, AFileForThisOneDeviceComesBeforeItsFactorySticks) {
  DeviceInfo info = made_pad();
  info.unique_id = "A1";
  info.physical_path = "usb-1";
  for (const char* whose : {"unique_id = 'A1'\n", "devices = ['*:*']\nport = 'usb-1'\n"}) {
    write("calibration/a.toml", std::string(whose) + "[left]\nx = { centre = 0.05 }\n");
    auto recorded = recorded_device(files(), info, kFactory);
    ASSERT_TRUE(recorded);
    EXPECT_EQ(replayed(files(), *recorded).left.x.centre, 0.05);
  }
}

TEST_F(PadSetup, WhatIsGivenByHandComesBeforeEverything) {
  write("calibration/a.toml", "unique_id = 'A1'\n[left]\ninner = 0.3\n");
  const std::string by_hand = write("own.toml", "[left]\ninner = 0.4\n");
  DeviceInfo info = made_pad();
  info.unique_id = "A1";
  auto recorded = recorded_device(files("", by_hand), info, kFactory);
  ASSERT_TRUE(recorded);
  const Calibration calibration = replayed(files(), *recorded);
  EXPECT_EQ(calibration.left.inner, 0.4);
  EXPECT_EQ(calibration.left.x.centre, 0.0);
}

TEST_F(PadSetup, FactoryNumbersThatNoStickHasAreNotTaken) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  FactorySticks odd;
  odd.left_x = {-1.0, nan, 1.0};
  odd.left_y = {0.9, 0.0, -0.9};
  odd.right_x = {-1.0, 0.99, 1.0};
  odd.right_y = {-7.0, 0.125, 9.0};
  auto recorded = recorded_device(files(), made_pad(), odd);
  ASSERT_TRUE(recorded);
  const Calibration calibration = replayed(files(), *recorded);
  EXPECT_EQ(calibration.left.x.centre, 0.0);
  EXPECT_EQ(calibration.left.y.min, -1.0);
  EXPECT_EQ(calibration.right.x.centre, 0.0);
  EXPECT_EQ(calibration.right.y.centre, 0.125);
  EXPECT_EQ(calibration.right.y.max, 1.0);
}

TEST_F(PadSetup, ARecordingsOwnCalibrationComesBeforeTheFiles) {
  write("calibration/a.toml", "devices = ['*:*']\n[left]\ninner = 0.3\n");
  TraceDevice device;
  device.info = made_pad();
  EXPECT_EQ(pad_config(files(), device, "x")->calibration.left.inner, 0.3);
  device.calibration = "[left]\ninner = 0.25\n";
  EXPECT_EQ(pad_config(files(), device, "x")->calibration.left.inner, 0.25);
  device.calibration = "[left]\ninner = 7\n";
  auto damaged = pad_config(files(), device, "walk.hid: device 0");
  ASSERT_FALSE(damaged);
  EXPECT_EQ(damaged.error().message.find("walk.hid: device 0: calibration:2:"), 0u)
      << damaged.error().message;
}

TEST_F(PadSetup, AMapGivenByHandComesBeforeConfigPads) {
  write("pads/a.toml", "[[pad]]\nvendor = 0x1209\npad = true\n");
  const std::string map = write("map.toml", "[[pad]]\nvendor = 0x1209\npad = false\n");
  TraceDevice device;
  device.info = made_pad();
  EXPECT_TRUE(pad_config(files(), device, "x")->is_usable);
  EXPECT_FALSE(pad_config(files(map), device, "x")->is_usable);
}

TEST_F(PadSetup, TextsOfAHostileDeviceFitIntoARecording) {
  DeviceInfo info = made_pad();
  info.name = std::string(100'000, 'n');
  info.unique_id = std::string(100'000, 'u');
  info.physical_path = "a\nE: 0.000000 1 00";
  info.driver = "hidraw";
  info.mapping = std::string(100'000, 'm');
  auto recorded = recorded_device(files(), info, std::nullopt);
  ASSERT_TRUE(recorded);
  EXPECT_TRUE(recorded->info.mapping.empty());
  static_cast<void>(replayed(files(), *recorded));
}

TEST_F(PadSetup, DamagedFilesAreErrorsThatNameThem) {
  const std::string damaged = write("damaged.toml", "unknown = 1\n");
  auto by_hand = load_pad_files({folder_}, "", damaged);
  ASSERT_FALSE(by_hand);
  EXPECT_EQ(by_hand.error().message, damaged + ":1: unknown key \"unknown\"");
  EXPECT_FALSE(load_pad_files({folder_}, damaged, ""));
  EXPECT_FALSE(load_pad_files({folder_}, "/nonexistent.toml", ""));
}

}  // namespace
}  // namespace gaitpad
