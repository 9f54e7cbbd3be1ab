#include "gaitpad/flight.h"

#include <gtest/gtest.h>

#include "gaitpad/motion.h"
#include "gaitpad/motion_file.h"
#include "motion/made_walk.h"
#include "tests/shared_data.h"

namespace gaitpad {
namespace {

// A walker at 100 Hz with prescribed ankles: each foot stands for 0.7 s and flies for 0.4 s over
// 1.2 m, the left one 0.55 s after the right one. Legs of 0.8 m.
constexpr double kFrameS = 0.01, kCycleS = 1.1, kFlightS = 0.4, kStrideM = 1.2, kPeakM = 0.15;

struct FootAt {
  double z_m, height_m;
};
FootAt foot_at(double time_s) {  // the foot lifts at 0, kCycleS, ...
  const double cycle = std::floor(time_s / kCycleS);
  const double u = std::min(1.0, (time_s - cycle * kCycleS) / kFlightS);
  const double bump = 64.0 * u * u * u * (1.0 - u) * (1.0 - u) * (1.0 - u);
  return {kStrideM * (cycle + u * u * (3.0 - 2.0 * u)), kPeakM * bump};
}

Motion walk(double start_s, int frames) {
  Motion m;
  m.frame_time_s = kFrameS;
  m.skeleton.joints.push_back({"root", -1, vec3(0.0), false});
  for (int side = 0; side < 2; ++side) {
    const int hip = 1 + 4 * side;
    m.legs[side] = {hip, hip + 1, hip + 2, hip + 3, hip + 3};
    for (int i = 0; i < 4; ++i) {
      m.skeleton.joints.push_back({"j", i == 0 ? 0 : hip + i - 1, vec3(0.0, -0.4, 0.0), false});
    }
  }
  for (int f = 0; f < frames; ++f) {
    const double time_s = start_s + f * kFrameS;
    MotionFrame frame;
    frame.root_m = vec3(0.0, 0.9, kStrideM * time_s / kCycleS);
    frame.local.assign(9, kIdentity);
    frame.translation_m.assign(9, vec3(0.0, -0.4, 0.0));
    for (int side = 0; side < 2; ++side) {
      const FootAt foot = foot_at(time_s - (side == kLeftSide ? 0.5 * kCycleS : 0.0));
      const int hip = 1 + 4 * side;
      frame.translation_m[hip] = vec3(0.0);
      // The knee's place is arbitrary, because only the ankle matters.
      frame.translation_m[hip + 2] =
          vec3(0.0, 0.1 + foot.height_m - 0.5, foot.z_m - frame.root_m.z);
    }
    m.frames.push_back(frame);
  }
  return m;
}

// A foot starts and stops with 6 L / T^2 = 45 m/s^2, so it passes 0.2 and 0.3 m/s within 7 ms.
TEST(Flight, LiftAndLandAreWhereTheFootStartsAndStops) {
  const Motion m = walk(0.8, 260);
  const auto right = swings(m, kRightSide), left = swings(m, kLeftSide);
  // Lifts at 1.1 and 2.2 s within 0.8 .. 3.4 s; the third flight is cut off.
  ASSERT_EQ(right.size(), 2u);
  ASSERT_EQ(left.size(), 2u);  // lifts at 1.65 and 2.75 s
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(right[i].lift * kFrameS + 0.8, 1.1 + i * kCycleS, 0.011);
    EXPECT_NEAR(right[i].land * kFrameS + 0.8, 1.1 + i * kCycleS + kFlightS, 0.011);
    EXPECT_NEAR(right[i].peak * kFrameS + 0.8, 1.1 + i * kCycleS + 0.5 * kFlightS, 0.011);
    EXPECT_NEAR(left[i].lift * kFrameS + 0.8, 1.65 + i * kCycleS, 0.011);
  }
}

TEST(Flight, HeelOffIsTheLastLowBeforeTheLift) {
  Motion m = walk(0.8, 300);
  // The heel rises 0.15 s before the foot travels.
  for (std::size_t f = 0; f < m.frames.size(); ++f) {
    const double before_s = 1.1 - (0.8 + static_cast<double>(f) * kFrameS);
    double rise_m = before_s > 0.15 ? 0.002 * (before_s - 0.15) : 0.1 * (0.15 - before_s);
    if (before_s < 0.0) rise_m = std::max(0.0, 0.015 + 0.1 * before_s);
    m.frames[f].translation_m[m.legs[kRightSide].ankle].y += rise_m;
  }
  EXPECT_NEAR(swings(m, kRightSide)[0].heel_off * kFrameS + 0.8, 0.95, 0.011);
}

TEST(Flight, ASwingCutByTheFilesEndsIsNone) {
  // The clip begins within one flight and ends before the next.
  EXPECT_TRUE(swings(walk(1.2, 80), kRightSide).empty());
  EXPECT_FALSE(robust_flight(walk(1.2, 80), kRightSide));
}

TEST(Flight, APostureFarInFrontOfTheMotionChangesNothing) {
  const Motion plain = walk(0.8, 300);
  Motion m = plain;
  MotionFrame away = m.frames[0];
  away.root_m += vec3(3.0, 0.2, -4.0);
  m.frames.insert(m.frames.begin(), away);
  for (const Side side : {kLeftSide, kRightSide}) {
    const auto before = swings(plain, side), after = swings(m, side);
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
      EXPECT_EQ(before[i].lift + 1, after[i].lift);
      EXPECT_EQ(before[i].peak + 1, after[i].peak);
      EXPECT_EQ(before[i].land + 1, after[i].land);
    }
  }
}

TEST(Flight, ALoopingClipIsSearchedOverItsEnd) {
  // One cycle, whose first pose is its last; it begins within the right foot's flight.
  const Motion m = walk(1.3, 111);
  const auto right = swings(m, kRightSide);
  ASSERT_EQ(right.size(), 1u);
  EXPECT_NEAR(right[0].lift * kFrameS, 0.9, 0.011);
  EXPECT_NEAR(right[0].land * kFrameS, 0.9 + kFlightS, 0.011);
  EXPECT_GE(right[0].land, 111);
  EXPECT_EQ(swings(m, kLeftSide).size(), 1u);
}

TEST(Flight, StandingHoldsNoFlight) {
  Motion m = walk(0.0, 1);
  EXPECT_TRUE(swings(m, kLeftSide).empty());
  EXPECT_FALSE(paper_flight(m, kLeftSide));
  for (int i = 0; i < 300; ++i) m.frames.push_back(m.frames[0]);
  EXPECT_TRUE(swings(m, kLeftSide).empty());
  EXPECT_FALSE(paper_flight(m, kLeftSide));
}

TEST(Flight, AStepTooShortToCarryAStrideIsNone) {
  Motion m = walk(0.8, 300);
  const auto all = swings(m, kRightSide);
  const auto best = robust_flight(m, kRightSide);  // the most typical flight of the clip
  ASSERT_TRUE(best);
  EXPECT_TRUE(std::ranges::any_of(all, [&](const Swing& s) { return s.lift == best->lift; }));
  for (MotionFrame& f : m.frames) {
    f.root_m.z *= 0.05;
    for (const LegJoints& leg : m.legs) f.translation_m[leg.ankle].z *= 0.05;
  }
  EXPECT_TRUE(swings(m, kRightSide).empty());
}

// The heights of figure 2: a stride of 40 frames, low at 4, peak at 15, low at 35, with a "blip"
// while falling.
std::vector<double> figure_2(double blip) {
  std::vector<double> h;
  for (int f = 0; f <= 4; ++f) h.push_back(0.004 * (4 - f));
  for (int f = 5; f <= 15; ++f) h.push_back(0.02 * (f - 4));
  for (int f = 16; f <= 35; ++f) h.push_back(0.22 - 0.011 * (f - 15));
  for (int f = 36; f < 40; ++f) h.push_back(0.002 * (f - 35));
  h[25] = h[24] + blip;
  return h;
}

// A blip during the fall is not the end: one downwards, a stationary point, real gradient changes.
TEST(PaperFlight, TargetsAreTheGradientChangesNearTheExtremes) {
  for (const double blip : {-0.011, 0.0, 0.003, 0.012}) {
    const auto s = paper_flight(figure_2(blip));
    ASSERT_TRUE(s);
    EXPECT_EQ(s->lift, 4);
    EXPECT_EQ(s->peak, 15);
    EXPECT_EQ(s->land, 35) << blip;
  }
}

TEST(PaperFlight, TheFirstLowCountsEvenWhereTheFootStillStands) {
  std::vector<double> h = {0.0, 0.002, 0.001, 0.0, 0.003, 0.001};  // 10 % of the range is 22 mm
  const auto stride = figure_2(-0.011);
  h.insert(h.end(), stride.begin(), stride.end());
  EXPECT_EQ(paper_flight(h)->lift, 3);
}

TEST(PaperFlight, OneHighStepElsewhereBreaksIt) {
  std::vector<double> h = figure_2(-0.011);
  // The range becomes 1 m, so the peak of 0.22 m is outside the band.
  h.insert(h.begin(), {1.0, 0.9});
  EXPECT_FALSE(paper_flight(h));
}

TEST(PaperFlight, WithoutACompleteCycleThereIsNone) {
  const auto h = figure_2(-0.011);
  EXPECT_FALSE(paper_flight(std::vector<double>(h.begin(), h.begin() + 30)));
  EXPECT_FALSE(paper_flight(std::vector<double>(h.begin() + 10, h.end())));
  EXPECT_FALSE(paper_flight(std::vector<double>{}));
}

TEST(Flight, SharedWalksGiveBothFeetByTheRobustRuleAndSevenByThePapers) {
  GAITPAD_NEEDS(kCapturedMotions);
  int literal = 0;
  for (const std::string file : kCapturedWalks) {
    const auto m = load_motion(kCapturedMotions + file + ".bvh");
    ASSERT_TRUE(m) << m.error().message;
    EXPECT_TRUE(robust_flight(*m, kLeftSide)) << file;
    EXPECT_TRUE(robust_flight(*m, kRightSide)) << file;
    literal += paper_flight(*m, kLeftSide) && paper_flight(*m, kRightSide);
  }
  EXPECT_EQ(literal, 7);
}

// Speed of the captured ankle over 50 ms, and its crossings of a fifth of a swing's peak. The
// motion is appended to itself, so that a swing across a loop's end is whole.
class Speed {
 public:
  Speed(const Motion& m, Side side) : frame_s_(m.frame_time_s) {
    const std::array<int, 2> joints = {m.legs[side].ankle, m.pelvis};
    const auto tracks = joint_tracks_m(m, joints);
    at_ = tracks[0];
    for (std::size_t f = 1; f < tracks[0].size(); ++f) {
      at_.push_back(tracks[0][f] + tracks[1].back() - tracks[1].front());
    }
  }
  double operator()(int frame) const {
    const int half = std::max(1, static_cast<int>(0.025 / frame_s_));
    const int a = std::max(0, frame - half),
              b = std::min(static_cast<int>(at_.size()) - 1, frame + half);
    return std::hypot(at_[b].x - at_[a].x, at_[b].z - at_[a].z) / ((b - a) * frame_s_);
  }
  // Time from `frame` to the nearest crossing of a fifth of the swing's peak speed.
  double crossing_s(const Swing& s, int frame) const {
    double peak = 0.0;
    for (int f = s.lift; f <= s.land; ++f) peak = std::max(peak, (*this)(f));
    double best = 1e300;
    for (int f = 1; f < static_cast<int>(at_.size()); ++f) {
      const bool crosses = ((*this)(f) < 0.2 * peak) != ((*this)(f - 1) < 0.2 * peak);
      if (crosses && std::abs(f - frame) < std::abs(best - frame)) best = f;
    }
    return best * frame_s_;
  }

 private:
  double frame_s_;
  std::vector<vec3> at_;
};

// A toe leaves before its ankle is fast, and a heel is still after its ankle has been slow.
TEST(Flight, SharedSwingsAgreeWithTheAnklesSpeedWithin120Ms) {
  GAITPAD_NEEDS(kCapturedMotions);
  int count = 0;
  for (const std::string file : kCapturedWalks) {
    const auto m = load_motion(kCapturedMotions + file + ".bvh");
    ASSERT_TRUE(m) << m.error().message;
    for (const Side side : {kLeftSide, kRightSide}) {
      const Speed speed(*m, side);
      for (const Swing& s : swings(*m, side)) {
        EXPECT_NEAR(s.lift * m->frame_time_s, speed.crossing_s(s, s.lift), 0.120)
            << file << " lift " << s.lift;
        EXPECT_NEAR(s.land * m->frame_time_s, speed.crossing_s(s, s.land), 0.120)
            << file << " land " << s.land;
        EXPECT_LE(s.heel_off, s.lift);
        EXPECT_LE(s.lift, s.peak);
        EXPECT_LT(s.peak, s.land);
        ++count;
      }
    }
  }
  EXPECT_GE(count, 67);  // the number of shared clips with swings
}

}  // namespace
}  // namespace gaitpad
