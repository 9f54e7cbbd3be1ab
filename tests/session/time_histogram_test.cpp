#include <gtest/gtest.h>

#include <memory>

#include "session/live_loop.h"

namespace gaitpad {
namespace {

TEST(TimeHistogram, IsZeroWithoutAnything) {
  const auto times = std::make_unique<TimeHistogram>();
  EXPECT_EQ(times->median_us(), 0.0);
  EXPECT_EQ(times->max_us(), 0.0);
}

TEST(TimeHistogram, MedianOfOneValueIsThatValueWithinOnePercent) {
  for (std::int64_t ns = 1; ns < std::int64_t{1} << 39; ns += ns / 3 + 1) {
    const auto times = std::make_unique<TimeHistogram>();
    times->add(ns);
    const double us = static_cast<double>(ns) / 1000.0;
    ASSERT_NEAR(times->median_us(), us, 0.01 * us) << ns;
    ASSERT_EQ(times->max_us(), us);
  }
}

TEST(TimeHistogram, HalfOfTheValuesLieBelowTheMedian) {
  const auto times = std::make_unique<TimeHistogram>();
  for (int i = 1; i <= 1001; ++i) times->add((i * 7919 % 1001 + 1) * 1000);  // each once
  EXPECT_NEAR(times->median_us(), 501.0, 5.1);
  EXPECT_EQ(times->max_us(), 1001.0);
}

TEST(TimeHistogram, WhatHasNoPlaceIsCountedAtTheEnds) {
  const auto times = std::make_unique<TimeHistogram>();
  times->add(-5);
  EXPECT_EQ(times->median_us(), 0.0);
  for (int i = 0; i < 3; ++i) times->add(std::int64_t{1} << 62);
  EXPECT_GT(times->median_us(), 1e9);
  EXPECT_EQ(times->max_us(), static_cast<double>(std::int64_t{1} << 62) / 1000.0);
}

}  // namespace
}  // namespace gaitpad
