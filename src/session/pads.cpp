#include "session/pads.h"

#include <algorithm>
#include <utility>

namespace gaitpad {
namespace {

constexpr double kNearCentre = 0.1;    // of the calibrated deflection
constexpr int kSilencesInSecond = 10;  // 100 ms each
const PadState kAtRest;

Stick calibrated(const Calibration& calibration, const PadState& state) noexcept {
  return stick_position(calibration, vec2(state.axis[kLeftX], state.axis[kLeftY]),
                        vec2(state.axis[kRightX], state.axis[kRightY]));
}

}  // namespace

Pads::Pads(std::vector<PadConfig> configs, int rate_hz)
    : silence_ticks_((rate_hz + kSilencesInSecond - 1) / kSilencesInSecond) {
  pads_.resize(configs.size());
  for (std::size_t i = 0; i < configs.size(); ++i) {
    pads_[i].config = std::move(configs[i]);
    if (pads_[i].config.is_present) add(static_cast<std::uint16_t>(i));
  }
}

void Pads::set(std::uint16_t device, PadConfig& config) noexcept {
  if (device >= pads_.size()) return;
  std::swap(pads_[device].config, config);
  pads_[device].config.is_present = false;
}

bool Pads::take(const Report& report) noexcept {
  if (report.device >= pads_.size()) return false;
  Pad& pad = pads_[report.device];
  if (!decode(pad.config.layout, report, pad.state)) return false;
  pad.silent_ticks = 0;
  pad.is_seen = true;
  if (pad.is_awaited) pad.is_awaited = !is_near_centre(pad);
  if (has_lost_its_driver() && can_take_over(pad)) driving_ = report.device;
  return true;
}

void Pads::add(std::uint16_t device) noexcept {
  if (device >= pads_.size()) return;
  Pad& pad = pads_[device];
  pad.config.is_present = true;
  pad.silent_ticks = 0;
  if (pad.turn == 0) pad.turn = ++turns_;
  if (driving_ == kNoDevice && pad.config.is_usable) driving_ = device;
}

void Pads::remove(std::uint16_t device) noexcept {
  if (device >= pads_.size()) return;
  Pad& lost = pads_[device];
  lost.config.is_present = false;
  lost.is_awaited = true;
  lost.is_seen = false;
  lost.state = PadState{};
  if (device != driving_) return;
  // One that rests takes over at once: nobody may touch it for a while.
  int first = 0;
  for (std::size_t i = 0; i < pads_.size(); ++i) {
    const Pad& pad = pads_[i];
    if (!can_take_over(pad) || (first != 0 && pad.turn > first)) continue;
    first = pad.turn;
    driving_ = static_cast<std::uint16_t>(i);
  }
}

bool Pads::is_silent(const Pad& pad) const noexcept {
  return pad.config.streams && pad.silent_ticks >= silence_ticks_;
}

bool Pads::is_near_centre(const Pad& pad) const noexcept {
  return glm::length(calibrated(pad.config.calibration, pad.state).left) <= kNearCentre;
}

bool Pads::can_take_over(const Pad& pad) const noexcept {
  return pad.config.is_usable && pad.config.is_present && pad.is_seen && !pad.is_awaited &&
         !is_silent(pad) && is_near_centre(pad);
}

bool Pads::has_lost_its_driver() const noexcept {
  return driving_ != kNoDevice && !pads_[driving_].config.is_present;
}

Stick Pads::stick_of_tick() noexcept {
  Stick stick;
  if (driving_ != kNoDevice) {
    const Pad& pad = pads_[driving_];
    const bool counts = pad.config.is_present && !pad.is_awaited && !is_silent(pad);
    if (counts) stick = calibrated(pad.config.calibration, pad.state);
  }
  for (Pad& pad : pads_) pad.silent_ticks = std::min(pad.silent_ticks + 1, silence_ticks_);
  return stick;
}

const PadState& Pads::driving_state() const noexcept {
  return driving_ == kNoDevice ? kAtRest : pads_[driving_].state;
}

}  // namespace gaitpad
