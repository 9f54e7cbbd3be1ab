#include "pads/pad_meter.h"

#include <gtest/gtest.h>

namespace gaitpad {
namespace {

TEST(PadMeter, JitterIsTheStandardDeviationOfTheIntervals) {
  EXPECT_DOUBLE_EQ(jitter({1000.0, 1000.0, 1000.0}), 0.0);
  EXPECT_DOUBLE_EQ(jitter({998.0, 1000.0, 1002.0}), 2.0);
  EXPECT_DOUBLE_EQ(jitter({1000.0}), 0.0);
}

TEST(PadMeter, TheRateIsCountedOverTheWholeWindow) {
  ReportWindow window;
  window.reports = 100;
  window.duration_s = 0.4;
  EXPECT_DOUBLE_EQ(rate_hz(window), 250.0);
  EXPECT_DOUBLE_EQ(greatest({}), 0.0);
  EXPECT_DOUBLE_EQ(greatest({1.0, 3.0, 2.0}), 3.0);
}

TEST(PadMeter, ReportsAreShownOnce) {
  MonitoredPads pads;
  pads[0].unshown_ns = {1, 2};
  note_shown(pads);
  EXPECT_EQ(pads[0].running.frame_us.size(), 2u);
  note_shown(pads);
  EXPECT_EQ(pads[0].running.frame_us.size(), 2u);
}

}  // namespace
}  // namespace gaitpad
