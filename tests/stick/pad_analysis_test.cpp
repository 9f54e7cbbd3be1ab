// Advice for given statistics, for made sticks and for real DualSense recordings.
#include "stick/pad_analysis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <span>
#include <sstream>
#include <string>

#include "stick/made_stick.h"
#include "stick/outline.h"
#include "tests/shared_data.h"

namespace gaitpad {
namespace {

// Statistics of a good stick that was released and turned; the numbers are round.
StickStatistics measured() {
  StickStatistics s;
  s.samples = 5000;
  s.centre = vec2(0.02, -0.01);
  s.sigma = vec2(0.002, 0.002);
  s.hysteresis = 0.02;
  s.drift_per_s = 0.0;
  s.min_x = -0.98;
  s.max_x = 0.98;
  s.min_y = -0.97;
  s.max_y = 0.95;
  s.outline.middle = *s.centre;
  s.outline.radius.fill(0.96);
  s.step_x = s.step_y = 2.0 / 255.0;
  return s;
}

StickAdvice advice_for(const StickStatistics& s) { return stick_advice(s, {}); }

// Checks that a file with this calibration loads and gives the same numbers.
void expect_loadable(const StickCalibration& c) {
  CalibrationFile file;
  file.calibration.left = c;
  const auto back = parse_calibration(calibration_text(file), "advice.toml");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->calibration.left.inner, c.inner);
  EXPECT_EQ(back->calibration.left.outer, c.outer);
  EXPECT_EQ(back->calibration.left.sideways, c.sideways);
  EXPECT_EQ(back->calibration.left.x.min, c.x.min);
  EXPECT_EQ(back->calibration.left.y.max, c.y.max);
}

TEST(StickAdvice, InnerZoneIsThreeSigmaPlusHysteresisAndAtLeastFivePercent) {
  StickStatistics s = measured();
  EXPECT_DOUBLE_EQ(advice_for(s).inner_zone, 0.05);
  s.sigma = vec2(0.01, 0.02);
  s.hysteresis = 0.12;
  EXPECT_DOUBLE_EQ(advice_for(s).inner_zone, 0.18);
  // The calibration stores the inner zone as a fraction of the shortest side.
  const double shortest = 0.95 - -0.01;
  EXPECT_NEAR(advice_for(s).calibration.inner, 0.18 / shortest, 1e-12);
}

// A radius of 3 sigma would let one report in ninety pass, because the noise has two directions.
TEST(StickAdvice, WithoutHysteresisTheCalibrationStillKeepsTheNoiseOut) {
  StickStatistics s = measured();
  s.centre = vec2(0.0);
  s.sigma = vec2(0.02, 0.02);
  s.hysteresis = 0.0;
  const StickAdvice advice = advice_for(s);
  EXPECT_DOUBLE_EQ(advice.inner_zone, 0.06);
  EXPECT_EQ(stick_position(advice.calibration, vec2(0.06, 0.075)), vec2(0.0));
}

TEST(StickAdvice, CentreAndEndsAreTheMeasuredOnes) {
  const StickAdvice advice = advice_for(measured());
  EXPECT_EQ(advice.calibration.x.min, -0.98);
  EXPECT_EQ(advice.calibration.x.centre, 0.02);
  EXPECT_EQ(advice.calibration.y.max, 0.95);
  EXPECT_EQ(advice.calibration.shape, ZoneShape::both);
  EXPECT_EQ(advice.calibration.curve, 0.0);
  EXPECT_EQ(advice.verdict, Verdict::good) << advice.reason;
  expect_loadable(advice.calibration);
}

TEST(StickAdvice, TheGivenFrameIsKept) {
  const StickFrame frame{RawDirection::minus_y, RawDirection::plus_x};
  EXPECT_EQ(stick_advice(measured(), frame).calibration.frame, frame);
}

TEST(StickAdvice, TheOuterZoneIsWithinTheShortestDirectionNoiseIncluded) {
  StickStatistics s = measured();
  EXPECT_LE(advice_for(s).calibration.outer, 0.95);
  s.outline.radius[40] = 0.6;
  const StickAdvice advice = advice_for(s);
  EXPECT_LT(advice.calibration.outer, 0.6 / 0.96);
  EXPECT_GT(advice.calibration.outer, 0.55 / 0.96);
  EXPECT_NEAR(advice.outer_zone, advice.calibration.outer * 0.96, 1e-12);
  s.outline.radius[40] = 0.0;  // one direction was not seen
  EXPECT_GT(advice_for(s).calibration.outer, 0.9);
}

TEST(StickAdvice, TheSidewaysZoneGrowsWithNoiseUpToWhatFullDeflectionAllows) {
  StickStatistics s = measured();
  EXPECT_EQ(advice_for(s).calibration.sideways, 0.11);
  s.sigma = vec2(0.015, 0.0);
  s.hysteresis = 0.12;
  EXPECT_GT(advice_for(s).calibration.sideways, 0.115);
  s.sigma = vec2(0.04, 0.0);
  StickCalibration noisy = advice_for(s).calibration;
  EXPECT_EQ(noisy.sideways, 0.14);
  for (int degrees = 0; degrees < 360; ++degrees) {
    const vec2 p(std::cos(degrees * kDegree), std::sin(degrees * kDegree));
    noisy.x = noisy.y = {};
    EXPECT_GE(glm::length(stick_position(noisy, p)), 0.96) << degrees;
  }
}

TEST(StickAdvice, OneReleaseAssumesAHysteresisAndSaysSo) {
  StickStatistics s = measured();
  s.hysteresis = {};
  const StickAdvice advice = advice_for(s);
  EXPECT_DOUBLE_EQ(advice.inner_zone, 0.05 + 3.0 * 0.002);
  EXPECT_NE(advice.reason.find("assumed"), std::string::npos) << advice.reason;
}

// The reason has the same number as picture and table: the reach in the worst direction, not on the
// side next to it.
TEST(StickAdvice, TheReasonNamesTheWorstDirectionsReach) {
  StickStatistics s = measured();
  s.max_x = 0.78;  // the end is 0.76 from the centre
  for (const int k : {0, 1, 2, 190, 191}) s.outline.radius[static_cast<std::size_t>(k)] = 0.76;
  s.outline.radius[5] = 0.75;
  StickAdvice advice = advice_for(s);
  EXPECT_EQ(advice.verdict, Verdict::worn);
  EXPECT_NE(advice.reason.find("right (9 degrees from the right) it reaches only 0.75"),
            std::string::npos)
      << advice.reason;
  EXPECT_EQ(advice.reason.find("0.76"), std::string::npos) << advice.reason;
  // A good stick again.
  s = measured();
  s.outline.radius[70] = 0.85;
  advice = advice_for(s);
  EXPECT_EQ(advice.verdict, Verdict::good) << advice.reason;
  EXPECT_NE(advice.reason.find("reaches 0.85 or more"), std::string::npos) << advice.reason;
}

TEST(StickAdvice, UnknownSaysWhatIsMissing) {
  StickStatistics s = measured();
  s.min_x = {};
  StickAdvice advice = advice_for(s);
  EXPECT_EQ(advice.verdict, Verdict::unknown);
  EXPECT_NE(advice.reason.find("left"), std::string::npos) << advice.reason;
  EXPECT_EQ(advice.calibration.x.min, -1.0);
  EXPECT_DOUBLE_EQ(advice.inner_zone, 0.05);

  s.max_x = s.min_y = s.max_y = {};
  s.outline.radius.fill(0.0);
  advice = advice_for(s);
  EXPECT_EQ(advice.verdict, Verdict::unknown);
  EXPECT_NE(advice.reason.find("never turned to the rim"), std::string::npos) << advice.reason;
  EXPECT_NEAR(advice.calibration.outer, 0.95, 1e-12);
  expect_loadable(advice.calibration);

  s.centre = {};
  advice = advice_for(s);
  EXPECT_EQ(advice.verdict, Verdict::unknown);
  EXPECT_NE(advice.reason.find("centre"), std::string::npos) << advice.reason;
  EXPECT_EQ(advice.calibration.inner, StickCalibration().inner);
}

struct Fault {
  const char* says;
  Verdict verdict;
  void (*make)(StickStatistics&);
};
constexpr Fault kFaults[] = {
    {"apart", Verdict::worn, [](StickStatistics& s) { s.hysteresis = 0.09; }},
    {"noise", Verdict::worn, [](StickStatistics& s) { s.sigma = vec2(0.015, 0.0); }},
    {"0.14 off the middle", Verdict::worn,
     [](StickStatistics& s) { s.centre = vec2(-0.1, 0.1), s.rests.resize(14); }},
    {"0.14 off the middle of its range, as if a thumb lay on it", Verdict::unknown,
     [](StickStatistics& s) { s.centre = vec2(-0.1, 0.1), s.rests.resize(7); }},
    {"not pressed to its rim to the front left", Verdict::unknown,
     [](StickStatistics& s) { s.unpressed = 72; }},
    {"stuck once", Verdict::good, [](StickStatistics& s) { s.stuck_count = 1; }},
    {"or a thumb lay on it: once more, hands off", Verdict::replace,
     [](StickStatistics& s) { s.wander = 0.05; }},
    {"front", Verdict::worn, [](StickStatistics& s) { s.max_y = 0.7; }},
    {"jumped", Verdict::worn, [](StickStatistics& s) { s.jump_count = 5; }},
    {"drifts", Verdict::worn, [](StickStatistics& s) { s.drift_per_s = 0.002; }},
    {"wanders", Verdict::worn, [](StickStatistics& s) { s.wander = 0.015; }},
    {"no dead zone cures", Verdict::replace,
     [](StickStatistics& s) {
       s.drift_per_s = 0.02;
       s.rest_s = 6.0;
     }},
    {"drifts", Verdict::worn,
     [](StickStatistics& s) {  // the thumb may have lain on the stick
       s.drift_per_s = 0.02;
       s.rest_s = 3.0;
     }},
    {"no dead zone cures", Verdict::replace, [](StickStatistics& s) { s.wander = 0.03; }},
    {"dead zone of 36 %", Verdict::replace, [](StickStatistics& s) { s.hysteresis = 0.354; }},
    {"noise", Verdict::replace, [](StickStatistics& s) { s.sigma = vec2(0.0, 0.06); }},
    {"back", Verdict::replace, [](StickStatistics& s) { s.min_y = -0.4; }},
    {"stuck", Verdict::replace, [](StickStatistics& s) { s.stuck_count = 4; }},
    {"are filtered; calibration makes up for it", Verdict::worn,
     [](StickStatistics& s) { s.jump_count = 5; }},
    {"in 4.0 % of its reports, too often to filter", Verdict::replace,
     [](StickStatistics& s) { s.jump_count = 200; }},
    {"no filter takes out", Verdict::replace,
     [](StickStatistics& s) { s.jump_count = s.long_jump_count = 5; }},
    {"lost contact 3 times, for 90 ms", Verdict::replace,
     [](StickStatistics& s) { s.drop_out_count = 3, s.drop_out_s = 0.09; }},
    {"fter 3 releases it stayed up to 0.15 off", Verdict::worn,
     [](StickStatistics& s) { s.displaced = 3, s.displaced_by = 0.15; }},
    {"after 1 release it stayed about 0.15 off", Verdict::good,
     [](StickStatistics& s) { s.displaced = 1, s.displaced_by = 0.15; }},
    {"front left (135 degrees from the right) it reaches only 0.60", Verdict::worn,
     [](StickStatistics& s) { s.outline.radius[72] = 0.6; }},
    {"front left (135 degrees from the right) it reaches only 0.40", Verdict::replace,
     [](StickStatistics& s) { s.outline.radius[72] = 0.4; }},
    {"in only 42 of 48 directions", Verdict::unknown,
     [](StickStatistics& s) { std::fill_n(s.outline.radius.begin() + 10, 26, 0.0); }},
    {"reports only 15 times a second", Verdict::unknown,
     [](StickStatistics& s) { s.rate_hz = 15.0, s.wander = 0.5, s.stuck_count = 9; }},
};

TEST(StickAdvice, EachFaultHasItsVerdictAndIsNamed) {
  for (const Fault& fault : kFaults) {
    StickStatistics s = measured();
    fault.make(s);
    const StickAdvice advice = advice_for(s);
    EXPECT_EQ(advice.verdict, fault.verdict) << advice.reason;
    EXPECT_NE(advice.reason.find(fault.says), std::string::npos)
        << fault.says << " not in: " << advice.reason;
    expect_loadable(advice.calibration);
  }
}

TEST(StickAdvice, NoiseJustAboveAStepIsNotWear) {
  StickStatistics s = measured();
  s.step_x = s.step_y = 2.0 / 63.0;  // the steps of 6 bits
  s.sigma = vec2(0.02, 0.02);
  EXPECT_EQ(advice_for(s).verdict, Verdict::good);
}

TEST(StickAdvice, AnyStatisticsGiveAFileThatLoads) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1.5, 1.5);
  for (int n = 0; n < 400; ++n) {
    StickStatistics s = measured();
    if (n % 5 != 0) s.centre = vec2(any(random), any(random));
    s.sigma = vec2(std::fabs(any(random)), 0.1 * std::fabs(any(random)));
    if (n % 3 != 0) s.hysteresis = std::fabs(any(random));
    s.min_x = any(random);
    if (n % 2 != 0) s.max_x = any(random);
    s.max_y = any(random);
    for (double& r : s.outline.radius) r = std::max(0.0, any(random));
    expect_loadable(advice_for(s).calibration);
  }
}

TEST(TriggerAdvice, EndsLieSlightlyInsideTheMeasuredOnes) {
  TriggerStatistics s;
  s.released = 0.1;
  s.pressed = 0.9;
  const TriggerCalibration c = trigger_advice(s);
  EXPECT_NEAR(c.released, 0.116, 1e-12);
  EXPECT_NEAR(c.pressed, 0.884, 1e-12);
  EXPECT_EQ(trigger_position(c, 0.1), 0.0);
  EXPECT_EQ(trigger_position(c, 0.9), 1.0);
  // Unknown ends and too little travel keep the default.
  EXPECT_EQ(trigger_advice({}), TriggerCalibration());
  s.pressed.reset();
  EXPECT_GT(trigger_advice(s).released, 0.1);
  EXPECT_EQ(trigger_advice(s).pressed, TriggerCalibration().pressed);
  s.pressed = 0.15;
  EXPECT_EQ(trigger_advice(s), TriggerCalibration());
}

// ---- Real DualSense recordings through Sony's default zones and through measured ones. The axes
// are read here by byte, not by the decoder: report 1 begins with left x, y, right x, y, 0..255, y
// downwards.

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
    sticks.push_back({stick_position(calibration.left, tracks[0][i].raw),
                      stick_position(calibration.right, tracks[1][i].raw)});
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

// Both sticks saturate on both axes and are round at the corners. Computed from the greatest radius
// of all reports in each bin, their circularity errors are 8.5 and 7.4 %.
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

// Three sets of zones: Sony's, from the recording in which the stick is turned, and from both
// recordings.
TEST_F(RecordedSticks, RestNeverWalksWithTheZonesOfTheRecordingsThatTurn) {
  constexpr const char* kLeft = "dualsense_usb_left_stick.hid";
  constexpr const char* kRight = "dualsense_usb_right_stick.hid";
  StickCalibration sony;
  sony.inner = kInnerZoneSony;
  const StickCalibration zones[2][3] = {{sony, advised({kLeft}, 0), advised({kLeft, kRight}, 0)},
                                        {sony, advised({kRight}, 1), advised({kLeft, kRight}, 1)}};
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
  double longest[4] = {};  // the longest reach in each quadrant
  for (const Stick& s : sticks) {
    ASSERT_EQ(s.right, vec2(0.0));
    ASSERT_LE(glm::length(s.left), 1.0 + 4e-16);
    double& l = longest[(s.left.x > 0.0) + 2 * (s.left.y > 0.0)];
    l = std::max(l, glm::length(s.left));
  }
  for (const double l : longest) EXPECT_GE(l, 0.978);
}

TEST(StickAdvice, TheFilterIsOnOnlyForJumpsOfSingleReports) {
  StickStatistics s = measured();
  EXPECT_FALSE(advice_for(s).calibration.filters_jumps);
  s.jump_count = s.long_jump_count = 5;
  EXPECT_FALSE(advice_for(s).calibration.filters_jumps);
  s.jump_count = 10;
  EXPECT_TRUE(advice_for(s).calibration.filters_jumps);
}

TEST(StickAdvice, TheInnerZoneCoversDisplacedRests) {
  StickStatistics s = measured();
  EXPECT_LT(0.93 * advice_for(s).calibration.inner, 0.1);
  s.displaced_by = 0.15;
  for (s.displaced = 1; s.displaced < 3; ++s.displaced)
    EXPECT_GE(0.93 * advice_for(s).calibration.inner, 0.15);  // 0.93: centre to nearest end
}

}  // namespace
}  // namespace gaitpad
