// Puts known rates into reports by the published layouts, byte by byte.
#include "pads/gyroscope.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "gaitpad/math.h"
#include "gaitpad/trace.h"
#include "tests/shared_data.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

DeviceInfo pad(std::uint16_t vendor, std::uint16_t product, BusType bus = BusType::usb) {
  DeviceInfo device;
  device.vendor = vendor;
  device.product = product;
  device.bus = bus;
  device.driver = "hidraw";
  return device;
}

// Writes the counts of x, y, z at this byte.
void put(Report& report, std::size_t at, std::array<int, 3> counts) {
  for (const int count : counts) {
    report.bytes[at++] = static_cast<std::uint8_t>(count & 0xff);
    report.bytes[at++] = static_cast<std::uint8_t>((count >> 8) & 0xff);
  }
}
Report report_with(std::uint8_t id, std::uint16_t size, std::size_t at, std::array<int, 3> counts,
                   std::int64_t time_ns = kMillisecond) {
  Report report;
  report.bytes.fill(0x80);
  report.bytes[0] = id;
  report.size = size;
  report.time_ns = time_ns;
  put(report, at, counts);
  return report;
}
TurnRates rates_of(const DeviceInfo& device, const Report& report,
                   const std::optional<FactoryGyro>& factory = {}) {
  GyroMeter meter(device, factory);
  meter.take(report);
  EXPECT_TRUE(meter.rates());
  return in_degrees(meter.rates().value_or(TurnRates{}));
}
void expect_near(const TurnRates& found, const TurnRates& expected, double tolerance) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], tolerance) << i;
}

// Counts are 1000, -2000, 3000; 32767 counts are 2048 degrees a second.
TEST(Gyroscope, SonysReportsHavePitchYawAndRoll) {
  constexpr std::array<int, 3> kCounts = {1000, -2000, 3000};
  const TurnRates expected = {62.502, -125.004, 187.506};
  expect_near(rates_of(pad(0x054c, 0x09cc), report_with(0x01, 64, 13, kCounts)), expected, 1e-3);
  expect_near(rates_of(pad(0x054c, 0x09cc, BusType::bluetooth), report_with(0x11, 78, 15, kCounts)),
              expected, 1e-3);
  expect_near(rates_of(pad(0x054c, 0x0ce6), report_with(0x01, 64, 16, kCounts)), expected, 1e-3);
  expect_near(rates_of(pad(0x054c, 0x0ce6, BusType::bluetooth), report_with(0x31, 78, 17, kCounts)),
              expected, 1e-3);
}

// SDL converts to -y, z, -x, and for the right Joy-Con to y, -z, -x; 13371 counts are 936 degrees a
// second.
TEST(Gyroscope, SwitchPadsHaveThreeSamplesInAReport) {
  Report report = report_with(0x30, 64, 13 + 6, {1, 2, 3});
  put(report, 25 + 6, {4, 5, 6});
  put(report, 37 + 6, {1337, 2674, -4011});
  expect_near(rates_of(pad(0x057e, 0x2009), report), {-187.19, -280.78, -93.59}, 0.01);
  expect_near(rates_of(pad(0x057e, 0x2007), report), {187.19, 280.78, -93.59}, 0.01);
  GyroMeter meter(pad(0x057e, 0x2006, BusType::bluetooth), {});
  for (int i = 0; i <= 40; ++i) {
    report.time_ns = (1 + 15 * i) * kMillisecond;
    meter.take(report);
  }
  EXPECT_NEAR(meter.sample_rate_hz(), 200.0, 1.0) << "a report each 15 ms";
}

// Byte 12 of a pair's report is L or R; the pair's gyroscope is that of the right one.
TEST(Gyroscope, APairOfJoyConsHasTheRightOnes) {
  Report left = report_with(0x30, 49, 13 + 6, {9, 9, 9});
  put(left, 37 + 6, {4000, 4000, 4000});
  left.bytes[12] = 'L';
  Report right = report_with(0x30, 64, 13 + 6, {1, 2, 3}, 2 * kMillisecond);
  put(right, 37 + 6, {1337, 2674, -4011});
  right.bytes[12] = 'R';
  GyroMeter meter(pad(0x057e, 0x2008, BusType::bluetooth), {});
  meter.take(left);
  EXPECT_FALSE(meter.rates());
  for (int i = 0; i <= 40; ++i) {
    right.time_ns = (1 + 15 * i) * kMillisecond;
    left.time_ns = right.time_ns + 7 * kMillisecond;
    meter.take(right);
    meter.take(left);
  }
  ASSERT_TRUE(meter.rates());
  expect_near(in_degrees(*meter.rates()), {187.19, 280.78, -93.59}, 0.01);
  EXPECT_NEAR(meter.sample_rate_hz(), 200.0, 1.0) << "three samples each 15 ms";
}

TEST(Gyroscope, TheSteamDecksYawAndRollAreExchanged) {
  expect_near(rates_of(pad(0x28de, 0x1205), report_with(0x01, 64, 30, {164, -328, 1638})),
              {10.01, 99.98, 20.02}, 0.01);
}

TEST(Gyroscope, FactoryCalibrationMovesAndScalesEachAxis) {
  const FactoryGyro factory{{10.0, 20.0, -30.0}, {0.1 * kDegree, 0.2 * kDegree, 0.3 * kDegree}};
  expect_near(rates_of(pad(0x054c, 0x0ce6), report_with(0x01, 64, 16, {110, 20, 70}), factory),
              {10.0, 0.0, 30.0}, 1e-9);
}

TEST(Gyroscope, OtherReportsDriversAndPadsHaveNone) {
  GyroMeter meter(pad(0x054c, 0x09cc, BusType::bluetooth), {});
  meter.take(report_with(0x01, 10, 2, {}));
  meter.take(report_with(0x11, 77, 15, {}));
  EXPECT_FALSE(meter.rates());
  DeviceInfo node = pad(0x054c, 0x09cc);
  node.driver = "evdev";
  EXPECT_FALSE(GyroMeter(node, {}).has_gyro());
  EXPECT_FALSE(GyroMeter(pad(0x045e, 0x028e), {}).has_gyro());
  EXPECT_FALSE(GyroMeter().has_gyro());
}

// Plays a second of samples with this mean and standard deviation, in counts, 250 samples a second.
void play(GyroMeter& meter, std::int64_t from_ms, std::array<double, 3> mean, double deviation,
          int milliseconds = 1000) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, deviation);
  for (int t = 0; t <= milliseconds; t += 4) {
    const auto count = [&](double m) { return static_cast<int>(std::lround(m + noise(random))); };
    meter.take(report_with(0x01, 64, 16, {count(mean[0]), count(mean[1]), count(mean[2])},
                           (1 + from_ms + t) * kMillisecond));
  }
}
constexpr double kCount = 2048.0 / 32767.0;  // a count in degrees a second

TEST(Gyroscope, RateBiasAndNoiseAreMeasuredWhileThePadLiesStill) {
  GyroMeter meter(pad(0x054c, 0x0ce6), {});
  play(meter, 0, {12.0, -7.0, 3.0}, 2.0, 4000);
  EXPECT_NEAR(meter.sample_rate_hz(), 250.0, 0.5);
  ASSERT_TRUE(meter.rest());
  EXPECT_NEAR(meter.rest()->duration_s, 4.0, 0.01);
  // With 1000 samples the mean is known to 2 / sqrt(1000) counts, and the deviation to 2.2 %.
  expect_near(in_degrees(meter.rest()->bias_rad_s), {12.0 * kCount, -7.0 * kCount, 3.0 * kCount},
              4.0 * 2.0 * kCount / std::sqrt(1000.0));
  // Rounding to counts adds 1/12 to the variance.
  for (const double noise : in_degrees(meter.rest()->noise_rad_s))
    EXPECT_NEAR(noise, std::sqrt(4.0 + 1.0 / 12.0) * kCount, 0.1 * 2.0 * kCount);
}

TEST(Gyroscope, AHandIsNoRestAndALaterRestReplacesTheFirst) {
  GyroMeter meter(pad(0x054c, 0x0ce6), {});
  play(meter, 0, {0.0, 0.0, 0.0}, 40.0, 3000);  // turns of 2.5 degrees a second to and fro
  EXPECT_FALSE(meter.rest());
  play(meter, 3004, {400.0, 0.0, 0.0}, 1.0, 3000);  // an even turn of 25 degrees a second
  EXPECT_FALSE(meter.rest());
  play(meter, 6008, {16.0, 0.0, 0.0}, 1.0, 3000);
  ASSERT_TRUE(meter.rest());
  EXPECT_NEAR(in_degrees(meter.rest()->bias_rad_s)[0], 1.0, 0.02);
  play(meter, 9012, {0.0, 0.0, 0.0}, 40.0, 3000);
  EXPECT_NEAR(in_degrees(meter.rest()->bias_rad_s)[0], 1.0, 0.02) << "the last rest";
  play(meter, 12016, {32.0, 0.0, 0.0}, 1.0, 3000);
  EXPECT_NEAR(in_degrees(meter.rest()->bias_rad_s)[0], 2.0, 0.02);
}

// Recordings of pads in a hand; a DualSense on USB sends 250 reports a second.
TEST(Gyroscope, RecordedPadsTellTheirRate) {
  GAITPAD_NEEDS(kPadRecordings);
  int recordings = 0;
  for (const std::string& path : files_in(kPadRecordings, ".hid")) {
    if (path.find("dualsense_usb_") == std::string::npos) continue;
    const Trace trace = value_of(read_trace(path, Damage::skip));
    if (trace.events.size() < 500) continue;
    DeviceInfo device = trace.devices.at(0).info;
    GyroMeter meter(device, {});
    Report report;
    for (const TraceEvent& event : trace.events) {
      copy_report(trace, event, report);
      meter.take(report);
    }
    EXPECT_NEAR(meter.sample_rate_hz(), 250.0, 5.0) << path;
    ASSERT_TRUE(meter.rates());
    for (const double rate : in_degrees(*meter.rates())) EXPECT_LT(std::fabs(rate), 360.0) << path;
    ++recordings;
  }
  EXPECT_GT(recordings, 3);
}

TEST(Gyroscope, SilenceAndUnpluggingBeginAnew) {
  GyroMeter meter(pad(0x054c, 0x0ce6), {});
  play(meter, 0, {}, 1.0);
  EXPECT_GT(meter.sample_rate_hz(), 0.0);
  meter.take(report_with(0x01, 64, 16, {}, 9'000 * kMillisecond));
  EXPECT_EQ(meter.sample_rate_hz(), 0.0);
  meter.cut();
  EXPECT_FALSE(meter.rates());
}

}  // namespace
}  // namespace gaitpad
