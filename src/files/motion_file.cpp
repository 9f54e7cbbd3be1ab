#include "gaitpad/motion_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "base/numeric.h"
#include "base/ranges.h"
#include "base/text.h"
#include "files/acclaim.h"
#include "files/euler.h"
#include "files/input_files.h"
#include "files/keyframe.h"
#include "files/toml_file.h"
#include "gaitpad/bvh.h"
#include "gaitpad/config_files.h"

namespace gaitpad {

namespace fs = std::filesystem;
namespace {

constexpr double kMinLegUnits = 1e-3, kMaxLegUnits = 1e6;
constexpr double kAcclaimRate_hz = 120.0;  // frame rate of files that state none, such as CMU's
constexpr double kInch_m = 0.0254;
constexpr double kLeastFrameRate_hz = 1.0, kMostFrameRate_hz = 1e4;

// The index of the axis that points up.
enum class UpAxis { y = 1, z = 2 };

// The axis along which the hips stand above the ankles, over all frames.
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

// Names the motion after its file and finds legs, pelvis and the axis that points up. The motion is
// still in file units.
Result<UpAxis> find_body(Motion& motion, const std::string& path, const LoadOptions& options) {
  motion.name = fs::path(path).filename().string();
  const auto legs = find_legs(motion, options.legs);
  if (!legs) return Error{fmt::format("{}: {}", path, legs.error().message)};
  motion.legs = *legs;
  motion.pelvis = pelvis_of(motion.skeleton, *legs);
  return up_axis_of(motion);
}

// Converts to metres and y up. `stated_unit_m` is the unit that the file states, 0: none; a unit in
// the options overrides it.
Result<Motion> finish_motion(Motion motion, UpAxis up, double stated_unit_m,
                             const std::string& path, const LoadOptions& options) {
  const double leg_units = leg_length_m(motion);
  if (leg_units < kMinLegUnits || leg_units > kMaxLegUnits) {
    return Error{fmt::format("{}: legs of {:.3g} units are not plausible", path, leg_units)};
  }
  const double unit_m = options.metres_per_unit > 0.0 ? options.metres_per_unit
                                                      : metres_per_unit(leg_units, stated_unit_m);
  scale(motion, unit_m);
  if (up == UpAxis::z) turn_y_up(motion);
  if (options.frame_rate_hz > 0.0) motion.frame_time_s = 1.0 / options.frame_rate_hz;
  return motion;
}

// An Acclaim skeleton as joints: depth first, an End Site after each bone without children.
struct AcclaimJoints {
  Skeleton skeleton;       // has offsets in the file's unit
  std::vector<int> joint;  // index of the joint of each bone
};

AcclaimJoints joints_of(const Asf& asf) {
  AcclaimJoints body;
  std::vector<bool> has_child(asf.bones.size(), false);
  for (const AsfBone& bone : asf.bones) {
    if (bone.parent >= 0) has_child[static_cast<std::size_t>(bone.parent)] = true;
  }
  std::vector<Joint>& joints = body.skeleton.joints;
  for (std::size_t i = 0; i < asf.bones.size(); ++i) {
    const AsfBone& bone = asf.bones[i];
    const bool is_root = bone.parent < 0;
    const int parent = is_root ? -1 : body.joint[static_cast<std::size_t>(bone.parent)];
    const int here = static_cast<int>(joints.size());
    body.joint.push_back(here);
    const vec3 offset =
        is_root ? vec3(0.0) : asf.bones[static_cast<std::size_t>(bone.parent)].end();
    joints.push_back({bone.name, parent, offset, false});
    if (!has_child[i]) joints.push_back({bone.name + "_End", here, bone.end(), true});
  }
  return body;
}

struct BonePose {
  quat rotation;
  vec3 translation;  // place relative to the rest position, in the parent's frame
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

// Converts to a Motion with rotations and positions still in file units.
Motion in_file_units(const Asf& asf, const Amc& amc) {
  AcclaimJoints body = joints_of(asf);
  Motion motion;
  motion.frame_time_s = 1.0 / (amc.frame_rate_hz > 0.0 ? amc.frame_rate_hz : kAcclaimRate_hz);
  bool moves = false;
  for (std::size_t i = 1; i < asf.bones.size(); ++i) moves |= has_translation(asf.bones[i]);
  const std::vector<Joint>& joints = body.skeleton.joints;
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
      const auto joint = static_cast<std::size_t>(body.joint[i]);
      frame.local[joint] = pose.rotation;
      if (i == 0) frame.root_m = asf.root_position + pose.translation;
      if (i > 0 && moves) frame.translation_m[joint] += pose.translation;
    }
  }
  motion.skeleton = std::move(body.skeleton);
  return motion;
}

// One frame of the rest pose.
Amc rest_of(const Asf& asf) {
  Amc amc;
  amc.frames = 1;
  amc.values.assign(static_cast<std::size_t>(asf.channels), 0.0);
  return amc;
}

// The skeleton of NAME_01.amc: NAME_01.asf, otherwise NAME.asf, otherwise the folder's only .asf
// file.
Result<std::string> skeleton_beside(const std::string& path) {
  const fs::path file(path);
  const std::string stem = file.stem().string();
  std::vector<std::string> tried = {stem + ".asf"};
  if (const auto end = stem.rfind('_'); end != stem.npos && end > 0) {
    tried.push_back(stem.substr(0, end) + ".asf");
  }
  for (const std::string& name : tried) {
    if (const std::string asf = beside(path, name); is_input(asf)) return asf;
  }
  std::vector<std::string> all =
      inputs_in(file.has_parent_path() ? file.parent_path().string() : ".");
  std::erase_if(all, [](const std::string& other) {
    return lower_case(fs::path(other).extension().string()) != ".asf";
  });
  if (all.size() == 1) return all.front();
  return Error{
      fmt::format("{}: its skeleton is missing: neither {} nor a single other .asf file "
                  "is in its folder",
                  path, fmt::join(tried, " nor "))};
}

struct JointValues {
  quat rotation = kIdentity;
  vec3 position{0.0};
  std::array<bool, 3> has{};  // position channels that the joint has
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

// The origin of a joint's position channels: its parent (place), or the place that its OFFSET gives
// (shift).
enum class PositionMeans { place, shift };

PositionMeans position_means(const Bvh& bvh, const BvhJoint& joint) {
  vec3 mean(0.0);
  for (int f = 0; f < bvh.frames; ++f) {
    const double* frame = bvh.values.data() + static_cast<std::size_t>(f) * bvh.channels;
    mean += values_of(joint, frame).position / static_cast<double>(bvh.frames);
  }
  const bool near_offset = glm::distance(mean, joint.offset) <= glm::length(mean);
  return near_offset ? PositionMeans::place : PositionMeans::shift;
}

// Converts BVH, in the file's unit. The root's position comes from its channels; axes without a
// channel take the OFFSET.
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
  return median(std::move(lowest));
}

// Adds the root's OFFSET to its positions if that puts the feet closer to the floor.
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
        fmt::format("{}: has its own skeleton, {} is not used with it", path, options.skeleton)};
  }
  Motion motion = in_file_units(bvh);
  const auto up = find_body(motion, path, options);
  if (!up) return up.error();
  settle_root(bvh, *up, motion);
  return finish_motion(std::move(motion), *up, 0.0, path, options);
}

bool ends_in(const std::string& path, std::string_view ending) {
  return lower_case(fs::path(path).extension().string()) == ending;
}

// Reads the names of a leg's joints; names that are already given stay.
void read_leg(TomlTable& root, const char* key, LegNames& names) {
  auto leg = root.table(key);
  if (!leg) return;
  const auto fill = [&leg](const char* part, std::string& name) {
    const std::string told = leg->string(part).value_or("");
    if (name.empty()) name = told;
  };
  fill("hip", names.hip);
  fill("knee", names.knee);
  fill("ankle", names.ankle);
  fill("toe", names.toe);
}

Pace pace_of(TomlTable& root) {
  const auto name = root.string("pace");
  const auto pace = pace_named(name.value_or(name_of(Pace::own)));
  if (!pace) root.reject("pace", fmt::format("{} is no pace: own or adult", in_quotes(*name)));
  return pace.value_or(Pace::own);
}

}  // namespace

double metres_per_unit(double leg_length_units) noexcept {
  constexpr double kMinLegM = 0.65, kMaxLegM = 1.05;
  constexpr double kUnitsM[] = {1.0, 0.1, 0.01, 0.001, 0.0254, 0.3048, 0.0254 / 0.45};
  for (const double unit_m : kUnitsM) {
    const double leg_m = leg_length_units * unit_m;
    if (leg_m >= kMinLegM && leg_m <= kMaxLegM) return unit_m;
  }
  return kReferenceLeg_m / leg_length_units;
}

double metres_per_unit(double leg_length_units, double stated_unit_m) noexcept {
  constexpr double kMinLegM = 0.4, kMaxLegM = 1.3;
  const double leg_m = leg_length_units * stated_unit_m;
  return leg_m >= kMinLegM && leg_m <= kMaxLegM ? stated_unit_m : metres_per_unit(leg_length_units);
}

std::optional<Error> check(const LoadOptions& options) {
  if (auto problem =
          range_problem("LoadOptions: metres_per_unit", options.metres_per_unit, 0.0, 1e3))
    return problem;
  if (options.frame_rate_hz == 0.0) return std::nullopt;
  return range_problem("LoadOptions: frame_rate_hz", options.frame_rate_hz, kLeastFrameRate_hz,
                       kMostFrameRate_hz);
}

Result<Motion> motion_from_bvh(std::string_view text, const std::string& name,
                               const LoadOptions& options) {
  if (auto problem = check(options)) return *problem;
  const auto bvh = parse_bvh(text, name);
  if (!bvh) return bvh.error();
  return motion_of(*bvh, name, options);
}

Result<Motion> motion_from_acclaim(const NamedText& asf_text, const NamedText& amc_text,
                                   const LoadOptions& options) {
  if (auto problem = check(options)) return *problem;
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
  const double stated_m = asf->length_unit > 0.0 ? kInch_m / asf->length_unit : 0.0;
  return finish_motion(std::move(motion), *up, stated_m, path, options);
}

namespace {

Result<Motion> load_amc(const std::string& path, const LoadOptions& options) {
  const auto amc = input_text(path, kMaxMotionFileBytes);
  if (!amc) return amc.error();
  auto skeleton = options.skeleton.empty() ? skeleton_beside(path) : options.skeleton;
  if (!skeleton) return skeleton.error();
  const auto asf = input_text(*skeleton, kMaxMotionFileBytes);
  if (!asf) return Error{fmt::format("{} (the skeleton of {})", asf.error().message, path)};
  return motion_from_acclaim({*skeleton, *asf}, {path, *amc}, options);
}

Result<Motion> load_asf(const std::string& path, const LoadOptions& options) {
  const auto asf = input_text(path, kMaxMotionFileBytes);
  if (!asf) return asf.error();
  return motion_from_acclaim({path, *asf}, {}, options);
}

}  // namespace

Result<Motion> load_motion(const std::string& path, const LoadOptions& options) {
  if (auto problem = check(options)) return *problem;
  if (ends_in(path, ".amc")) return load_amc(path, options);
  if (ends_in(path, ".asf")) return load_asf(path, options);
  const auto bvh = read_bvh(path);
  if (!bvh) return bvh.error();
  return motion_of(*bvh, path, options);
}

Result<std::string> motion_path(const std::vector<std::string>& folders,
                                const std::string& file_or_name) {
  std::error_code error;
  const bool is_path =
      file_or_name.find_first_of("./") != std::string::npos || fs::exists(file_or_name, error);
  if (is_path) return file_or_name;
  return config_file(folders, "motions", file_or_name);
}

Result<Motion> load_motion_source(const std::string& path, const LoadOptions& given) {
  if (auto problem = check(given)) return *problem;
  if (!path.ends_with(".toml")) return load_motion(path, given);
  auto file = TomlFile::load(path);
  if (!file) return file.error();
  TomlTable root = file->root();
  if (is_keyframe_file(*file)) {
    const Pace pace = pace_of(root);
    auto motion = keyframe_motion(*file);
    if (motion) motion->pace = pace;
    return motion;
  }
  root.require("file");
  const std::string motion_file = root.string("file").value_or("");
  const double unit_m = root.number("metres_per_unit", 1e-6, 1e3).value_or(0.0);
  const double rate_hz =
      root.number("frame_rate_hz", kLeastFrameRate_hz, kMostFrameRate_hz).value_or(0.0);
  const std::string skeleton = root.string("skeleton").value_or("");
  const Pace pace = pace_of(root);
  LoadOptions options = given;
  if (given.metres_per_unit <= 0.0) options.metres_per_unit = unit_m;
  if (given.frame_rate_hz <= 0.0) options.frame_rate_hz = rate_hz;
  if (given.skeleton.empty() && !skeleton.empty()) options.skeleton = beside(path, skeleton);
  read_leg(root, "left_leg", options.legs[kLeftSide]);
  read_leg(root, "right_leg", options.legs[kRightSide]);
  if (auto problem = file->problem()) return *problem;
  auto motion = load_motion(beside(path, motion_file), options);
  if (motion) motion->pace = pace;
  return motion;
}

}  // namespace gaitpad
