// Strikes and toe-offs of tracks and walks whose events are known.
#include "motion/gait_events.h"

#include <gtest/gtest.h>

#include <random>

#include "gaitpad/gait_cycle.h"
#include "motion/made_walk.h"

namespace gaitpad {
namespace {

constexpr double kRate_hz = 240.0, kStride_s = 1.1, kStride_m = 1.4, kOff = 0.62;

double smooth(double u) { return u * u * (3.0 - 2.0 * u); }

// The points of one foot over one stride. The foot strikes at 0: its heel comes down at 0.5 m/s and
// stops. Its toe leaves at kOff and moves to the next place with constant acceleration, then
// constant deceleration.
struct Points {
  vec3 heel_m, toe_m;
};
Points points_at(double phase, double creep_m_s) {
  const double stood_s = std::min(phase, kOff) * kStride_s, to_go_s = (1.0 - phase) * kStride_s;
  const double u = std::max(0.0, phase - kOff) / (1.0 - kOff);
  const double way_m = smooth(u) * (kStride_m - creep_m_s * kOff * kStride_s);
  vec3 heel(0.0, 0.2 * std::sin(kPi * std::clamp((phase - 0.4) / 0.6, 0.0, 1.0)), 0.0);
  vec3 toe(0.0, 0.05 * std::sin(kPi * u), 0.18);
  heel.z += creep_m_s * stood_s + way_m;
  toe.z += creep_m_s * stood_s + way_m;
  if (to_go_s < 0.03) heel.y = std::min(heel.y, 0.5 * to_go_s);
  return {heel, toe};
}

// Tracks of both feet over a stride. `left_at`: the phase of the left strike.
FeetTracks stride(double left_at, double creep_m_s = 0.0, double noise_m = 0.0,
                  double rate_hz = kRate_hz) {
  FeetTracks tracks;
  std::mt19937 random(7);
  const auto noise = [&] {
    const auto one = [&] { return noise_m * (double(random()) / 2147483648.0 - 1.0); };
    return vec3(one(), one(), one());
  };
  const int samples = static_cast<int>(kStride_s * rate_hz + 0.5);
  tracks.sample_s = kStride_s / samples;
  tracks.leg_m = 0.84;
  for (int side = 0; side < 2; ++side) {
    for (int i = 0; i < samples; ++i) {
      const double own = double(i) / samples - (side == kLeftSide ? left_at : 0.0);
      const Points p = points_at(own - std::floor(own), creep_m_s);
      const vec3 way = kForward * (kStride_m * (std::floor(own) + (side == 0 ? left_at : 0.0)));
      FootTrack& foot = tracks.foot[side];
      foot.heel_m.push_back(p.heel_m + way + noise());
      foot.toe_m.push_back(p.toe_m + way + noise());
      foot.ankle_m.push_back(0.7 * p.heel_m + 0.3 * p.toe_m + way + vec3(0.0, 0.08, 0.0));
    }
  }
  return tracks;
}

double apart_s(double a, double b) {
  const double phases = a - b;
  return (phases - std::floor(phases + 0.5)) * kStride_s;
}

TEST(GaitEvents, AHeelStrikesWhenItIsDownAndStillAndAToeIsOffWhenItBeginsToLeave) {
  const auto events = stride_events(stride(0.5), kForward * kStride_m);
  ASSERT_TRUE(events) << events.error().message;
  // The toe reaches 0.2 m/s within 5 ms; speeds are averaged over 24 ms.
  for (const Side side : {kLeftSide, kRightSide}) {
    const double shift = side == kLeftSide ? 0.5 : 0.0;
    EXPECT_NEAR(apart_s(events->strike[side], shift), 0.0, 0.015);
    EXPECT_NEAR(apart_s(events->toe_off[side], kOff + shift), 0.0, 0.015);
  }
}

// A sample of 40 Hz takes 25 ms.
TEST(GaitEvents, AreFoundBetweenSamplesAndUnderNoise) {
  const auto plain = stride_events(stride(0.5), kForward * kStride_m);
  const auto coarse = stride_events(stride(0.5, 0.0, 0.0, 40.0), kForward * kStride_m);
  const auto noisy = stride_events(stride(0.5, 0.0, 0.0005), kForward * kStride_m);
  ASSERT_TRUE(plain && coarse && noisy);
  for (const int side : {0, 1}) {
    EXPECT_NEAR(apart_s(coarse->strike[side], plain->strike[side]), 0.0, 0.02);
    EXPECT_NEAR(apart_s(coarse->toe_off[side], plain->toe_off[side]), 0.0, 0.02);
    EXPECT_NEAR(apart_s(noisy->strike[side], plain->strike[side]), 0.0, 0.015);
    EXPECT_NEAR(apart_s(noisy->toe_off[side], plain->toe_off[side]), 0.0, 0.015);
  }
}

TEST(GaitEvents, FeetThatSlideStillStrikeBeforeTheOtherToeLeaves) {
  const auto events = stride_events(stride(0.5, 0.35), kForward * kStride_m);
  ASSERT_TRUE(events) << events.error().message;
  EXPECT_GT(apart_s(events->toe_off[kLeftSide], events->strike[kRightSide]), 0.03);
  EXPECT_GT(apart_s(events->toe_off[kRightSide], events->strike[kLeftSide]), 0.03);
}

TEST(GaitEvents, OutOfOrderAreRefusedWithTheReason) {
  // The left foot strikes 0.75 of a stride after the right one, which has left at 0.62.
  const auto events = stride_events(stride(0.75), kForward * kStride_m);
  ASSERT_FALSE(events);
  EXPECT_NE(events.error().message.find("the right toe leaves"), std::string::npos);
  EXPECT_NE(events.error().message.find("before the left heel strikes"), std::string::npos);
}

TEST(GaitEvents, OfAFileAreWhereItsFeetStartAndStop) {
  const MadeWalk walk{.start_s = 0.3, .end_s = 5.0};
  const FeetTracks tracks = feet_tracks(made_walk(walk));
  int strikes = 0;
  for (const FootSwing& s : foot_swings(tracks, kMovingShares[0])) {
    const double shift = s.side == kLeftSide ? walk.left_at : 0.0;
    const auto off_s = [&](double frame, double phase) {
      const double strides = (walk.start_s + frame / walk.rate_hz) / walk.stride_s - shift - phase;
      return (strides - std::floor(strides + 0.5)) * walk.stride_s;
    };
    // The swing's speed crosses 0.2 and 0.3 m/s within 12 ms of its ends; speeds are averaged over
    // 24 ms.
    if (s.toe_off) {
      EXPECT_NEAR(off_s(*s.toe_off, walk.stance), 0.0, 0.015);
    }
    if (s.strike) {
      EXPECT_NEAR(off_s(*s.strike, 0.0), 0.0, 0.015) << *s.strike;
    }
    strikes += s.strike.has_value();
  }
  EXPECT_EQ(strikes, 8);  // strikes at 0.6, 1.2, .. 4.8 s
}

}  // namespace
}  // namespace gaitpad
