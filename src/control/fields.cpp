#include "control/fields.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/text.h"
#include "gaitpad/control.h"
#include "gaitpad/math.h"

namespace gaitpad {
namespace {

// Largest factor on hip sway, hip bounce and the flight's height.
constexpr double kMostFactor = 3.0;
// A giant's values; its limits bound them.
constexpr double kMostStride_m = 20.0, kMostSpeed_m_s = 20.0;

// Accessors to the numbers of a style.
template <double StyleValues::*number>
std::span<double> of_whole(StyleValues& style, int) {
  return {&(style.*number), 1};
}
template <double StrideFactors::*number>
std::span<double> of_stride(StyleValues& style, int side) {
  return {&(style.stride[side].*number), 1};
}
std::span<double> of_idle(StyleValues& style, int) { return {&style.body.idle, 1}; }
std::span<double> of_arm_swing(StyleValues& style, int side) {
  return {&style.body.arm_swing[side], 1};
}
std::span<double> of_arm_out(StyleValues& style, int side) {
  return {&style.body.arm_out_deg[side], 1};
}
template <double TrunkParams::*number>
std::span<double> of_trunk(StyleValues& style, int) {
  return {&(style.body.trunk.*number), 1};
}
template <double HandParams::*number>
std::span<double> of_hand(StyleValues& style, int side) {
  return {&(style.body.hand[side].*number), 1};
}
template <double HeadParams::*number>
std::span<double> of_head(StyleValues& style, int) {
  return {&(style.body.head.*number), 1};
}
std::span<double> leg_weights(StyleValues& style, int side) { return style.weight[side]; }
std::span<double> arm_weights(StyleValues& style, int side) { return style.body.arm_weight[side]; }
std::span<double> spine_weights(StyleValues& style, int) { return style.body.spine_weight; }

// The weights of the DOFs from `first` to `last`.
template <auto weights, int first, int last = first>
std::span<double> dofs(StyleValues& style, int side) {
  return weights(style, side).subspan(first, last - first + 1);
}
template <int first, int last = first>
constexpr StyleField leg_weight(std::string_view name) {
  return {name, "", 0.0, 1.0, &dofs<&leg_weights, first, last>};
}
template <int first, int last = first>
constexpr StyleField arm_weight(std::string_view name) {
  return {name, "", 0.0, 1.0, &dofs<&arm_weights, first, last>};
}

constexpr StyleField kWholeFields[] = {
    {"fatigue", "", 0.0, 1.0, &of_whole<&StyleValues::fatigue>, "fatigue",
     "0 fresh, 1 exhausted: shortens and slows each step."},
    {"hip_sway", "x", 0.0, kMostFactor, &of_whole<&StyleValues::hip_sway>, "hip sway",
     "How far the hips move sideways; 1 as in the motion."},
    {"hip_bounce", "x", 0.0, kMostFactor, &of_whole<&StyleValues::hip_bounce>, "hip bounce",
     "How far the hips move up and down; 1 as in the motion."},
};
// The window shows these only when it is asked for them.
constexpr StyleField kRareFields[] = {
    {"idle", "", 0.0, 1.0, &of_idle, "life in a stand",
     "How much breath, sway and glances a stand shows; 0 none, 1 all."},
    {"blend_s", "s", 0.0, 10.0, &of_whole<&StyleValues::blend_s>, "blending, s",
     "How long a change of style takes, in seconds."},
    {"fatigue_model.per_100_m", "", 0.0, 10.0, &of_whole<&StyleValues::fatigue_per_100_m>,
     "tiring per 100 m", "How much fatigue 100 metres add."},
    {"fatigue_model.recovery_per_s", "1/s", 0.0, 1.0,
     &of_whole<&StyleValues::fatigue_recovery_per_s>, "recovery per s",
     "How much fatigue a second of rest takes."},
};
constexpr StyleField kLegFields[] = {
    {"stride_length", "x", 0.0, 1.5, &of_stride<&StrideFactors::length>, "stride length",
     "Factor on the length of this foot's step."},
    {"stride_speed", "x", 0.5, 2.0, &of_stride<&StrideFactors::speed>, "stride speed",
     "Factor on the speed of this foot's step."},
    {"flight_height", "x", 0.0, kMostFactor, &of_stride<&StrideFactors::flight_height>,
     "flight height", "Factor on the height of this foot's step."},
    leg_weight<kHipX, kHipY>("weight.hip"),
    leg_weight<kKneeX>("weight.knee"),
    leg_weight<kAnkleX, kAnkleY>("weight.ankle"),
    leg_weight<kHipX>("weight.hip_x"),
    leg_weight<kHipZ>("weight.hip_z"),
    leg_weight<kHipY>("weight.hip_y"),
    leg_weight<kKneeX>("weight.knee_x"),
    leg_weight<kAnkleX>("weight.ankle_x"),
    leg_weight<kAnkleZ>("weight.ankle_z"),
    leg_weight<kAnkleY>("weight.ankle_y"),
};
constexpr StyleField kArmFields[] = {
    {"swing", "x", 0.0, 3.0, &of_arm_swing},
    {"out_deg", "deg", 0.0, 45.0, &of_arm_out},
    arm_weight<kShoulderX, kShoulderY>("weight.shoulder"),
    arm_weight<kElbowX>("weight.elbow"),
    arm_weight<kWristX, kWristZ>("weight.wrist"),
    arm_weight<kShoulderX>("weight.shoulder_x"),
    arm_weight<kShoulderZ>("weight.shoulder_z"),
    arm_weight<kShoulderY>("weight.shoulder_y"),
    arm_weight<kElbowX>("weight.elbow_x"),
    arm_weight<kWristX>("weight.wrist_x"),
    arm_weight<kWristZ>("weight.wrist_z"),
};
constexpr StyleField kHandFields[] = {
    {"carry", "", 0.0, 1.0, &of_hand<&HandParams::carry>},
    {"x_m", "m", -1.0, 1.0, &of_hand<&HandParams::x_m>},
    {"y_m", "m", -1.0, 1.0, &of_hand<&HandParams::y_m>},
    {"z_m", "m", -1.0, 1.0, &of_hand<&HandParams::z_m>},
    {"rail", "", 0.0, 1.0, &of_hand<&HandParams::rail>},
    {"rail_height_m", "m", 0.3, 2.0, &of_hand<&HandParams::rail_height_m>},
    {"rail_side_m", "m", 0.1, 1.0, &of_hand<&HandParams::rail_side_m>},
};
constexpr StyleField kTrunkFields[] = {
    {"lean_deg", "deg", -20.0, 40.0, &of_trunk<&TrunkParams::lean_deg>},
    {"over_left_deg", "deg", 0.0, 30.0, &of_trunk<&TrunkParams::over_left_deg>},
    {"over_right_deg", "deg", 0.0, 30.0, &of_trunk<&TrunkParams::over_right_deg>},
};
constexpr StyleField kSpineFields[] = {
    {"weight.lower", "", 0.0, 1.0, &dofs<&spine_weights, kLowerSpine>},
    {"weight.upper", "", 0.0, 1.0, &dofs<&spine_weights, kUpperSpine>},
};
constexpr StyleField kHeadFields[] = {
    {"look", "", 0.0, 1.0, &of_head<&HeadParams::look>},
    {"yaw_deg", "deg", -90.0, 90.0, &of_head<&HeadParams::yaw_deg>},
    {"pitch_deg", "deg", -60.0, 60.0, &of_head<&HeadParams::pitch_deg>},
    {"look_at", "", 0.0, 1.0, &of_head<&HeadParams::look_at>},
    {"x_m", "m", -100.0, 100.0, &of_head<&HeadParams::x_m>},
    {"y_m", "m", -100.0, 100.0, &of_head<&HeadParams::y_m>},
    {"z_m", "m", -100.0, 100.0, &of_head<&HeadParams::z_m>},
    {"lead", "", 0.0, 1.0, &of_head<&HeadParams::lead>},
};

constexpr StyleSection kSections[] = {
    {"", kLeftSide, kLeftSide, kWholeFields, nullptr, ""},
    {"", kLeftSide, kLeftSide, kRareFields, nullptr, "", true},
    {"legs", kLeftSide, kRightSide, kLegFields, &leg_weights, "leg"},
    {"left_leg", kLeftSide, kLeftSide, kLegFields, &leg_weights, "leg"},
    {"right_leg", kRightSide, kRightSide, kLegFields, &leg_weights, "leg"},
    {"arms", kLeftSide, kRightSide, kArmFields, &arm_weights, "arm", true},
    {"left_arm", kLeftSide, kLeftSide, kArmFields, &arm_weights, "arm", true},
    {"right_arm", kRightSide, kRightSide, kArmFields, &arm_weights, "arm", true},
    {"hands", kLeftSide, kRightSide, kHandFields, nullptr, "", true},
    {"left_hand", kLeftSide, kLeftSide, kHandFields, nullptr, "", true},
    {"right_hand", kRightSide, kRightSide, kHandFields, nullptr, "", true},
    {"trunk", kLeftSide, kLeftSide, kTrunkFields, nullptr, ""},
    {"spine", kLeftSide, kLeftSide, kSpineFields, &spine_weights, "spine", true},
    {"head", kLeftSide, kLeftSide, kHeadFields, nullptr, "", true},
};

double speed_of(const GaitParams& params) noexcept {
  const auto& [left, right] = params.stride;
  const double cycle_s = left.time_s + right.time_s;
  if (!params.walking || !(cycle_s > 0.0)) return 0.0;
  const double speed_m_s = (left.length_m + right.length_m) / cycle_s;
  return params.backward ? 0.0 - speed_m_s : speed_m_s;
}

// A value that a `gait` command may override. Rows are in the order of GaitKey.
struct GaitField {
  GaitKeyInfo info;
  double (*value)(const GaitParams& params) noexcept;
};
constexpr std::array<GaitField, kGaitKeys> kGaitFields = {{
    {{"speed_m_s", "m/s", -kMostSpeed_m_s, kMostSpeed_m_s}, &speed_of},
    {{"stride_left_m", "m", 0.0, kMostStride_m},
     [](const GaitParams& p) noexcept { return p.stride[kLeftSide].length_m; }},
    {{"stride_right_m", "m", 0.0, kMostStride_m},
     [](const GaitParams& p) noexcept { return p.stride[kRightSide].length_m; }},
    {{"flight_left", "x", 0.0, kMostFactor},
     [](const GaitParams& p) noexcept { return p.stride[kLeftSide].flight_height; }},
    {{"flight_right", "x", 0.0, kMostFactor},
     [](const GaitParams& p) noexcept { return p.stride[kRightSide].flight_height; }},
    {{"turn_rate_rad_s", "rad/s", -kQuickerInPlace* kMaxTurnRate_rad_s,
      kQuickerInPlace* kMaxTurnRate_rad_s},
     [](const GaitParams& p) noexcept { return p.turn_rate_rad_s; }},
    {{"hip_sway", "x", 0.0, kMostFactor}, [](const GaitParams& p) noexcept { return p.hip_sway; }},
    {{"hip_bounce", "x", 0.0, kMostFactor},
     [](const GaitParams& p) noexcept { return p.hip_bounce; }},
}};

struct FoundField {
  const StyleSection* section;
  const StyleField* field;
};

// `hip_sway`, or SECTION.NAME.
std::optional<FoundField> field_of(std::string_view key) noexcept {
  const auto in_section = [](const StyleSection& section, std::string_view name) {
    for (const StyleField& field : section.fields) {
      if (field.name == name) return std::optional(FoundField{&section, &field});
    }
    return std::optional<FoundField>();
  };
  for (const StyleSection& section : kSections) {
    if (!section.name.empty()) break;
    if (const auto whole = in_section(section, key)) return whole;
  }
  const std::string_view table = take_part(key, '.');
  if (table.empty()) return std::nullopt;
  for (const StyleSection& section : kSections) {
    if (section.name == table) return in_section(section, key);
  }
  return std::nullopt;
}

// The words of a field in the table, or its name: `weight.hip_x` is "hip x weight", `lean_deg` is
// "lean, deg".
std::string words_of(const StyleField& field) {
  if (!field.words.empty()) return std::string(field.words);
  constexpr std::string_view kWeight = "weight.";
  std::string words(field.is_weight() ? field.name.substr(kWeight.size()) : field.name);
  if (field.is_weight()) words += " weight";
  const std::string unit = "_" + std::string(field.unit);
  const bool has_unit = !field.unit.empty() && words.ends_with(unit);
  if (has_unit) words.erase(words.size() - unit.size());
  std::replace(words.begin(), words.end(), '_', ' ');
  return has_unit ? words + ", " + std::string(field.unit) : words;
}

std::vector<StyleKey> all_style_keys() {
  std::vector<StyleKey> keys;
  for (const StyleSection& section : kSections) {
    const std::string table = section.name.empty() ? "" : std::string(section.name) + ".";
    for (const StyleField& f : section.fields)
      keys.push_back({table + std::string(f.name), f.unit, f.min, f.max, section.name, words_of(f),
                      f.effect, section.is_rare});
  }
  return keys;
}

}  // namespace

std::span<const StyleSection> style_sections() noexcept { return kSections; }

void set_field(const StyleSection& section, const StyleField& field, double value,
               StyleValues& style) noexcept {
  for (int side = section.first_side; side <= section.last_side; ++side)
    for (double& number : field.values(style, side)) number = value;
}

bool is_locked(const StyleSection& section, StyleValues& style) noexcept {
  if (section.weights == nullptr) return false;
  for (int side = section.first_side; side <= section.last_side; ++side) {
    const std::span<const double> weights = section.weights(style, side);
    if (std::all_of(weights.begin(), weights.end(), [](double w) { return w == 0.0; })) return true;
  }
  return false;
}

const std::vector<StyleKey>& style_keys() {
  static const std::vector<StyleKey> keys = all_style_keys();
  return keys;
}

bool set_value(StyleValues& style, std::string_view key, double value) noexcept {
  const auto found = field_of(key);
  if (!found || !(value >= found->field->min && value <= found->field->max)) return false;
  StyleValues changed = style;
  // Adding 0 turns -0 into 0, as in a file.
  set_field(*found->section, *found->field, value + 0.0, changed);
  if (is_locked(*found->section, changed)) return false;
  style = changed;
  return true;
}

std::optional<double> value_of(const StyleValues& style, std::string_view key) noexcept {
  const auto found = field_of(key);
  if (!found) return std::nullopt;
  StyleValues copy = style;
  return found->field->values(copy, found->section->first_side).front();
}

StyleValues mixed(const StyleValues& from, const StyleValues& to, double share) noexcept {
  if (!(share < 1.0)) return to;
  StyleValues values = from, goal = to;
  const auto mix_each = [share](std::span<double> own, std::span<const double> goals) {
    for (std::size_t i = 0; i < own.size(); ++i) own[i] = mix(own[i], goals[i], share);
  };
  for (const StyleSection& section : kSections) {
    if (section.is_of_both()) continue;  // the left and right sections contain all values
    const int side = section.first_side;
    for (const StyleField& field : section.fields) {
      if (!field.is_weight()) mix_each(field.values(values, side), field.values(goal, side));
    }
    if (section.weights) mix_each(section.weights(values, side), section.weights(goal, side));
  }
  return values;
}

const GaitKeyInfo& info_of(GaitKey key) noexcept {
  return kGaitFields[static_cast<std::size_t>(key)].info;
}

std::optional<GaitKey> gait_key(std::string_view name) noexcept {
  for (int k = 0; k < kGaitKeys; ++k) {
    if (kGaitFields[k].info.name == name) return static_cast<GaitKey>(k);
  }
  return std::nullopt;
}

double value_of(GaitKey key, const GaitParams& params) noexcept {
  return kGaitFields[static_cast<std::size_t>(key)].value(params);
}

}  // namespace gaitpad
