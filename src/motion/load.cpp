#include "motion/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "motion/bvh.h"
#include "motion/euler.h"
#include "motion/load_steps.h"
#include "motion/motion_text.h"
#include "motion/tracks.h"

namespace gaitpad {
namespace {

struct JointValues {
  quat rotation = kIdentity;
  vec3 position{0.0};
  std::array<bool, 3> has{};  // position channels present
};

JointValues values_of(const BvhJoint& joint, const double* frame) {
  JointValues v;
  for (int c = 0; c < joint.channels; ++c) {
    const double value = frame[joint.first_value + c];
    const int axis = static_cast<int>(joint.channel[c]) % 3;
    if (is_rotation(joint.channel[c])) {
      v.rotation = v.rotation * rotation_about_axis(axis, value * kDegree);
    } else {
      v.position[axis] = value;
      v.has[axis] = true;
    }
  }
  v.rotation = glm::normalize(v.rotation);
  return v;
}

bool has_position(const BvhJoint& joint) {
  for (int c = 0; c < joint.channels; ++c) {
    if (!is_rotation(joint.channel[c])) return true;
  }
  return false;
}

enum class PositionMeans { place, shift };  // from the parent, or from OFFSET

PositionMeans position_means(const Bvh& bvh, const BvhJoint& joint) {
  vec3 mean(0.0);
  for (int f = 0; f < bvh.frames; ++f) {
    const double* frame = bvh.values.data() + static_cast<std::size_t>(f) * bvh.channels;
    mean += values_of(joint, frame).position / static_cast<double>(bvh.frames);
  }
  const bool near_offset = glm::distance(mean, joint.offset) <= glm::length(mean);
  return near_offset ? PositionMeans::place : PositionMeans::shift;
}

// The file's numbers as a motion in file units. The root stands where its channels say; axes
// without a channel take the OFFSET.
Motion in_file_units(const Bvh& bvh) {
  Motion motion;
  motion.frame_time_s = bvh.frame_time_s;
  std::vector<PositionMeans> means(bvh.joints.size(), PositionMeans::place);
  bool has_translations = false;
  for (std::size_t j = 0; j < bvh.joints.size(); ++j) {
    const BvhJoint& joint = bvh.joints[j];
    motion.skeleton.joints.push_back({joint.name, joint.parent, joint.offset, joint.is_end_site});
    if (j == 0 || !has_position(joint)) continue;
    has_translations = true;
    means[j] = position_means(bvh, joint);
  }
  motion.skeleton.joints[0].offset_m = vec3(0.0);
  motion.frames.resize(static_cast<std::size_t>(bvh.frames));
  for (int f = 0; f < bvh.frames; ++f) {
    MotionFrame& frame = motion.frames[f];
    const double* values = bvh.values.data() + static_cast<std::size_t>(f) * bvh.channels;
    frame.local.resize(bvh.joints.size(), kIdentity);
    if (has_translations) frame.translation_m.resize(bvh.joints.size());
    for (std::size_t j = 0; j < bvh.joints.size(); ++j) {
      const JointValues v = values_of(bvh.joints[j], values);
      frame.local[j] = v.rotation;
      vec3 place = bvh.joints[j].offset;
      for (int axis = 0; axis < 3; ++axis) {
        if (!v.has[axis]) continue;
        place[axis] = v.position[axis] + (means[j] == PositionMeans::shift ? place[axis] : 0.0);
      }
      if (j == 0)
        frame.root_m = place;
      else if (has_translations)
        frame.translation_m[j] = place;
    }
  }
  return motion;
}

// Median over the frames of the lowest foot joint's height.
double floor_height(const Motion& motion, UpAxis up) {
  const std::array<int, 6> feet = {motion.legs[0].ankle,   motion.legs[0].toe,
                                   motion.legs[0].toe_end, motion.legs[1].ankle,
                                   motion.legs[1].toe,     motion.legs[1].toe_end};
  const auto tracks = joint_tracks_m(motion, feet);
  std::vector<double> lowest(motion.frames.size(), 1e300);
  for (const auto& track : tracks) {
    for (std::size_t f = 0; f < track.size(); ++f) {
      lowest[f] = std::min(lowest[f], track[f][static_cast<int>(up)]);
    }
  }
  const auto middle = lowest.begin() + static_cast<std::ptrdiff_t>(lowest.size() / 2);
  std::nth_element(lowest.begin(), middle, lowest.end());
  return *middle;
}

// Adds the root OFFSET to the channels' position if the feet then stand nearer to the floor.
void settle_root(const Bvh& bvh, UpAxis up, Motion& motion) {
  const BvhJoint& root = bvh.joints[0];
  const JointValues channels = values_of(root, bvh.values.data());
  vec3 shift(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    if (channels.has[axis]) shift[axis] = root.offset[axis];
  }
  const double floor = floor_height(motion, up);
  if (std::abs(floor + shift[static_cast<int>(up)]) >= std::abs(floor)) return;
  for (MotionFrame& frame : motion.frames) frame.root_m += shift;
}

Result<Motion> motion_of(const Bvh& bvh, const std::string& path, const LoadOptions& options) {
  if (!options.skeleton.empty()) {
    return Error{
        fmt::format("{}: brings its skeleton itself, {} is not for it", path, options.skeleton)};
  }
  Motion motion = in_file_units(bvh);
  const auto up = find_body(motion, path, options);
  if (!up) return up.error();
  settle_root(bvh, *up, motion);
  return finished(std::move(motion), *up, 0.0, path, options);
}

bool ends_in(const std::string& path, std::string_view ending) {
  return lower_case(std::filesystem::path(path).extension().string()) == ending;
}

}  // namespace

Result<Motion> load_motion(const std::string& path, const LoadOptions& options) {
  if (ends_in(path, ".amc")) return load_amc(path, options);
  if (ends_in(path, ".asf")) return load_asf(path, options);
  const auto bvh = read_bvh(path);
  if (!bvh) return bvh.error();
  return motion_of(*bvh, path, options);
}

Result<Motion> motion_from_bvh(std::string_view text, const std::string& name,
                               const LoadOptions& options) {
  const auto bvh = parse_bvh(text, name);
  if (!bvh) return bvh.error();
  return motion_of(*bvh, name, options);
}

}  // namespace gaitpad
