// A motion file made ready: metres, y up, the root's place settled, both legs found.
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/anatomy.h"
#include "gaitpad/motion.h"
#include "gaitpad/result.h"

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

// How long a file's unit is. BVH does not say, ASF not reliably; a leg does, since adults' legs are
// much alike.

// Hip to ankle of the adult that unknown units are scaled to.
inline constexpr double kAdultLegM = 0.84;

// Of m, dm, cm, mm, inch, foot and the CMU data base's unit (1 inch / 0.45) the one that makes the
// leg 0.65 to 1.05 m long (at most one does); where none fits, the unit that makes it kAdultLegM.
double metres_per_unit(double leg_length_units) noexcept;
// The same for a file that states its unit: that one wherever it makes a leg of 0.4 to 1.3 m, as of
// children and giants; else the file is wrong about it, as endorphin's are.
double metres_per_unit(double leg_length_units, double stated_unit_m) noexcept;

// The motion that a session walks by.

// Which file a user's FILE|NAME means: motions/NAME.toml of the configuration, unless it is a path
// (has a dot or a slash) or a file of that name stands here.
Result<std::string> motion_path(const std::vector<std::string>& folders,
                                const std::string& file_or_name);

// A BVH or AMC file, or a .toml file beside one that says what cannot be found in it: its unit, its
// skeleton, its frame rate, the joints of the legs; or a .toml file of poses (config/README.md,
// Motions).
// `given` goes before what the .toml file says.
Result<Motion> load_motion_source(const std::string& path, const LoadOptions& given = {});

}  // namespace gaitpad
