#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "gaitpad/keyboard.h"
#include "system/clock.h"
#include "system/descriptors.h"

namespace gaitpad {
namespace {

constexpr std::int64_t kPeriod_ns = 4'000'000;  // time between two steps of the stick
// Longest step of the stick, so that it does not jump after a delay of the thread.
constexpr std::int64_t kMaxStep_ns = 4 * kPeriod_ns;
// Speeds: from the centre to the rim in 0.15 s, back in 0.10 s.
constexpr double kOut_per_s = 1.0 / 0.15, kBack_per_s = 1.0 / 0.10;
constexpr std::uint16_t kReportBytes = 4;

// A descriptor of a game pad: X and Y of 16 bits, -32767..32767, no report id.
constexpr std::array<std::uint8_t, 23> kDescriptor = {
    0x05, 0x01, 0x09, 0x05, 0xa1, 0x01, 0x16, 0x01, 0x80, 0x26, 0xff, 0x7f,
    0x75, 0x10, 0x95, 0x02, 0x09, 0x30, 0x09, 0x31, 0x81, 0x02, 0xc0};

using Counts = std::array<std::int16_t, 2>;

Counts counts_of(const vec2& position) noexcept {
  const auto count = [](double x) {
    return static_cast<std::int16_t>(std::lround(x * KeyboardStick::kFull));
  };
  return {count(position.x), count(position.y)};
}

// Converts to counts. Rounds towards 0, so that a diagonal does not become longer than 1.
Counts counts_inside(const vec2& position) noexcept {
  const auto count = [](double x) { return static_cast<std::int16_t>(x * KeyboardStick::kFull); };
  return {count(position.x), count(position.y)};
}

vec2 in_disc(const vec2& wanted) noexcept {
  if (!std::isfinite(wanted.x) || !std::isfinite(wanted.y)) return vec2(0.0);
  const double length = std::hypot(wanted.x, wanted.y);
  return length > 1.0 ? vec2(wanted.x / length, wanted.y / length) : wanted;
}

// Moves in a straight line, so that the position stays in the disc.
vec2 moved(const vec2& from, const vec2& to, double time_s) noexcept {
  const vec2 way = to - from;
  const double distance = std::hypot(way.x, way.y);
  const bool is_back = from.x * way.x + from.y * way.y < 0.0;
  const double step = time_s * (is_back ? kBack_per_s : kOut_per_s);
  return distance <= step ? to : from + way * (step / distance);
}

DeviceInfo keyboard_info() {
  DeviceInfo info;
  info.bus = BusType::virtual_bus;
  info.driver = kKeyboardDriver;
  info.name = "Keyboard";
  info.descriptor.assign(kDescriptor.begin(), kDescriptor.end());
  return info;
}

class KeyboardDevice final : public Device {
 public:
  KeyboardDevice(std::shared_ptr<KeyboardStick> stick, Timer timer)
      : info_(keyboard_info()),
        stick_(std::move(stick)),
        timer_(std::move(timer)),
        poll_fds_{{{stick_->bell().fd(), POLLIN, 0}, {timer_.fd(), POLLIN, 0}}} {}

  const DeviceInfo& info() const noexcept override { return info_; }
  std::span<const pollfd> poll_fds() const noexcept override { return poll_fds_; }

  Status read(Report& report) noexcept override {
    stick_->bell().clear();
    timer_.take();
    const std::int64_t time_ns = now_ns();
    if (is_first_) {
      is_first_ = false;
      return fill(report, time_ns);
    }
    if (is_moving_ && time_ns < next_ns_) return Status::nothing;
    if (!is_moving_) last_ns_ = time_ns - kPeriod_ns;
    is_moving_ = !has_arrived();
    if (!is_moving_) return Status::nothing;
    position_ = moved(position_, stick_->wanted(),
                      static_cast<double>(std::min(time_ns - last_ns_, kMaxStep_ns)) * 1e-9);
    last_ns_ = time_ns;
    wake_after(time_ns);
    return counts_of(position_) == reported_ ? Status::nothing : fill(report, time_ns);
  }

 private:
  // True if the stick has reached its goal; it then goes to sleep. A change at that moment is seen
  // by the second look or makes fd() readable.
  bool has_arrived() noexcept {
    if (position_ != stick_->wanted()) return false;
    stick_->sleep();
    return position_ == stick_->wanted();
  }
  void wake_after(std::int64_t time_ns) noexcept {
    next_ns_ += kPeriod_ns;
    if (next_ns_ <= time_ns) next_ns_ = time_ns + kPeriod_ns;
    timer_.set(next_ns_);
  }
  Status fill(Report& report, std::int64_t time_ns) noexcept {
    reported_ = counts_of(position_);
    // HID's y grows backwards.
    const Counts hid = {reported_[0], static_cast<std::int16_t>(-reported_[1])};
    for (std::size_t i = 0; i < hid.size(); ++i) {
      const auto bits = static_cast<std::uint16_t>(hid[i]);
      report.bytes[2 * i] = static_cast<std::uint8_t>(bits & 0xff);
      report.bytes[2 * i + 1] = static_cast<std::uint8_t>(bits >> 8);
    }
    report.size = kReportBytes;
    report.time_ns = time_ns;
    return Status::report;
  }

  const DeviceInfo info_;
  const std::shared_ptr<KeyboardStick> stick_;
  Timer timer_;
  const std::array<pollfd, 2> poll_fds_;
  vec2 position_{0.0};
  Counts reported_{};
  // Makes the first report the stick's rest, as most pads do when they are opened.
  bool is_first_ = true;
  bool is_moving_ = false;
  std::int64_t last_ns_ = 0, next_ns_ = 0;  // times of the last and of the next step
};

}  // namespace

KeyboardStick::KeyboardStick() : bell_(std::make_unique<Bell>()) {}
KeyboardStick::~KeyboardStick() = default;

void KeyboardStick::steer(const vec2& wanted) noexcept {
  const Counts counts = counts_inside(in_disc(wanted));
  const auto low = static_cast<std::uint16_t>(counts[0]);
  const auto high = static_cast<std::uint16_t>(counts[1]);
  wanted_.store(std::uint32_t{high} << 16 | low);
  if (!is_awake_.exchange(true)) bell_->ring();
}

vec2 KeyboardStick::wanted() const noexcept {
  const std::uint32_t both = wanted_.load();
  const auto part = [](std::uint32_t bits) {
    return static_cast<double>(static_cast<std::int16_t>(bits & 0xffff)) / kFull;
  };
  return {part(both), part(both >> 16)};
}

void KeyboardStick::sleep() noexcept { is_awake_.store(false); }

Result<std::unique_ptr<Device>> open_keyboard(std::shared_ptr<KeyboardStick> stick) {
  if (!stick) return Error{"open_keyboard: stick is null"};
  Timer timer;
  if (timer.fd() < 0 || stick->bell().fd() < 0)
    return Error{"no file descriptors are left for the keyboard"};
  return std::unique_ptr<Device>(
      std::make_unique<KeyboardDevice>(std::move(stick), std::move(timer)));
}

}  // namespace gaitpad
