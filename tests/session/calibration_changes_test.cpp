// changes_since(), of session/calibration_store.h.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "pads/calibration_store.h"

namespace gaitpad {
namespace {

CalibrationFile measured_file() {
  CalibrationFile file;
  for (StickCalibration* stick : {&file.calibration.left, &file.calibration.right}) {
    stick->x = {-0.95, 0.01, 0.97};
    stick->y = {-0.96, -0.02, 0.95};
    stick->inner = 0.05;
  }
  for (auto& measured : file.measured) measured = StickMeasured{0.002, 0.01, 0.0, 8.0};
  return file;
}
std::string only_change(const CalibrationFile& then, const CalibrationFile& now) {
  const auto changes = changes_since(then, now);
  if (changes.size() == 1) return changes[0];
  std::string all = std::to_string(changes.size()) + ":";
  for (const std::string& change : changes) all += " " + change + ";";
  return all;
}

TEST(ChangesSince, TheSameStickHasNone) {
  EXPECT_EQ(changes_since(measured_file(), measured_file()), std::vector<std::string>());
  // Nor one measured a second time, within what two measurements differ by.
  CalibrationFile again = measured_file();
  again.calibration.left.x = {-0.94, 0.014, 0.98};
  again.measured[0] = StickMeasured{0.0023, 0.013, 0.0, 8.5};
  EXPECT_EQ(changes_since(measured_file(), again), std::vector<std::string>());
}

TEST(ChangesSince, AMovedCentreIsComparedWithTheInnerZone) {
  CalibrationFile now = measured_file();
  now.calibration.left.x.centre = 0.04;
  EXPECT_EQ(only_change(measured_file(), now),
            "left stick: the centre has moved by 0.030, from (0.010, -0.020) to (0.040, -0.020): "
            "more than half of the inner zone of 0.047, so it may soon walk by itself");
  now.calibration.left.x.centre = 0.07;
  EXPECT_NE(only_change(measured_file(), now).find("beyond the inner zone"), std::string::npos);
}

TEST(ChangesSince, AShorterReachTellsWhetherFullDeflectionIsLeft) {
  CalibrationFile now = measured_file();
  now.calibration.right.y.max = 0.80;
  EXPECT_EQ(only_change(measured_file(), now),
            "right stick: it reaches 0.800 forward, 0.950 in the file: full deflection is not "
            "reached there any more");
  now.calibration.right.y.max = 0.95 - 0.04;
  EXPECT_NE(only_change(measured_file(), now).find("barely"), std::string::npos);
  now.calibration.right = measured_file().calibration.right;
  now.calibration.right.x.min = -1.0;
  EXPECT_NE(only_change(measured_file(), now)
                .find("1.000 to the left, 0.950 in the file: full "
                      "deflection comes before the rim"),
            std::string::npos);
}

TEST(ChangesSince, NoiseHysteresisDriftAndCircularityHaveBothNumbers) {
  CalibrationFile now = measured_file();
  now.measured[0]->sigma = 0.0085;
  EXPECT_EQ(
      only_change(measured_file(), now),
      "left stick: its noise at rest is 0.0085 (sigma), 0.0020 in the file: the inner zone of "
      "0.047 covers it");
  now.measured[0]->sigma = 0.0130;
  EXPECT_NE(only_change(measured_file(), now).find("0.047 is too small for it"), std::string::npos);
  now = measured_file();
  now.measured[1]->hysteresis = 0.03;
  EXPECT_EQ(only_change(measured_file(), now),
            "right stick: the places to which it returns lie 0.030 apart, 0.010 in the file: the "
            "inner zone of 0.047 covers it");
  now = measured_file();
  now.measured[1]->drift_per_s = 0.0075;
  EXPECT_EQ(only_change(measured_file(), now),
            "right stick: at rest it drifts by 0.0075 a second, 0.0000 in the file: no dead zone "
            "cures that");
  now = measured_file();
  now.measured[0]->circularity_error = 12.25;
  EXPECT_EQ(only_change(measured_file(), now),
            "left stick: its circularity error is 12.2 %, 8.0 % in the file: the directions differ "
            "more in how far it reaches");
}

TEST(ChangesSince, WhatWasNotMeasuredTodayIsNotCompared) {
  CalibrationFile now;  // every value another one
  EXPECT_EQ(changes_since(measured_file(), now), std::vector<std::string>());
  now.measured[0] = StickMeasured{};
  EXPECT_EQ(changes_since(measured_file(), now), std::vector<std::string>());
  now.measured[0]->sigma = 0.002;  // it rested, but was not turned round
  now.calibration.left.x.centre = 0.3;
  EXPECT_EQ(changes_since(measured_file(), now).size(), 1u);
}

TEST(ChangesSince, AFileMadeByHandIsComparedInWhatSteers) {
  CalibrationFile then;
  then.calibration.left.inner = 0.1;
  CalibrationFile now = measured_file();
  now.calibration.left.x = {-0.8, 0.0, 1.0};
  now.calibration.left.y = {-1.0, 0.0, 1.0};
  now.measured[1].reset();
  EXPECT_EQ(only_change(then, now).find("left stick: it reaches 0.800 to the left, 1.000 in"), 0u);
}

TEST(ChangesSince, TurnedAxesAreToldAloneAndNotANumberIsNoChange) {
  CalibrationFile now = measured_file();
  now.calibration.left.frame = {RawDirection::plus_y, RawDirection::plus_x};
  now.calibration.left.x.centre = 0.5;
  EXPECT_EQ(only_change(measured_file(), now).find("left stick: its axes lie otherwise"), 0u);
  now = measured_file();
  const double nan = std::nan("");
  now.calibration.left.x = {nan, nan, nan};
  now.measured[0] = StickMeasured{nan, nan, nan, nan};
  EXPECT_EQ(changes_since(measured_file(), now), std::vector<std::string>());
}

}  // namespace
}  // namespace gaitpad
