// Acclaim motion (AMC) text: the numbers of each frame for the bones of its skeleton.
// Files come from strangers: memory grows with the text alone, and up to a bound.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "motion/asf.h"

namespace gaitpad {

struct Amc {
  int frames = 0;
  double angle_unit = kDegree;  // rad; :DEGREES or :RADIANS, else the skeleton's
  double frame_rate_hz = 0.0;   // 0: not said, as usual
  std::vector<double> values;   // frames x asf.channels; file units
};

// Frames are numbered lines, counted up by one from any number; CRLF, comments and blank lines do
// not matter. A bone that the first frame leaves out rests; one that a later frame leaves out keeps
// its last values, or is damage where the file says :FULLY-SPECIFIED. `asf_name` stands in the
// sentence about a bone that the skeleton does not have. Errors read `NAME:LINE: cause`.
Result<Amc> parse_amc(std::string_view text, const std::string& name, const Asf& asf,
                      const std::string& asf_name);

}  // namespace gaitpad
