// Acclaim files as a motion: which skeleton an .amc file has, and what its numbers mean.
#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "motion/amc.h"
#include "motion/euler.h"
#include "motion/load_steps.h"
#include "motion/motion_text.h"

namespace gaitpad {
namespace fs = std::filesystem;
namespace {

constexpr double kDefaultRate = 120.0;
constexpr double kInch = 0.0254;

// Joints as in Skeleton: depth first, an End Site behind the bones that nothing hangs on.
struct Layout {
  Skeleton skeleton;       // offsets in file units
  std::vector<int> joint;  // of each bone
};

Layout layout_of(const Asf& asf) {
  Layout layout;
  std::vector<bool> has_child(asf.bones.size(), false);
  for (const AsfBone& bone : asf.bones) {
    if (bone.parent >= 0) has_child[static_cast<std::size_t>(bone.parent)] = true;
  }
  std::vector<Joint>& joints = layout.skeleton.joints;
  for (std::size_t i = 0; i < asf.bones.size(); ++i) {
    const AsfBone& bone = asf.bones[i];
    const bool is_root = bone.parent < 0;
    const int parent = is_root ? -1 : layout.joint[static_cast<std::size_t>(bone.parent)];
    const int here = static_cast<int>(joints.size());
    layout.joint.push_back(here);
    const vec3 offset =
        is_root ? vec3(0.0) : asf.bones[static_cast<std::size_t>(bone.parent)].end();
    joints.push_back({bone.name, parent, offset, false});
    if (!has_child[i]) joints.push_back({bone.name + "_End", here, bone.end(), true});
  }
  return layout;
}

struct BonePose {
  quat rotation;
  vec3 translation;  // from where it stands at rest, in its parent's frame
};

BonePose pose_of(const AsfBone& bone, const double* values, double angle_unit) {
  quat turn = kIdentity;
  vec3 shift(0.0);
  for (int c = 0; c < bone.channels; ++c) {
    const double value = values[bone.first_value + c];
    const int axis = static_cast<int>(bone.channel[c]) % 3;
    if (is_rotation(bone.channel[c])) {
      turn = rotation_about_axis(axis, value * angle_unit) * turn;
    } else {
      shift[axis] = value;
    }
  }
  return {glm::normalize(bone.axes * turn * glm::conjugate(bone.axes)), bone.axes * shift};
}

bool has_translation(const AsfBone& bone) {
  for (int c = 0; c < bone.channels; ++c) {
    if (!is_rotation(bone.channel[c])) return true;
  }
  return false;
}

Motion in_file_units(const Asf& asf, const Amc& amc) {
  Layout layout = layout_of(asf);
  Motion motion;
  motion.frame_time_s = 1.0 / (amc.frame_rate_hz > 0.0 ? amc.frame_rate_hz : kDefaultRate);
  bool moves = false;
  for (std::size_t i = 1; i < asf.bones.size(); ++i) moves |= has_translation(asf.bones[i]);
  const std::vector<Joint>& joints = layout.skeleton.joints;
  motion.frames.resize(static_cast<std::size_t>(amc.frames));
  for (int f = 0; f < amc.frames; ++f) {
    MotionFrame& frame = motion.frames[static_cast<std::size_t>(f)];
    const double* values = amc.values.data() + static_cast<std::size_t>(f) * asf.channels;
    frame.local.assign(joints.size(), kIdentity);
    if (moves) {
      for (const Joint& joint : joints) frame.translation_m.push_back(joint.offset_m);
    }
    for (std::size_t i = 0; i < asf.bones.size(); ++i) {
      const BonePose pose = pose_of(asf.bones[i], values, amc.angle_unit);
      const auto joint = static_cast<std::size_t>(layout.joint[i]);
      frame.local[joint] = pose.rotation;
      if (i == 0) frame.root_m = asf.root_position + pose.translation;
      if (i > 0 && moves) frame.translation_m[joint] += pose.translation;
    }
  }
  motion.skeleton = std::move(layout.skeleton);
  return motion;
}

// One frame in which every bone rests.
Amc rest_of(const Asf& asf) {
  Amc amc;
  amc.frames = 1;
  amc.values.assign(static_cast<std::size_t>(asf.channels), 0.0);
  return amc;
}

// Names are tried in this order, then any single .asf of the folder.
Result<std::string> skeleton_beside(const std::string& path) {
  const fs::path file(path);
  const std::string stem = file.stem().string();
  std::vector<std::string> tried = {stem + ".asf"};
  if (const auto end = stem.rfind('_'); end != stem.npos && end > 0) {
    tried.push_back(stem.substr(0, end) + ".asf");
  }
  std::error_code error;
  for (const std::string& name : tried) {
    const fs::path beside = file.parent_path() / name;
    if (fs::is_regular_file(beside, error)) return beside.string();
  }
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  std::vector<std::string> all;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (lower_case(it->path().extension().string()) == ".asf") all.push_back(it->path().string());
    if (all.size() > 1) break;
  }
  if (all.size() == 1) return all.front();
  return Error{
      fmt::format("{}: its skeleton is missing: neither {} nor a single other .asf file "
                  "stands beside it",
                  path, fmt::join(tried, " nor "))};
}

}  // namespace

Result<Motion> motion_from_acclaim(const NamedText& asf_text, const NamedText& amc_text,
                                   const LoadOptions& options) {
  const auto asf = parse_asf(asf_text.text, asf_text.name);
  if (!asf) return asf.error();
  std::optional<Amc> amc;
  if (!amc_text.name.empty()) {
    auto parsed =
        parse_amc(amc_text.text, amc_text.name, *asf, fs::path(asf_text.name).filename().string());
    if (!parsed) return parsed.error();
    amc = std::move(*parsed);
  }
  const std::string& path = amc ? amc_text.name : asf_text.name;
  Motion motion = in_file_units(*asf, amc ? *amc : rest_of(*asf));
  const auto up = find_body(motion, path, options);
  if (!up) return up.error();
  const double stated_m = asf->length_unit > 0.0 ? kInch / asf->length_unit : 0.0;
  return finished(std::move(motion), *up, stated_m, path, options);
}

Result<Motion> load_amc(const std::string& path, const LoadOptions& options) {
  const auto amc = motion_file_text(path);
  if (!amc) return amc.error();
  auto skeleton = options.skeleton.empty() ? skeleton_beside(path) : options.skeleton;
  if (!skeleton) return skeleton.error();
  const auto asf = motion_file_text(*skeleton);
  if (!asf) return Error{fmt::format("{} (the skeleton of {})", asf.error().message, path)};
  return motion_from_acclaim({*skeleton, *asf}, {path, *amc}, options);
}

Result<Motion> load_asf(const std::string& path, const LoadOptions& options) {
  const auto asf = motion_file_text(path);
  if (!asf) return asf.error();
  return motion_from_acclaim({path, *asf}, {}, options);
}

}  // namespace gaitpad
