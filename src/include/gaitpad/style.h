// The stylization state: what makes one motion many (Meredith & Maddock 2005, sections 3.1
// and 3.3.3).
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/gait_params.h"
#include "gaitpad/result.h"

namespace gaitpad {

struct StrideFactors {
  double length = 1.0;         // on the stride length
  double speed = 1.0;          // on the pace with which that leg's stride is undertaken
  double flight_height = 1.0;  // on the peak height of the flight
  bool operator==(const StrideFactors&) const = default;
};
// Plain, trivially copyable: what a tick reads and a command may change.
struct StyleValues {
  std::array<StrideFactors, 2> stride;  // left, right
  std::array<LegWeights, 2> weight{kEvenWeights, kEvenWeights};
  double hip_sway = 1.0;
  double hip_bounce = 1.0;
  double fatigue = 0.0;  // 0 fresh .. 1: linear on maximum speed and stride
  double fatigue_per_100_m = 0.0, fatigue_recovery_per_s = 0.0;  // control/fatigue.h
  double blend_s = 0.0;  // how long a change to this style or from it takes; control/style_blend.h
  BodyParams body;       // above the hips
  bool operator==(const StyleValues&) const = default;
};
struct Style : StyleValues {
  std::string name;
};
Result<Style> load_style(const std::string& path);
// The text that load_style() reads back to the same values; never empty.
std::string style_text(const Style& style);

// One value by the name that it has in a file: `left_leg.weight.knee`, `legs.stride_length` (both
// legs), `right_leg.weight.hip_x`, `hip_sway`, `hands.carry`, `head.yaw_deg`. A joint's weight is
// that of its DOFs.
struct StyleKey {
  std::string name;
  double min = 0.0, max = 1.0;
};
const std::vector<StyleKey>& style_keys();  // in the order in which people would read them
// No heap. False where there is no such name or the value is out of its bounds or would lock a
// whole leg or arm or the spine.
bool set_value(StyleValues& style, std::string_view name, double value) noexcept;
// Where several DOFs, legs or arms stand for it and differ: the first one's.
std::optional<double> value_of(const StyleValues& style, std::string_view name) noexcept;

// From one stylization state to the next over a time.

// All values part of the way from `from` (share 0) to `to` (share 1, exactly that).
StyleValues mixed(const StyleValues& from, const StyleValues& to, double share) noexcept;

// Plain, trivially copyable.
struct StyleBlend {
  StyleValues from;
  double length_s = 0.0, passed_s = 0.0;  // over: as long as it has passed
};
// From what is in force towards another style, which takes the longer of both styles' blend_s.
StyleBlend begun_blend(const StyleValues& in_force, const StyleValues& before,
                       const StyleValues& after) noexcept;
// What is in force after dt more seconds. Its own when it is over.
StyleValues advance(StyleBlend& blend, const StyleValues& to, double dt_s) noexcept;

// Who walks far tires, who stands recovers: a share of fatigue on top of the style's own.

// One tick more: linear in the way and in the time of rest, from 0 to 1. A style without a fatigue
// model leaves it as it is.
double tired(double before, const StyleValues& style, double way_m, bool is_resting,
             double dt_s) noexcept;
// The style with `tired` added to its fatigue, at most 1, where it has a fatigue model.
StyleValues with_fatigue(const StyleValues& style, double tired) noexcept;

}  // namespace gaitpad
