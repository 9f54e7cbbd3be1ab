// A source with room for 63 reports, a pad that sends at its rate, and a reader that is stopped.
#include "drivers/missed_reports.h"

#include <gtest/gtest.h>

namespace gaitpad {
namespace {

constexpr std::int64_t kMs = 1'000'000, kRoom = 63;

class Flood : public testing::Test {
 protected:
  // The pad sends at `rate_hz` for so long, and the reader looks every `look_ms`, taking at most
  // `at_once` each time.
  void run(double rate_hz, double seconds, double look_ms, std::int64_t at_once = 1000) {
    const auto end_ns = now_ns_ + static_cast<std::int64_t>(seconds * 1e9);
    while (now_ns_ < end_ns) {
      const auto step_ns = static_cast<std::int64_t>(look_ms * 1e6);
      now_ns_ += step_ns;
      sent_ += rate_hz * static_cast<double>(step_ns) * 1e-9;
      for (; sent_ >= 1.0; sent_ -= 1.0) {
        if (held_ < kRoom)
          ++held_;
        else
          ++dropped_;
      }
      for (std::int64_t i = 0; i < at_once && held_ > 0; ++i, --held_)
        missed_.note_report(now_ns_ + i);
      if (held_ == 0) missed_.note_empty(now_ns_ + at_once);
    }
  }

  MissedReports missed_{kRoom};
  std::int64_t now_ns_ = 1000 * kMs, held_ = 0, dropped_ = 0;
  double sent_ = 0.0;
};

TEST_F(Flood, NothingIsMissedByAReaderThatKeepsUp) {
  run(1000.0, 5.0, 4.0);
  run(125.0, 5.0, 300.0);
  EXPECT_EQ(dropped_, 0);
  EXPECT_EQ(missed_.missed(), 0);
}

TEST_F(Flood, AtLeastTheRealGapsAreCountedAfterEachStop) {
  for (const double rate_hz : {125.0, 250.0, 1000.0}) {
    missed_ = MissedReports(kRoom);
    dropped_ = 0;
    run(rate_hz, 2.0, 4.0);
    for (const double stop_ms : {700.0, 900.0, 2500.0}) {
      run(rate_hz, stop_ms / 1000.0, stop_ms);
      run(rate_hz, 1.0, 4.0);
    }
    EXPECT_GT(dropped_, 100) << rate_hz;
    EXPECT_GE(missed_.missed(), dropped_) << rate_hz;
    EXPECT_LE(missed_.missed(), dropped_ + dropped_ / 20 + 10) << rate_hz;
  }
}

TEST_F(Flood, PausesOfThePadHideNoGap) {
  for (int i = 0; i < 10; ++i) {
    run(250.0, 0.15, 4.0);
    run(0.0, 0.1, 4.0);
  }
  run(250.0, 0.9, 900.0);
  EXPECT_GT(dropped_, 100);
  EXPECT_GE(missed_.missed(), dropped_);
}

TEST_F(Flood, CountsWhileTheSourceIsNeverFoundEmpty) {
  run(1000.0, 1.0, 4.0);
  run(1000.0, 3.0, 40.0, 20);  // takes half of what comes
  EXPECT_GT(held_, 0);
  EXPECT_GT(dropped_, 1000);
  // What the source still holds is not known to the reader.
  EXPECT_GE(missed_.missed(), dropped_);
  EXPECT_LE(missed_.missed(), dropped_ + dropped_ / 20 + kRoom + 10);
}

TEST_F(Flood, CountsFromTheBeginningOnIfTheReaderNeverKeepsUp) {
  run(1000.0, 3.0, 40.0, 20);
  EXPECT_GE(missed_.missed() + kRoom, dropped_);
  EXPECT_GT(missed_.missed(), 1000);
}

TEST_F(Flood, APadAtRestMissesNothingHoweverLongTheReaderStops) {
  run(250.0, 1.0, 4.0);
  run(0.0, 100.0, 10000.0);
  run(250.0, 1.0, 4.0);
  EXPECT_EQ(missed_.missed(), 0);
}

TEST_F(Flood, WhatWaitedDuringTheOpeningIsNotCounted) {
  for (int i = 0; i < kRoom; ++i) missed_.note_report(now_ns_ + i);
  EXPECT_TRUE(missed_.note_empty(now_ns_ + kMs)) << "the pad's state may be another by now";
  EXPECT_EQ(missed_.missed(), 0);
}

}  // namespace
}  // namespace gaitpad
