// The embedded default walk: published normative joint curves on the adult of procedural_skeleton.
// Sources. Hip, knee, ankle, pelvic tilt: six-harmonic fits of an adult data set (gaitutils,
// normal.gcd). Pelvic obliquity and rotation: fits of Schwartz, Rozumalski & Trost 2008 (free
// speed), odd harmonics only, which makes the two sides exact mirror images. Pelvis sway,
// shoulders, elbows: Boulic, Magnenat-Thalmann & Thalmann 1990, their knots replaced by the nearest
// few harmonics.
#include <algorithm>

#include "motion/procedural_skeleton.h"
#include "motion/stride_plane.h"

namespace gaitpad {
namespace {

constexpr double kSpeed = 1.25;  // m/s, wanted; the stride's time is rounded to whole frames
constexpr double kFrameRate = 120.0;
constexpr double kTrack = 0.05;  // each foot from the middle line: step width .10 m
constexpr int kHalf = kCycleSamples / 2;
constexpr int kStridesInMotion = 4;

// a0 + sum of a cos 2 pi k p + b sin 2 pi k p, degrees; rows k = 1..6.
struct Harmonics {
  double mean;
  std::array<std::array<double, 2>, 6> row;
  double at(double phase) const {
    double sum = mean;
    for (int k = 0; k < 6; ++k) {
      const SinCos s = sin_cos(2.0 * kPi * (k + 1) * phase);
      sum += row[k][0] * s.cos + row[k][1] * s.sin;
    }
    return sum;
  }
};
constexpr Harmonics kHip = {
    15.42, {{{22.21, -.64}, {-2.67, -2.64}, {-1.16, 1.49}, {.26, -.07}, {-.33, .20}, {-.01, .20}}}};
constexpr Harmonics kKnee = {
    20.73,
    {{{3.50, -22.36}, {-18.00, .52}, {-3.18, 3.91}, {-1.01, -.51}, {-1.11, .48}, {.04, .08}}}};
constexpr Harmonics kAnkle = {
    4.58,
    {{{-5.19, 5.45}, {3.95, -3.86}, {-3.10, -1.59}, {.95, 1.46}, {1.06, -.49}, {-.14, -.08}}}};
constexpr Harmonics kTilt = {9.76,
                             {{{0, 0}, {1.16, -.04}, {0, 0}, {.28, .27}, {0, 0}, {-.10, .15}}}};
constexpr Harmonics kObliquity = {0.0, {{{1.85, 2.12}, {0, 0}, {-1.19, .22}}}};
constexpr Harmonics kRotation = {0.0, {{{3.74, 2.10}, {0, 0}, {.34, -.37}}}};

// The fit dips to 0 at heel strike; a knee is never quite straight.
double knee_flexion(double phase) {
  return (1.5 + soft_positive(kKnee.at(phase) - 1.5, 2.0)) * kDegree;
}

// The set's foot stands 5 degrees toe-up at mid-stance and its toe grazes the floor in late swing:
// its foot markers are not our sole. One cosine lays the standing foot flat and clears the swinging
// one.
double foot_correction(double phase) {
  return 3.5 * kDegree * sin_cos(2.0 * kPi * (phase - 0.33)).cos;
}

SagittalLeg sagittal_leg(double phase) {
  SagittalLeg leg;
  leg.thigh = (kTilt.at(phase) - kHip.at(phase)) * kDegree;
  leg.shank = leg.thigh + knee_flexion(phase);
  leg.foot = leg.shank - kAnkle.at(phase) * kDegree + foot_correction(phase);
  // The toes stay on the floor while the heel rises over them, and straighten in early swing.
  const double on_floor = 1.0 - smoothstep(0.58, 0.80, phase) + smoothstep(0.94, 1.0, phase);
  const double bend = soft_positive(leg.foot, 8.0 * kDegree) * on_floor;
  leg.toe = -(bend - soft_positive(bend - 45.0 * kDegree, 20.0 * kDegree));
  return leg;
}

quat pelvis_rotation(double phase) {
  return rotation_y(kRotation.at(phase) * kDegree) * rotation_z(-kObliquity.at(phase) * kDegree) *
         rotation_x((kTilt.at(phase) - kTilt.mean) * kDegree);
}

// Pelvis rotation and sway, and the leg angles. The left leg is the right one half a cycle later.
void fill_angles(GaitCycle& cycle) {
  const double leg_m = cycle.leg[kRightSide].length_m();
  cycle.samples.resize(kCycleSamples);
  for (int i = 0; i < kHalf; ++i) {
    const double phase = double(i) / kCycleSamples;
    CycleSample& now = cycle.samples[i];
    CycleSample& later = cycle.samples[i + kHalf];
    now.pelvis = pelvis_rotation(phase);
    now.pelvis_m.x = -0.032 * leg_m * sin_cos(2.0 * kPi * (phase - 0.1)).sin;
    later.pelvis = gaitpad::mirrored(now.pelvis);
    later.pelvis_m.x = -now.pelvis_m.x;
  }
  for (int i = 0; i < kCycleSamples; ++i) {
    CycleSample& at = cycle.samples[i];
    at.leg[kRightSide] = right_leg_in_plane(cycle.leg[kRightSide], at,
                                            sagittal_leg(double(i) / kCycleSamples), kTrack);
    CycleSample& later = cycle.samples[(i + kHalf) % kCycleSamples];
    later.leg[kLeftSide] = mirrored(at.leg[kRightSide]);
  }
}

// The even harmonics up to 6 of a curve that repeats every half cycle.
std::array<double, kHalf> smoothed(const std::array<double, kHalf>& curve) {
  std::array<double, kHalf> out{};
  for (int k = 0; k <= 3; ++k) {
    double a = 0.0, b = 0.0;
    for (int i = 0; i < kHalf; ++i) {
      const SinCos s = sin_cos(2.0 * kPi * k * i / kHalf);
      a += curve[i] * s.cos;
      b += curve[i] * s.sin;
    }
    const double share = (k == 0 ? 1.0 : 2.0) / kHalf;
    for (int i = 0; i < kHalf; ++i) {
      const SinCos s = sin_cos(2.0 * kPi * k * i / kHalf);
      out[i] += share * (a * s.cos + b * s.sin);
    }
  }
  return out;
}

// The pelvis stands on whichever foot reaches lower. Fore and aft it swings by 70 % of what would
// let the standing foot slide least (least squares over heel and ball): slowest over the standing
// foot. (Boulic's fore-aft curve, as ported, runs the other way and makes the foot slide.)
void fill_pelvis_path(GaitCycle& cycle) {
  std::array<double, kHalf> height;
  for (int i = 0; i < kHalf; ++i) {
    const CycleSample& at = cycle.samples[i];
    height[i] = -std::min(foot_clearance(cycle, 0, at), foot_clearance(cycle, 1, at));
  }
  height = smoothed(height);
  for (int i = 0; i < kHalf; ++i) {
    const SinCos s = sin_cos(2.0 * kPi * i / kHalf);
    for (const int at : {i, i + kHalf}) {
      cycle.samples[at].pelvis_m.y = height[i];
      cycle.samples[at].pelvis_m.z = -0.005 * s.cos - 0.004 * s.sin;
    }
  }
  for (CycleSample& at : cycle.samples) {
    for (int side = 0; side < 2; ++side) {
      const LegPose p = pose_of(cycle, side, at);
      at.leg[side].ankle_m = p.ankle_m;
      at.leg[side].foot = p.foot;
    }
  }
}

// Boulic's knots at 1.25 m/s, as one cosine each: shoulder -19 .. 10 degrees, elbow 16 .. 50.
double shoulder_flexion(double phase) { return -4.3 - 14.7 * sin_cos(2.0 * kPi * phase).cos; }
double elbow_flexion(double phase) { return 32.0 - 16.5 * sin_cos(2.0 * kPi * (phase + 0.02)).cos; }

void set_arm(GaitCycle& cycle, quat* local, const std::string& side, double sign, double phase) {
  const Skeleton& s = cycle.skeleton;
  local[s.find(side + "Arm")] =
      rotation_x(-shoulder_flexion(phase) * kDegree) * rotation_z(sign * 6.0 * kDegree);
  local[s.find(side + "ForeArm")] =
      rotation_y(sign * -12.0 * kDegree) * rotation_x(-elbow_flexion(phase) * kDegree);
}

// Spine and chest undo the pelvis' list and tilt and turn against it (shoulders against hips); neck
// and head keep the face ahead.
void set_trunk(GaitCycle& cycle, quat* local, double phase) {
  const Skeleton& s = cycle.skeleton;
  const double turn = -0.75 * kRotation.at(phase) * kDegree;
  const double list = 0.5 * kObliquity.at(phase) * kDegree;
  const double tilt = -0.5 * (kTilt.at(phase) - kTilt.mean) * kDegree;
  const quat half = rotation_y(turn) * rotation_z(list) * rotation_x(tilt);
  local[s.find("Spine")] = half;
  local[s.find("Chest")] = half;
  const quat face = rotation_y(0.25 * kRotation.at(phase) * kDegree);
  local[s.find("Neck")] = face;
  local[s.find("Head")] = face;
}

// The joint on the other side, or the joint itself.
std::vector<int> mirror_joints(const Skeleton& skeleton) {
  std::vector<int> partner(skeleton.joints.size());
  for (std::size_t j = 0; j < partner.size(); ++j) {
    const std::string& name = skeleton.joints[j].name;
    partner[j] = static_cast<int>(j);
    if (name.starts_with("Left")) partner[j] = skeleton.find("Right" + name.substr(4));
    if (name.starts_with("Right")) partner[j] = skeleton.find("Left" + name.substr(5));
  }
  return partner;
}

void fill_locals(GaitCycle& cycle) {
  const std::size_t joints = cycle.skeleton.joints.size();
  const std::vector<int> partner = mirror_joints(cycle.skeleton);
  cycle.local.assign(kCycleSamples * joints, kIdentity);
  for (int i = 0; i < kHalf; ++i) {
    const double phase = double(i) / kCycleSamples;
    quat* now = cycle.local.data() + i * joints;
    quat* later = cycle.local.data() + (i + kHalf) * joints;
    now[cycle.pelvis] = cycle.samples[i].pelvis;
    set_trunk(cycle, now, phase);
    set_arm(cycle, now, "Right", -1.0, phase);
    set_arm(cycle, now, "Left", 1.0, phase + 0.5);
    for (int side = 0; side < 2; ++side) {
      set_leg_locals(cycle.skeleton, cycle.leg[side], pose_of(cycle, side, cycle.samples[i]), now);
    }
    for (std::size_t j = 0; j < joints; ++j) later[partner[j]] = gaitpad::mirrored(now[j]);
  }
}

// The length at which the standing foot stays in place: the heel from foot flat to mid-stance, then
// the ball until it leaves.
double stride_length(const GaitCycle& cycle) {
  constexpr int kFlat = kCycleSamples * 6 / 100, kMiddle = kCycleSamples * 30 / 100,
                kRise = kCycleSamples * 55 / 100;
  const auto point = [&](int i) {
    const LegPose p = pose_of(cycle, kRightSide, cycle.samples[i]);
    return vec2(p.heel_m.z, p.toe_m.z) - vec2(cycle.samples[i].pelvis_m.z);
  };
  const double back_m = (point(kFlat) - point(kMiddle)).x + (point(kMiddle) - point(kRise)).y;
  return back_m * kCycleSamples / (kRise - kFlat);
}

}  // namespace

GaitCycle procedural_gait() {
  constexpr double kToeOff = 0.62;
  GaitCycle cycle = procedural_body();
  fill_angles(cycle);
  fill_pelvis_path(cycle);
  fill_locals(cycle);
  cycle.stride_m = stride_length(cycle);
  cycle.duration_s = std::floor(cycle.stride_m / kSpeed * kFrameRate + 0.5) / kFrameRate;
  cycle.step_m = {0.5 * cycle.stride_m, 0.5 * cycle.stride_m};
  const double heel_m = cycle.leg[kLeftSide].heel_m.x;  // toes out: the heel stands further in
  cycle.track_m = {kTrack + heel_m, -kTrack - heel_m};
  cycle.strike = {0.5, 0.0};
  cycle.toe_off = {kToeOff - 0.5, kToeOff};
  return cycle;
}

Motion procedural_motion() {
  const GaitCycle cycle = procedural_gait();
  Motion motion;
  motion.name = cycle.name;
  motion.skeleton = cycle.skeleton;
  motion.pelvis = cycle.pelvis;
  motion.legs = {cycle.leg[kLeftSide].joints, cycle.leg[kRightSide].joints};
  motion.frame_time_s = 1.0 / kFrameRate;
  const int stride_frames = static_cast<int>(std::floor(cycle.duration_s * kFrameRate + 0.5));
  Pose pose;
  for (int f = 0; f <= kStridesInMotion * stride_frames; ++f) {
    const double strides = double(f) / stride_frames;
    sample_local(cycle, strides, pose);
    MotionFrame frame;
    frame.root_m = sample_at(cycle, strides).pelvis_m + kForward * (strides * cycle.stride_m);
    frame.local.assign(pose.local.begin(), pose.local.begin() + pose.joint_count);
    motion.frames.push_back(frame);
  }
  return motion;
}

}  // namespace gaitpad
