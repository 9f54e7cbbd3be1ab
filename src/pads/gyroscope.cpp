#include "pads/gyroscope.h"

#include <algorithm>
#include <cmath>

#include "drivers/pads/pads_of_devices.h"
#include "gaitpad/math.h"

namespace gaitpad {
namespace {

constexpr std::uint16_t kSony = 0x054c, kNintendo = 0x057e, kValve = 0x28de;

constexpr std::array<GyroLayout::Axis, 3> kAsCounted = {{{0}, {1}, {2}}};
// The range of 2048 degrees a second is hid-playstation.c's.
constexpr double kSonyCount_rad_s = 2048.0 / 32767.0 * kDegree;
// By the calibration that hid-nintendo.c assumes; then the Steam Deck's.
constexpr double kSwitchCount_rad_s = 936.0 / 13371.0 * kDegree;
constexpr double kDeckCount_rad_s = 2000.0 / 32768.0 * kDegree;

constexpr std::size_t kBluetoothBytes = 78, kUsbBytes = 64;

// `common`: number of the byte at which the part begins that USB and Bluetooth have in common;
// `at`: byte of the rates in this part.
GyroLayout sony(bool is_bluetooth, std::uint8_t bluetooth_id, std::size_t bluetooth_common,
                std::size_t at) {
  return {.report_id = is_bluetooth ? bluetooth_id : std::uint8_t{0x01},
          .report_bytes = is_bluetooth ? kBluetoothBytes : kUsbBytes,
          .first = (is_bluetooth ? bluetooth_common : 1) + at,
          .rad_s_per_count = kSonyCount_rad_s,
          .axes = kAsCounted};
}

// Three samples of six numbers, the accelerometer's first, 5 ms apart. The right Joy-Con's chip is
// turned by half a turn about its length.
GyroLayout nintendo(double sign) {
  return {.report_id = 0x30,
          .report_bytes = 49,
          .first = 13 + 6,
          .samples = 3,
          .sample_bytes = 12,
          .rad_s_per_count = kSwitchCount_rad_s,
          .axes = {{{1, -sign}, {2, sign}, {0, -1.0}}}};
}

// Reports with the sensors of the left and of the right Joy-Con come in turns; the right one's are
// taken.
GyroLayout pair_of_joy_cons() {
  GyroLayout layout = nintendo(-1.0);
  layout.mark_at = kPairSideByte;
  layout.mark = kPairRight;
  return layout;
}

}  // namespace

std::optional<GyroLayout> gyro_layout(const DeviceInfo& device) {
  if (device.driver == "evdev" || device.driver == "sdl") return std::nullopt;
  const bool is_bluetooth = device.bus == BusType::bluetooth;
  switch (std::uint32_t{device.vendor} << 16 | device.product) {
    case kSony << 16 | 0x05c4:
    case kSony << 16 | 0x09cc:
    case kSony << 16 | 0x0ba0:
      return sony(is_bluetooth, 0x11, 3, 12);
    case kSony << 16 | 0x0ce6:
    case kSony << 16 | 0x0df2:
      return sony(is_bluetooth, 0x31, 2, 15);
    case kNintendo << 16 | 0x2006:
    case kNintendo << 16 | 0x2009:
      return nintendo(1.0);
    case kNintendo << 16 | 0x2007:
      return nintendo(-1.0);
    case kNintendo << 16 | 0x2008:
      return pair_of_joy_cons();
    case kValve << 16 | 0x1205:
      return GyroLayout{.report_id = 0x01,
                        .report_bytes = 64,
                        .first = 30,
                        .rad_s_per_count = kDeckCount_rad_s,
                        .axes = {{{0}, {2}, {1, -1.0}}}};
    default:
      return std::nullopt;
  }
}

TurnRates in_degrees(const TurnRates& rates) noexcept {
  return {rates[0] / kDegree, rates[1] / kDegree, rates[2] / kDegree};
}

void GyroMeter::Sums::add(const TurnRates& rates) noexcept {
  ++count;
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const double before = rates[i] - mean[i];
    mean[i] += before / static_cast<double>(count);
    squares[i] += before * (rates[i] - mean[i]);
  }
}

// Merges the variances of two samples (Chan, Golub and LeVeque).
void GyroMeter::Sums::add(const Sums& other) noexcept {
  if (other.count == 0) return;
  const auto a = static_cast<double>(count), b = static_cast<double>(other.count);
  for (std::size_t i = 0; i < mean.size(); ++i) {
    const double between = other.mean[i] - mean[i];
    mean[i] += between * b / (a + b);
    squares[i] += other.squares[i] + between * between * a * b / (a + b);
  }
  count += other.count;
}

double GyroMeter::Sums::deviation(std::size_t axis) const noexcept {
  return count < 2 ? 0.0 : std::sqrt(squares[axis] / static_cast<double>(count - 1));
}

// A pad in a hand turns to and fro by several degrees a second; on a table the noise of these chips
// is below 0.3 degrees a second. A mean beyond the limit is no bias: the pad turns evenly.
void GyroMeter::end_window(std::int64_t time_ns) noexcept {
  constexpr double kMostNoise_rad_s = 1.0 * kDegree, kMostBias_rad_s = 15.0 * kDegree;
  constexpr std::size_t kLeastSamples = 10;
  const double duration_s = 1e-9 * static_cast<double>(time_ns - window_ns_);
  sample_rate_hz_ = static_cast<double>(window_.count) / duration_s;
  bool is_still = window_.count >= kLeastSamples;
  for (std::size_t i = 0; i < window_.mean.size(); ++i)
    is_still = is_still && window_.deviation(i) < kMostNoise_rad_s &&
               std::fabs(window_.mean[i]) < kMostBias_rad_s;
  if (is_still) {
    still_.add(window_);
    still_s_ += duration_s;
    rest_ = Rest{still_.mean, {}, still_s_};
    for (std::size_t i = 0; i < still_.mean.size(); ++i)
      rest_->noise_rad_s[i] = still_.deviation(i);
  } else {
    still_ = {};
    still_s_ = 0.0;
  }
  window_ = {};
  window_ns_ = time_ns;
}

void GyroMeter::take(const Report& report) noexcept {
  constexpr std::int64_t kWindow_ns = 500'000'000, kSilence_ns = 1'000'000'000;
  if (!layout_ || report.size < layout_->report_bytes || report.bytes[0] != layout_->report_id)
    return;
  if (layout_->mark_at != 0 && report.bytes[layout_->mark_at] != layout_->mark) return;
  if (last_ns_ != 0 && (report.time_ns < last_ns_ || report.time_ns - last_ns_ > kSilence_ns))
    cut();
  if (window_ns_ == 0) window_ns_ = report.time_ns;
  last_ns_ = report.time_ns;
  if (report.time_ns - window_ns_ >= kWindow_ns) end_window(report.time_ns);
  for (std::size_t s = 0; s < layout_->samples; ++s) {
    TurnRates rates{};
    for (std::size_t i = 0; i < rates.size(); ++i) {
      const auto& [number, sign] = layout_->axes[i];
      const std::size_t at = layout_->first + s * layout_->sample_bytes + 2 * number;
      const auto count = static_cast<std::int16_t>(report.bytes[at] | (report.bytes[at + 1] << 8));
      const double scaled =
          factory_ ? (count - factory_->zero[number]) * factory_->rad_s_per_count[number]
                   : count * layout_->rad_s_per_count;
      rates[i] = sign * scaled;
    }
    rates_ = rates;
    window_.add(rates);
  }
}

void GyroMeter::cut() noexcept {
  rates_.reset();
  sample_rate_hz_ = 0.0;
  window_ns_ = last_ns_ = 0;
  window_ = still_ = {};
  still_s_ = 0.0;
}

}  // namespace gaitpad
