// Styles and characters as TOML files; config/README.md describes their grammar.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "control/fields.h"
#include "files/input_files.h"
#include "files/toml_file.h"
#include "gaitpad/config_files.h"

namespace gaitpad {
namespace {

constexpr std::string_view kWeightTable = "weight";

// In a name with a point, the part before the point is a table inside `table`.
std::optional<double> read_number(TomlTable& table, const StyleField& field) {
  const std::size_t point = field.name.find('.');
  if (point == std::string_view::npos) return table.number(field.name, field.min, field.max);
  auto inner = table.table(field.name.substr(0, point));
  return inner ? inner->number(field.name.substr(point + 1), field.min, field.max) : std::nullopt;
}

void read_section(const StyleSection& section, TomlTable& table, StyleValues& style) {
  for (const StyleField& field : section.fields) {
    if (const auto value = read_number(table, field)) set_field(section, field, *value, style);
  }
  if (!section.weights || !table.has(kWeightTable) || !is_locked(section, style)) return;
  table.reject(kWeightTable,
               fmt::format("all weights of the {} are 0: it could not move", section.limb));
}

// The weights that are not 1, as an inline table: one value for a joint with equal DOFs, otherwise
// one for each DOF.
std::string weights_text(const StyleSection& section, StyleValues& style) {
  const int side = section.first_side;
  std::string text;
  const auto add = [&](const StyleField& field, double weight) {
    const std::string_view name = field.name.substr(kWeightTable.size() + 1);
    if (weight != 1.0) text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", name, weight);
  };
  const double* written = nullptr;  // end of the written weights: their DOFs' keys are skipped
  for (const StyleField& joint : section.fields) {
    if (!joint.is_weight()) continue;
    const std::span<double> own = joint.values(style, side);
    if (written && own.data() < written) break;
    written = own.data() + own.size();
    if (std::all_of(own.begin(), own.end(), [&own](double w) { return w == own[0]; })) {
      add(joint, own[0]);
      continue;
    }
    for (const StyleField& dof : section.fields) {
      if (!dof.is_weight() || &dof == &joint) continue;
      const double* weight = dof.values(style, side).data();
      if (weight >= own.data() && weight < written) add(dof, *weight);
    }
  }
  return text.empty() ? "" : fmt::format("{} = {{ {} }}\n", kWeightTable, text);
}

std::string section_text(const StyleSection& section, StyleValues& style) {
  std::string text;
  StyleValues plain;
  for (const StyleField& field : section.fields) {
    if (field.is_weight()) continue;
    const double value = field.values(style, section.first_side).front();
    if (value != field.values(plain, section.first_side).front())
      text += fmt::format("{} = {}\n", field.name, value);
  }
  if (section.weights) text += weights_text(section, style);
  if (section.name.empty() || text.empty()) return text;
  return fmt::format("\n[{}]\n{}", section.name, text);
}

// True if both sides of a section have equal values.
bool is_even(const StyleSection& both, StyleValues& style) {
  return std::all_of(both.fields.begin(), both.fields.end(), [&](const StyleField& field) {
    const auto left = field.values(style, kLeftSide), right = field.values(style, kRightSide);
    return std::equal(left.begin(), left.end(), right.begin(), right.end());
  });
}

}  // namespace

Result<Style> load_style(const std::string& path) {
  auto file = TomlFile::load(path);
  if (!file) return file.error();
  TomlTable root = file->root();
  Style style;
  style.name = root.string("name").value_or(config_name(path));
  for (const StyleSection& section : style_sections()) {
    if (section.name.empty()) {
      read_section(section, root, style);
    } else if (auto table = root.table(section.name)) {
      read_section(section, *table, style);
    }
  }
  if (style.name.empty()) root.reject("name", "the name is empty");
  if (auto problem = file->problem()) return *problem;
  return style;
}

std::string style_text(const Style& style) {
  std::string text = "# A style: how a character walks. What is left out is plain.\n";
  if (!style.name.empty()) text += fmt::format("name = {}\n", toml_string(style.name));
  StyleValues values = style;
  bool are_sides_even = false;  // both sides of the present limb have equal values
  for (const StyleSection& section : style_sections()) {
    if (section.is_of_both()) are_sides_even = is_even(section, values);
    const bool is_one_of_two =
        section.name.starts_with("left_") || section.name.starts_with("right_");
    if (section.is_of_both() && !are_sides_even) continue;
    if (is_one_of_two && are_sides_even) continue;
    text += section_text(section, values);
  }
  return text;
}

Result<Character> load_character(const std::string& path) {
  constexpr double kLeastFactor = 0.3, kMostFactor = 3.0;
  auto file = TomlFile::load(path);
  if (!file) return file.error();
  TomlTable root = file->root();
  Character character;
  character.name = root.string("name").value_or(config_name(path));
  character.scale = root.number("scale", kLeastFactor, kMostFactor).value_or(1.0);
  character.leg_ratio = root.number("leg_ratio", kLeastFactor, kMostFactor).value_or(1.0);
  if (const auto skeleton = root.string("skeleton")) {
    if (skeleton->empty()) root.reject("skeleton", "the path of the skeleton is empty");
    character.skeleton = beside(path, *skeleton);
  }
  if (character.name.empty()) root.reject("name", "the name is empty");
  if (auto problem = file->problem()) return *problem;
  return character;
}

}  // namespace gaitpad
