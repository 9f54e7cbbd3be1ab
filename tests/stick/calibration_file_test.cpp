#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "stick/calibration.h"

namespace gaitpad {
namespace {

CalibrationFile parsed(const std::string& text) {
  auto file = parse_calibration(text, "c.toml");
  EXPECT_TRUE(file) << file.error().message;
  return file ? *file : CalibrationFile();
}
std::string refusal(const std::string& text) {
  auto file = parse_calibration(text, "c.toml");
  return file ? "none" : file.error().message;
}

TEST(CalibrationFile, EmptyFileGivesTheDefaults) {
  const CalibrationFile file = parsed("");
  EXPECT_EQ(file.calibration.left.inner, kInnerZoneUnknown);
  EXPECT_EQ(file.calibration.left.outer, 0.95);
  EXPECT_EQ(file.calibration.left.sideways, 0.08);
  EXPECT_EQ(file.calibration.left.shape, ZoneShape::both);
}

TEST(CalibrationFile, EveryKeyIsRead) {
  const CalibrationFile file = parsed(
      "name = 'mine'\nunique_id = 'aa:bb'\nport = '1-2'\ndevices = ['054c:09cc', '057e:*']\n"
      "[right]\nx = {min = -0.9, centre = 0.05, max = 0.95}\ny.centre = -0.1\nshape = 'axial'\n"
      "inner = 0.07\nouter = 0.9\nsideways = 0.1\ncurve = 0.4\n");
  EXPECT_EQ(file.name, "mine");
  EXPECT_EQ(file.unique_id, "aa:bb");
  EXPECT_EQ(file.port, "1-2");
  ASSERT_EQ(file.devices.size(), 2u);
  EXPECT_EQ(file.devices[0].vendor, 0x054c);
  EXPECT_EQ(file.devices[0].product, 0x09cc);
  EXPECT_EQ(file.devices[1].product, -1);
  const StickCalibration& right = file.calibration.right;
  EXPECT_EQ(right.x.min, -0.9);
  EXPECT_EQ(right.x.centre, 0.05);
  EXPECT_EQ(right.x.max, 0.95);
  EXPECT_EQ(right.y.centre, -0.1);
  EXPECT_EQ(right.shape, ZoneShape::axial);
  EXPECT_EQ(right.inner, 0.07);
  EXPECT_EQ(right.outer, 0.9);
  EXPECT_EQ(right.sideways, 0.1);
  EXPECT_EQ(right.curve, 0.4);
  EXPECT_EQ(file.calibration.left.inner, kInnerZoneUnknown);
}

TEST(CalibrationFile, WrittenTextReadsBackToTheSameBits) {
  CalibrationFile file;
  file.name = "a \"b\" \\ \n c";
  file.unique_id = "x";
  file.devices = {{0x054c, 0x0ce6}, {-1, -1}};
  file.calibration.left.x = {-1.0 / 3.0, 0.1 + 0.2 - 0.25, 0.7};
  file.calibration.left.inner = 1e-5;
  file.calibration.right.shape = ZoneShape::radial;
  file.calibration.right.curve = 2.0 / 7.0;
  const CalibrationFile back = parsed(calibration_text(file));
  EXPECT_EQ(back.name, file.name);
  EXPECT_EQ(back.devices.size(), 2u);
  EXPECT_EQ(back.calibration.left.x.min, file.calibration.left.x.min);
  EXPECT_EQ(back.calibration.left.x.centre, file.calibration.left.x.centre);
  EXPECT_EQ(back.calibration.left.inner, file.calibration.left.inner);
  EXPECT_EQ(back.calibration.right.shape, ZoneShape::radial);
  EXPECT_EQ(back.calibration.right.curve, file.calibration.right.curve);
  EXPECT_EQ(calibration_text(back), calibration_text(file));
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

TEST(CalibrationFit, TheMoreAFileSaysTheBetterItFits) {
  DeviceIdentity device{0x054c, 0x09cc, "aa:bb", "1-2"};
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

class FindCalibration : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(user_);
    std::filesystem::create_directories(shipped_);
  }
  void TearDown() override { std::filesystem::remove_all(top_); }
  static void write(const std::string& path, const std::string& text) {
    std::ofstream(path) << text;
  }

  // Tests run side by side, each in its own process.
  std::string top_ = testing::TempDir() + "gaitpad_calibration_" + std::to_string(getpid()) + "/";
  std::string user_ = top_ + "user", shipped_ = top_ + "shipped";
  std::vector<std::string> folders_ = {user_, shipped_};
  DeviceIdentity device_{0x054c, 0x09cc, "aa:bb", "1-2"};
};

TEST_F(FindCalibration, WithoutFilesAnUnknownStickIsAssumed) {
  folders_.push_back(top_ + "absent");
  auto found = find_calibration(folders_, device_);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->calibration.left.inner, kInnerZoneUnknown);
}

TEST_F(FindCalibration, TheBestFitWinsAndTheEarlierFolderAmongEquals) {
  write(shipped_ + "/a.toml", "name = 'shipped'\ndevices = ['054c:*']\n");
  write(shipped_ + "/b.toml", "name = 'any'\ndevices = ['*:*']\n");
  EXPECT_EQ(find_calibration(folders_, device_)->name, "shipped");
  write(user_ + "/z.toml", "name = 'user'\ndevices = ['054c:*']\n");
  EXPECT_EQ(find_calibration(folders_, device_)->name, "user");
  write(shipped_ + "/c.toml", "name = 'exact'\ndevices = ['054c:09cc']\n");
  EXPECT_EQ(find_calibration(folders_, device_)->name, "exact");
}

TEST_F(FindCalibration, ADamagedFileIsAnErrorThatNamesIt) {
  write(user_ + "/z.toml", "\n\nouter = 1\n");
  auto found = find_calibration(folders_, device_);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().message, user_ + "/z.toml:3: unknown key \"outer\"");
}

}  // namespace
}  // namespace gaitpad
