// The data module's third kind of walk: key-framed (Meredith & Maddock 2005, section 3.2). A few
// poses of one stride, by hand, on the procedural adult.
#pragma once
#include <string_view>
#include <vector>

#include "files/toml_file.h"
#include "gaitpad/motion.h"
#include "gaitpad/result.h"

namespace gaitpad {

// A value over a cycle, from keys at phases in [0, 1): cubic pieces with a continuous slope.
// Between two keys it never leaves their values, and rests at a key that is higher or lower than
// both neighbours (Fritsch and Butland 1984, made periodic). One key is a constant, none is 0.
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
  std::vector<double> slope_;  // a cycle
};

// Whether a motion's .toml file holds poses itself.
bool is_keyframe_file(TomlFile& file);

// Several strides of the walk that the file describes (config/README.md, Motions), 128 frames each.
// The pelvis stands on whichever foot reaches lower and travels as far as the standing foot goes
// backwards below it. Errors read `FILE:LINE: cause`.
Result<Motion> keyframe_motion(TomlFile& file);

}  // namespace gaitpad
