// The stylization state: the values that turn one motion into many walks (Meredith & Maddock 2005,
// sections 3.1 and 3.3.3). Styles are plain values; gaitpad/config_files.h reads and writes them as
// files.
//
//   gaitpad::StyleValues limp;
//   gaitpad::set_value(limp, "left_leg.stride_length", 0.6);
//   gaitpad::set_value(limp, "left_leg.weight.knee", 0.1);
//   const gaitpad::GaitParams params = gaitpad::gait_params(stick, limp, limits);
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/gait_params.h"
#include "gaitpad/result.h"

namespace gaitpad {

// Factors on one leg's stride.
struct StrideFactors {
  double length = 1.0;         // factor on the length, 0 .. 1.5
  double speed = 1.0;          // factor on the pace of that leg's stride, 0.5 .. 2
  double flight_height = 1.0;  // factor on the peak height of the flight, 0 .. 3
  bool operator==(const StrideFactors&) const = default;
};

// All values of a style. The default is the plain walk of the motion data. A style's file, a
// program or set_value() fills it. Plain, trivially copyable: a tick reads it and a command may
// change it.
struct StyleValues {
  std::array<StrideFactors, 2> stride;  // factors of both legs, indexed by Side
  // W of equation (5), section 3.3.3: the weight of each DOF of the legs; indexed by Side.
  std::array<LegWeights, 2> weight{kEvenWeights, kEvenWeights};
  double hip_sway = 1.0;    // factor on the pelvis' rotation about the vertical axis, 0 .. 3
  double hip_bounce = 1.0;  // factor on the pelvis' vertical travel, 0 .. 3
  double fatigue = 0.0;     // 0 fresh .. 1: lowers the maximum speed and stride linearly
  // The fatigue model; both 0: there is none. Fatigue gained by walking 100 m, 0 .. 10, and fatigue
  // lost in a second of rest, 0 .. 1.
  double fatigue_per_100_m = 0.0, fatigue_recovery_per_s = 0.0;
  double blend_s = 0.0;  // duration of a change to or from this style, 0 .. 10 s
  UpperBodyParams body;  // values of arms, hands, spine and head
  bool operator==(const StyleValues&) const = default;
};
struct Style : StyleValues {
  std::string name;  // the name in commands and zones
};
// Errors read `StyleValues: left_leg.stride_length is nan, outside [0, 1.5]`. The bounds are those
// of style_keys(); at least one weight of a leg, an arm or the spine must be above 0.
std::optional<Error> check(const StyleValues& style);

// A value's key in a file, in a command and for a slider: `hip_sway`, `left_leg.weight.knee`,
// `legs.stride_length` (both legs), `right_leg.weight.hip_x`, `hands.carry`, `head.yaw_deg`. The
// weight of a joint (`hip`) means those of all its DOFs (`hip_x`, `hip_z`, `hip_y`).
struct StyleKey {
  std::string name;
  std::string_view unit;  // "m", "s", "1/s", "deg"; "x" for a factor; "" for a share or a weight
  double min = 0.0, max = 1.0;
  // The words below are for a user interface.
  std::string_view limb{};    // `left_leg`; empty: the whole character
  std::string words{};        // label within the limb: "stride length", "hip weight"
  std::string_view effect{};  // a sentence about the effect; empty if the label says enough
  bool is_rare = false;       // few users need it
};
// All keys: the whole character's first, then legs, arms, hands, spine and head.
const std::vector<StyleKey>& style_keys();
// No heap. Returns false, and changes nothing, if there is no such key, if the value is out of its
// bounds or no number, or if it would set all weights of a leg, an arm or the spine to 0.
bool set_value(StyleValues& style, std::string_view key, double value) noexcept;
// The value of a key; none if there is no such key. A key for several values that differ gives the
// first one's. No heap.
std::optional<double> value_of(const StyleValues& style, std::string_view key) noexcept;

// All values at a share of the way from `from` (share 0) to `to` (share 1, exactly `to`).
StyleValues mixed(const StyleValues& from, const StyleValues& to, double share) noexcept;

// A change from one stylization state to the next over a time. Plain, trivially copyable.
struct StyleBlend {
  StyleValues from;  // values when the change began
  // Duration of the change and time since its begin; it is over when passed_s reaches length_s.
  double length_s = 0.0, passed_s = 0.0;
};
// Begins the change from the present values to the style `after`. It takes the longer blend_s of
// the style `before` it and of `after`.
StyleBlend begun_blend(const StyleValues& in_force, const StyleValues& before,
                       const StyleValues& after) noexcept;
// Advances the change by dt_s. Returns the present values, at the end exactly `to`.
StyleValues advance(StyleBlend& blend, const StyleValues& to, double dt_s) noexcept;

// The walker's tiredness one tick later: a share of fatigue, 0 .. 1, on top of the style's own. It
// grows with the distance and shrinks with the time of rest, both linearly, at the rates of the
// style's fatigue model. A style without a model leaves it unchanged.
double tired(double before, const StyleValues& style, double way_m, bool is_resting,
             double dt_s) noexcept;
// The style with `tired` added to its fatigue, at most 1, if it has a fatigue model.
StyleValues with_fatigue(const StyleValues& style, double tired) noexcept;

}  // namespace gaitpad
