#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "stick/made_stick.h"
#include "stick/pad_analysis.h"

namespace gaitpad {
namespace {

// A stick that was let go and turned, in whole numbers.
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

StickAdvice advice_for(const MadeStick& stick, const StickTrack& track) {
  const vec2 step(stick.bits > 0 ? 2.0 / (std::exp2(stick.bits) - 1.0) : 0.0);
  return stick_advice(stick_statistics(std::span(&track, 1), step), {});
}

// A file with it can be loaded, and the text gives the same numbers back.
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

TEST(StickAdvice, InnerZoneIsThreeSigmaAndHysteresisButFivePercentAtLeast) {
  StickStatistics s = measured();
  EXPECT_DOUBLE_EQ(advice_for(s).inner_zone, 0.05);
  s.sigma = vec2(0.01, 0.02);
  s.hysteresis = 0.12;
  EXPECT_DOUBLE_EQ(advice_for(s).inner_zone, 0.18);
  // The calibration's is a fraction of the shortest side.
  const double shortest = 0.95 - -0.01;
  EXPECT_NEAR(advice_for(s).calibration.inner, 0.18 / shortest, 1e-12);
}

TEST(StickAdvice, AWanderingStickRestsInItsZonesUnlessItIsToBeReplaced) {
  for (const double wander : {0.005, 0.01}) {
    std::int64_t walking = 0, resting = 0;
    for (std::uint32_t seed = 1; seed <= 40; ++seed) {
      MadeStick stick;
      stick.seed = seed;
      stick.sigma = vec2(0.003);
      stick.wander = wander;
      MadeMoves moves(stick);
      moves.rest(10.0);
      for (int k = 0; k < 6; ++k) {
        moves.push(k);
        moves.release();
        moves.rest(0.6);
      }
      moves.turn(3.0);
      const StickTrack track = reported(stick, moves.path());
      const StickAdvice advice = advice_for(stick, track);
      if (advice.verdict == Verdict::replace) continue;
      for (std::size_t i = 0; i < 2500; ++i) {
        walking += stick_position(advice.calibration, track[i].raw) != vec2(0.0);
        ++resting;
      }
    }
    EXPECT_LE(static_cast<double>(walking), 0.015 * static_cast<double>(resting)) << wander;
  }
}

// 3 sigma in two directions would let one report in ninety through.
TEST(StickAdvice, WithoutHysteresisTheCalibrationStillKeepsTheNoiseOut) {
  StickStatistics s = measured();
  s.centre = vec2(0.0);
  s.sigma = vec2(0.02, 0.02);
  s.hysteresis = 0.0;
  const StickAdvice advice = advice_for(s);
  EXPECT_DOUBLE_EQ(advice.inner_zone, 0.06);
  EXPECT_EQ(stick_position(advice.calibration, vec2(0.06, 0.075)), vec2(0.0));
}

TEST(StickAdvice, CentreAndEndsAreThoseMeasured) {
  const StickAdvice advice = advice_for(measured());
  EXPECT_EQ(advice.calibration.x.min, -0.98);
  EXPECT_EQ(advice.calibration.x.centre, 0.02);
  EXPECT_EQ(advice.calibration.y.max, 0.95);
  EXPECT_EQ(advice.calibration.shape, ZoneShape::both);
  EXPECT_EQ(advice.calibration.curve, 0.0);
  EXPECT_EQ(advice.verdict, Verdict::good) << advice.reason;
  expect_loadable(advice.calibration);
}

TEST(StickAdvice, TheFrameIsTheOneGiven) {
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
  s.outline.radius[40] = 0.0;  // not seen
  EXPECT_GT(advice_for(s).calibration.outer, 0.9);
}

TEST(StickAdvice, TheSidewaysZoneGrowsWithNoiseToAsMuchAsFullDeflectionAllows) {
  StickStatistics s = measured();
  EXPECT_EQ(advice_for(s).calibration.sideways, 0.08);
  s.sigma = vec2(0.015, 0.0);
  s.hysteresis = 0.08;
  EXPECT_GT(advice_for(s).calibration.sideways, 0.1);
  s.sigma = vec2(0.04, 0.0);
  StickCalibration noisy = advice_for(s).calibration;
  EXPECT_EQ(noisy.sideways, 0.14);
  for (int degrees = 0; degrees < 360; ++degrees) {
    const vec2 p(std::cos(degrees * kDegree), std::sin(degrees * kDegree));
    noisy.x = noisy.y = {};
    EXPECT_GE(glm::length(stick_position(noisy, p)), 0.96) << degrees;
  }
}

TEST(StickAdvice, LetGoOnceASpreadIsAssumedAndSaid) {
  StickStatistics s = measured();
  s.hysteresis = {};
  const StickAdvice advice = advice_for(s);
  EXPECT_DOUBLE_EQ(advice.inner_zone, 0.05 + 3.0 * 0.002);
  EXPECT_NE(advice.reason.find("assumed"), std::string::npos) << advice.reason;
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
    {"middle", Verdict::worn, [](StickStatistics& s) { s.centre = vec2(-0.1, 0.1); }},
    {"front", Verdict::worn, [](StickStatistics& s) { s.max_y = 0.7; }},
    {"jumped", Verdict::worn, [](StickStatistics& s) { s.jumps = 5; }},
    {"drifts", Verdict::worn, [](StickStatistics& s) { s.drift_per_s = 0.002; }},
    {"wanders", Verdict::worn, [](StickStatistics& s) { s.wander = 0.015; }},
    {"no dead zone cures", Verdict::replace,
     [](StickStatistics& s) {
       s.drift_per_s = 0.02;
       s.rest_s = 6.0;
     }},
    {"drifts", Verdict::worn,
     [](StickStatistics& s) {  // perhaps a thumb that lay on it
       s.drift_per_s = 0.02;
       s.rest_s = 3.0;
     }},
    {"no dead zone cures", Verdict::replace, [](StickStatistics& s) { s.wander = 0.03; }},
    {"dead zone of 36 %", Verdict::replace, [](StickStatistics& s) { s.hysteresis = 0.354; }},
    {"noise", Verdict::replace, [](StickStatistics& s) { s.sigma = vec2(0.0, 0.06); }},
    {"back", Verdict::replace, [](StickStatistics& s) { s.min_y = -0.4; }},
    {"stuck", Verdict::replace, [](StickStatistics& s) { s.stuck = 4; }},
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

TEST(StickAdvice, NoiseOfLittleMoreThanAStepIsNoWear) {
  StickStatistics s = measured();
  s.step_x = s.step_y = 2.0 / 63.0;  // 6 bits
  s.sigma = vec2(0.02, 0.02);
  EXPECT_EQ(advice_for(s).verdict, Verdict::good);
}

TEST(StickAdvice, AnyStatisticsGiveAFileThatLoads) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1.5, 1.5);
  for (int n = 0; n < 2000; ++n) {
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

TEST(StickAdvice, NewSticksAreGoodAndKeepStill) {
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    MadeStick stick;
    stick.seed = seed;
    stick.centre = vec2(0.03, -0.02);
    stick.sigma = vec2(0.002);
    stick.hysteresis = 0.03;
    stick.reach_x = 0.95;
    stick.bits = seed % 2 == 0 ? 8 : 12;
    const StickTrack track = made_track(stick);
    const StickAdvice advice = advice_for(stick, track);
    EXPECT_EQ(advice.verdict, Verdict::good) << seed << ": " << advice.reason;
    // All of its rests, the first 0.6 s among them.
    for (std::size_t i = 0; i < 150; ++i) {
      EXPECT_EQ(stick_position(advice.calibration, track[i].raw), vec2(0.0));
    }
  }
}

TEST(TriggerAdvice, ALittleWithinTheEnds) {
  TriggerStatistics s;
  s.released = 0.1;
  s.pressed = 0.9;
  const TriggerCalibration c = trigger_advice(s);
  EXPECT_NEAR(c.released, 0.116, 1e-12);
  EXPECT_NEAR(c.pressed, 0.884, 1e-12);
  EXPECT_EQ(trigger_position(c, 0.1), 0.0);
  EXPECT_EQ(trigger_position(c, 0.9), 1.0);
}

TEST(TriggerAdvice, WhatIsUnknownOrNoTravelStaysAsItIs) {
  const TriggerCalibration plain;
  EXPECT_EQ(trigger_advice({}).released, plain.released);
  EXPECT_EQ(trigger_advice({}).pressed, plain.pressed);
  TriggerStatistics s;
  s.released = 0.05;
  EXPECT_GT(trigger_advice(s).released, 0.05);
  EXPECT_EQ(trigger_advice(s).pressed, plain.pressed);
  s.pressed = 0.1;
  EXPECT_EQ(trigger_advice(s).released, plain.released);
}

}  // namespace
}  // namespace gaitpad
