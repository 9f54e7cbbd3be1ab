// Real DualSense recordings through Sony's default zones. Axes read here by byte: report 1 begins
// with left x, y, right x, y, 0..255, y downwards.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "stick/calibration.h"

namespace gaitpad {
namespace {

std::vector<Stick> recorded(const std::string& name) {
  Calibration calibration;
  calibration.left.inner = calibration.right.inner = kInnerZoneSony;
  std::vector<Stick> sticks;
  std::ifstream file(std::string(GAITPAD_SHARED_DATA "/hid/") + name);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string tag, time, size;
    int report = 0, axis[4] = {};
    words >> tag >> time >> size >> std::hex >> report;
    for (int& a : axis) words >> a;
    if (tag != "E:" || !words || report != 1) continue;
    const auto raw = [&](int i) { return (axis[i] - 127.5) / 127.5; };
    sticks.push_back(stick_position(calibration, {raw(0), -raw(1)}, {raw(2), -raw(3)}));
  }
  return sticks;
}

class RecordedSticks : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(GAITPAD_SHARED_DATA "/hid")) {
      GTEST_SKIP() << "no recordings at " GAITPAD_SHARED_DATA "/hid";
    }
  }
};

TEST_F(RecordedSticks, RestNeverWalks) {
  for (const char* button : {"circle", "dpad_down", "dpad_left", "dpad_right", "dpad_up", "l2",
                             "r1", "r2", "square", "start", "x", "right_stick"}) {
    const auto sticks = recorded(std::string("dualsense_usb_") + button + ".hid");
    EXPECT_GT(sticks.size(), 700u) << button;
    for (const Stick& s : sticks) ASSERT_EQ(s.left, vec2(0.0)) << button;
  }
}

TEST_F(RecordedSticks, ATurnedStickReachesTheRimAllRoundAndTheOtherRests) {
  const auto sticks = recorded("dualsense_usb_left_stick.hid");
  ASSERT_GT(sticks.size(), 1000u);
  double longest[4] = {};  // by quadrant
  for (const Stick& s : sticks) {
    ASSERT_EQ(s.right, vec2(0.0));
    ASSERT_LE(glm::length(s.left), 1.0 + 4e-16);
    double& l = longest[(s.left.x > 0.0) + 2 * (s.left.y > 0.0)];
    l = std::max(l, glm::length(s.left));
  }
  for (const double l : longest) EXPECT_GE(l, 0.978);
}

}  // namespace
}  // namespace gaitpad
