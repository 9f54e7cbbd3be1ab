#include "stick/new_values.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

#include "tests/minimum_jerk.h"

namespace gaitpad {
namespace {

constexpr std::int64_t kMs = 1'000'000;

// Deflection of a stick that is pushed forward in 100 ms.
double pushed(double time_s) { return minimum_jerk(time_s / 0.1); }

// Counts for one second of a pad that reports every `report_ms` and measures its stick every
// `value_ms`; the stick is pushed twice and held in between.
NewValueCount counted(int report_ms, int value_ms) {
  NewValueCount count;
  for (int ms = 0; ms < 1000; ms += report_ms) {
    const double time_s = 1e-3 * (ms / value_ms * value_ms);
    const double y = pushed(time_s - 0.1) - pushed(time_s - 0.5);
    count.take(ms * kMs, {0.0, y}, {0.0, 0.0});
  }
  return count;
}

TEST(NewValueCount, APadThatSendsEachPositionFourTimesHasAQuarterOfTheRate) {
  const auto rate = counted(1, 4).rate();
  ASSERT_TRUE(rate);
  EXPECT_NEAR(rate->report_hz, 1000.0, 1.0);
  EXPECT_NEAR(rate->new_value_hz, 250.0, 1.0);
  EXPECT_NEAR(rate->repeats(), 0.75, 0.001);
}

TEST(NewValueCount, APadWhoseReportsAreAllNewRepeatsNothing) {
  for (const int ms : {1, 4, 8}) {
    const auto rate = counted(ms, ms).rate();
    ASSERT_TRUE(rate) << ms;
    EXPECT_NEAR(rate->new_value_hz, 1000.0 / ms, 1.0) << ms;
    EXPECT_EQ(rate->repeats(), 0.0) << ms;
  }
}

TEST(NewValueCount, NoiseAtRestIsNoMovement) {
  NewValueCount count;
  for (int ms = 0; ms < 5000; ms += 60) count.take(ms * kMs, {0.01 * (ms % 7), 0.0}, {0.0, 0.0});
  EXPECT_FALSE(count.rate());
  EXPECT_FALSE(NewValueCount().rate());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::int64_t ns : {INT64_MAX, INT64_MIN, std::int64_t{0}, INT64_MAX})
    for (const double x : {0.0, nan, 1.0, 1e300}) count.take(ns, {x, 0.0}, {0.0, nan});
  EXPECT_FALSE(count.rate());
}

}  // namespace
}  // namespace gaitpad
