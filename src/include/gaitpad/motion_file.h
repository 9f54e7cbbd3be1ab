// Captured, procedural and key-framed motions from files, made ready for a walk: in metres, y up,
// with the root's place settled and both legs found.
//
//   const auto motion = gaitpad::load_motion("walk.bvh");
//   if (!motion) return fail(motion.error().message);
//   const auto cycle = gaitpad::gait_cycle(*motion);
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/anatomy.h"
#include "gaitpad/motion.h"
#include "gaitpad/result.h"

namespace gaitpad {

// Largest size of a file; a larger one is an error.
inline constexpr std::size_t kMaxMotionFileBytes = std::size_t{512} << 20;
// Frames times joints; for 100 joints 14 minutes at 120 Hz.
inline constexpr long long kMaxFrameJoints = 10'000'000;

// Facts that a motion file does not state, or states wrongly. The caller fills it.
struct LoadOptions {
  // Unit of the file, at most 1000; 0: found from the length of the legs, metres_per_unit() below.
  double metres_per_unit = 0.0;
  // Frame rate, 1 .. 10,000; 0: what the file says; 120 Hz for an .amc that says nothing.
  double frame_rate_hz = 0.0;
  std::string skeleton;  // .asf file of an .amc file; empty: the one beside it
  // Names of the legs' joints, indexed by Side; find_legs() finds those that are empty.
  std::array<LegNames, 2> legs{};
};
// Errors read `LoadOptions: frame_rate_hz is -1, outside [1, 10000]`. Every function below calls
// it.
std::optional<Error> check(const LoadOptions& options);

// Loads a motion by its file's ending: .amc with its .asf, .asf alone (its rest pose as one frame),
// else BVH. Errors read `PATH: cause` or `PATH:LINE: cause`.
//
// Facts that the file leaves open:
// - Up is the axis of y and z along which the hips stand above the ankles; z-up files are turned to
//   y up.
// - The root's OFFSET is part of its position channels in some files and not in others. The reading
//   that puts the feet's usual lowest height nearer to 0 is taken; if both are equally near, the
//   channels alone count. root_m holds the result, and the skeleton's root offset is 0.
// - Position channels of another joint replace its OFFSET if they are nearer to it than to 0, else
//   they are added to it.
// - The skeleton of NAME_01.amc is NAME_01.asf, else NAME.asf (up to the last `_`), else the only
//   .asf file in the folder.
// - An Acclaim bone becomes a joint at its start, with the bone's name; a chain ends in an End
//   Site. The file's `:units length` counts 1/length inches (CMU's 0.45: 56.4 mm) if the legs then
//   have a plausible length.
Result<Motion> load_motion(const std::string& path, const LoadOptions& options = {});

// Load a motion from texts in memory; `name` replaces the path in errors.
Result<Motion> motion_from_bvh(std::string_view text, const std::string& name,
                               const LoadOptions& options = {});
struct NamedText {
  std::string name;
  std::string_view text;
};
// An `amc` without a name gives the rest pose.
Result<Motion> motion_from_acclaim(const NamedText& asf, const NamedText& amc,
                                   const LoadOptions& options = {});

// The length of a file's unit, from the length of its legs. BVH does not state it, and ASF not
// reliably. Of m, dm, cm, mm, inch, foot and the CMU data base's unit (1 inch / 0.45) the one that
// makes the leg 0.65 to 1.05 m long (at most one does); if none does, the leg is kReferenceLeg_m
// long.
double metres_per_unit(double leg_length_units) noexcept;
// The unit of a file that states it. The stated unit counts if it makes the leg 0.4 to 1.3 m long,
// as children and giants have; otherwise the file is wrong, as endorphin's are.
double metres_per_unit(double leg_length_units, double stated_unit_m) noexcept;

// The file that a user's FILE|NAME means: FILE itself if it has a dot or a slash or exists, else
// motions/NAME.toml in the folders of configuration (config_files.h).
Result<std::string> motion_path(const std::vector<std::string>& folders,
                                const std::string& file_or_name);

// Loads the motion of a session: a file as load_motion() does, or a .toml file (config/README.md,
// Motions). A .toml file holds key-framed poses, or names a motion file beside it and states what
// cannot be found in that file: its unit, skeleton, frame rate and the joints of the legs. `given`
// takes precedence over the .toml file.
Result<Motion> load_motion_source(const std::string& path, const LoadOptions& given = {});

}  // namespace gaitpad
