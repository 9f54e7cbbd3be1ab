#include "gaitpad/style.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <span>
#include <string_view>

#include "control/body_keys.h"
#include "files/toml_file.h"
#include "gaitpad/math.h"

namespace gaitpad {

namespace {

struct StyleNumber {
  std::string_view name;
  double StyleValues::*value;
  double min, max;
};
constexpr StyleNumber kStyleNumbers[] = {
    {"fatigue", &StyleValues::fatigue, 0.0, 1.0},
    {"hip_sway", &StyleValues::hip_sway, 0.0, 3.0},
    {"hip_bounce", &StyleValues::hip_bounce, 0.0, 3.0},
    {"blend_s", &StyleValues::blend_s, 0.0, 10.0},
    {"fatigue_model.per_100_m", &StyleValues::fatigue_per_100_m, 0.0, 10.0},
    {"fatigue_model.recovery_per_s", &StyleValues::fatigue_recovery_per_s, 0.0, 1.0},
};

struct LegNumber {
  std::string_view name;
  double StrideFactors::*value;
  double min, max;
};
constexpr LegNumber kLegNumbers[] = {
    {"stride_length", &StrideFactors::length, 0.0, 1.5},
    {"stride_speed", &StrideFactors::speed, 0.5, 2.0},
    {"flight_height", &StrideFactors::flight_height, 0.0, 3.0},
};

struct WeightName {
  std::string_view name;
  int first, last;  // LegDof, inclusive
};
// A joint first, its single DOFs after it: these override.
constexpr WeightName kJointWeights[] = {
    {"hip", kHipX, kHipY}, {"knee", kKneeX, kKneeX}, {"ankle", kAnkleX, kAnkleY}};
constexpr WeightName kDofWeights[] = {
    {"hip_x", kHipX, kHipX},       {"hip_z", kHipZ, kHipZ},       {"hip_y", kHipY, kHipY},
    {"knee_x", kKneeX, kKneeX},    {"ankle_x", kAnkleX, kAnkleX}, {"ankle_z", kAnkleZ, kAnkleZ},
    {"ankle_y", kAnkleY, kAnkleY},
};
constexpr std::string_view kWeightTable = "weight";

struct Legs {
  std::string_view name;
  Side first, last;
};
// Both first: a single leg overrides them.
constexpr Legs kLegs[] = {{"legs", kLeftSide, kRightSide},
                          {"left_leg", kLeftSide, kLeftSide},
                          {"right_leg", kRightSide, kRightSide}};

// Where a point stands in the name, what is before it is a table.
std::optional<double> number_in(TomlTable root, const StyleNumber& n) {
  const std::size_t point = n.name.find('.');
  if (point == std::string_view::npos) return root.number(n.name, n.min, n.max);
  auto table = root.table(n.name.substr(0, point));
  return table ? table->number(n.name.substr(point + 1), n.min, n.max) : std::nullopt;
}

bool is_locked(const LegWeights& weights) noexcept {
  return std::all_of(weights.begin(), weights.end(), [](double w) { return w == 0.0; });
}

void set_weight(const WeightName& name, double weight, LegWeights& weights) noexcept {
  std::fill(weights.begin() + name.first, weights.begin() + name.last + 1, weight);
}

void read_weights(TomlTable& leg, LegWeights& weights) {
  auto table = leg.table(kWeightTable);
  if (!table) return;
  const auto read = [&](const WeightName& entry) {
    if (const auto weight = table->number(entry.name, 0.0, 1.0))
      set_weight(entry, *weight, weights);
  };
  for (const WeightName& joint : kJointWeights) read(joint);
  for (const WeightName& dof : kDofWeights) read(dof);
  if (is_locked(weights))
    leg.reject(kWeightTable, "all weights of the leg are 0: it could not move");
}

void read_leg(TomlTable leg, StrideFactors& stride, LegWeights& weights) {
  for (const LegNumber& n : kLegNumbers)
    stride.*n.value = leg.number(n.name, n.min, n.max).value_or(stride.*n.value);
  read_weights(leg, weights);
}

std::string weights_text(const LegWeights& weights) {
  std::string text;
  const auto add = [&](std::string_view name, double weight) {
    if (weight != 1.0) text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", name, weight);
  };
  for (const WeightName& joint : kJointWeights) {
    const double first = weights[joint.first];
    if (std::all_of(weights.begin() + joint.first, weights.begin() + joint.last + 1,
                    [first](double w) { return w == first; })) {
      add(joint.name, first);
      continue;
    }
    for (const WeightName& dof : kDofWeights) {
      if (dof.first >= joint.first && dof.last <= joint.last) add(dof.name, weights[dof.first]);
    }
  }
  return text.empty() ? "" : fmt::format("{} = {{ {} }}\n", kWeightTable, text);
}

std::string leg_text(std::string_view name, const StrideFactors& stride,
                     const LegWeights& weights) {
  std::string text;
  for (const LegNumber& n : kLegNumbers) {
    if (stride.*n.value != 1.0) text += fmt::format("{} = {}\n", n.name, stride.*n.value);
  }
  text += weights_text(weights);
  return text.empty() ? "" : fmt::format("\n[{}]\n{}", name, text);
}

// What a key of style_keys() means: one of the three pointers is set.
struct KeyTarget {
  const StyleNumber* number = nullptr;
  const LegNumber* leg_number = nullptr;
  const WeightName* weight = nullptr;
  Side first = kLeftSide, last = kRightSide;
  double min = 0.0, max = 1.0;
};

template <class T, std::size_t n>
const T* found(const T (&table)[n], std::string_view name) noexcept {
  const auto* entry = std::find_if(table, table + n, [name](const T& t) { return t.name == name; });
  return entry == table + n ? nullptr : entry;
}

// Cuts what stands before the first point off `name`.
std::string_view next_part(std::string_view& name) noexcept {
  const std::string_view part = name.substr(0, name.find('.'));
  name.remove_prefix(std::min(part.size() + 1, name.size()));
  return part;
}

std::optional<KeyTarget> target_of(std::string_view name) noexcept {
  KeyTarget target;
  if (const StyleNumber* n = target.number = found(kStyleNumbers, name)) {
    target.min = n->min, target.max = n->max;
    return target;
  }
  const Legs* legs = found(kLegs, next_part(name));
  if (legs == nullptr) return std::nullopt;
  target.first = legs->first, target.last = legs->last;
  if (const LegNumber* n = target.leg_number = found(kLegNumbers, name)) {
    target.min = n->min, target.max = n->max;
    return target;
  }
  if (next_part(name) != kWeightTable) return std::nullopt;
  target.weight = found(kJointWeights, name);
  if (target.weight == nullptr) target.weight = found(kDofWeights, name);
  if (target.weight == nullptr) return std::nullopt;
  return target;
}

std::vector<StyleKey> made_style_keys() {
  std::vector<StyleKey> keys;
  for (const StyleNumber& n : kStyleNumbers) keys.push_back({std::string(n.name), n.min, n.max});
  for (const Legs& legs : kLegs) {
    for (const LegNumber& n : kLegNumbers)
      keys.push_back({fmt::format("{}.{}", legs.name, n.name), n.min, n.max});
    const auto add_weight = [&](const WeightName& weight) {
      keys.push_back({fmt::format("{}.{}.{}", legs.name, kWeightTable, weight.name)});
    };
    for (const WeightName& joint : kJointWeights) add_weight(joint);
    for (const WeightName& dof : kDofWeights) add_weight(dof);
  }
  for (BodyKey& key : body_keys()) keys.push_back({std::move(key.name), key.min, key.max});
  return keys;
}

}  // namespace

Result<Style> load_style(const std::string& path) {
  auto file = TomlFile::load(path);
  if (!file) return file.error();
  TomlTable root = file->root();
  Style style;
  style.name = root.string("name").value_or(std::filesystem::path(path).stem().string());
  for (const StyleNumber& n : kStyleNumbers)
    style.*n.value = number_in(root, n).value_or(style.*n.value);
  for (const Legs& legs : kLegs) {
    for (int side = legs.first; side <= legs.last; ++side) {
      if (auto leg = root.table(legs.name)) read_leg(*leg, style.stride[side], style.weight[side]);
    }
  }
  read_body(root, style.body);
  if (style.name.empty()) root.reject("name", "the name is empty");
  if (auto problem = file->problem()) return *problem;
  return style;
}

std::string style_text(const Style& style) {
  std::string text = "# A style: how a character walks. What is left out is plain.\n";
  if (!style.name.empty()) text += fmt::format("name = {}\n", toml_string(style.name));
  const StyleValues plain;
  for (const StyleNumber& n : kStyleNumbers) {
    if (style.*n.value != plain.*n.value) text += fmt::format("{} = {}\n", n.name, style.*n.value);
  }
  const bool is_even = style.stride[kLeftSide] == style.stride[kRightSide] &&
                       style.weight[kLeftSide] == style.weight[kRightSide];
  for (const Legs& legs : kLegs) {
    if ((legs.first != legs.last) == is_even)
      text += leg_text(legs.name, style.stride[legs.first], style.weight[legs.first]);
  }
  text += body_text(style.body);
  return text;
}

StyleValues mixed(const StyleValues& from, const StyleValues& to, double share) noexcept {
  if (!(share < 1.0)) return to;
  StyleValues values = from;
  for (const StyleNumber& n : kStyleNumbers)
    values.*n.value = mix(from.*n.value, to.*n.value, share);
  for (const Side side : {kLeftSide, kRightSide}) {
    for (const LegNumber& n : kLegNumbers) {
      values.stride[side].*n.value =
          mix(from.stride[side].*n.value, to.stride[side].*n.value, share);
    }
    for (std::size_t d = 0; d < values.weight[side].size(); ++d)
      values.weight[side][d] = mix(from.weight[side][d], to.weight[side][d], share);
  }
  values.body = mixed(from.body, to.body, share);
  return values;
}

const std::vector<StyleKey>& style_keys() {
  static const std::vector<StyleKey> keys = made_style_keys();
  return keys;
}

bool set_value(StyleValues& style, std::string_view name, double value) noexcept {
  if (set_body_value(style.body, name, value)) return true;
  const auto target = target_of(name);
  if (!target || !(value >= target->min && value <= target->max)) return false;
  value += 0.0;  // -0 would come back from a file as 0
  StyleValues changed = style;
  if (target->number) changed.*target->number->value = value;
  for (int side = target->first; side <= target->last; ++side) {
    if (target->leg_number) changed.stride[side].*target->leg_number->value = value;
    if (target->weight) set_weight(*target->weight, value, changed.weight[side]);
    if (is_locked(changed.weight[side])) return false;
  }
  style = changed;
  return true;
}

std::optional<double> value_of(const StyleValues& style, std::string_view name) noexcept {
  const auto target = target_of(name);
  if (!target) return body_value(style.body, name);
  if (target->number) return style.*target->number->value;
  if (target->leg_number) return style.stride[target->first].*target->leg_number->value;
  return style.weight[target->first][target->weight->first];
}

StyleBlend begun_blend(const StyleValues& in_force, const StyleValues& before,
                       const StyleValues& after) noexcept {
  return {in_force, std::max(before.blend_s, after.blend_s), 0.0};
}

StyleValues advance(StyleBlend& blend, const StyleValues& to, double dt_s) noexcept {
  if (!(blend.passed_s < blend.length_s)) return to;
  blend.passed_s += dt_s;
  return mixed(blend.from, to, smoothstep(0.0, blend.length_s, blend.passed_s));
}

double tired(double before, const StyleValues& style, double way_m, bool is_resting,
             double dt_s) noexcept {
  const double change =
      is_resting ? -style.fatigue_recovery_per_s * dt_s : style.fatigue_per_100_m * way_m / 100.0;
  return std::clamp(before + change, 0.0, 1.0);
}

StyleValues with_fatigue(const StyleValues& style, double tired) noexcept {
  const bool has_model = style.fatigue_per_100_m > 0.0 || style.fatigue_recovery_per_s > 0.0;
  StyleValues tiring = style;
  if (has_model) tiring.fatigue = std::min(style.fatigue + tired, 1.0);
  return tiring;
}

}  // namespace gaitpad
