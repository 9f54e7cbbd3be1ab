#include "control/body_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "gaitpad/math.h"

namespace gaitpad {
namespace {

// One number of a table; `at` finds it, the side counts where there are two.
struct BodyNumber {
  std::string_view name;
  double min, max;
  double& (*at)(BodyParams&, int side);
};

constexpr BodyNumber kArmNumbers[] = {
    {"swing", 0.0, 3.0, [](BodyParams& b, int s) -> double& { return b.arm_swing[s]; }},
};
constexpr BodyNumber kHandNumbers[] = {
    {"carry", 0.0, 1.0, [](BodyParams& b, int s) -> double& { return b.hand[s].carry; }},
    {"x_m", -1.0, 1.0, [](BodyParams& b, int s) -> double& { return b.hand[s].x_m; }},
    {"y_m", -1.0, 1.0, [](BodyParams& b, int s) -> double& { return b.hand[s].y_m; }},
    {"z_m", -1.0, 1.0, [](BodyParams& b, int s) -> double& { return b.hand[s].z_m; }},
    {"rail", 0.0, 1.0, [](BodyParams& b, int s) -> double& { return b.hand[s].rail; }},
    {"rail_height_m", 0.3, 2.0,
     [](BodyParams& b, int s) -> double& { return b.hand[s].rail_height_m; }},
    {"rail_side_m", 0.1, 1.0,
     [](BodyParams& b, int s) -> double& { return b.hand[s].rail_side_m; }},
};
constexpr BodyNumber kHeadNumbers[] = {
    {"look", 0.0, 1.0, [](BodyParams& b, int) -> double& { return b.head.look; }},
    {"yaw_deg", -90.0, 90.0, [](BodyParams& b, int) -> double& { return b.head.yaw_deg; }},
    {"pitch_deg", -60.0, 60.0, [](BodyParams& b, int) -> double& { return b.head.pitch_deg; }},
    {"look_at", 0.0, 1.0, [](BodyParams& b, int) -> double& { return b.head.look_at; }},
    {"x_m", -100.0, 100.0, [](BodyParams& b, int) -> double& { return b.head.x_m; }},
    {"y_m", -100.0, 100.0, [](BodyParams& b, int) -> double& { return b.head.y_m; }},
    {"z_m", -100.0, 100.0, [](BodyParams& b, int) -> double& { return b.head.z_m; }},
    {"lead", 0.0, 1.0, [](BodyParams& b, int) -> double& { return b.head.lead; }},
};

struct WeightName {
  std::string_view name;
  int first, last;  // of the weights, inclusive
};
// A joint first, its single DOFs after it: these override.
constexpr WeightName kArmWeights[] = {
    {"shoulder", kShoulderX, kShoulderY},
    {"elbow", kElbowX, kElbowX},
    {"wrist", kWristX, kWristZ},
    {"shoulder_x", kShoulderX, kShoulderX},
    {"shoulder_z", kShoulderZ, kShoulderZ},
    {"shoulder_y", kShoulderY, kShoulderY},
    {"elbow_x", kElbowX, kElbowX},
    {"wrist_x", kWristX, kWristX},
    {"wrist_z", kWristZ, kWristZ},
};
constexpr WeightName kSpineWeights[] = {{"lower", kLowerSpine, kLowerSpine},
                                        {"upper", kUpperSpine, kUpperSpine}};
constexpr int kArmJoints = 3;  // the leading rows of kArmWeights
constexpr std::string_view kWeightTable = "weight";

std::span<double> arm_weights(BodyParams& body, int side) { return body.arm_weight[side]; }
std::span<double> spine_weights(BodyParams& body, int) { return body.spine_weight; }

// What a table may hold, and whose it is.
struct BodyTable {
  std::string_view name;
  int first, last;  // sides
  std::span<const BodyNumber> numbers;
  std::span<const WeightName> weights;
  std::span<double> (*weights_of)(BodyParams&, int side);
  std::string_view owner;  // of the weights
};
// Both sides first: a single one overrides them.
constexpr BodyTable kTables[] = {
    {"arms", kLeftSide, kRightSide, kArmNumbers, kArmWeights, &arm_weights, "arm"},
    {"left_arm", kLeftSide, kLeftSide, kArmNumbers, kArmWeights, &arm_weights, "arm"},
    {"right_arm", kRightSide, kRightSide, kArmNumbers, kArmWeights, &arm_weights, "arm"},
    {"hands", kLeftSide, kRightSide, kHandNumbers, {}, nullptr, ""},
    {"left_hand", kLeftSide, kLeftSide, kHandNumbers, {}, nullptr, ""},
    {"right_hand", kRightSide, kRightSide, kHandNumbers, {}, nullptr, ""},
    {"spine", kLeftSide, kLeftSide, {}, kSpineWeights, &spine_weights, "spine"},
    {"head", kLeftSide, kLeftSide, kHeadNumbers, {}, nullptr, ""},
};

bool is_locked(std::span<const double> weights) noexcept {
  return std::all_of(weights.begin(), weights.end(), [](double w) { return w == 0.0; });
}

void fill(const WeightName& name, double weight, std::span<double> weights) noexcept {
  std::fill(weights.begin() + name.first, weights.begin() + name.last + 1, weight);
}

void read_weights(const BodyTable& entry, TomlTable& table, BodyParams& body) {
  auto weights = table.table(kWeightTable);
  if (!weights) return;
  for (const WeightName& name : entry.weights) {
    const auto weight = weights->number(name.name, 0.0, 1.0);
    for (int side = entry.first; weight && side <= entry.last; ++side)
      fill(name, *weight, entry.weights_of(body, side));
  }
  for (int side = entry.first; side <= entry.last; ++side) {
    if (!is_locked(entry.weights_of(body, side))) continue;
    table.reject(kWeightTable,
                 fmt::format("all weights of the {} are 0: it could not move", entry.owner));
    return;
  }
}

// Single weights where a joint's differ, else the joint's.
std::string weights_text(const BodyTable& entry, std::span<const double> weights) {
  std::string text;
  const auto add = [&](std::string_view name, double weight) {
    if (weight != 1.0) text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", name, weight);
  };
  const std::size_t joints = entry.owner == "arm" ? kArmJoints : entry.weights.size();
  for (const WeightName& joint : entry.weights.first(joints)) {
    const auto own = weights.subspan(joint.first, joint.last - joint.first + 1);
    if (std::all_of(own.begin(), own.end(), [&own](double w) { return w == own[0]; })) {
      add(joint.name, own[0]);
      continue;
    }
    for (const WeightName& dof : entry.weights.subspan(joints)) {
      if (dof.first >= joint.first && dof.last <= joint.last) add(dof.name, weights[dof.first]);
    }
  }
  return text.empty() ? "" : fmt::format("{} = {{ {} }}\n", kWeightTable, text);
}

std::string table_text(const BodyTable& entry, BodyParams body) {
  std::string text;
  BodyParams plain;
  for (const BodyNumber& n : entry.numbers) {
    const double value = n.at(body, entry.first);
    if (value != n.at(plain, entry.first)) text += fmt::format("{} = {}\n", n.name, value);
  }
  if (entry.weights_of != nullptr) text += weights_text(entry, entry.weights_of(body, entry.first));
  return text.empty() ? "" : fmt::format("\n[{}]\n{}", entry.name, text);
}

// One key: a number, or some weights, of a table.
struct Target {
  const BodyTable* table = nullptr;
  const BodyNumber* number = nullptr;
  const WeightName* weight = nullptr;
};

template <class T>
const T* found(std::span<const T> list, std::string_view name) noexcept {
  const auto at =
      std::find_if(list.begin(), list.end(), [name](const T& t) { return t.name == name; });
  return at == list.end() ? nullptr : &*at;
}

std::optional<Target> target_of(std::string_view name) noexcept {
  const std::string_view head = name.substr(0, name.find('.'));
  name.remove_prefix(std::min(head.size() + 1, name.size()));
  Target target;
  target.table = found(std::span<const BodyTable>(kTables), head);
  if (target.table == nullptr) return std::nullopt;
  target.number = found(target.table->numbers, name);
  if (target.number != nullptr) return target;
  if (!name.starts_with(kWeightTable) || name.size() <= kWeightTable.size()) return std::nullopt;
  if (name[kWeightTable.size()] != '.') return std::nullopt;
  target.weight = found(target.table->weights, name.substr(kWeightTable.size() + 1));
  if (target.weight == nullptr) return std::nullopt;
  return target;
}

}  // namespace

void read_body(TomlTable& root, BodyParams& body) {
  for (const BodyTable& entry : kTables) {
    auto table = root.table(entry.name);
    if (!table) continue;
    for (const BodyNumber& n : entry.numbers) {
      const auto value = table->number(n.name, n.min, n.max);
      for (int side = entry.first; value && side <= entry.last; ++side) n.at(body, side) = *value;
    }
    if (entry.weights_of != nullptr) read_weights(entry, *table, body);
  }
}

std::string body_text(const BodyParams& body) {
  std::string text;
  for (const BodyTable& entry : kTables) {
    const bool is_paired = entry.name != "spine" && entry.name != "head";
    const bool is_arm = entry.owner == "arm";
    const bool is_even =
        is_arm ? body.arm_swing[0] == body.arm_swing[1] && body.arm_weight[0] == body.arm_weight[1]
               : body.hand[0] == body.hand[1];
    if (!is_paired || (entry.first != entry.last) == is_even) text += table_text(entry, body);
  }
  return text;
}

std::vector<BodyKey> body_keys() {
  std::vector<BodyKey> keys;
  for (const BodyTable& entry : kTables) {
    for (const BodyNumber& n : entry.numbers)
      keys.push_back({fmt::format("{}.{}", entry.name, n.name), n.min, n.max});
    for (const WeightName& weight : entry.weights)
      keys.push_back({fmt::format("{}.{}.{}", entry.name, kWeightTable, weight.name)});
  }
  return keys;
}

bool set_body_value(BodyParams& body, std::string_view name, double value) noexcept {
  const auto target = target_of(name);
  if (!target) return false;
  const double min = target->number ? target->number->min : 0.0;
  const double max = target->number ? target->number->max : 1.0;
  if (!(value >= min && value <= max)) return false;
  value += 0.0;  // -0 would come back from a file as 0
  BodyParams changed = body;
  for (int side = target->table->first; side <= target->table->last; ++side) {
    if (target->number) {
      target->number->at(changed, side) = value;
      continue;
    }
    const std::span<double> weights = target->table->weights_of(changed, side);
    fill(*target->weight, value, weights);
    if (is_locked(weights)) return false;
  }
  body = changed;
  return true;
}

BodyParams mixed(const BodyParams& from, const BodyParams& to, double share) noexcept {
  BodyParams values = from, end = to;
  for (const BodyTable& entry : kTables) {
    const bool is_single = entry.name == "spine" || entry.name == "head";
    if (!is_single && entry.first == entry.last) continue;  // the tables of both sides have all
    for (int side = entry.first; side <= entry.last; ++side) {
      for (const BodyNumber& n : entry.numbers) {
        double& value = n.at(values, side);
        value = mix(value, n.at(end, side), share);
      }
      if (entry.weights_of == nullptr) continue;
      const std::span<double> weights = entry.weights_of(values, side);
      const std::span<double> goals = entry.weights_of(end, side);
      for (std::size_t i = 0; i < weights.size(); ++i)
        weights[i] = mix(weights[i], goals[i], share);
    }
  }
  return values;
}

std::optional<double> body_value(const BodyParams& body, std::string_view name) noexcept {
  const auto target = target_of(name);
  if (!target) return std::nullopt;
  BodyParams copy = body;
  const int side = target->table->first;
  if (target->number) return target->number->at(copy, side);
  return target->table->weights_of(copy, side)[target->weight->first];
}

}  // namespace gaitpad
