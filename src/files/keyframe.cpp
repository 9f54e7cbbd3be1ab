#include "files/keyframe.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "motion/procedural.h"

namespace gaitpad {

namespace {

constexpr std::size_t kMostPoses = 64;
constexpr int kStrides = 4;
// Least distance of two keys of one channel, a share of the stride.
constexpr double kLeastGap = 0.005;

// The channels that a pose can key. Each side's phases count from its own strike: in a symmetric
// walk the left leg has the right leg's values half a stride later. The trunk's values then repeat
// every half stride; those of sideways motion change their sign.
enum Channel { kHip, kKnee, kAnkle, kToe, kShoulder, kElbow, kSideChannels };
enum TrunkChannel {
  kTurn,
  kList,
  kTilt,
  kSideways,
  kChestTurn,
  kChestList,
  kChestTilt,
  kTrunkChannels
};

struct KeyName {
  const char* name;
  double min, max, unit;  // range in the file; `unit` in radians or metres
};
constexpr std::array<KeyName, kSideChannels> kSideNames = {{{"hip", -60.0, 120.0, kDegree},
                                                            {"knee", 0.0, 150.0, kDegree},
                                                            {"ankle", -60.0, 45.0, kDegree},
                                                            {"toe", 0.0, 70.0, kDegree},
                                                            {"shoulder", -90.0, 180.0, kDegree},
                                                            {"elbow", 0.0, 150.0, kDegree}}};
constexpr std::array<KeyName, kTrunkChannels> kTrunkNames = {
    {{"pelvis_turn", -45.0, 45.0, kDegree},
     {"pelvis_list", -30.0, 30.0, kDegree},
     {"pelvis_tilt", -45.0, 45.0, kDegree},
     {"pelvis_side_m", -0.2, 0.2, 1.0},
     {"chest_turn", -45.0, 45.0, kDegree},
     {"chest_list", -30.0, 30.0, kDegree},
     {"chest_tilt", -45.0, 60.0, kDegree}}};
bool is_even(int channel) { return channel == kTilt || channel == kChestTilt; }

struct Keys {
  std::array<std::array<std::vector<PeriodicKeys::Key>, kSideChannels>, 2> side;
  std::array<std::vector<PeriodicKeys::Key>, kTrunkChannels> trunk;
};

struct KeyedStride {
  std::array<std::array<PeriodicKeys, kSideChannels>, 2> side;  // keys of both sides, by Side
  std::array<PeriodicKeys, kTrunkChannels> trunk;
  double duration_s = 1.1, track_m = 0.05, shoulder_out_rad = 0.0;
};

// Collects the keys of all poses and, for a symmetric walk, their mirror images half a stride
// later.
class KeyframeReader {
 public:
  explicit KeyframeReader(bool is_symmetric) : is_symmetric_(is_symmetric) {}

  void read(TomlTable& pose) {
    const double phase = pose.number("phase", 0.0, 1.0).value_or(0.0);
    pose.require("phase");
    if (phase >= 1.0) pose.reject("phase", "phase 1 is the next stride's 0");
    for (int c = 0; c < kTrunkChannels; ++c) {
      const auto value = value_of(pose, kTrunkNames[c], kTrunkNames[c].name);
      if (!value) continue;
      add(pose, kTrunkNames[c].name, phase, *value, keys.trunk[c]);
      if (is_symmetric_) {
        add(pose, kTrunkNames[c].name, fraction(phase + 0.5), is_even(c) ? *value : -*value,
            keys.trunk[c]);
      }
    }
    for (int c = 0; c < kSideChannels; ++c) read_sides(pose, c, phase);
  }

  Keys keys;

 private:
  static std::optional<double> value_of(TomlTable& pose, const KeyName& key,
                                        const std::string& name) {
    const auto value = pose.number(name, key.min, key.max);
    return value ? std::optional(*value * key.unit) : std::nullopt;
  }

  void read_sides(TomlTable& pose, int c, double phase) {
    const KeyName& key = kSideNames[c];
    if (is_symmetric_) {
      const auto value = value_of(pose, key, key.name);
      if (!value) return;
      add(pose, key.name, phase, *value, keys.side[kRightSide][c]);
      add(pose, key.name, fraction(phase + 0.5), *value, keys.side[kLeftSide][c]);
      return;
    }
    for (const Side side : {kLeftSide, kRightSide}) {
      const std::string name = (side == kLeftSide ? "left_" : "right_") + std::string(key.name);
      if (const auto value = value_of(pose, key, name)) {
        add(pose, name, phase, *value, keys.side[side][c]);
      }
    }
  }

  static void add(TomlTable& pose, const std::string& name, double phase, double value,
                  std::vector<PeriodicKeys::Key>& keys) {
    for (const auto& key : keys) {
      const double apart = std::abs(fraction(key.phase - phase + 0.5) - 0.5);
      if (apart >= kLeastGap) continue;
      pose.reject(name, fmt::format("{} is keyed twice at phase {:.3f} (a symmetric walk repeats "
                                    "every half stride)",
                                    name, phase));
      return;
    }
    keys.push_back({phase, value});
  }

  bool is_symmetric_;
};

KeyedStride stride_of(TomlTable& root) {
  KeyedStride stride;
  root.string("name");  // the key is allowed, but not used
  stride.duration_s = root.number("duration_s", 0.5, 4.0).value_or(stride.duration_s);
  root.require("duration_s");
  stride.track_m = root.number("track_m", 0.0, 0.3).value_or(stride.track_m);
  stride.shoulder_out_rad = root.number("arms_out", 0.0, 90.0).value_or(6.0) * kDegree;
  const bool is_symmetric = root.boolean("symmetric").value_or(true);
  KeyframeReader reader(is_symmetric);
  for (TomlTable& pose : root.tables("pose", kMostPoses)) reader.read(pose);
  for (const Side side : {kLeftSide, kRightSide}) {
    for (const int c : {kHip, kKnee}) {
      if (reader.keys.side[side][c].size() >= 2) continue;
      root.reject("pose", fmt::format("the poses key {} fewer than two times: nothing would walk",
                                      kSideNames[c].name));
    }
    for (int c = 0; c < kSideChannels; ++c)
      stride.side[side][c] = PeriodicKeys(reader.keys.side[side][c]);
  }
  for (int c = 0; c < kTrunkChannels; ++c) stride.trunk[c] = PeriodicKeys(reader.keys.trunk[c]);
  return stride;
}

quat turned(double turn, double list, double tilt) {
  return rotation_y(turn) * rotation_z(list) * rotation_x(tilt);
}

// Fills in both legs and the pelvis without its height.
void fill_samples(const KeyedStride& stride, GaitCycle& cycle) {
  cycle.samples.assign(kCycleSamples, CycleSample{});
  for (int i = 0; i < kCycleSamples; ++i) {
    const double phase = double(i) / kCycleSamples;
    const auto trunk = [&](int c) { return stride.trunk[c].at(phase); };
    CycleSample& at = cycle.samples[i];
    at.pelvis = turned(trunk(kTurn), trunk(kList), trunk(kTilt));
    at.pelvis_m.x = trunk(kSideways);
    for (const Side side : {kLeftSide, kRightSide}) {
      const auto angle = [&](int c) { return stride.side[side][c].at(phase); };
      SagittalLeg plane;
      plane.thigh = trunk(kTilt) - angle(kHip);
      plane.shank = plane.thigh + angle(kKnee);
      plane.foot = plane.shank - angle(kAnkle);
      plane.toe = -angle(kToe);
      CycleSample body = at;
      if (side == kLeftSide) {
        body.pelvis_m = mirrored(at.pelvis_m);
        body.pelvis = mirrored(at.pelvis);
      }
      const LegSample leg = right_leg_in_plane(cycle.leg[kRightSide], body, plane, stride.track_m);
      at.leg[side] = side == kRightSide ? leg : mirrored(leg);
    }
  }
}

// Sets the height of the pelvis so that the lower foot stands on the floor.
void stand_on_lower_foot(GaitCycle& cycle) {
  const auto height = heights_on_lower_foot(cycle, kCycleSamples, 6);
  for (int i = 0; i < kCycleSamples; ++i) cycle.samples[i].pelvis_m.y = height[i];
}

// The length of a stride. Between two samples, the lowest point (heel, ball, tip) of those that
// move backwards is assumed to stand, and the pelvis travels by its movement. A swinging toe may be
// lower but moves forward.
double travel_m(const GaitCycle& cycle) {
  double sum_m = 0.0;
  for (int i = 0; i < kCycleSamples; ++i) {
    const CycleSample &now = cycle.samples[i], &next = cycle.samples[(i + 1) % kCycleSamples];
    double lowest_m = 1e9, back_m = 0.0;
    for (int side = 0; side < 2; ++side) {
      const LegModel& model = cycle.leg[side];
      const LegPose a = pose_of(cycle, side, now), b = pose_of(cycle, side, next);
      const std::pair<vec3 LegPose::*, double> points[] = {
          {&LegPose::heel_m, 0.0},
          {&LegPose::toe_m, model.toe_rest_m},
          {&LegPose::toe_end_m, model.toe_end_rest_m}};
      for (const auto& [point, rest_m] : points) {
        const double height_m = (a.*point).y + (b.*point).y - 2.0 * rest_m;
        const double goes_back_m = (a.*point).z - (b.*point).z;
        if (goes_back_m <= 0.0 || height_m >= lowest_m) continue;
        lowest_m = height_m;
        back_m = goes_back_m;
      }
    }
    sum_m += back_m;
  }
  return sum_m;
}

// Sets arms, trunk and head of a frame whose pelvis is set. Chest and head keep their rotation in
// the travel frame.
void set_upper_body(const KeyedStride& stride, const GaitCycle& cycle, int i, quat* local) {
  const Skeleton& s = cycle.skeleton;
  const double phase = double(i) / kCycleSamples;
  const auto trunk = [&](int c) { return stride.trunk[c].at(phase); };
  const quat chest = turned(trunk(kChestTurn), trunk(kChestList), trunk(kChestTilt));
  const auto half = [](const quat& q) { return from_rotation_vector(0.5 * rotation_vector(q)); };
  local[s.find("Spine")] = local[s.find("Chest")] =
      half(glm::conjugate(cycle.samples[i].pelvis) * chest);
  local[s.find("Neck")] = local[s.find("Head")] = half(glm::conjugate(chest));
  for (const Side side : {kLeftSide, kRightSide}) {
    const double out = side == kLeftSide ? 1.0 : -1.0;
    const std::string name = side == kLeftSide ? "Left" : "Right";
    const auto angle = [&](int c) { return stride.side[side][c].at(phase); };
    local[s.find(name + "Arm")] =
        rotation_x(-angle(kShoulder)) * rotation_z(out * stride.shoulder_out_rad);
    local[s.find(name + "ForeArm")] = rotation_x(-angle(kElbow));
  }
}

Motion motion_of(const KeyedStride& stride, const std::string& name) {
  GaitCycle cycle = procedural_body();
  fill_samples(stride, cycle);
  stand_on_lower_foot(cycle);
  const double stride_m = travel_m(cycle);
  Motion motion;
  motion.name = name;
  motion.skeleton = cycle.skeleton;
  motion.pelvis = cycle.pelvis;
  motion.legs = {cycle.leg[kLeftSide].joints, cycle.leg[kRightSide].joints};
  motion.frame_time_s = stride.duration_s / kCycleSamples;
  for (int f = 0; f <= kStrides * kCycleSamples; ++f) {
    const int i = f % kCycleSamples;
    const CycleSample& at = cycle.samples[i];
    MotionFrame frame;
    frame.root_m = at.pelvis_m + kForward * (stride_m * f / kCycleSamples);
    frame.local.assign(motion.skeleton.joints.size(), kIdentity);
    frame.local[cycle.pelvis] = at.pelvis;
    set_upper_body(stride, cycle, i, frame.local.data());
    for (int side = 0; side < 2; ++side) {
      set_leg_locals(cycle.skeleton, cycle.leg[side], pose_of(cycle, side, at), frame.local.data());
    }
    motion.frames.push_back(std::move(frame));
  }
  return motion;
}

}  // namespace

PeriodicKeys::PeriodicKeys(std::vector<Key> keys) : keys_(std::move(keys)) {
  std::sort(keys_.begin(), keys_.end(),
            [](const Key& a, const Key& b) { return a.phase < b.phase; });
  const std::size_t n = keys_.size();
  std::vector<double> gap(n, 1.0), steepness(n, 0.0);
  for (std::size_t k = 0; n > 1 && k < n; ++k) {
    const Key& next = keys_[(k + 1) % n];
    gap[k] = next.phase - keys_[k].phase + (k + 1 == n ? 1.0 : 0.0);
    steepness[k] = (next.value - keys_[k].value) / gap[k];
  }
  slope_.assign(n, 0.0);
  for (std::size_t k = 0; n > 1 && k < n; ++k) {
    const std::size_t before = (k + n - 1) % n;
    const double a = steepness[before], b = steepness[k];
    if (a * b <= 0.0) continue;
    const double w1 = 2.0 * gap[k] + gap[before], w2 = gap[k] + 2.0 * gap[before];
    slope_[k] = (w1 + w2) / (w1 / a + w2 / b);
  }
}

double PeriodicKeys::at(double phase) const {
  const std::size_t n = keys_.size();
  if (n == 0) return 0.0;
  if (n == 1) return keys_[0].value;
  const double p = fraction(phase);
  std::size_t k = n - 1;  // the key before p; before the first key, the previous cycle's last
  while (k > 0 && keys_[k].phase > p) --k;
  if (keys_[k].phase > p) k = n - 1;
  const std::size_t next = (k + 1) % n;
  const double gap = fraction(keys_[next].phase - keys_[k].phase);
  const double t = fraction(p - keys_[k].phase) / gap;
  const double t2 = t * t, t3 = t2 * t;
  return (2.0 * t3 - 3.0 * t2 + 1.0) * keys_[k].value + (t3 - 2.0 * t2 + t) * gap * slope_[k] +
         (3.0 * t2 - 2.0 * t3) * keys_[next].value + (t3 - t2) * gap * slope_[next];
}

bool is_keyframe_file(TomlFile& file) { return file.root().has("pose"); }

Result<Motion> keyframe_motion(TomlFile& file) {
  TomlTable root = file.root();
  const KeyedStride stride = stride_of(root);
  if (auto problem = file.problem()) return *problem;
  return motion_of(stride, std::filesystem::path(file.name()).filename().string());
}

}  // namespace gaitpad
