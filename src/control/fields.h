// The numbers of a style with their keys in files, commands and sliders.
#pragma once
#include <span>
#include <string_view>

#include "gaitpad/style.h"

namespace gaitpad {

// One key of a section: one number, or the weights of all DOFs of a joint.
struct StyleField {
  std::string_view name;  // the key within its section: `stride_length`, `weight.knee`
  std::string_view unit;  // "m", "s", "deg"; "x": a factor; "": a share or a weight
  double min, max;        // range of the value in files and commands
  std::span<double> (*values)(StyleValues& style, int side);
  std::string_view words{};   // words for a label, if the name does not read well
  std::string_view effect{};  // a sentence for a tip, if the label does not say it
  bool is_weight() const noexcept { return name.starts_with("weight."); }
};

// A table of a style's file. Its fields belong to one side, to both, or to the whole character.
struct StyleSection {
  std::string_view name;  // `left_leg`; empty: keys before the first table
  int first_side, last_side;
  std::span<const StyleField> fields;
  // All weights of one side; null if the section has none. At least one must be above 0, because a
  // limb with all joints locked could not move.
  std::span<double> (*weights)(StyleValues& style, int side);
  std::string_view limb;  // name of the limb that has the weights, for messages
  bool is_rare = false;   // few users change its keys: a window may hide them
  bool is_of_both() const noexcept { return first_side != last_side; }
};

// In the order of a file: for each limb both sides, then left and right, which override them.
// Weights of joints come before weights of their single DOFs.
std::span<const StyleSection> style_sections() noexcept;

// Sets all numbers of the field, on all sides of the section. No bounds are checked.
void set_field(const StyleSection& section, const StyleField& field, double value,
               StyleValues& style) noexcept;

// True if all weights on one side of the section are 0.
bool is_locked(const StyleSection& section, StyleValues& style) noexcept;

}  // namespace gaitpad
