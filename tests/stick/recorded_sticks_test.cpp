// Real DualSense recordings through Sony's default zones and through measured ones. Axes read here
// by byte: report 1 begins with left x, y, right x, y, 0..255, y downwards.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <span>
#include <sstream>

#include "stick/outline.h"
#include "stick/pad_analysis.h"
#include "tests/shared_data.h"

namespace gaitpad {
namespace {

std::array<StickTrack, 2> tracks_of(const std::string& name) {
  std::array<StickTrack, 2> tracks;
  std::ifstream file(kPadRecordings + name);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string tag, time, size;
    int report = 0, axis[4] = {};
    words >> tag >> time >> size >> std::hex >> report;
    for (int& a : axis) words >> a;
    if (tag != "E:" || !words || report != 1) continue;
    const auto raw = [&](int i) { return (axis[i] - 127.5) / 127.5; };
    const std::int64_t time_ns = std::llround(std::stod(time) * 1e9);
    tracks[0].push_back({time_ns, {raw(0), -raw(1)}});
    tracks[1].push_back({time_ns, {raw(2), -raw(3)}});
  }
  return tracks;
}

std::vector<Stick> recorded(const std::string& name) {
  Calibration calibration;
  calibration.left.inner = calibration.right.inner = kInnerZoneSony;
  const auto tracks = tracks_of(name);
  std::vector<Stick> sticks;
  for (std::size_t i = 0; i < tracks[0].size(); ++i)
    sticks.push_back(stick_position(calibration, tracks[0][i].raw, tracks[1][i].raw));
  return sticks;
}

StickCalibration advised(std::initializer_list<const char*> recordings, std::size_t side) {
  std::vector<StickTrack> tracks;
  for (const char* name : recordings) tracks.push_back(tracks_of(name)[side]);
  return stick_advice(stick_statistics(tracks, vec2(2.0 / 255.0)), {}).calibration;
}

class RecordedSticks : public testing::Test {
 protected:
  void SetUp() override { GAITPAD_NEEDS(kPadRecordings); }
};

TEST_F(RecordedSticks, RestNeverWalks) {
  for (const char* button : {"circle", "dpad_down", "dpad_left", "dpad_right", "dpad_up", "l2",
                             "r1", "r2", "square", "start", "x", "right_stick"}) {
    const auto sticks = recorded(std::string("dualsense_usb_") + button + ".hid");
    EXPECT_GT(sticks.size(), 700u) << button;
    for (const Stick& s : sticks) ASSERT_EQ(s.left, vec2(0.0)) << button;
  }
}

// Both sticks saturate in both axes and are round at the corners. By every report's greatest radius
// they come to 8.5 and 7.4 %.
TEST_F(RecordedSticks, OutlineOfARealDualSense) {
  for (const std::size_t side : {0, 1}) {
    const std::string name = side == 0 ? "left" : "right";
    const StickTrack track = tracks_of("dualsense_usb_" + name + "_stick.hid")[side];
    const Outline outline = outline_of(std::span(&track, 1), vec2(0.01, 0.0), 0.0);
    EXPECT_EQ(filled_bins(outline), kCircularityBins);
    EXPECT_NEAR(circularity_error(outline).value_or(0.0), side == 0 ? 8.5 : 7.4, 0.6);
    const Reach reach = reach_of(outline);
    EXPECT_NEAR(reach.min_x.value_or(0.0), -1.0, 0.005);
    EXPECT_NEAR(reach.max_x.value_or(0.0), 1.0, 0.005);
    EXPECT_NEAR(reach.min_y.value_or(0.0), -1.0, 0.005);
    EXPECT_NEAR(reach.max_y.value_or(0.0), 1.0, 0.005);
  }
}

// Of the recording in which the stick is turned alone, and with the one in which it rests.
TEST_F(RecordedSticks, RestNeverWalksWithTheZonesOfTheRecordingsThatTurn) {
  constexpr const char* kLeft = "dualsense_usb_left_stick.hid";
  constexpr const char* kRight = "dualsense_usb_right_stick.hid";
  const StickCalibration zones[2][2] = {{advised({kLeft}, 0), advised({kLeft, kRight}, 0)},
                                        {advised({kRight}, 1), advised({kLeft, kRight}, 1)}};
  for (const char* name :
       {"circle.hid", "dpad_down.hid", "dpad_left.hid", "dpad_right.hid", "dpad_up.hid",
        "l1.raw.hid", "l2.hid", "l3.hid", "r1.hid", "r2.hid", "square.hid", "start.hid", "x.hid",
        "left_stick.hid", "right_stick.hid"}) {
    const std::string button = name;
    const auto tracks = tracks_of("dualsense_usb_" + button);
    ASSERT_GT(tracks[0].size(), 700u) << name;
    const bool is_moved[2] = {button[0] == 'l' && button[1] != '2', button == "right_stick.hid"};
    for (std::size_t side = 0; side < 2; ++side) {
      if (is_moved[side]) continue;
      for (const StickSample& sample : tracks[side])
        for (const StickCalibration& c : zones[side])
          ASSERT_EQ(stick_position(c, sample.raw), vec2(0.0)) << name << side;
    }
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
