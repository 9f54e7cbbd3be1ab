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
  explicit PeriodicKeys(std::vector<Key> keys);  // any order, no phase twice
  double at(double phase) const;

 private:
  std::vector<Key> keys_;
  std::vector<double> slope_;  // at each key, per cycle
};

// Whether a motion's .toml file holds poses, and does not name a motion file.
bool is_keyframe_file(TomlFile& file);

// Four strides of the walk that the file describes (config/README.md, Motions), 128 frames each.
// The pelvis is as high as the foot that reaches lower needs it, and travels as far as the standing
// foot moves backwards below it. Errors read `FILE:LINE: cause`.
Result<Motion> keyframe_motion(TomlFile& file);

}  // namespace gaitpad
