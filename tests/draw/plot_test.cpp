#include "draw/plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gaitpad {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kEndless = std::numeric_limits<double>::infinity();

TEST(PlotScale, StepsAreOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_DOUBLE_EQ(nice_step(1.0, 5), 0.2);
  EXPECT_DOUBLE_EQ(nice_step(1.0, 4), 0.5);
  EXPECT_DOUBLE_EQ(nice_step(10.0, 10), 1.0);
  EXPECT_DOUBLE_EQ(nice_step(81.0, 4), 50.0);
  EXPECT_DOUBLE_EQ(nice_step(0.003, 3), 0.001);
  EXPECT_DOUBLE_EQ(nice_step(1.0, 1), 1.0);
  for (double span = 1e-7; span < 1e9; span *= 1.37) {
    for (int most = 1; most < 12; ++most) {
      const double step = nice_step(span, most);
      ASSERT_LE(span / step, most * (1.0 + 1e-6));
      ASSERT_GT(span / step, most / 2.6) << "a smaller round step would do";
      const double mantissa = step / std::pow(10.0, std::floor(std::log10(step) + 1e-9));
      ASSERT_TRUE(std::abs(mantissa - 1.0) < 1e-6 || std::abs(mantissa - 2.0) < 1e-6 ||
                  std::abs(mantissa - 5.0) < 1e-6)
          << step;
    }
  }
}

TEST(PlotScale, ThereIsNoStepWhereThereIsNoSpan) {
  for (const double span : {0.0, -1.0, kNone, kEndless}) EXPECT_EQ(nice_step(span, 5), 0.0);
  EXPECT_EQ(nice_step(1.0, 0), 0.0);
  EXPECT_TRUE(nice_ticks(1.0, 1.0, 5).empty());
  EXPECT_TRUE(nice_ticks(0.0, kEndless, 5).empty());
}

TEST(PlotScale, TicksAreTheStepsMultiplesWithinTheRange) {
  EXPECT_EQ(nice_ticks(-2.0, 0.0, 4), (std::vector<double>{-2.0, -1.5, -1.0, -0.5, 0.0}));
  EXPECT_EQ(nice_ticks(-21.0, 33.0, 3), (std::vector<double>{-20.0, 0.0, 20.0}));
  const auto ticks = nice_ticks(0.0, 0.3, 3);
  ASSERT_EQ(ticks.size(), 4u);  // 0.3 is a tick, though 3 * 0.1 != 0.3
  EXPECT_FALSE(std::signbit(nice_ticks(-1.0, 1.0, 2)[1]));
}

TEST(PlotScale, TickTextHasTheDecimalsOfItsStep) {
  EXPECT_EQ(tick_text(0.25, 0.05), "0.25");
  EXPECT_EQ(tick_text(-1.5, 0.5), "-1.5");
  EXPECT_EQ(tick_text(20.0, 20.0), "20");
  EXPECT_EQ(tick_text(-0.001, 0.1), "0.0");
  EXPECT_EQ(tick_text(kNone, 0.1), "-");
}

TEST(PlotScale, LogarithmsAreMarkedAtPowersOfTenAndBetweenThemIfThereIsRoom) {
  const auto texts = [](double min, double max, int steps) {
    std::vector<std::string> all;
    for (const PlotTick& tick : plot_ticks({min, max, true}, steps)) all.push_back(tick.text);
    return all;
  };
  EXPECT_EQ(texts(0.0, 5.0, 8),
            (std::vector<std::string>{"1", "10", "100", "1000", "10000", "100000"}));
  EXPECT_EQ(texts(2.5, 3.8, 8), (std::vector<std::string>{"500", "1000", "2000", "5000"}));
  EXPECT_EQ(texts(-1.0, 0.0, 8), (std::vector<std::string>{"0.1", "0.2", "0.5", "1"}));
  EXPECT_TRUE(plot_ticks({0.0, kEndless, true}, 8).empty());
  EXPECT_DOUBLE_EQ(plot_ticks({2.5, 3.8, true}, 8)[1].value, 3.0);
}

TEST(PlotScale, ARangeHoldsItsEndsAndIsNeverEmpty) {
  const PlotRange r = nice_range(-21.0, 33.0, 10.0);
  EXPECT_EQ(r.min, -40.0);
  EXPECT_EQ(r.max, 40.0);
  for (const auto& [min, max] : {std::pair{5.0, 5.0}, {kNone, 1.0}, {kEndless, -kEndless}}) {
    const PlotRange made = nice_range(min, max, 2.0);
    EXPECT_GE(made.max - made.min, 2.0);
  }
}

std::vector<PlotPoint> wave(std::size_t count) {
  std::vector<PlotPoint> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = static_cast<double>(i) / static_cast<double>(count - 1);
    points.push_back({x, std::sin(40.0 * x)});
  }
  return points;
}

TEST(PlotScale, DecimationKeepsEachColumnsExtremesAndIsBounded) {
  std::vector<PlotPoint> points = wave(20000), shown;
  points[7777].y = 9.0;  // a single outlier
  points[12345].y = -7.0;
  decimate(points, {0.0, 1.0}, 200, shown);
  EXPECT_LE(shown.size(), 800u);
  double low = 0.0, high = 0.0;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    low = std::min(low, shown[i].y);
    high = std::max(high, shown[i].y);
    ASSERT_GE(shown[i].x, shown[i > 0 ? i - 1 : 0].x);
  }
  EXPECT_EQ(high, 9.0);
  EXPECT_EQ(low, -7.0);
  EXPECT_EQ(shown.front().x, 0.0);
  EXPECT_EQ(shown.back().x, 1.0);
}

TEST(PlotScale, FewPointsStayAsTheyAre) {
  const std::vector<PlotPoint> points = wave(100);
  std::vector<PlotPoint> shown;
  decimate(points, {0.0, 1.0}, 60, shown);
  ASSERT_EQ(shown.size(), points.size());
  for (std::size_t i = 0; i < shown.size(); ++i) EXPECT_EQ(shown[i].y, points[i].y);
}

TEST(PlotScale, WhatIsNoNumberIsOneGap) {
  std::vector<PlotPoint> points = wave(5000), shown;
  for (std::size_t i = 2000; i < 2500; ++i) points[i].y = kNone;
  points[0].y = kEndless;
  decimate(points, {0.0, 1.0}, 100, shown);
  int gaps = 0;
  for (const PlotPoint& p : shown) gaps += std::isfinite(p.y) ? 0 : 1;
  EXPECT_EQ(gaps, 1);
  EXPECT_TRUE(std::isfinite(shown.front().y));
  decimate(points, {1.0, 1.0}, 100, shown);
  EXPECT_TRUE(shown.empty());
}

TEST(PlotOnCairo, PlacesMapToPixels) {
  Plot plot;
  plot.x = {0.0, 2.0};
  plot.y = {-10.0, 10.0};
  const Box box{100.0, 50.0, 200.0, 100.0};
  EXPECT_EQ(pixel_in(box, plot, vec2(1.0, 10.0)), vec2(200.0, 50.0));
  EXPECT_EQ(pixel_in(box, plot, vec2(0.0, -10.0)), vec2(100.0, 150.0));
}

}  // namespace
}  // namespace gaitpad
