#include "control/style.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "base/toml_file.h"

namespace gaitpad {

namespace {

struct WeightName {
  std::string_view name;
  int first, last;  // LegDof, inclusive
};
// A joint first, its single DOFs after it: these override.
constexpr WeightName kWeightNames[] = {
    {"hip", kHipX, kHipY},         {"knee", kKneeX, kKneeX},      {"ankle", kAnkleX, kAnkleY},
    {"hip_x", kHipX, kHipX},       {"hip_z", kHipZ, kHipZ},       {"hip_y", kHipY, kHipY},
    {"knee_x", kKneeX, kKneeX},    {"ankle_x", kAnkleX, kAnkleX}, {"ankle_z", kAnkleZ, kAnkleZ},
    {"ankle_y", kAnkleY, kAnkleY},
};

void read_weights(TomlTable& leg, LegWeights& weights) {
  auto table = leg.table("weight");
  if (!table) return;
  for (const WeightName& entry : kWeightNames) {
    const auto weight = table->number(entry.name, 0.0, 1.0);
    if (!weight) continue;
    std::fill(weights.begin() + entry.first, weights.begin() + entry.last + 1, *weight);
  }
  if (std::all_of(weights.begin(), weights.end(), [](double w) { return w == 0.0; })) {
    leg.reject("weight", "all weights of the leg are 0: it could not move");
  }
}

void read_leg(TomlTable leg, StrideFactors& stride, LegWeights& weights) {
  stride.length = leg.number("stride_length", 0.0, 1.5).value_or(stride.length);
  stride.speed = leg.number("stride_speed", 0.5, 2.0).value_or(stride.speed);
  stride.flight_height = leg.number("flight_height", 0.0, 3.0).value_or(stride.flight_height);
  read_weights(leg, weights);
}

}  // namespace

Result<Style> load_style(const std::string& path) {
  auto file = TomlFile::load(path);
  if (!file) return file.error();
  TomlTable root = file->root();
  Style style;
  style.name = root.string("name").value_or(std::filesystem::path(path).stem().string());
  style.fatigue = root.number("fatigue", 0.0, 1.0).value_or(style.fatigue);
  style.hip_sway = root.number("hip_sway", 0.0, 3.0).value_or(style.hip_sway);
  style.hip_bounce = root.number("hip_bounce", 0.0, 3.0).value_or(style.hip_bounce);
  // `legs` is asked for each side anew, `left_leg` and `right_leg` override it.
  for (const Side side : {kLeftSide, kRightSide}) {
    for (const char* key : {"legs", side == kLeftSide ? "left_leg" : "right_leg"}) {
      auto leg = root.table(key);
      if (leg) read_leg(*leg, style.stride[side], style.weight[side]);
    }
  }
  if (style.name.empty()) root.reject("name", "the name is empty");
  if (auto problem = file->problem()) return *problem;
  return style;
}

}  // namespace gaitpad
