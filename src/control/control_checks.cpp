// Checks styles, parameters and limits that a caller has filled in.
#include "base/ranges.h"
#include "control/fields.h"
#include "control/params_range.h"
#include "gaitpad/control.h"

namespace gaitpad {
namespace {

// Bounds of a step: a giant's length; a shorter time would blur the legs.
constexpr double kMostStep_m = 20.0, kLeastStep_s = 0.05, kMostStep_s = 20.0;
constexpr double kMostTurn_rad_s = 4.0;
constexpr double kFarthestLook_m = 1e6;  // a place in a large world, farther than a style's

// A style from the numbers that parameters have in common with it.
StyleValues style_of(const GaitParams& params) {
  StyleValues style;
  for (const int side : {0, 1})
    style.stride[side].flight_height = params.stride[side].flight_height;
  style.weight = params.weight;
  style.hip_sway = params.hip_sway;
  style.hip_bounce = params.hip_bounce;
  style.body = params.body;
  return style;
}

GaitParams params_of(const StyleValues& style, double step_m, double step_s, double turn_rad_s,
                     double look_m) noexcept {
  GaitParams params;
  for (const int side : {0, 1})
    params.stride[side] = {step_m, step_s, style.stride[side].flight_height};
  params.turn_rate_rad_s = turn_rad_s;
  params.weight = style.weight;
  params.hip_sway = style.hip_sway;
  params.hip_bounce = style.hip_bounce;
  params.body = style.body;
  params.body.head.x_m = params.body.head.y_m = params.body.head.z_m = look_m;
  return params;
}

ParamsRange made_range() noexcept {
  StyleValues least, most;
  for (const StyleSection& section : style_sections()) {
    for (const StyleField& field : section.fields) {
      set_field(section, field, field.min, least);
      set_field(section, field, field.max, most);
    }
  }
  return {params_of(least, 0.0, kLeastStep_s, -kMostTurn_rad_s, -kFarthestLook_m),
          params_of(most, kMostStep_m, kMostStep_s, kMostTurn_rad_s, kFarthestLook_m)};
}

std::optional<Error> problem_of(const std::string& owner, StyleValues style) {
  for (const StyleSection& section : style_sections()) {
    if (section.is_of_both()) continue;
    const std::string table =
        owner + ": " + (section.name.empty() ? "" : std::string(section.name) + ".");
    for (const StyleField& field : section.fields) {
      for (const double value : field.values(style, section.first_side)) {
        if (value >= field.min && value <= field.max) continue;  // before the name is built
        return range_problem(table + std::string(field.name), value, field.min, field.max);
      }
    }
    if (is_locked(section, style))
      return Error{table + "weight: all are 0, one at least must be above 0"};
  }
  return std::nullopt;
}

}  // namespace

const ParamsRange& params_range() noexcept {
  static const ParamsRange range = made_range();
  return range;
}

std::optional<Error> check(const StyleValues& style) { return problem_of("StyleValues", style); }

std::optional<Error> check(const GaitParams& params) {
  const auto [least, most] = params_range();
  for (const int side : {0, 1}) {
    const std::string stride = "GaitParams: stride[" + std::to_string(side) + "].";
    const StrideParams &is = params.stride[side], &low = least.stride[side],
                       &high = most.stride[side];
    if (auto problem = range_problem(stride + "length_m", is.length_m, low.length_m, high.length_m))
      return problem;
    if (auto problem = range_problem(stride + "time_s", is.time_s, low.time_s, high.time_s))
      return problem;
  }
  if (auto problem = range_problem("GaitParams: turn_rate_rad_s", params.turn_rate_rad_s,
                                   least.turn_rate_rad_s, most.turn_rate_rad_s))
    return problem;
  StyleValues style = style_of(params);
  HeadParams& head = style.body.head;
  for (double* place : {&head.x_m, &head.y_m, &head.z_m}) {
    if (auto problem = range_problem("GaitParams: body.head's place", *place, -kFarthestLook_m,
                                     kFarthestLook_m))
      return problem;
    *place = 0.0;
  }
  return problem_of("GaitParams", style);
}

std::optional<Error> check(const GaitLimits& limits) {
  constexpr double kMost = 50.0;
  const struct {
    const char* name;
    double value, least;
  } fields[] = {
      {"max_speed_m_s", limits.max_speed_m_s, 1e-3},
      {"max_step_m", limits.max_step_m, 1e-3},
      {"step_share[0]", limits.step_share[0], 0.0},
      {"step_share[1]", limits.step_share[1], 0.0},
      {"max_step_time_s", limits.max_step_time_s, kLeastStep_s},
      {"max_turning_step_time_s", limits.max_turning_step_time_s, kLeastStep_s},
      {"turn_step_time_s", limits.turn_step_time_s, kLeastStep_s},
      {"max_turn_rate_rad_s", limits.max_turn_rate_rad_s, 0.0},
  };
  for (const auto& field : fields) {
    if (auto problem = range_problem(std::string("GaitLimits: ") + field.name, field.value,
                                     field.least, kMost))
      return problem;
  }
  return std::nullopt;
}

}  // namespace gaitpad
