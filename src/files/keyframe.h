// Key-framed walks, the third kind of motion of the data module (Meredith & Maddock 2005, section
// 3.2): a few poses of one stride, written by hand, on the procedural adult.
#pragma once
#include <string_view>
#include <vector>

#include "files/toml_file.h"
#include "gaitpad/motion.h"
#include "gaitpad/result.h"

namespace gaitpad {

// A value over a cycle, interpolated between keys at phases in [0, 1) by cubics with a continuous
// slope. Between two keys it stays within their values, and its slope is 0 at a key that is higher
// or lower than both neighbours (Fritsch and Butland 1984, made periodic). One key gives a
// constant, no key 0.
class PeriodicKeys {
 public:
  struct Key {
    double phase, value;
  };
  PeriodicKeys() = default;
  // Keys may be in any order; no two have the same phase.
  explicit PeriodicKeys(std::vector<Key> keys);
  double at(double phase) const;

 private:
  std::vector<Key> keys_;
  std::vector<double> slope_;  // slope at each key, per cycle
};

// True if a motion's .toml file contains poses instead of naming a motion file.
bool is_keyframe_file(TomlFile& file);

// Four strides of the walk that the file describes (config/README.md, Motions), 128 frames each.
// The pelvis' height puts the lower foot on the floor, and its travel keeps the standing foot in
// place. Errors read `FILE:LINE: cause`.
Result<Motion> keyframe_motion(TomlFile& file);

}  // namespace gaitpad
