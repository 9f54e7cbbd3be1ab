#include "session/pads.h"

#include <algorithm>
#include <utility>

namespace gaitpad {
namespace {

constexpr double kNearCentre = 0.1;    // of the calibrated deflection
constexpr int kSilencesInSecond = 10;  // 100 ms each

Stick calibrated(const Calibration& calibration, const PadState& state) noexcept {
  return stick_position(calibration, vec2(state.axis[kLeftX], state.axis[kLeftY]),
                        vec2(state.axis[kRightX], state.axis[kRightY]));
}

}  // namespace

Pads::Pads(std::vector<PadConfig> configs, int rate_hz)
    : silence_ticks_((rate_hz + kSilencesInSecond - 1) / kSilencesInSecond) {
  const auto usable = std::find_if(configs.begin(), configs.end(),
                                   [](const PadConfig& config) { return config.is_usable; });
  driving_ = static_cast<std::size_t>(usable - configs.begin());
  pads_.reserve(configs.size());
  for (PadConfig& config : configs) pads_.emplace_back().config = std::move(config);
}

bool Pads::take(const Report& report) noexcept {
  if (report.device >= pads_.size()) return false;
  Pad& pad = pads_[report.device];
  if (!decode(pad.config.layout, report, pad.state)) return false;
  pad.silent_ticks = 0;
  if (pad.is_awaited) {
    pad.is_awaited = glm::length(calibrated(pad.config.calibration, pad.state).left) > kNearCentre;
  }
  return true;
}

void Pads::add(std::uint16_t device) noexcept {
  if (device >= pads_.size()) return;
  pads_[device].config.is_present = true;
  pads_[device].silent_ticks = 0;
}

void Pads::remove(std::uint16_t device) noexcept {
  if (device >= pads_.size()) return;
  Pad& pad = pads_[device];
  pad.config.is_present = false;
  pad.is_awaited = true;
  pad.state = PadState{};
}

Stick Pads::stick_of_tick() noexcept {
  if (driving_ >= pads_.size()) return Stick{};
  Pad& pad = pads_[driving_];
  const bool is_silent = pad.config.streams && pad.silent_ticks >= silence_ticks_;
  pad.silent_ticks = std::min(pad.silent_ticks + 1, silence_ticks_);
  if (!pad.config.is_present || pad.is_awaited || is_silent) return Stick{};
  return calibrated(pad.config.calibration, pad.state);
}

}  // namespace gaitpad
