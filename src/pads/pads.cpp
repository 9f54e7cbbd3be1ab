#include "gaitpad/pads.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/ranges.h"
#include "gaitpad/trace.h"

namespace gaitpad {
namespace {

constexpr double kMostCount = 65536.0;  // number of counts of a gyroscope with 16 bits
constexpr double kNearCentre = 0.1;     // calibrated deflection below which a stick counts as
                                        // centred
// Change of the calibrated deflection that counts as a movement; noise is below the inner zone.
constexpr double kMoved = 0.1;
constexpr int kYielding_s = 5;  // a driving pad at rest for this time gives way to one that moves
constexpr int kSilencesInSecond = 10;  // silences of 100 ms
const PadState kAtRest;

// The D-pad as a stick: fully deflected, or 0.
vec2 hat_position(const PadState& state) noexcept {
  const auto is_down = [&state](PadButton b) { return pressed(state, b) ? 1.0 : 0.0; };
  const vec2 place(is_down(kButtonDpadRight) - is_down(kButtonDpadLeft),
                   is_down(kButtonDpadUp) - is_down(kButtonDpadDown));
  return place == vec2(0.0) ? place : glm::normalize(place);
}

bool has_moved(const Stick& from, const Stick& to) noexcept {
  return glm::length(to.left - from.left) > kMoved || glm::length(to.right - from.right) > kMoved;
}

}  // namespace

void count_presses(std::uint32_t before, std::uint32_t now, PressCounts& presses) noexcept {
  for (int b = 0; b < kButtonCount; ++b) presses[b] += (now & ~before) >> b & 1u;
}

std::optional<Error> check(const PadConfig& config) {
  if (auto problem = check(config.calibration)) return problem;
  if (!config.factory_gyro) return std::nullopt;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string index = "[" + std::to_string(axis) + "]";
    if (auto problem = range_problem("PadConfig: factory_gyro.zero" + index,
                                     config.factory_gyro->zero[axis], -kMostCount, kMostCount))
      return problem;
    if (auto problem = range_problem("PadConfig: factory_gyro.rad_s_per_count" + index,
                                     config.factory_gyro->rad_s_per_count[axis], -1.0, 1.0))
      return problem;
  }
  return std::nullopt;
}

Pads::Pads(std::vector<PadConfig> configs, int rate_hz, PadRules rules)
    : rules_(rules),
      rate_hz_(std::clamp(rate_hz, 1, kMaxRateHz)),
      silence_ticks_((rate_hz_ + kSilencesInSecond - 1) / kSilencesInSecond),
      settled_ticks_(static_cast<int>(std::ceil(JumpFilter::kSettled_s * rate_hz_))),
      yielding_ticks_(kYielding_s * rate_hz_) {
  pads_.resize(configs.size());
  for (std::size_t i = 0; i < configs.size(); ++i) {
    pads_[i].config = std::move(configs[i]);
    calibrate(pads_[i]);
    if (pads_[i].config.is_present) add_pad(static_cast<std::uint16_t>(i));
  }
}

void Pads::set_pad(std::uint16_t device, PadConfig& config) noexcept {
  if (device >= pads_.size()) return;
  std::swap(pads_[device].config, config);
  pads_[device].config.is_present = false;
  calibrate(pads_[device]);
}

bool Pads::take_report(const Report& report) noexcept {
  if (report.device >= pads_.size()) return false;
  Pad& pad = pads_[report.device];
  ++pad.reports;
  const std::uint32_t buttons_before = pad.state.buttons;
  if (!pad.config.layout || !decode(*pad.config.layout, report, pad.state)) return false;
  // A pad that reports more slowly is silent for longer between two reports.
  const bool is_steady = pad.silent_ticks < silence_ticks_;
  pad.settled_ticks = std::max(settled_ticks_, is_steady ? 2 * pad.silent_ticks : 0);
  pad.silent_ticks = 0;
  pad.filter.take(pad.state);
  calibrate(pad);
  const bool is_first = !pad.is_seen;
  const bool has_moved = take_movement(pad, buttons_before);
  pad.is_seen = true;
  if (pad.is_awaited) pad.is_awaited = !is_near_centre(pad);
  if (has_lost_its_driver() && can_take_over(pad)) give_seat(report.device);
  if (rules_ == PadRules::version_2) offer_seat(report.device, is_first, has_moved);
  if (report.device == driving_) count_presses(buttons_before, pad.state.buttons, presses_);
  return true;
}

void Pads::add_pad(std::uint16_t device) noexcept {
  if (device >= pads_.size()) return;
  Pad& pad = pads_[device];
  pad.config.is_present = true;
  pad.silent_ticks = 0;
  if (pad.turn == 0) pad.turn = ++turns_;
  if (!pad.config.is_usable) return;
  if (driving_ == kNoDevice || (is_fallback(driving_) && !is_fallback(device))) give_seat(device);
}

// The first report tells the pad's state, not that it was moved.
bool Pads::take_movement(Pad& pad, std::uint32_t buttons_before) noexcept {
  const bool is_elsewhere = has_moved(pad.moved_to, pad.stick);
  pad.has_left_moved = pad.has_left_moved || !is_near_centre(pad);
  if (is_elsewhere || !pad.is_seen) pad.moved_to = pad.stick;
  const bool is_moved = pad.is_seen && (is_elsewhere || pad.state.buttons != buttons_before);
  if (is_moved || !is_at_rest(pad)) pad.resting_ticks = 0;
  return is_moved;
}

void Pads::offer_seat(std::uint16_t device, bool is_first, bool has_moved) noexcept {
  const Pad& pad = pads_[device];
  if (!pad.config.is_usable || !pad.config.is_present || pad.config.is_fallback || pad.is_awaited)
    return;
  if (device != driving_) {
    if (driving_ == kNoDevice || has_lost_its_driver()) return;
    const Pad& driver = pads_[driving_];
    const bool yields = !is_driver_moved_ || driver.resting_ticks >= yielding_ticks_;
    const bool is_found_held =
        is_first && !is_driver_moved_ && is_at_rest(driver) && !is_at_rest(pad);
    if (!(has_moved && yields) && !is_found_held) return;
    give_seat(device);
  }
  is_driver_moved_ = is_driver_moved_ || has_moved;
}

void Pads::give_seat(std::uint16_t device) noexcept {
  if (device != driving_) watch_ = UntouchedWatch();
  driving_ = device;
  is_driver_moved_ = false;
}

void Pads::remove_pad(std::uint16_t device) noexcept {
  if (device >= pads_.size()) return;
  Pad& lost = pads_[device];
  lost.config.is_present = false;
  lost.is_awaited = true;
  lost.is_seen = false;
  lost.state = PadState{};
  lost.filter = JumpFilter();
  calibrate(lost);
  lost.resting_ticks = 0;
  lost.has_left_moved = false;
  if (device == driving_) {
    watch_ = UntouchedWatch();
    is_driver_moved_ = false;
  }
  if (has_lost_its_driver()) replace_driver();
}

// A pad at rest takes over at once, because it may not be touched for a while.
void Pads::replace_driver() noexcept {
  int first = 0;
  for (std::size_t i = 0; i < pads_.size(); ++i) {
    const Pad& pad = pads_[i];
    if (!can_take_over(pad) || (first != 0 && pad.turn > first)) continue;
    first = pad.turn;
    give_seat(static_cast<std::uint16_t>(i));
  }
}

bool Pads::is_silent(const Pad& pad) const noexcept {
  return pad.config.streams && pad.silent_ticks >= silence_ticks_;
}

void Pads::calibrate(Pad& pad) noexcept {
  const Calibration& calibration = pad.config.calibration;
  pad.stick = stick_position(calibration, pad.filter.filtered(calibration, pad.state));
}

void Pads::settle(Pad& pad) noexcept {
  pad.filter.settle();
  const Calibration& calibration = pad.config.calibration;
  if (calibration.left.filters_jumps || calibration.right.filters_jumps) calibrate(pad);
}

bool Pads::is_near_centre(const Pad& pad) const noexcept {
  return glm::length(pad.stick.left) <= kNearCentre;
}

bool Pads::is_at_rest(const Pad& pad) const noexcept {
  if (is_silent(pad)) return true;
  return pad.state.buttons == 0 && !has_moved({}, pad.stick);
}

bool Pads::can_take_over(const Pad& pad) const noexcept {
  if (!pad.config.is_usable || !pad.config.is_present || pad.is_awaited || is_silent(pad))
    return false;
  // While another pad is plugged in, the stick of a fallback is watched but does not drive.
  if (pad.config.is_fallback) return !is_other_plugged_in();
  return pad.is_seen && is_near_centre(pad);
}

bool Pads::has_lost_its_driver() const noexcept {
  return driving_ != kNoDevice && !pads_[driving_].config.is_present;
}

bool Pads::is_fallback(std::uint16_t device) const noexcept {
  return pads_[device].config.is_fallback;
}

bool Pads::is_other_plugged_in() const noexcept {
  return std::ranges::any_of(pads_, [](const Pad& pad) {
    return pad.config.is_usable && pad.config.is_present && !pad.config.is_fallback;
  });
}

bool Pads::is_driven_by_hat(const Pad& pad) const noexcept {
  return rules_ == PadRules::version_2 && !pad.has_left_moved &&
         hat_position(pad.state) != vec2(0.0);
}

Stick Pads::stick_of(const Pad& pad) const noexcept {
  if (!pad.config.is_present || pad.is_awaited || is_silent(pad)) return {};
  Stick stick = pad.stick;
  if (is_driven_by_hat(pad)) stick.left = hat_position(pad.state);
  return stick;
}

// If several fallbacks are deflected, the one that was plugged in first counts.
Stick Pads::fallback_stick() const noexcept {
  Stick stick;
  int first = 0;
  for (const Pad& pad : pads_) {
    if (!pad.config.is_fallback || !pad.config.is_usable || (first != 0 && pad.turn > first))
      continue;
    const Stick own = stick_of(pad);
    if (own.left == vec2(0.0)) continue;
    first = pad.turn;
    stick = own;
  }
  return stick;
}

void Pads::watch(const Pad& pad, const vec2& left) noexcept {
  const std::int64_t time_ns = ++ticks_ * 1'000'000'000 / rate_hz_;
  const vec2 raw(pad.state.axis[kLeftX], pad.state.axis[kLeftY]);
  untouched_ += watch_.take(time_ns, pad.config.calibration.left, raw, left);
}

Stick Pads::finish_tick() noexcept {
  Stick stick;
  if (driving_ != kNoDevice) {
    const Pad& pad = pads_[driving_];
    stick = stick_of(pad);
    if (!pad.config.is_fallback && !is_driven_by_hat(pad)) watch(pad, stick.left);
  }
  if (const Stick other = fallback_stick(); stick.left == vec2(0.0) && other.left != vec2(0.0))
    stick = other;
  for (Pad& pad : pads_) {
    pad.silent_ticks = std::min(pad.silent_ticks + 1, silence_ticks_);
    pad.resting_ticks = is_at_rest(pad) ? std::min(pad.resting_ticks + 1, yielding_ticks_) : 0;
    if (pad.silent_ticks >= std::min(pad.settled_ticks, silence_ticks_)) settle(pad);
  }
  return stick;
}

const PadState& Pads::driving_state() const noexcept {
  return driving_ == kNoDevice ? kAtRest : pads_[driving_].state;
}

const PadConfig* Pads::driving_pad() const noexcept {
  return driving_ == kNoDevice ? nullptr : &pads_[driving_].config;
}

std::uint64_t Pads::driving_reports() const noexcept {
  return driving_ == kNoDevice ? 0 : pads_[driving_].reports;
}

}  // namespace gaitpad
