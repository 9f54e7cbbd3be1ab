// A pad's gyroscope: its rates out of the pad's own reports (DualShock 4, DualSense, Switch Pro,
// Joy-Con, Steam Deck), how often they come, and what it shows while the pad lies still. Layouts
// are from Linux's hid-playstation.c, hid-nintendo.c and hid-steam.c, directions and the Steam
// Deck's scale from SDL 3's drivers.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "gaitpad/report.h"

namespace gaitpad {

// The place of the rates in a kind of pad's reports: little-endian numbers of 16 bits, three for
// each sample.
struct GyroLayout {
  struct Axis {
    std::size_t number = 0;  // which of the sample's three numbers
    double sign = 1.0;
  };
  std::uint8_t report_id = 0;    // first byte of the reports with rates
  std::size_t report_bytes = 0;  // size of a report with rates; shorter reports have none
  // Byte that says which part of the pad the rates are of; 0: there is only one.
  std::size_t mark_at = 0;
  std::uint8_t mark = 0;  // value of that byte in the reports that count
  std::size_t first = 0;  // byte at which the first sample begins
  std::size_t samples = 1, sample_bytes = 0;
  double rad_s_per_count = 0.0;  // scale of a pad that stores no calibration
  std::array<Axis, 3> axes{};    // pitch (nose up), yaw (to the left), roll (to the left)
};
// The layout of a device's rates. None: the pad has no gyroscope, or the driver hands on other
// reports than the pad's.
std::optional<GyroLayout> gyro_layout(const DeviceInfo& device);

// Converts to degrees, as users read them.
TurnRates in_degrees(const TurnRates& rates) noexcept;

class GyroMeter {
 public:
  GyroMeter() = default;  // Measures nothing, for a pad without a gyroscope.
  GyroMeter(const DeviceInfo& device, const std::optional<FactoryGyro>& factory)
      : layout_(gyro_layout(device)), factory_(factory) {}

  bool has_gyro() const noexcept { return layout_.has_value(); }
  bool has_factory_calibration() const noexcept { return layout_ && factory_; }
  void take(const Report& report) noexcept;
  void cut() noexcept;  // Call it when the pad was unplugged.

  // The newest sample; none: no sample has come yet.
  const std::optional<TurnRates>& rates() const noexcept { return rates_; }
  // Samples a second, in the last half second; 0: not known.
  double sample_rate_hz() const noexcept { return sample_rate_hz_; }
  // Mean and noise of the rates from the last time that the pad lay still.
  struct Rest {
    TurnRates bias_rad_s{};   // mean of the rates
    TurnRates noise_rad_s{};  // standard deviation of the rates
    double duration_s = 0.0;
  };
  const std::optional<Rest>& rest() const noexcept { return rest_; }

 private:
  // Sums of samples; the squares are of the distances from the mean.
  struct Sums {
    std::size_t count = 0;
    TurnRates mean{}, squares{};
    void add(const TurnRates& rates) noexcept;
    void add(const Sums& other) noexcept;
    double deviation(std::size_t axis) const noexcept;
  };
  void end_window(std::int64_t time_ns) noexcept;

  std::optional<GyroLayout> layout_;
  std::optional<FactoryGyro> factory_;
  std::optional<TurnRates> rates_;
  double sample_rate_hz_ = 0.0;
  // Times of the window's begin and of the last report; 0: none.
  std::int64_t window_ns_ = 0, last_ns_ = 0;
  // Sums of the present window, and of all windows since the pad was laid down.
  Sums window_, still_;
  double still_s_ = 0.0;
  std::optional<Rest> rest_;
};

}  // namespace gaitpad
