#include <gtest/gtest.h>

#include <cmath>

#include "session/live_loop.h"

namespace gaitpad {
namespace {

constexpr std::int64_t kStart_ns = 123'456'789'012'345;

TEST(TickClock, TicksAreDueAtWholeFractionsOfASecondForEver) {
  const TickClock clock(240, kStart_ns);
  EXPECT_EQ(clock.due_ns(0), kStart_ns);
  EXPECT_EQ(clock.due_ns(1), kStart_ns + 4'166'666);
  EXPECT_EQ(clock.due_ns(2), kStart_ns + 8'333'333);
  EXPECT_EQ(clock.due_ns(240), kStart_ns + kSecond_ns);
  // A year at 10 kHz: 3.2e11 ticks, whose product with 1e9 has no room in 64 bits.
  const TickClock fast(10'000, kStart_ns);
  const std::int64_t year_s = 31'536'000;
  EXPECT_EQ(fast.due_ns(year_s * 10'000 + 1), kStart_ns + year_s * kSecond_ns + 100'000);
}

TEST(TickClock, ALateTickMovesNoneOfThoseAfterIt) {
  TickClock clock(100, kStart_ns);
  const std::int64_t period_ns = 10'000'000;
  EXPECT_EQ(clock.begin(5, clock.due_ns(5)), TickClock::Begin::on_time);
  EXPECT_EQ(clock.begin(6, clock.due_ns(6) + period_ns), TickClock::Begin::on_time);
  EXPECT_EQ(clock.begin(7, clock.due_ns(7) + period_ns + 1), TickClock::Begin::late);
  EXPECT_EQ(clock.begin(8, clock.due_ns(8) + kSecond_ns), TickClock::Begin::late);
  EXPECT_EQ(clock.due_ns(9), kStart_ns + 9 * period_ns);
}

TEST(TickClock, AfterMoreThanASecondItIsSetForward) {
  TickClock clock(100, kStart_ns);
  const std::int64_t now_ns = clock.due_ns(50) + kSecond_ns + 1;
  EXPECT_EQ(clock.begin(50, now_ns), TickClock::Begin::after_standstill);
  EXPECT_EQ(clock.skipped_ns(), kSecond_ns + 1);
  EXPECT_EQ(clock.due_ns(50), now_ns);
  EXPECT_EQ(clock.due_ns(51), now_ns + 10'000'000);
  EXPECT_EQ(clock.begin(51, clock.due_ns(51)), TickClock::Begin::on_time);
}

TEST(TickClock, APaceStretchesTheTimeBetweenTicks) {
  TickClock clock(100, kStart_ns);
  clock.set_pace(0.25, 10, clock.due_ns(9));
  EXPECT_EQ(clock.due_ns(10), kStart_ns + 100'000'000) << "as it was";
  EXPECT_EQ(clock.due_ns(11), kStart_ns + 140'000'000);
  EXPECT_EQ(clock.due_ns(10 + 1'000'000), kStart_ns + 100'000'000 + 40'000'000'000'000);
  EXPECT_EQ(clock.begin(11, clock.due_ns(11) + 39'000'000), TickClock::Begin::on_time);
  EXPECT_EQ(clock.begin(12, clock.due_ns(12) + 41'000'000), TickClock::Begin::late);
  // Quicker again: not as late as at the old pace.
  clock.set_pace(1.0, 13, clock.due_ns(12) + 1'000'000);
  EXPECT_EQ(clock.due_ns(13), kStart_ns + 100'000'000 + 2 * 40'000'000 + 11'000'000);
}

TEST(TickClock, WhatIsLateStaysLateAtAnotherPace) {
  TickClock clock(100, kStart_ns);
  const std::int64_t now_ns = clock.due_ns(20);
  clock.set_pace(0.5, 15, now_ns);
  EXPECT_EQ(clock.due_ns(15), now_ns - 50'000'000);
  EXPECT_EQ(clock.begin(15, now_ns), TickClock::Begin::late);
}

TEST(TickClock, StandingStillIsNeitherLateNorSkipped) {
  TickClock clock(100, kStart_ns);
  clock.set_pace(0.0, 7, clock.due_ns(7));
  EXPECT_EQ(clock.due_ns(7), TickClock::kNever_ns);
  const std::int64_t now_ns = kStart_ns + 3600 * kSecond_ns;
  clock.set_pace(1.0, 9, now_ns);  // two ticks were stepped meanwhile
  EXPECT_EQ(clock.due_ns(9), now_ns);
  EXPECT_EQ(clock.begin(9, now_ns), TickClock::Begin::on_time);
  EXPECT_EQ(clock.skipped_ns(), 0);
}

TEST(TickClock, OnlyPacesThatMakeSenseAreUsable) {
  EXPECT_EQ(TickClock::usable_pace(0.25), 0.25);
  EXPECT_EQ(TickClock::usable_pace(-1.0), 0.0);
  EXPECT_EQ(TickClock::usable_pace(std::nan("")), 0.0);
  EXPECT_EQ(TickClock::usable_pace(1e-9), 0.0);
  EXPECT_EQ(TickClock::usable_pace(1e300), TickClock::kMaxPace);
}

TEST(TickClock, TicksThatTakeTooLongAreNoStandstill) {
  TickClock clock(100, kStart_ns);
  std::int64_t now_ns = kStart_ns;
  int set_forward = 0;
  for (int tick = 0; tick < 400; ++tick, now_ns += 15'000'000) {  // of 10 ms each
    const TickClock::Begin begin = clock.begin(tick, now_ns);
    EXPECT_NE(begin, TickClock::Begin::after_standstill);
    set_forward += begin == TickClock::Begin::after_overload;
  }
  EXPECT_EQ(set_forward, 1) << "after 201 ticks it is a second late, after 402 again";
}

}  // namespace
}  // namespace gaitpad
