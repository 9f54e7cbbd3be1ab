#include "gaitpad/pad_configuration.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdlib>
#include <filesystem>

#include "tests/own_folder.h"
#include "tests/session/made_session.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

namespace fs = std::filesystem;

class PadConfiguration : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ + "/calibration");
    fs::create_directories(folder_ + "/pads");
    fs::create_directories(folder_ + "/user");
  }
  std::string write(const std::string& name, const std::string& text) const {
    return own_.write(name, text);
  }
  PadFiles files(const std::string& map = "", const std::string& calibration = "") const {
    PadFiles files = value_of(load_pad_files({folder_}, map, calibration));
    files.user_calibrations = folder_ + "/user";
    return files;
  }
  TraceDevice recorded(const PadFiles& all, const DeviceInfo& info,
                       const std::optional<FactorySticks>& factory = std::nullopt) {
    return recorded_device(all, info, factory, remarks_).device;
  }
  // The configuration of the device in a live session.
  Result<PadConfig> live_pad(const PadFiles& all, const DeviceInfo& info,
                             const std::optional<FactorySticks>& factory = std::nullopt) {
    const auto [device, calibration] = recorded_device(all, info, factory, remarks_);
    return pad_config(all, device.info, calibration, "live");
  }
  // The configuration in a replay of the recording, which is written as text and read; the files
  // are the same except --calibration.
  PadConfig replayed_pad(const PadFiles& all, const TraceDevice& device) const {
    Trace trace;
    trace.devices = {device};
    const Trace read = value_of(parse_trace(trace_text(trace), "a recording"));
    PadFiles others = all;
    others.calibration.reset();
    return value_of(pad_config(others, read.devices.front(), "a recording"));
  }
  Calibration replayed(const PadFiles& all, const TraceDevice& device) const {
    return replayed_pad(all, device).calibration;
  }

  OwnFolder own_;
  const std::string folder_ = own_.path.string();
  std::vector<std::string> remarks_;
};

bool is_bit_identical(const StickCalibration& a, const StickCalibration& b) {
  const auto same = [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  };
  return a.frame == b.frame && same(a.x.min, b.x.min) && same(a.x.centre, b.x.centre) &&
         same(a.x.max, b.x.max) && same(a.y.min, b.y.min) && same(a.y.centre, b.y.centre) &&
         same(a.y.max, b.y.max) && a.shape == b.shape && same(a.inner, b.inner) &&
         same(a.outer, b.outer) && same(a.sideways, b.sideways) && same(a.curve, b.curve);
}

constexpr FactorySticks kFactory = {.left_x = {-0.7123456789012345, 1.0 / 30, 0.81},
                                    .left_y = {-0.8, -0.02, 0.79},
                                    .right_x = {-0.75, 0.01, 0.75},
                                    .right_y = {-0.75, -0.0, 0.75}};

TEST_F(PadConfiguration, AReplayHasTheCalibrationOfTheLiveSessionBitByBit) {
  write("calibration/a.toml", "devices = ['*:*']\n[left]\ninner = 0.1234567890123456789\n");
  const std::string by_hand =
      write("own.toml",
            "name = 'my \\\"own\\\"\\nfile'\n[right]\nx = { centre = -0.0 }\n"
            "right = '-y'\nforward = 'x'\n[left_trigger]\nreleased = 0.1\n");
  for (const std::string& calibration : {std::string(), by_hand}) {
    for (const auto& factory : {std::optional<FactorySticks>(), std::optional(kFactory)}) {
      const PadFiles all = files("", calibration);
      const TraceDevice device = recorded(all, made_pad(), factory);
      auto live = live_pad(all, made_pad(), factory);
      ASSERT_TRUE(live) << live.error().message;
      const Calibration again = replayed(all, device);
      EXPECT_TRUE(is_bit_identical(live->calibration.left, again.left));
      EXPECT_TRUE(is_bit_identical(live->calibration.right, again.right));
      EXPECT_EQ(live->calibration.left_trigger, again.left_trigger);
      EXPECT_EQ(again.left_trigger.released, calibration.empty() ? 0.0 : 0.1);
      EXPECT_EQ(again.right.frame.right,
                calibration.empty() ? RawDirection::plus_x : RawDirection::minus_y);
    }
  }
}

TEST_F(PadConfiguration, TheKeyboardIsAFallbackLiveAndInAReplay) {
  const PadFiles all = files();
  DeviceInfo info = made_pad();
  info.driver = "keyboard";
  const TraceDevice device = recorded(all, info);
  auto live = live_pad(all, info);
  ASSERT_TRUE(live);
  EXPECT_TRUE(live->is_fallback);
  EXPECT_TRUE(replayed_pad(all, device).is_fallback);
  info.driver = "evdev";
  EXPECT_FALSE(replayed_pad(all, recorded(all, info)).is_fallback);
}

// Factory sticks take precedence over the model's file, whose zones they keep, but not if axes are
// turned, because the pad reports unturned ones. A file for this device or one given by hand takes
// precedence over them.
TEST_F(PadConfiguration, FactorySticksComeBeforeWhatIsNotForThisOneDevice) {
  DeviceInfo info = made_pad();
  info.unique_id = "A1";
  info.physical_path = "usb-1";
  const auto with = [&](const std::string& file) {
    write("calibration/a.toml", file);
    return replayed(files(), recorded(files(), info, kFactory));
  };
  const Calibration model =
      with("devices = ['1209:0001']\n[left]\ninner = 0.3\nx = { min = -0.5, max = 0.5 }\n");
  EXPECT_EQ(model.left.inner, 0.3);
  EXPECT_EQ(model.left.x.centre, 1.0 / 30);
  EXPECT_EQ(model.left.x.min, -0.7123456789012345);
  EXPECT_EQ(model.right.y.max, 0.75);
  for (const char* file :
       {"unique_id = 'A1'\n[left]\n", "devices = ['*:*']\nport = 'usb-1'\n[left]\n",
        "devices = ['*:*']\n[left]\nright = '-x'\n"})
    EXPECT_EQ(with(file + std::string("x = { centre = 0.05 }\n")).left.x.centre, 0.05) << file;
  const std::string by_hand = write("own.toml", "[left]\ninner = 0.4\n");
  const Calibration hand = replayed(files(), recorded(files("", by_hand), info, kFactory));
  EXPECT_EQ(hand.left.inner, 0.4);
  EXPECT_EQ(hand.left.x.centre, 0.0);
}

TEST_F(PadConfiguration, TheUsersFileComesBeforeAnEquallyGoodOneOfConfig) {
  write("calibration/a.toml", "devices = ['1209:0001']\n[left]\ninner = 0.3\n");
  write("user/z.toml", "devices = ['1209:0001']\n[left]\ninner = 0.25\n");
  EXPECT_EQ(replayed(files(), recorded(files(), made_pad())).left.inner, 0.25);
  // A file given by hand takes precedence over both.
  const std::string by_hand = write("own.toml", "[left]\ninner = 0.4\n");
  EXPECT_EQ(replayed(files(), recorded(files("", by_hand), made_pad())).left.inner, 0.4);
}

TEST_F(PadConfiguration, AReplayDoesNotSeeTheUsersFiles) {
  write("user/a.toml", "devices = ['*:*']\n[left]\ninner = 0.3\n");
  TraceDevice foreign;
  foreign.info = made_pad();
  EXPECT_EQ(pad_config(files(), foreign, "x")->calibration.left.inner, kInnerZoneUnknown);
  write("user/b.toml", "damaged");
  EXPECT_TRUE(pad_config(files(), foreign, "x"));
}

TEST_F(PadConfiguration, AFileForAnotherDriverIsNotTaken) {
  write("user/a.toml", "devices = ['*:*']\ndrivers = ['evdev', 'sdl']\n[left]\ninner = 0.3\n");
  DeviceInfo info = made_pad();
  info.driver = "hidraw";
  EXPECT_EQ(replayed(files(), recorded(files(), info)).left.inner, kInnerZoneUnknown);
  info.driver = "evdev";
  EXPECT_EQ(replayed(files(), recorded(files(), info)).left.inner, 0.3);
}

// The file may belong to another pad, which cannot be known.
TEST_F(PadConfiguration, ADamagedFileOfTheUsersIsARemarkAndThePadPlaysOn) {
  const std::string damaged = write("user/a.toml", "[left]\ninner = 7\n");
  write("user/b.toml", "devices = ['1209:0001']\n[left]\ninner = 0.25\n");
  EXPECT_EQ(replayed(files(), recorded(files(), made_pad())).left.inner, 0.25);
  ASSERT_EQ(remarks_.size(), 1u);
  EXPECT_EQ(remarks_[0], damaged +
                             ":2: \"inner\" is 7, outside [0, 0.9]; pads go on without this "
                             "calibration");
}

// Other data in a calibration would only identify the pad's owner.
TEST_F(PadConfiguration, ARecordingHoldsWhatSteersAndNothingElse) {
  write("user/a.toml",
        "name = 'mine'\nunique_id = 'A1'\nmeasured_on = '2026-11-21'\n[left.measured]\nsigma = "
        "0.5\n");
  DeviceInfo info = made_pad();
  info.unique_id = "A1";
  const std::string text = recorded(files(), info).calibration;
  EXPECT_NE(text.find("name = \"mine\""), std::string::npos) << text;
  for (const char* absent : {"A1", "measured", "2026"})
    EXPECT_EQ(text.find(absent), std::string::npos) << text;
}

constexpr const char* kSwapped =
    "03000000091200000100000011010000,Swapped,leftx:a2,lefty:a3,rightx:a0,righty:a1,a:b2,b:b1,";

PadState decoded(const PadConfig& pad) {
  Report report = made_report(0xff, 0x80);
  report.bytes[4] = 0x18;  // presses button 1
  PadState state;
  EXPECT_TRUE(decode(*pad.layout, report, state));
  return state;
}

TEST_F(PadConfiguration, AFilesMappingComesBeforeConfigPadsAndAReplayHasItToo) {
  write("user/a.toml", "devices = ['*:*']\n");  // without this file config/pads names the controls
  write("pads/a.toml", "[[pad]]\nvendor = 0x1209\n[pad.axes]\nright_x = '0001:0030'\n");
  EXPECT_EQ(decoded(replayed_pad(files(), recorded(files(), made_pad()))).axis[kRightX], 1.0f);
  write("user/a.toml", std::string("devices = ['*:*']\nmapping = '") + kSwapped + "'\n");
  const std::string other = "[[pad]]\nvendor = 0x1234\n";
  const std::string own =
      "[[pad]]\nvendor = 0x1209\nstreams = true\nbutton_order = 'top_first'\n"
      "[pad.axes]\nleft_x = '0001:0030'\n";
  for (const std::string& entry : {other, own}) {
    write("pads/a.toml", entry);
    const TraceDevice device = recorded(files(), made_pad());
    EXPECT_EQ(device.info.mapping, kSwapped);
    auto live = live_pad(files(), made_pad());
    ASSERT_TRUE(live) << live.error().message;
    PadFiles others = files();
    others.user_calibrations.clear();
    const PadConfig again = replayed_pad(others, device);
    for (const PadConfig& pad : {*live, again}) {
      EXPECT_EQ(decoded(pad).axis[kRightX], 1.0f);
      EXPECT_LT(std::abs(decoded(pad).axis[kLeftX]), 0.01f);
      EXPECT_FALSE(pressed(decoded(pad), kButtonA));  // button A is the third one in the file
      // The other keys of config/pads still apply.
      EXPECT_EQ(pad.streams, entry == own);
    }
  }
}

// SDL numbers the kernel's controls, which an untrue descriptor does not describe.
TEST_F(PadConfiguration, AReplacedDescriptorKeepsItsControls) {
  write("user/a.toml", std::string("devices = ['*:*']\nmapping = '") + kSwapped + "'\n");
  write(
      "pads/a.toml",
      "[[pad]]\nvendor = 0x1209\n[pad.replace]\nlengths = [6]\ndescriptor = '05 01 09 05 a1 01 15 "
      "00 26 ff 00 75 08 95 06 09 30 09 31 09 32 09 35 09 33 09 34 81 02 c0'\n");
  const PadConfig pad = replayed_pad(files(), recorded(files(), made_pad()));
  EXPECT_EQ(decoded(pad).axis[kLeftX], 1.0f);
}

TEST_F(PadConfiguration, FactoryNumbersThatNoStickHasAreNotTaken) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  FactorySticks odd;
  odd.left_x = {-1.0, nan, 1.0};
  odd.left_y = {0.9, 0.0, -0.9};
  odd.right_x = {-1.0, 0.99, 1.0};
  odd.right_y = {-7.0, 0.125, 9.0};
  const TraceDevice device = recorded(files(), made_pad(), odd);
  const Calibration calibration = replayed(files(), device);
  EXPECT_EQ(calibration.left.x.centre, 0.0);
  EXPECT_EQ(calibration.left.y.min, -1.0);
  EXPECT_EQ(calibration.right.x.centre, 0.0);
  EXPECT_EQ(calibration.right.y.centre, 0.125);
  EXPECT_EQ(calibration.right.y.max, 1.0);
}

TEST_F(PadConfiguration, ARecordingsOwnCalibrationComesBeforeTheFiles) {
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

TEST_F(PadConfiguration, AMapGivenByHandComesBeforeConfigPads) {
  write("pads/a.toml", "[[pad]]\nvendor = 0x1209\npad = true\n");
  const std::string map = write("map.toml", "[[pad]]\nvendor = 0x1209\npad = false\n");
  TraceDevice device;
  device.info = made_pad();
  EXPECT_TRUE(pad_config(files(), device, "x")->is_usable);
  EXPECT_FALSE(pad_config(files(map), device, "x")->is_usable);
}

TEST_F(PadConfiguration, TextsOfAHostileDeviceFitIntoARecording) {
  DeviceInfo info = made_pad();
  info.name = std::string(100'000, 'n');
  info.unique_id = std::string(100'000, 'u');
  info.physical_path = "a\nE: 0.000000 1 00";
  info.driver = "hidraw";
  info.mapping = std::string(100'000, 'm');
  const TraceDevice device = recorded(files(), info);
  EXPECT_TRUE(device.info.mapping.empty());
  static_cast<void>(replayed(files(), device));
}

TEST_F(PadConfiguration, DamagedFilesAreErrorsThatNameThem) {
  const std::string damaged = write("damaged.toml", "unknown = 1\n");
  auto by_hand = load_pad_files({folder_}, "", damaged);
  ASSERT_FALSE(by_hand);
  EXPECT_EQ(by_hand.error().message, damaged + ":1: unknown key \"unknown\"");
  EXPECT_FALSE(load_pad_files({folder_}, damaged, ""));
  EXPECT_FALSE(load_pad_files({folder_}, "/nonexistent.toml", ""));
}

TEST_F(PadConfiguration, TheUsersDataBaseNamesTheControlsOfLivePads) {
  const std::string guid = "03000000091200000100000000000000,Mine,";
  const std::string in_file = guid + "leftx:a2,lefty:a3,platform:Linux,",
                    in_line = guid + "leftx:a1,lefty:a0,platform:Linux,";
  const std::string db = write("db.txt", "# x\n" + in_file + "\n");
  const Environment file("SDL_GAMECONTROLLERCONFIG_FILE", db.c_str());
  for (const char* driver : {"hidraw", "evdev", "usb"}) {
    DeviceInfo info = made_pad();
    info.driver = driver;
    EXPECT_EQ(recorded(files(), info).info.mapping, in_file) << driver;
    const Environment line("SDL_GAMECONTROLLERCONFIG", in_line.c_str());
    EXPECT_EQ(recorded(files(), info).info.mapping, in_line) << driver;
  }
  EXPECT_TRUE(remarks_.empty());
  // A mapping cannot express everything that config/pads can.
  const PadFiles mapped = files(write("map.toml", "[[pad]]\nvendor = 0x1209\n"));
  EXPECT_TRUE(recorded(mapped, made_pad()).info.mapping.empty());
}

// SDL has already applied such lines: the driver's own line names the controls that SDL has named.
TEST_F(PadConfiguration, LinesOfTheDataBaseAndOfCalibrationsDoNotCountForTheDriverSdl) {
  const std::string guid = "03000000091200000100000000000000,Mine,";
  const Environment line("SDL_GAMECONTROLLERCONFIG", (guid + "leftx:a1,platform:Linux,").c_str());
  DeviceInfo info = made_pad();
  info.driver = "sdl";
  info.mapping = guid + "leftx:a0,lefty:a1,";
  const PadFiles all = files();
  EXPECT_EQ(recorded(all, info).info.mapping, info.mapping);
  PadFiles own = all;
  own.calibration.emplace();
  own.calibration->mapping = guid + "leftx:a2,";
  EXPECT_EQ(recorded(own, info).info.mapping, info.mapping);
  EXPECT_EQ(recorded(own, info).calibration.find("a2"), std::string::npos);
  info.driver = "evdev";
  EXPECT_EQ(recorded(own, info).info.mapping, own.calibration->mapping);
}

TEST_F(PadConfiguration, ADataBaseThatCannotBeReadIsToldOf) {
  // Do not set SDL's variable: SDL would try to load the folder as a file of 2^63 bytes.
  const Environment config("XDG_CONFIG_HOME", folder_.c_str());
  fs::create_directories(user_mapping_file());
  recorded(files(), made_pad());
  ASSERT_EQ(remarks_.size(), 1u);
  EXPECT_NE(remarks_[0].find("not a regular file (a folder)"), std::string::npos);
}

}  // namespace
}  // namespace gaitpad
