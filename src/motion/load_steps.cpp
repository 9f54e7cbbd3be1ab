#include "motion/load_steps.h"

#include <fmt/format.h>

#include <filesystem>

#include "motion/tracks.h"
#include "motion/units.h"

namespace gaitpad {
namespace {

constexpr double kMinLegUnits = 1e-3, kMaxLegUnits = 1e6;

UpAxis up_axis(const std::array<std::vector<vec3>, 2>& hips,
               const std::array<std::vector<vec3>, 2>& ankles) {
  double y = 0.0, z = 0.0;
  for (int s = 0; s < 2; ++s) {
    for (std::size_t f = 0; f < hips[s].size(); ++f) {
      const vec3 leg = hips[s][f] - ankles[s][f];
      const double length = glm::length(leg);
      if (length <= 0.0) continue;
      y += leg.y / length;
      z += leg.z / length;
    }
  }
  return z > std::abs(y) ? UpAxis::z : UpAxis::y;
}

UpAxis up_axis_of(const Motion& motion) {
  const std::array<int, 4> joints = {motion.legs[0].hip, motion.legs[1].hip, motion.legs[0].ankle,
                                     motion.legs[1].ankle};
  const auto tracks = joint_tracks_m(motion, joints);
  return up_axis({tracks[0], tracks[1]}, {tracks[2], tracks[3]});
}

void scale(Motion& motion, double metres_per_unit) {
  motion.metres_per_unit = metres_per_unit;
  for (Joint& joint : motion.skeleton.joints) joint.offset_m *= metres_per_unit;
  for (MotionFrame& frame : motion.frames) {
    frame.root_m *= metres_per_unit;
    for (vec3& t : frame.translation_m) t *= metres_per_unit;
  }
}

void turn_y_up(Motion& motion) {
  const quat turn = rotation_x(-0.5 * kPi);
  for (MotionFrame& frame : motion.frames) {
    frame.root_m = vec3(frame.root_m.x, frame.root_m.z, -frame.root_m.y);
    frame.local[0] = glm::normalize(turn * frame.local[0]);
  }
}

}  // namespace

Result<UpAxis> find_body(Motion& motion, const std::string& path, const LoadOptions& options) {
  motion.name = std::filesystem::path(path).filename().string();
  const auto legs = find_legs(motion, options.legs);
  if (!legs) return Error{fmt::format("{}: {}", path, legs.error().message)};
  motion.legs = *legs;
  motion.pelvis = pelvis_of(motion.skeleton, *legs);
  return up_axis_of(motion);
}

Result<Motion> finished(Motion motion, UpAxis up, double stated_unit_m, const std::string& path,
                        const LoadOptions& options) {
  const double leg_units = leg_length_m(motion);
  if (leg_units < kMinLegUnits || leg_units > kMaxLegUnits) {
    return Error{fmt::format("{}: legs of {:.3g} units are no legs", path, leg_units)};
  }
  const double unit_m = options.metres_per_unit > 0.0 ? options.metres_per_unit
                                                      : metres_per_unit(leg_units, stated_unit_m);
  scale(motion, unit_m);
  if (up == UpAxis::z) turn_y_up(motion);
  if (options.frame_rate_hz > 0.0) motion.frame_time_s = 1.0 / options.frame_rate_hz;
  return motion;
}

}  // namespace gaitpad
