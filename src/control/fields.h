// The numbers of a style, each with the key by which files, commands and sliders call it.
#pragma once
#include <span>
#include <string_view>

#include "gaitpad/style.h"

namespace gaitpad {

// One key of a section. It stands for one number, or for the weights of all DOFs of one joint.
struct StyleField {
  std::string_view name;  // within its section: `stride_length`, `weight.knee`
  std::string_view unit;  // "m", "s", "deg"; "x" a factor; "" a share or a weight
  double min, max;        // what a file or a command may give
  std::span<double> (*values)(StyleValues& style, int side);
  bool is_weight() const noexcept { return name.starts_with("weight."); }
};

// A table of a style's file. Its fields belong to one side, to both, or to the whole character.
struct StyleSection {
  std::string_view name;  // `left_leg`; empty: what stands before the first table
  int first_side, last_side;
  std::span<const StyleField> fields;
  // All weights of one side; null where the section has none. At least one must be above 0, since a
  // limb whose joints are all locked could not move.
  std::span<double> (*weights)(StyleValues& style, int side);
  std::string_view limb;  // whose weights they are, for sentences
  bool is_of_both() const noexcept { return first_side != last_side; }
};

// In the order of a file: of a limb first both sides, then the left and the right one, which
// override them. Of the weights first the joints, then their single DOFs.
std::span<const StyleSection> style_sections() noexcept;

// Sets all numbers of the field, on all sides of the section. No bounds are checked.
void set_field(const StyleSection& section, const StyleField& field, double value,
               StyleValues& style) noexcept;

// Whether all weights are 0 on one side of the section.
bool is_locked(const StyleSection& section, StyleValues& style) noexcept;

}  // namespace gaitpad
