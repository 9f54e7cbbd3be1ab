// A motion file made ready: metres, y up, the root's place settled, both legs found.
#pragma once
#include <array>
#include <string>
#include <string_view>

#include "motion/legs.h"
#include "motion/motion.h"

namespace gaitpad {

struct LoadOptions {
  double metres_per_unit = 0.0;    // 0: from the leg's length (units.h)
  double frame_rate_hz = 0.0;      // 0: as the file says; 120 Hz for .amc, which says nothing
  std::string skeleton;            // the .asf file of an .amc file; empty: beside it
  std::array<LegNames, 2> legs{};  // by Side; empty names are found (legs.h)
};

// What the file leaves open is settled thus.
// - Up: the axis of y and z along which the hips stand above the ankles; z-up files are turned to y
// up.
// - Root OFFSET: some files count it into the position channels, some do not. Of the two readings
// the
//   one is taken that puts the feet's usual lowest height nearer to 0; with an equal height (an
//   OFFSET of no height) the channels hold it. The skeleton's root offset is then 0: root_m says
//   all.
// - Positions of other joints replace their OFFSET if they are nearer to it than to 0, else add to
// it.
// By the file's ending: .bvh (and anything else), .amc with its .asf, .asf alone: its rest pose as
// one frame. The skeleton of NAME_01.amc is NAME_01.asf, else NAME.asf (up to the last `_`), else
// the only .asf file in the folder. An Acclaim bone is a joint at its start, named as the bone; a
// chain ends in an End Site. Its `:units length` counts 1/length inches (CMU's 0.45: 56.4 mm), as
// far as that makes a leg of it (units.h).
Result<Motion> load_motion(const std::string& path, const LoadOptions& options = {});
Result<Motion> motion_from_bvh(std::string_view text, const std::string& name,
                               const LoadOptions& options = {});
// Without a name for `amc`: the rest pose.
struct NamedText {
  std::string name;
  std::string_view text;
};
Result<Motion> motion_from_acclaim(const NamedText& asf, const NamedText& amc,
                                   const LoadOptions& options = {});

}  // namespace gaitpad
