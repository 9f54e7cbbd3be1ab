#include "stick/outline.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "stick/made_stick.h"

namespace gaitpad {
namespace {

struct Ends {
  double min_x = 2.0, max_x = -2.0, min_y = 2.0, max_y = -2.0;
};
Ends true_ends(const MadeStick& stick) {
  Ends ends;
  for (int i = 0; i < 3600; ++i) {
    const double angle = 0.1 * i * kDegree, radius = gate_radius(stick, angle);
    const vec2 p = stick.centre + radius * vec2(std::cos(angle), std::sin(angle));
    ends = {std::min(ends.min_x, p.x), std::max(ends.max_x, p.x), std::min(ends.min_y, p.y),
            std::max(ends.max_y, p.y)};
  }
  return ends;
}

// Expects an end within 1 % or 2 sigma of the truth.
void expect_end(const std::optional<double>& found, double truth, double sigma) {
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found, truth, std::max(0.01 * std::fabs(truth), 2.0 * sigma));
}
void expect_ends(const Outline& outline, const MadeStick& stick) {
  const Ends truth = true_ends(stick);
  const Reach found = reach_of(outline);
  const double sigma = std::max(stick.sigma.x, stick.sigma.y);
  expect_end(found.min_x, truth.min_x, sigma);
  expect_end(found.max_x, truth.max_x, sigma);
  expect_end(found.min_y, truth.min_y, sigma);
  expect_end(found.max_y, truth.max_y, sigma);
}

Outline outline_of(const StickTrack& track, const MadeStick& stick) {
  return gaitpad::outline_of(std::span(&track, 1), stick.centre,
                             std::max(stick.sigma.x, stick.sigma.y));
}

struct Shape {
  const char* name;
  Gate gate;
  double reach_x, reach_y;
};
constexpr Shape kShapes[] = {
    {"circle", Gate::circle, 1.0, 1.0},         {"short circle", Gate::circle, 0.75, 0.75},
    {"wide ellipse", Gate::ellipse, 1.0, 0.75}, {"short ellipse", Gate::ellipse, 0.8, 0.7},
    {"square", Gate::square, 1.0, 1.0},         {"short square", Gate::square, 0.7, 0.7}};

MadeStick made(const Shape& shape, const vec2& centre, double sigma, int bits, std::uint32_t seed) {
  MadeStick stick;
  stick.gate = shape.gate;
  stick.reach_x = shape.reach_x;
  stick.reach_y = shape.reach_y;
  stick.centre = centre;
  stick.sigma = vec2(sigma);
  stick.bits = bits;
  stick.seed = seed;
  return stick;
}

void expect_true_outline(const StickTrack& track, const MadeStick& stick) {
  const Outline outline = outline_of(track, stick);
  ASSERT_TRUE(circularity_error(outline));
  EXPECT_NEAR(*circularity_error(outline), true_circularity_error(stick), 0.5);
  EXPECT_EQ(filled_bins(outline), kCircularityBins);
  expect_ends(outline, stick);
}

TEST(Outline, CircularityAndReachOfEveryGateOffCentreNoisyAndQuantised) {
  std::uint32_t seed = 0;
  for (const Shape& shape : kShapes) {
    for (const vec2& centre : {vec2(0.06, -0.04), vec2(-0.08, 0.15)}) {
      for (const double sigma : {0.0, 0.02}) {
        for (const int bits : {8, 16}) {
          SCOPED_TRACE(testing::Message() << shape.name << " at " << centre.x << " sigma " << sigma
                                          << " bits " << bits);
          const MadeStick stick = made(shape, centre, sigma, bits, ++seed);
          expect_true_outline(made_track(stick), stick);
        }
      }
    }
  }
}

TEST(Outline, HoldsAtAnyReportRateAndNumberOfTurnsAndWithLostReports) {
  for (const Shape& shape : kShapes) {
    for (const double rate_hz : {125.0, 1000.0}) {
      MadeStick stick = made(shape, vec2(0.03, -0.05), 0.01, 8, 6);
      stick.rate_hz = rate_hz;
      stick.drop_chance = 0.1;
      stick.reports_changes_only = rate_hz == 125.0;
      SCOPED_TRACE(testing::Message() << shape.name << " at " << rate_hz << " Hz");
      const double turns = stick.reports_changes_only ? 5.0 : 2.0;
      expect_true_outline(made_track(stick, 8, 0.2, turns), stick);
    }
  }
}

// On a slow pad some directions next to a corner are never reported.
TEST(Outline, CircularityOfASquareGateTurnedQuicklyOnASlowPad) {
  for (const vec2& centre : {vec2(0.0), vec2(0.05, 0.1), vec2(0.18, 0.16)}) {
    for (const double reach : {0.8, 0.95}) {
      MadeStick stick = made({"square", Gate::square, reach, reach}, centre, 0.0, 12, 1);
      stick.rate_hz = 66.0;
      SCOPED_TRACE(testing::Message() << "at " << centre.x << " reach " << reach);
      const Outline outline = outline_of(made_track(stick), stick);
      ASSERT_TRUE(circularity_error(outline));
      EXPECT_NEAR(*circularity_error(outline), true_circularity_error(stick), 0.5);
    }
  }
}

// The formula gives 20.5 % for a full square: 48 bins, each with its greatest radius.
TEST(Outline, FullSquareIsTwentyAndAHalfPercentByTheGreatestRadiusOfEachBin) {
  const MadeStick stick = made(kShapes[4], vec2(0.0), 0.0, 16, 1);
  EXPECT_NEAR(*circularity_error(outline_of(made_track(stick), stick)), 20.5, 0.3);
}

// A turn that cuts corners lies below the others and is left out of the rim; a held corner, which a
// streaming pad repeats hundreds of times, does not outweigh its neighbours.
TEST(Outline, TurnsThatCutCornersAndLongHoldsDoNotShrinkTheGate) {
  for (const Shape& shape : kShapes) {
    for (const double sigma : {0.0, 0.01}) {
      SCOPED_TRACE(testing::Message() << shape.name << " sigma " << sigma);
      const MadeStick cut = made(shape, vec2(0.05, 0.0), sigma, 12, 9);
      MadeMoves moves(cut);
      moves.rest(0.5);
      moves.push(0.0);
      moves.turn(1.0);
      moves.turn(1.0, 1.5, 0.9);
      moves.turn(0.4, 1.5, 0.6);
      moves.turn(1.0);
      moves.release();
      moves.rest(0.5);
      expect_true_outline(reported(cut, moves.path()), cut);
      const MadeStick held = made(shape, vec2(0.0), sigma, 8, 4);
      MadeMoves holds(held);
      holds.push(0.0);
      holds.turn(2.125);
      holds.hold(4.0);
      holds.release();
      expect_true_outline(reported(held, holds.path()), held);
    }
  }
}

TEST(Outline, PushesAloneGiveReachButNoCircularity) {
  for (const double sigma : {0.0, 0.01, 0.04}) {
    const MadeStick stick = made(kShapes[3], vec2(0.1, -0.05), sigma, 10, 3);
    const Outline outline = outline_of(made_track(stick, 0, 0.5, 0.0), stick);
    expect_ends(outline, stick);
    EXPECT_FALSE(circularity_error(outline));
    EXPECT_LT(filled_bins(outline), 20);
    // Samples on the way to the rim must not count as the gate.
    for (int k = 0; k < kOutlineDirections; ++k) {
      if (outline.radius[static_cast<std::size_t>(k)] == 0.0) continue;
      const double truth = gate_radius(stick, 2.0 * kPi * k / kOutlineDirections);
      EXPECT_GT(outline.radius[static_cast<std::size_t>(k)], 0.9 * truth) << k;
    }
  }
}

TEST(Outline, QuickPushesThatReachTheRimCount) {
  const MadeStick stick = made(kShapes[1], vec2(0.0), 0.005, 8, 3);
  MadeMoves moves(stick);
  for (int k = 0; k < 16; ++k) {
    moves.push(k * 22.5 * kDegree, 0.08);
    moves.release();
  }
  const Outline outline = outline_of(reported(stick, moves.path()), stick);
  for (std::size_t k = 0; k < kOutlineDirections; k += 12) {
    EXPECT_NEAR(outline.radius[k], 0.75, 0.045) << k;
  }
  EXPECT_EQ(outline.radius[6], 0.0);
  EXPECT_FALSE(circularity_error(outline));
}

TEST(Outline, AHalfTurnGivesHalfOfTheReach) {
  const MadeStick stick = made(kShapes[0], vec2(0.0), 0.0, 8, 1);
  MadeMoves moves(stick);
  moves.push(-60.0 * kDegree);
  moves.turn(0.5);
  const Outline outline = outline_of(reported(stick, moves.path()), stick);
  const Reach reach = reach_of(outline);
  EXPECT_TRUE(reach.max_x && reach.max_y);
  EXPECT_FALSE(reach.min_x);
  EXPECT_FALSE(reach.min_y);
  EXPECT_FALSE(circularity_error(outline));
  EXPECT_NEAR(filled_bins(outline), 24, 3);
}

TEST(Outline, RestAndInvalidNumbersGiveNoOutline) {
  const MadeStick stick;
  MadeMoves moves(stick);
  moves.hold(1.0);
  StickTrack track = reported(stick, moves.path());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  track.push_back({0, vec2(nan, 0.5)});
  track.push_back({0, vec2(0.0, std::numeric_limits<double>::infinity())});
  for (const double sigma : {0.0, -1.0, nan, 1e300}) {
    const Outline outline = gaitpad::outline_of(std::span(&track, 1), vec2(0.0), sigma);
    EXPECT_EQ(outline.samples, 0);
    EXPECT_EQ(filled_bins(outline), 0);
    EXPECT_FALSE(reach_of(outline).max_x);
    EXPECT_FALSE(circularity_error(outline));
  }
}

TEST(Outline, NeverLeavesTheRange) {
  for (const Shape& shape : kShapes) {
    const MadeStick stick = made(shape, vec2(0.15, -0.1), 0.04, 8, 2);
    const Outline outline = outline_of(made_track(stick), stick);
    for (std::size_t k = 0; k < kOutlineDirections; ++k) {
      const double angle = 2.0 * kPi * static_cast<double>(k) / kOutlineDirections;
      const vec2 p = outline.middle + outline.radius[k] * vec2(std::cos(angle), std::sin(angle));
      EXPECT_LE(std::max(std::fabs(p.x), std::fabs(p.y)), 1.0 + 1e-12);
    }
  }
}

TEST(Outline, AWeakSectorIsItsWorstDirection) {
  for (std::uint32_t seed = 1; seed <= 6; ++seed) {
    Draw draw(seed);
    MadeStick stick;
    stick.seed = seed;
    stick.sigma = vec2(0.003);
    stick.reach_x = 0.94;
    stick.bits = 12;
    stick.weak_rad = draw.within(-kPi, kPi);
    stick.weak_width_rad = draw.within(10.0, 57.0) * kDegree;
    stick.weak_reach = draw.within(0.5, 0.8);
    const Outline outline = outline_of(made_track(stick, 0, 0.6, 3.0), stick);
    const auto worst = worst_direction(outline);
    ASSERT_TRUE(worst) << seed;
    const double angle = 2.0 * kPi * *worst / kOutlineDirections;
    EXPECT_LT(std::fabs(wrapped(angle - stick.weak_rad)), 0.5 * stick.weak_width_rad + 0.05)
        << seed;
    EXPECT_NEAR(outline.radius[static_cast<std::size_t>(*worst)], stick.weak_reach, 0.03) << seed;
  }
}

// The picture's lowest bar is at the arrow and has the number beside it, also for a stick with a
// shifted centre.
TEST(Outline, TheLeastReachByDirectionIsThatOfTheWorstDirection) {
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    Draw draw(seed);
    MadeStick stick;
    stick.seed = seed;
    stick.sigma = vec2(0.003);
    stick.centre = vec2(draw.within(-0.1, 0.1), draw.within(-0.1, 0.1));
    stick.bits = 12;
    stick.weak_rad = draw.within(-kPi, kPi);
    stick.weak_width_rad = draw.within(10.0, 57.0) * kDegree;
    stick.weak_reach = draw.within(0.5, 0.8);
    const Outline outline = outline_of(made_track(stick, 0, 0.6, 3.0), stick);
    const int worst = worst_direction(outline).value_or(-1);
    ASSERT_GE(worst, 0) << seed;
    const auto bars = least_reaches(outline);
    const auto lowest = std::min_element(bars.begin(), bars.end());
    EXPECT_EQ(*lowest, outline.radius[static_cast<std::size_t>(worst)]) << seed;
    const double bar_deg = 360.0 / kCircularityBins * static_cast<double>(lowest - bars.begin());
    EXPECT_LE(std::fabs(std::remainder(bar_deg - degrees_of(worst), 360.0)), 3.75 + 0.5) << seed;
    EXPECT_NE(direction_text(worst).find(fmt::format("({} degrees", degrees_of(worst))),
              std::string::npos);
    EXPECT_NEAR(degrees_of(worst), worst * 360.0 / kOutlineDirections, 0.5);
  }
}

TEST(Outline, WithoutADirectionThereIsNoWorstOne) { EXPECT_FALSE(worst_direction(Outline())); }

}  // namespace
}  // namespace gaitpad
