// Gait parameters that somebody has taken over from the stick, one by one: the window's sliders,
// a `gait` command of a script.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "control/control.h"

namespace gaitpad {

enum class GaitKey : std::uint8_t {
  speed_m_s,  // (left + right step) / cycle time, backwards negative
  stride_left_m,
  stride_right_m,
  flight_left,  // factor on the flight's height
  flight_right,
  turn_rate_rad_s,
  hip_sway,
  hip_bounce,
};
inline constexpr int kGaitKeys = 8;

struct GaitKeyInfo {
  std::string_view name;  // as in a command, unit included
  double min, max;        // what may be given; a character's limits bound it further: range_of()
};
const GaitKeyInfo& info_of(GaitKey key) noexcept;
std::optional<GaitKey> gait_key(std::string_view name) noexcept;
// What `params` say of it.
double value_of(GaitKey key, const GaitParams& params) noexcept;

struct GaitRange {
  double min, max;
};
// What has an effect on a character with these limits: as far as its stick, or else a style, goes.
GaitRange range_of(GaitKey key, const GaitLimits& limits) noexcept;

// Plain, trivially copyable.
struct GaitOverrides {
  std::array<double, kGaitKeys> value{};
  std::array<bool, kGaitKeys> is_set{};
};
// The stick's parameters with what is taken over. Total: a value that is no number counts as not
// taken over, others are bounded by range_of().
// - Speed takes the place of the forward deflection: strides as at that speed by stick, style and
//   fatigue, both step times stretched alike until the speed is met or a foot would step quicker or
//   slower than any stick and style let it (in the sharpest turn: than a stick). 0 stands, whatever
//   else is given.
// - The turn rate takes the place of the sideways deflection. Without speed and with a neutral
//   stick it turns in place.
// - A stride holds wherever one is asked for, by stick or speed: standing and turning in place ask
//   for none. Without speed the step keeps the stick's time.
// - What is not taken over stays as the stick and the style give it; of nothing all of it, bit by
//   bit.
GaitParams gait_params(const Stick& stick, const StyleValues& style, const GaitOverrides& overrides,
                       const GaitLimits& limits) noexcept;

}  // namespace gaitpad
