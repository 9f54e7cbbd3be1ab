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
Result<Motion> load_motion(const std::string& path, const LoadOptions& options = {});
Result<Motion> motion_from_bvh(std::string_view text, const std::string& name,
                               const LoadOptions& options = {});

}  // namespace gaitpad
