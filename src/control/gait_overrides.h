// Gait parameters that somebody has taken over from the stick, one by one: the window's sliders,
// a `gait` command of a script.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "control/gait_params.h"

namespace gaitpad {

struct GaitLimits;

enum class GaitKey : std::uint8_t {
  speed_m_s,  // of both feet: step times follow; > 0 walks without the stick, 0 stands
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
  double min, max;        // what may be given; a character's limits bound it further
};
const GaitKeyInfo& info_of(GaitKey key) noexcept;
std::optional<GaitKey> gait_key(std::string_view name) noexcept;
// What `params` say of it.
double value_of(GaitKey key, const GaitParams& params) noexcept;

// Plain, trivially copyable.
struct GaitOverrides {
  std::array<double, kGaitKeys> value{};
  std::array<bool, kGaitKeys> is_set{};
};
// The parameters with what is taken over; what is not stays as the stick and the style give it.
GaitParams overridden(const GaitParams& params, const GaitOverrides& overrides,
                      const GaitLimits& limits) noexcept;

}  // namespace gaitpad
