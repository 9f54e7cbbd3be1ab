#include <gtest/gtest.h>

#include <filesystem>

#include "gaitpad/calibration.h"
#include "tests/own_folder.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

CalibrationFile parsed(const std::string& text) {
  return value_of(parse_calibration(text, "c.toml"));
}
std::string refusal(const std::string& text) { return cause_of(parse_calibration(text, "c.toml")); }

CalibrationFile full_file() {
  CalibrationFile file;
  file.name = "a \"b\" \\ \n c \x7f \xc3\xa4";
  file.unique_id = "x";
  file.port = "usb-0000:00:14.0-1/input0";
  file.devices = {{0x054c, 0x0ce6}, {0x057e, -1}, {-1, -1}};
  file.drivers = {"hidraw", "usb"};
  file.measured_on = "2026-11-21";
  file.mapping = "030000004c050000e60c000011810000,My \"pad\",a:b0,leftx:a0~,-lefty:+a1,dpup:h0.1,";
  Calibration& c = file.calibration;
  c.left.frame = {RawDirection::minus_y, RawDirection::plus_x};
  c.right.frame = {RawDirection::minus_x, RawDirection::plus_y};
  c.left.x = {-1.0 / 3.0, 0.1 + 0.2 - 0.25, 0.7};
  c.left.inner = 1e-5;
  c.right.y.centre = -0.1;
  c.right.shape = ZoneShape::radial;
  c.right.outer = 0.9;
  c.right.sideways = 0.1;
  c.right.curve = 2.0 / 7.0;
  c.right.filters_jumps = true;
  c.left_trigger = {0.1 / 3.0, 1.0};
  c.right_trigger = {0.0, 0.1 + 1e-16};
  file.measured[0] = StickMeasured{0.0021, 1e-7, 0.0, 11.0 / 3.0};
  file.measured[1] = StickMeasured{};
  return file;
}

// A file written by hand; missing keys keep their defaults.
TEST(CalibrationFile, EveryKeyIsReadAndAnEmptyFileGivesTheDefaults) {
  EXPECT_EQ(parsed(""), CalibrationFile());
  CalibrationFile expected = full_file();
  expected.calibration.left = {};
  expected.calibration.right.frame = {};
  expected.measured = {};
  expected.measured[0].emplace().sigma = 0.003;
  expected.measured[0]->drift_per_s = 0.0;
  EXPECT_EQ(parsed("name = \"a \\\"b\\\" \\\\ \\n c \\u007f \xc3\xa4\"\nunique_id = 'x'\n"
                   "port = 'usb-0000:00:14.0-1/input0'\n"
                   "devices = ['054c:0ce6', '057e:*', '*:*']\ndrivers = ['hidraw', 'usb']\n"
                   "measured_on = '2026-11-21'\nmapping = '" +
                   expected.mapping +
                   "'\n[left.measured]\nsigma = 0.003\ndrift_per_s = 0\n"
                   "[right]\ny.centre = -0.1\nshape = 'radial'\nouter = 0.9\nsideways = 0.1\n"
                   "curve = 0.2857142857142857\nfilters_jumps = true\n"
                   "[left_trigger]\nreleased = 0.03333333333333333\n"
                   "[right_trigger]\npressed = 0.1000000000000001\n"),
            expected);
}

TEST(CalibrationFile, WrittenTextReadsBackToTheSameBits) {
  for (const CalibrationFile& file : {full_file(), CalibrationFile()}) {
    const std::string text = calibration_text(file);
    EXPECT_EQ(parsed(text), file) << text;
    EXPECT_EQ(calibration_text(parsed(text)), text);
  }
}

TEST(CalibrationFile, TheBiasOfTheGyroscopeIsKept) {
  CalibrationFile file;
  EXPECT_EQ(calibration_text(file).find("gyro"), std::string::npos);
  file.gyro_bias_rad_s = TurnRates{0.01, -0.02, 0.0};
  EXPECT_NE(calibration_text(file).find("\n[gyro]\nbias_rad_s = [0.01, -0.02, 0]\n"),
            std::string::npos);
  EXPECT_EQ(parsed(calibration_text(file)).gyro_bias_rad_s, file.gyro_bias_rad_s);
  EXPECT_EQ(cause_of(parse_calibration("[gyro]\nbias_rad_s = [0, 0]\n", "own.toml")).substr(0, 11),
            "own.toml:2:");
}

TEST(CalibrationFile, WrittenNumbersUseTheFewestDigitsAndDefaultsAreLeftOut) {
  CalibrationFile file;
  file.calibration.left.x = {-0.98, 0.012, 1.0};
  const std::string text = calibration_text(file);
  EXPECT_NE(text.find("x = { min = -0.98, centre = 0.012, max = 1 }\n"), std::string::npos) << text;
  for (const char* key : {"forward", "trigger", "filters_jumps"})
    EXPECT_EQ(text.find(key), std::string::npos) << text;
}

// A name with invalid UTF-8 must not make the whole file unreadable.
TEST(CalibrationFile, ANameWithInvalidUtf8IsWrittenAsText) {
  CalibrationFile file;
  file.name = "pad \xff\xfe";
  EXPECT_EQ(parsed(calibration_text(file)).name, "pad ??");
}

TEST(CalibrationFile, AxesWithoutBothDirectionsAreRefused) {
  EXPECT_EQ(refusal("[left]\nright = 'z'"),
            "c.toml:2: unknown direction \"z\"; one of x, -x, y, -y");
  EXPECT_EQ(refusal("[left]\nright = 'y'"),
            "c.toml:2: right is \"y\" and forward is \"y\": one must be an x, the other a y");
  EXPECT_EQ(refusal("[left]\n\nforward = '-x'").substr(0, 10), "c.toml:3: ");
  EXPECT_EQ(refusal("[left]\nright = '-y'\nforward = '-x'"), "accepted");
}

TEST(CalibrationFile, TriggersNeedATravel) {
  EXPECT_EQ(refusal("[left_trigger]\nreleased = 0.5\npressed = 0.55"),
            "c.toml:3: pressed 0.55 is not 0.1 above released 0.5");
  EXPECT_EQ(refusal("[right_trigger]\nreleased = 0.95").substr(0, 10), "c.toml:2: ");
  EXPECT_EQ(refusal("[right_trigger]\npressed = -0.1").substr(0, 10), "c.toml:2: ");
  EXPECT_EQ(refusal("[left_trigger]\nreleased = 0.2\npressed = 0.31"), "accepted");
}

TEST(CalibrationFile, UnknownDriversAndDamagedMappingsAreRefused) {
  EXPECT_EQ(refusal("drivers = ['hidraw', 'xinput']"),
            "c.toml:1: unknown driver \"xinput\"; one of hidraw, usb, evdev, sdl");
  EXPECT_EQ(refusal("\nmapping = 'pad,a:b0'"),
            "c.toml:2: SDL mapping: \"pad\" is no GUID of 32 hexadecimal digits");
  const std::string guid(32, '0');
  EXPECT_EQ(refusal("mapping = '" + guid + ",x,a:q3,'"),
            "c.toml:1: SDL mapping: unknown source \"q3\"");
  EXPECT_EQ(refusal("mapping = \"" + guid + ",x\\ny,a:b0,\""),
            "c.toml:1: \"mapping\" is more than one line");
  EXPECT_EQ(refusal("mapping = '" + guid + "," + std::string(600, 'x') + ",'").substr(0, 22),
            "c.toml:1: SDL mapping:");
  EXPECT_EQ(refusal("mapping = '" + guid + ",x,a:b99,leftx:a0,'"), "accepted");
}

TEST(CalibrationFile, MeasuredNumbersAreFiniteAndBounded) {
  for (const std::string value : {"nan", "inf", "-0.1", "1e9", "'x'"}) {
    EXPECT_EQ(refusal("[left.measured]\nhysteresis = " + value).substr(0, 10), "c.toml:2: ");
  }
  EXPECT_EQ(refusal("[right.measured]\ncentre = 0").substr(0, 31),
            "c.toml:2: unknown key \"centre\"");
}

TEST(CalibrationFile, BadValuesAreRefusedWithFileAndLine) {
  EXPECT_EQ(refusal("[left]\ninenr = 1"),
            "c.toml:2: unknown key \"inenr\"; did you mean \"inner\"?");
  EXPECT_EQ(refusal("\n[left]\ninner = 0.95"), "c.toml:3: \"inner\" is 0.95, outside [0, 0.9]");
  EXPECT_EQ(refusal("[left]\ninner = 0.5\nouter = 0.52"),
            "c.toml:3: the outer zone 0.52 is not 0.05 above the inner zone 0.5");
  EXPECT_EQ(refusal("[left]\nshape = 'round'"),
            "c.toml:2: unknown shape \"round\"; one of radial, axial, both");
  EXPECT_EQ(refusal("[left]\nx = {min = 0.5, centre = 0, max = 1}").substr(0, 13),
            "c.toml:2: \"x\"");
  EXPECT_EQ(refusal("[left]\ny = {centre = 0.95}").substr(0, 13), "c.toml:2: \"y\"");
  EXPECT_EQ(refusal("middle = 1"), "c.toml:1: unknown key \"middle\"");
}

TEST(CalibrationFile, BadDevicePatternsAreRefused) {
  for (const std::string device :
       {"054c", "54c:09cc", "054c:09ccc", "*:09cc", "-54c:09cc", "054g:*", "0x4c:*", ":", ""}) {
    EXPECT_EQ(refusal("devices = ['" + device + "']").substr(0, 10), "c.toml:1: ") << device;
  }
}

TEST(CalibrationFit, AFileThatNamesMoreOfTheDeviceFitsBetter) {
  DeviceIdentity device{0x054c, 0x09cc, "aa:bb", "1-2", "hidraw"};
  const auto fit = [&](const std::string& text) { return calibration_fit(parsed(text), device); };
  const int any = fit("devices = ['*:*']"), vendor = fit("devices = ['054c:*']");
  const int product = fit("devices = ['*:*', '054c:09cc']");
  const int port = fit("devices = ['054c:09cc']\nport = '1-2'");
  const int unique = fit("unique_id = 'aa:bb'");
  EXPECT_TRUE(0 < any && any < vendor && vendor < product && product < port && port < unique);
  EXPECT_EQ(fit("devices = ['054c:0ce6']"), 0);
  EXPECT_EQ(fit("devices = ['054c:09cc']\nport = '1-3'"), 0);
  EXPECT_EQ(fit("devices = ['054c:09cc']\nunique_id = 'aa:cc'"), 0);
  EXPECT_EQ(fit("devices = ['054c:0ce6']\nunique_id = 'aa:bb'"), 0);
  EXPECT_EQ(fit(""), 0);
}

TEST(CalibrationFit, AFileForOtherDriversDoesNotFit) {
  const auto fit = [](const std::string& driver, const std::string& drivers) {
    return calibration_fit(parsed("unique_id = 'aa'\ndrivers = " + drivers),
                           {0x054c, 0x09cc, "aa", "", driver});
  };
  EXPECT_GT(fit("evdev", "['evdev', 'sdl']"), 0);
  EXPECT_GT(fit("sdl", "['evdev', 'sdl']"), 0);
  EXPECT_EQ(fit("hidraw", "['evdev', 'sdl']"), 0);
  EXPECT_GT(fit("hidraw", "[]"), 0);
  // A recording that names no driver came from hidraw.
  EXPECT_GT(fit("", "['hidraw', 'usb']"), 0);
  EXPECT_EQ(fit("", "['evdev']"), 0);
  // A file that names the driver fits better than one that names none, since a pad may be
  // calibrated through two drivers. Naming the device itself counts for more.
  EXPECT_GT(fit("evdev", "['evdev']"), fit("evdev", "[]"));
  const CalibrationFile model = parsed("devices = ['054c:09cc']\nport = '1'\ndrivers = ['evdev']");
  EXPECT_LT(calibration_fit(model, {0x054c, 0x09cc, "aa", "1", "evdev"}), fit("evdev", "[]"));
}

class FindCalibration : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(user_);
    std::filesystem::create_directories(shipped_);
  }
  void write(const std::string& name, const std::string& text) { own_.write(name, text); }

  OwnFolder own_;
  std::string user_ = own_.at("user"), shipped_ = own_.at("shipped");
  std::vector<std::string> folders_ = {user_, shipped_};
  DeviceIdentity device_{0x054c, 0x09cc, "aa:bb", "1-2", "hidraw"};
};

TEST_F(FindCalibration, WithoutFilesAnUnknownStickIsAssumed) {
  folders_.push_back(own_.at("absent"));
  const FoundCalibration found = find_calibration(folders_, device_);
  EXPECT_TRUE(found.problems.empty());
  EXPECT_EQ(found.file.calibration.left.inner, kInnerZoneUnknown);
}

TEST_F(FindCalibration, TheBestFitWinsAndTheEarlierFolderAmongEquals) {
  write("shipped/a.toml", "name = 'shipped'\ndevices = ['054c:*']\n");
  write("shipped/b.toml", "name = 'any'\ndevices = ['*:*']\n");
  EXPECT_EQ(find_calibration(folders_, device_).file.name, "shipped");
  write("user/z.toml", "name = 'user'\ndevices = ['054c:*']\n");
  EXPECT_EQ(find_calibration(folders_, device_).file.name, "user");
  write("shipped/c.toml", "name = 'exact'\ndevices = ['054c:09cc']\n");
  EXPECT_EQ(find_calibration(folders_, device_).file.name, "exact");
}

// The damaged file may be for another pad, so the next best file is used.
TEST_F(FindCalibration, ADamagedFileIsLeftOutAndNamed) {
  write("user/z.toml", "\n\nouter = 1\n");
  write("user/zz.toml", "name = 'sound'\nunique_id = 'aa:bb'\n");
  write("shipped/a.toml", "name = 'shipped'\ndevices = ['054c:*']\n");
  const FoundCalibration found = find_calibration(folders_, device_);
  EXPECT_EQ(found.file.name, "sound");
  ASSERT_EQ(found.problems.size(), 1u);
  EXPECT_EQ(found.problems[0], user_ + "/z.toml:3: unknown key \"outer\"");
}

TEST_F(FindCalibration, AFileInPlaceOfAFolderIsLeftOutAndNamed) {
  write("file", "");
  write("shipped/a.toml", "name = 'shipped'\ndevices = ['054c:*']\n");
  const FoundCalibration found = find_calibration({{own_.at("file"), shipped_}}, device_);
  EXPECT_EQ(found.file.name, "shipped");
  ASSERT_EQ(found.problems.size(), 1u);
  EXPECT_EQ(found.problems[0], own_.at("file") + ": Not a directory");
}

}  // namespace
}  // namespace gaitpad
