#include "motion/captured_cycle.h"

#include <algorithm>
#include <memory>

#include "base/numeric.h"
#include "gaitpad/anatomy.h"
#include "gaitpad/curve.h"
#include "gaitpad/motion.h"
#include "motion/leg_pose.h"
#include "motion/sole.h"

namespace gaitpad {
namespace {

// --- One stride as a periodic function -----------------------------------------------------------

constexpr int kPoints = 256;    // samples of the closed stride, before its harmonics are taken
constexpr double kFade = 0.12;  // longest fade on either side of the seam, a share of the stride
constexpr double kLeastFade = 0.08;  // share of the stride: with less room the gaps are spread
constexpr int kFullHarmonics = 10;   // harmonics above this number fade out to kStrideHarmonics

// Natural cubic spline through values at 0, 1, 2 ...
struct Spline {
  std::vector<vec3> value, curvature;
  vec3 at(double x) const {
    const int last = static_cast<int>(value.size()) - 2;
    const int i = std::clamp(static_cast<int>(std::floor(x)), 0, last);
    const double t = x - i, s = 1.0 - t;
    return value[i] * s + value[i + 1] * t +
           ((s * s * s - s) * curvature[i] + (t * t * t - t) * curvature[i + 1]) / 6.0;
  }
};

Spline spline(std::vector<vec3> value) {
  const int n = static_cast<int>(value.size());
  std::vector<vec3> curvature(n, vec3(0.0));
  std::vector<double> upper(n, 0.0);
  for (int i = 1; i + 1 < n; ++i) {
    const double pivot = 4.0 - upper[i - 1];
    upper[i] = 1.0 / pivot;
    const vec3 bend = 6.0 * (value[i + 1] - 2.0 * value[i] + value[i - 1]);
    curvature[i] = (bend - curvature[i - 1]) / pivot;
  }
  for (int i = n - 2; i > 0; --i) curvature[i] -= upper[i] * curvature[i + 1];
  return {std::move(value), std::move(curvature)};
}

// The frames that are read: the window and a margin for fading the seam.
struct StrideFrames {
  int first = 0, count = 0;
  // Begin and length of the cycle in frames, counted from `first`.
  double start = 0.0, period = 0.0;
  // Margins for fading before and after the period, as shares of it.
  double before = 0.0, after = 0.0;
  double place(double phase) const { return start + phase * period; }
};

StrideFrames frames_of(const StrideWindow& w) {
  StrideFrames s;
  const double margin = kFade * w.period + 4.0;
  s.first = std::max(w.first, static_cast<int>(std::floor(w.start - margin)));
  const int last = std::min(w.last, static_cast<int>(std::ceil(w.start + w.period + margin)));
  s.count = last - s.first + 1;
  s.start = w.start - s.first;
  s.period = w.period;
  s.before = std::min(kFade, s.start / s.period);
  s.after = std::min(kFade, (s.count - 1 - s.start - s.period) / s.period);
  return s;
}

vec3 faded(const StrideFrames& s, const Spline& x, double phase) {
  const vec3 y = x.at(s.place(phase));
  const double share = s.before / (s.before + s.after);
  if (phase > 1.0 - s.before)
    return gaitpad::mix(y, x.at(s.place(phase - 1.0)),
                        share * smoothstep(1.0 - s.before, 1.0, phase));
  if (phase < s.after) {
    const double w = (1.0 - share) * (1.0 - smoothstep(0.0, s.after, phase));
    return gaitpad::mix(y, x.at(s.place(phase + 1.0)), w);
  }
  return y;
}

vec3 with_spread_gap(const StrideFrames& s, const Spline& x, double phase) {
  // Distance from the seam up to which the gaps are spread, and that over which a slope is taken;
  // shares of the stride.
  constexpr double kReach = 0.15, kStep = 0.01;
  const vec3 gap = x.at(s.place(1.0)) - x.at(s.place(0.0));
  const vec3 slope_start = (x.at(s.place(kStep)) - x.at(s.place(0.0))) / kStep;
  const vec3 slope_end = (x.at(s.place(1.0)) - x.at(s.place(1.0 - kStep))) / kStep;
  const vec3 half = 0.5 * (slope_end - slope_start);
  const double from_seam = std::min(phase, 1.0 - phase);
  const double rest = std::max(0.0, 1.0 - from_seam / kReach);
  const double near = 0.5 * (1.0 - smoothstep(0.0, kReach, from_seam));
  return x.at(s.place(phase)) + gap * (phase < 0.5 ? near : -near) + half * from_seam * rest * rest;
}

// Makes x(phase), 0 .. 1, periodic. If the motion continues beyond the seam, both of its sides are
// cross-faded. Otherwise the gaps in value and slope are spread around the seam. Samples away from
// the seam do not change.
std::array<vec3, kPoints> closed(const StrideFrames& s, const Spline& x) {
  const auto y = s.before + s.after >= kLeastFade ? &faded : &with_spread_gap;
  std::array<vec3, kPoints> points;
  for (int i = 0; i < kPoints; ++i) points[i] = y(s, x, double(i) / kPoints);
  return points;
}

using Wave = std::array<SinCos, kPoints>;  // of 2 pi i / kPoints

// Harmonics below the Nyquist frequency of the source's frames. The highest ones fade out, so that
// contacts do not ring.
Fourier harmonics(const std::array<vec3, kPoints>& y, const Wave& wave, double period_frames) {
  Fourier f;
  for (const vec3& v : y) f.mean += v / double(kPoints);
  const int most = std::min(kStrideHarmonics, static_cast<int>(0.5 * period_frames) - 1);
  const int full = std::min(kFullHarmonics, most);
  for (int k = 1; k <= most; ++k) {
    vec3 a(0.0), b(0.0);
    for (int i = 0; i < kPoints; ++i) {
      const SinCos& s = wave[(k * i) % kPoints];
      a += y[i] * s.cos;
      b += y[i] * s.sin;
    }
    const double keep = 1.0 - smoothstep(full, most + 1, k);
    f.a[k - 1] = keep * 2.0 / kPoints * a;
    f.b[k - 1] = keep * 2.0 / kPoints * b;
  }
  return f;
}

vec3 value_at(const Fourier& f, const std::array<SinCos, kStrideHarmonics>& wave) {
  vec3 sum = f.mean;
  for (int k = 0; k < kStrideHarmonics; ++k) sum += f.a[k] * wave[k].cos + f.b[k] * wave[k].sin;
  return sum;
}

// The pelvis' path with its turning removed frame by frame, then rotated about y so that the stride
// goes along +z. Returns the heading that was removed at each frame.
std::vector<double> straighten(const Motion& motion, const StrideFrames& s, double turn_rad,
                               std::vector<vec3>& path_m) {
  const auto world = std::make_unique<JointFrames>();
  std::vector<double> heading(s.count);
  std::vector<vec3> place(s.count);
  vec3 before(0.0);
  for (int f = 0; f < s.count; ++f) {
    heading[f] = turn_rad * (f - s.start) / s.period;
    forward_kinematics(motion, motion.frames[s.first + f], *world);
    const vec3 now = world->position_m[motion.pelvis];
    const double middle = heading[f] - 0.5 * turn_rad / s.period;
    place[f] = f == 0 ? now : place[f - 1] + rotation_y(-middle) * (now - before);
    before = now;
  }
  const double course = heading_of(point_at(place, s.place(1.0)) - point_at(place, s.place(0.0)));
  for (int f = 0; f < s.count; ++f) {
    heading[f] += course;
    path_m.push_back(rotation_y(-course) * (place[f] - place[0]));
    path_m[f].y += place[0].y;
  }
  return heading;
}

}  // namespace

PeriodicMotion periodic_motion(const Motion& motion, const StrideWindow& window) {
  const StrideFrames s = frames_of(window);
  Wave wave;
  for (int i = 0; i < kPoints; ++i) wave[i] = sin_cos(2.0 * kPi * i / kPoints);
  PeriodicMotion out;
  out.duration_s = s.period * motion.frame_time_s;

  std::vector<vec3> path_m;
  const std::vector<double> heading = straighten(motion, s, window.turn_rad, path_m);
  const Spline whole = spline(path_m);
  const vec3 travel = whole.at(s.place(1.0)) - whole.at(s.place(0.0));
  out.stride_m = travel.z;
  for (int f = 0; f < s.count; ++f) path_m[f] -= travel * (f - s.start) / s.period;
  out.pelvis_m = harmonics(closed(s, spline(path_m)), wave, s.period);
  out.pelvis_m.mean = vec3(0.0, out.pelvis_m.mean.y, 0.0);

  const int joints = static_cast<int>(motion.skeleton.joints.size());
  std::vector<quat> local(s.count);
  for (int j = 0; j < joints; ++j) {
    for (int f = 0; f < s.count; ++f) {
      const quat& q = motion.frames[s.first + f].local[j];
      local[f] = j == 0 ? rotation_y(-heading[f]) * q : q;
    }
    out.mean.push_back(mean_rotation(s.count, [&](int f) { return local[f]; }));
    std::vector<vec3> turn;
    for (const quat& q : local) turn.push_back(rotation_vector(glm::conjugate(out.mean[j]) * q));
    out.rotation.push_back(harmonics(closed(s, spline(turn)), wave, s.period));
  }
  return out;
}

namespace {

// --- Sampled poses -------------------------------------------------------------------------------

Pose pose_at(const PeriodicMotion& motion, double phase) {
  std::array<SinCos, kStrideHarmonics> wave;
  for (int k = 0; k < kStrideHarmonics; ++k) wave[k] = sin_cos(2.0 * kPi * (k + 1) * phase);
  Pose pose;
  pose.root_m = value_at(motion.pelvis_m, wave);
  pose.joint_count = static_cast<int>(motion.mean.size());
  for (int j = 0; j < pose.joint_count; ++j)
    pose.local[j] = motion.mean[j] * from_rotation_vector(value_at(motion.rotation[j], wave));
  return pose;
}

// Joint offsets; their mean over the motion if the frames have their own.
std::vector<vec3> mean_offsets(const Motion& motion) {
  std::vector<vec3> offset;
  for (const Joint& joint : motion.skeleton.joints) offset.push_back(joint.offset_m);
  if (motion.frames.front().translation_m.empty()) return offset;
  for (std::size_t j = 0; j < offset.size(); ++j) {
    vec3 sum(0.0);
    for (const MotionFrame& frame : motion.frames) sum += frame.translation_m[j];
    offset[j] = sum / double(motion.frames.size());
  }
  return offset;
}

// Moves the root to the pelvis. Other children of the joints in between keep their places relative
// to the pelvis.
Skeleton rooted_at_pelvis(const Motion& motion) {
  Skeleton skeleton = motion.skeleton;
  const std::vector<vec3> offset = mean_offsets(motion);
  for (std::size_t j = 0; j < offset.size(); ++j) skeleton.joints[j].offset_m = offset[j];
  vec3 to_pelvis(0.0);  // from the joint to the pelvis, in the joint's frame
  for (int joint = motion.pelvis; joint >= 0; joint = skeleton.joints[joint].parent) {
    const int parent = skeleton.joints[joint].parent;
    if (joint != motion.pelvis) to_pelvis = motion.frames.front().local[joint] * to_pelvis;
    to_pelvis += offset[joint];
    skeleton.joints[joint].offset_m = vec3(0.0);
    if (parent < 0) break;
    for (std::size_t k = 0; k < offset.size(); ++k) {
      const bool is_beside = skeleton.joints[k].parent == parent && static_cast<int>(k) != joint;
      if (is_beside) skeleton.joints[k].offset_m = offset[k] - to_pelvis;
    }
  }
  return skeleton;
}

void add_leg(const Skeleton& skeleton, const JointFrames& world, const LegJoints& j,
             CapturedLeg& leg) {
  leg.hip_m.push_back(world.position_m[j.hip]);
  leg.knee_m.push_back(world.position_m[j.knee]);
  leg.ankle_m.push_back(world.position_m[j.ankle]);
  leg.toe_m.push_back(world.position_m[j.toe]);
  leg.hip.push_back(world.rotation[j.hip]);
  leg.above_knee.push_back(world.rotation[skeleton.joints[j.knee].parent]);
  leg.knee.push_back(world.rotation[j.knee]);
  leg.ankle.push_back(world.rotation[j.ankle]);
  leg.toe.push_back(world.rotation[j.toe]);
}

CapturedCycle without_samples(const Motion& motion) {
  CapturedCycle cycle;
  cycle.skeleton = rooted_at_pelvis(motion);
  cycle.pelvis = motion.pelvis;
  cycle.legs = motion.legs;
  return cycle;
}

void add_sample(const Pose& at, JointFrames& world, CapturedCycle& cycle) {
  forward_kinematics(cycle.skeleton, at, world);
  cycle.local.insert(cycle.local.end(), at.local.begin(), at.local.begin() + at.joint_count);
  cycle.pelvis_m.push_back(at.root_m);
  cycle.pelvis_rotation.push_back(world.rotation[cycle.pelvis]);
  for (int side = 0; side < 2; ++side)
    add_leg(cycle.skeleton, world, cycle.legs[side], cycle.leg[side]);
}

// Turns the line of the hips to +x: about the vertical, then about z, so that the hips are level.
quat turned_to_left(const vec3& hips) {
  return rotation_z(-gaitpad::atan2(hips.y, horizontal_length(hips))) *
         rotation_y(-hips_heading(hips));
}

}  // namespace

CapturedCycle captured_cycle(const Motion& motion, const PeriodicMotion& periodic, double shift) {
  CapturedCycle cycle = without_samples(motion);
  cycle.duration_s = periodic.duration_s;
  cycle.stride_m = periodic.stride_m;
  const auto world = std::make_unique<JointFrames>();
  for (int i = 0; i < kCycleSamples; ++i) {
    add_sample(pose_at(periodic, shift + double(i) / kCycleSamples), *world, cycle);
  }
  return cycle;
}

CapturedCycle captured_pose(const Motion& motion, const MotionFrame& frame) {
  CapturedCycle cycle = without_samples(motion);
  cycle.duration_s = 1.0;
  const auto world = std::make_unique<JointFrames>();
  forward_kinematics(motion, frame, *world);
  const auto& at = world->position_m;
  const vec3 left = at[motion.legs[kLeftSide].hip] - at[motion.legs[kRightSide].hip];
  Pose pose{vec3(0.0, at[motion.pelvis].y, 0.0), {}, static_cast<int>(cycle.joints())};
  std::copy(frame.local.begin(), frame.local.end(), pose.local.begin());
  pose.local[0] = turned_to_left(left) * frame.local[0];
  for (int i = 0; i < kCycleSamples; ++i) add_sample(pose, *world, cycle);
  return cycle;
}

std::vector<double> ground_speed(const CapturedCycle& cycle, const std::vector<vec3>& point_m) {
  const double step_s = cycle.duration_s / kCycleSamples;
  const vec3 travel = kForward * (2.0 * cycle.stride_m / kCycleSamples);
  std::vector<double> speed;
  for (int i = 0; i < kCycleSamples; ++i) {
    const vec3 moved = point_m[wrapped_index(i + 1)] - point_m[wrapped_index(i - 1)] + travel;
    speed.push_back(glm::length(moved) / (2.0 * step_s));
  }
  return speed;
}

FlatFoot flat_foot(const CapturedCycle& cycle, int side) {
  const CapturedLeg& leg = cycle.leg[side];
  const std::vector<double> ankle = ground_speed(cycle, leg.ankle_m);
  const std::vector<double> toe = ground_speed(cycle, leg.toe_m);
  return {lowest(0, kCycleSamples - 1, [&](int i) {
    double sum = 0.0;
    for (int k = -2 * FlatFoot::reach; k <= 2 * FlatFoot::reach; ++k) {
      const int at = wrapped_index(i + k);
      sum += ankle[at] + toe[at] + kFlatRate_per_s * (leg.ankle_m[at].y + leg.toe_m[at].y);
    }
    return sum;
  })};
}

namespace {

// The middle rotation comes first: the others are nearest to it.
quat mean_turn(const std::vector<quat>& q, int middle, int reach) {
  return mean_rotation(2 * reach + 1, [&](int k) {
    return q[wrapped_index(middle + (k == 0 ? 0 : k <= reach ? k - 1 - reach : k - reach))];
  });
}
quat mean_of(const std::vector<quat>& q) { return mean_turn(q, 0, kCycleSamples / 2 - 1); }

}  // namespace

vec3 mean_around(const std::vector<vec3>& p, int middle, int reach) {
  vec3 sum(0.0);
  for (int k = -reach; k <= reach; ++k) sum += p[wrapped_index(middle + k)];
  return sum / double(2 * reach + 1);
}

namespace {

// --- The standing pose ---------------------------------------------------------------------------

// Height of a toeless ankle above the floor. A foot point at more than twice this depth under the
// ankle is ignored.
constexpr double kOwnAnkle_legs = 0.08;
// Greatest flexion of toes; some clips turn them all the way round.
constexpr double kMostToe = 70.0 * kDegree;

// Joints strictly between `from` and `to`, topmost first.
std::vector<int> joints_between(const Skeleton& skeleton, int from, int to) {
  return path_below(skeleton, from, skeleton.joints[to].parent);
}

// Turns a vector from the frame of the joint at the top into that of the last joint between.
vec3 into_last(const std::vector<int>& between, const std::vector<quat>& local, vec3 v) {
  for (const int j : between) v = glm::conjugate(local[j]) * v;
  return v;
}

std::vector<quat> mean_locals(const CapturedCycle& c) {
  std::vector<quat> mean, all(kCycleSamples);
  for (std::size_t j = 0; j < c.joints(); ++j) {
    for (int i = 0; i < kCycleSamples; ++i) all[i] = c.local[i * c.joints() + j];
    mean.push_back(mean_of(all));
  }
  return mean;
}

// The knee's hinge axis in the thigh's and in the shank's joint frame: the normal of the plane of
// hip, knee and ankle while the knee is bent, positive for flexion.
struct Hinge {
  vec3 thigh, shank;
};
Hinge knee_hinge(const CapturedLeg& leg, const quat& pelvis_standing,
                 const std::vector<quat>& pelvis) {
  std::vector<vec3> across(kCycleSamples);
  double most = 0.0;
  for (int i = 0; i < kCycleSamples; ++i) {
    const vec3 thigh = glm::normalize(leg.knee_m[i] - leg.hip_m[i]);
    const vec3 shank = glm::normalize(leg.ankle_m[i] - leg.knee_m[i]);
    across[i] = glm::cross(thigh, shank);  // a vector whose length is the sine of the flexion
    const vec3 left = pelvis[i] * glm::conjugate(pelvis_standing) * kLeft;
    if (glm::dot(across[i], left) > 0.0) most = std::max(most, glm::length(across[i]));
  }
  Hinge hinge{vec3(0.0), vec3(0.0)};
  for (int i = 0; i < kCycleSamples; ++i) {
    const vec3 left = pelvis[i] * glm::conjugate(pelvis_standing) * kLeft;
    const bool is_bent = glm::length(across[i]) >= 0.7 * most && glm::dot(across[i], left) > 0.0;
    const vec3 axis = most > 0.15 ? (is_bent ? across[i] : vec3(0.0)) : left;
    hinge.thigh += glm::conjugate(leg.hip[i]) * axis;
    hinge.shank += glm::conjugate(leg.knee[i]) * axis;
  }
  return hinge;
}

// The rotation that turns the bone to point straight down and the hinge to the left.
quat upright(const vec3& bone, const vec3& hinge) {
  const vec3 y = -glm::normalize(bone);
  const vec3 x = glm::normalize(hinge - y * glm::dot(hinge, y));
  return glm::conjugate(from_axes(x, y, glm::cross(x, y)));
}

struct FlatPose {
  vec3 ankle_m;
  quat foot, toe;  // rotations of the joints' frames
};
FlatPose flat_pose(const CapturedCycle& c, int side) {
  const FlatFoot flat = flat_foot(c, side);
  const CapturedLeg& leg = c.leg[side];
  return {mean_around(leg.ankle_m, flat.middle, FlatFoot::reach),
          mean_turn(leg.ankle, flat.middle, FlatFoot::reach),
          mean_turn(leg.toe, flat.middle, FlatFoot::reach)};
}

// Offsets ankle to toe and toe to its end when standing. An End Site without length becomes a toe
// of the usual length; one far under the foot is ignored.
void build_toes(const FlatPose& flat, const std::vector<quat>& local, GaitCycle& out,
                LegModel& leg) {
  std::vector<Joint>& joints = out.skeleton.joints;
  LegJoints& j = leg.joints;
  const double leg_m = leg.length_m();
  const auto from_ankle = [&](int joint) {
    return flat.foot * link(out.skeleton, local, j.ankle, joint);
  };
  const auto is_short = [&](int joint) { return is_short_foot(from_ankle(joint), leg_m); };
  if (is_short(j.toe) && !is_short(j.toe_end)) j.toe = j.toe_end;
  if (is_short(j.toe)) {
    const vec3 wanted(0.0, -kOwnAnkle_legs * leg_m, kOwnToe_legs * leg_m);
    const vec3 missing = glm::conjugate(flat.foot) * (wanted - from_ankle(j.toe));
    joints[j.toe].offset_m +=
        into_last(joints_between(out.skeleton, j.ankle, j.toe), local, missing);
  }
  leg.toe_m = from_ankle(j.toe);
  leg.toe_end_m = joints[j.toe].is_end_site || j.toe == j.toe_end
                      ? vec3(0.0)
                      : flat.toe * link(out.skeleton, local, j.toe, j.toe_end);
  const double end_m = leg.toe_m.y + leg.toe_end_m.y;
  if (end_m < -2.0 * kOwnAnkle_legs * leg_m || end_m > 0.0) {
    j.toe_end = j.toe;
    leg.toe_end_m = vec3(0.0);
  }
}

// Sets the heel point and the toes' rest heights, for an ankle of this height above the floor.
void build_sole(double ankle_height_m, LegModel& leg) {
  const vec3 flat(leg.toe_m.x, 0.0, leg.toe_m.z);
  leg.heel_m = -kHeelShare * flat - ankle_height_m * kUp;
  leg.toe_rest_m = std::max(0.0, leg.toe_m.y + ankle_height_m);
  leg.toe_end_rest_m = std::max(0.0, leg.toe_m.y + leg.toe_end_m.y + ankle_height_m);
}

Result<LegModel> leg_bones(const CapturedCycle& c, int side, const GaitCycle& out,
                           const std::vector<quat>& local) {
  LegModel leg;
  leg.joints = c.legs[side];
  const LegJoints& j = leg.joints;
  const vec3 thigh = link(out.skeleton, local, j.hip, j.knee);
  const vec3 shank = link(out.skeleton, local, j.knee, j.ankle);
  leg.thigh_m = glm::length(thigh);
  leg.shank_m = glm::length(shank);
  if (!(leg.thigh_m > 0.05 * leg.shank_m) || !(leg.shank_m > 0.05 * leg.thigh_m)) {
    return Error{"has a leg without a thigh or a shank"};
  }
  leg.hip_m = out.pelvis_standing * link(out.skeleton, local, c.pelvis, j.hip);
  const Hinge hinge = knee_hinge(c.leg[side], out.pelvis_standing, c.pelvis_rotation);
  leg.standing[0] = upright(thigh, hinge.thigh);
  leg.standing[1] = upright(shank, hinge.shank);
  return leg;
}

void build_standing_local(const CapturedCycle& c, std::vector<quat> local, GaitCycle& out) {
  const quat above = world_rotation(c.skeleton, local.data(), c.skeleton.joints[c.pelvis].parent);
  local[c.pelvis] = glm::conjugate(above) * out.pelvis_standing;
  for (const LegModel& leg : out.leg) {
    const LegPose pose = leg_pose(leg, vec3(0.0), kIdentity, LegAngles{}, 0.0);
    set_leg_locals(out.skeleton, leg, pose, local.data());
  }
  out.standing_local = std::move(local);
}

}  // namespace

Result<double> build_standing(const CapturedCycle& c, GaitCycle& out) {
  out.skeleton = c.skeleton;
  out.pelvis = c.pelvis;
  out.pelvis_standing = mean_of(c.pelvis_rotation);
  const std::vector<quat> local = mean_locals(c);
  double floor_m = 0.0;
  for (int side = 0; side < 2; ++side) {
    Result<LegModel> leg = leg_bones(c, side, out, local);
    if (!leg) return leg.error();
    const FlatPose flat = flat_pose(c, side);
    build_toes(flat, local, out, *leg);
    leg->standing[2] = flat.foot;
    leg->standing[3] = flat.toe;
    const double lowest = std::min(
        {leg->toe_m.y, leg->toe_m.y + leg->toe_end_m.y, -kLeastAnkle_legs * leg->length_m()});
    // Each foot stands on its own lowest point: captured floors are uneven by 1 to 2 cm, and with
    // one common floor the character would stand on one foot.
    floor_m += 0.5 * (flat.ankle_m.y + lowest);
    build_sole(-lowest, *leg);
    out.leg[side] = *leg;
  }
  build_standing_local(c, local, out);
  return floor_m;
}

namespace {

// --- The legs' angles ----------------------------------------------------------------------------

// Knee flexion that puts the ankle at distance `reach_m` from the hip. A nearly straight knee keeps
// the captured angle, because there the distance hardly depends on it.
double knee_angle(const LegModel& leg, double captured_rad, double reach_m) {
  const double share = smoothstep(4.0 * kDegree, 12.0 * kDegree, captured_rad);
  const double knee = mix(captured_rad, knee_at_span(leg, reach_m), share);
  // A knee straightens at 300 degrees/s, so it is slowed over kWidth instead of stopped at once.
  constexpr double kLeast = 1.5 * kDegree, kWidth = 5.0 * kDegree;
  return kLeast + soft_positive(knee - kLeast, kWidth);
}

// The knee's hinge in the frame of the joint above the knee (the thigh or its twist joint).
vec3 hinge_above_knee(const GaitCycle& cycle, int side) {
  const LegModel& leg = cycle.leg[side];
  return into_last(joints_between(cycle.skeleton, leg.joints.hip, leg.joints.knee),
                   cycle.standing_local, glm::conjugate(leg.standing[0]) * kLeft);
}

// Leg angles that put the ankle and the foot at their captured places, with the knee's hinge as
// close to its captured direction as possible.
LegSample leg_sample(const CapturedLeg& from, int i, const LegModel& model,
                     const vec3& hinge_above_knee, const vec3& hip_m, const quat& pelvis) {
  const vec3 hinge = from.above_knee[i] * hinge_above_knee;
  const vec3 upper = from.knee_m[i] - from.hip_m[i], lower = from.ankle_m[i] - from.knee_m[i];
  const double bent =
      gaitpad::atan2(glm::dot(glm::cross(upper, lower), hinge), glm::dot(upper, lower));
  const vec3 to_ankle = from.ankle_m[i] - hip_m;
  const double knee = knee_angle(model, bent, glm::length(to_ankle));

  const SinCos k = sin_cos(knee);
  const vec3 in_thigh =
      glm::normalize(vec3(0.0, -model.thigh_m - model.shank_m * k.cos, -model.shank_m * k.sin));
  const vec3 line = glm::normalize(to_ankle);
  const vec3 across = glm::normalize(hinge - line * glm::dot(hinge, line));
  const quat model_axes = from_axes(kLeft, in_thigh, glm::cross(kLeft, in_thigh));
  const quat turned =
      from_axes(across, line, glm::cross(across, line)) * glm::conjugate(model_axes);

  LegSample leg;
  leg.foot = from.ankle[i] * glm::conjugate(model.standing[2]);
  leg.ankle_m = from.ankle_m[i];
  const AnglesXzy hip = angles_xzy(glm::conjugate(pelvis) * turned);
  const AnglesXzy ankle = angles_xzy(glm::conjugate(turned * rotation_x(knee)) * leg.foot);
  leg.angles = {hip.x, hip.z, hip.y, knee, ankle.x, ankle.z, ankle.y};
  const quat toe = glm::conjugate(leg.foot) * from.toe[i] * glm::conjugate(model.standing[3]);
  const vec3 ahead = toe * kForward;
  leg.toe_x = std::clamp(gaitpad::atan2(-ahead.y, std::max(ahead.z, 0.1)), -kMostToe, kMostToe);
  return leg;
}

// Removes jumps by whole turns between neighbouring samples; quaternions stay in one hemisphere.
void make_continuous(GaitCycle& out) {
  for (int i = 1; i < kCycleSamples; ++i) {
    for (int side = 0; side < 2; ++side) {
      const LegSample& before = out.samples[i - 1].leg[side];
      LegSample& leg = out.samples[i].leg[side];
      for (int d = 0; d < kLegDofs; ++d) {
        leg.angles[d] = before.angles[d] + wrapped(leg.angles[d] - before.angles[d]);
      }
      leg.toe_x = before.toe_x + wrapped(leg.toe_x - before.toe_x);
      leg.foot = nearer(leg.foot, before.foot);
    }
    out.samples[i].pelvis = nearer(out.samples[i].pelvis, out.samples[i - 1].pelvis);
  }
  const std::size_t joints = out.standing_local.size();
  for (std::size_t k = joints; k < out.local.size(); ++k)
    out.local[k] = nearer(out.local[k], out.local[k - joints]);
}

}  // namespace

void build_samples(const CapturedCycle& c, double floor_m, GaitCycle& out) {
  const vec3 down = -floor_m * kUp;
  out.local = c.local;
  out.samples.assign(kCycleSamples, CycleSample{});
  const std::array<vec3, 2> hinge = {hinge_above_knee(out, kLeftSide),
                                     hinge_above_knee(out, kRightSide)};
  std::array<std::vector<int>, 2> twist;
  for (int side = 0; side < 2; ++side)
    twist[side] = twist_joints(c.skeleton, c.pelvis, out.leg[side].joints);
  for (int i = 0; i < kCycleSamples; ++i) {
    CycleSample& at = out.samples[i];
    at.pelvis_m = c.pelvis_m[i] + down;
    at.pelvis = c.pelvis_rotation[i] * glm::conjugate(out.pelvis_standing);
    quat* local = out.local.data() + i * c.joints();
    for (int side = 0; side < 2; ++side) {
      const LegModel& model = out.leg[side];
      const vec3 hip_m = c.pelvis_m[i] + at.pelvis * model.hip_m;
      LegSample& leg = at.leg[side];
      leg = leg_sample(c.leg[side], i, model, hinge[side], hip_m, at.pelvis);
      leg.ankle_m += down;
      for (const int k : twist[side]) local[k] = out.standing_local[k];
      set_leg_locals(out.skeleton, model, pose_of(out, side, at), local);
    }
  }
  make_continuous(out);
}

}  // namespace gaitpad
