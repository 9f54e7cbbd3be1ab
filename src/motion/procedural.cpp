#include "motion/procedural.h"

#include <algorithm>
#include <limits>

namespace gaitpad {
namespace {

// --- The adult -----------------------------------------------------------------------------------

// Segment lengths, here and below, are fractions of the stature H (Drillis & Contini, in Winter's
// tables). The hip joints stand closer than Winter's .0955 H, which is half the pelvis' outer
// breadth. Thigh and shank are 0.245 + 0.246 of the stature.
constexpr double kStature_m = kReferenceLeg_m / 0.491;
constexpr double kThigh_m = kReferenceLeg_m * 0.245 / 0.491;
constexpr double kShank_m = kReferenceLeg_m - kThigh_m;
constexpr double kHipDrop_m = 0.03 * kStature_m;  // height of the pelvis joint above the hip joints
constexpr double kAnkleHeight_m = 0.039 * kStature_m;  // above the floor, standing
// Heel and ball from the ankle, tip from the ball; then the heights of ball and tip of a standing
// foot.
constexpr double kHeelBack_m = 0.05, kBallForward_m = 0.13, kToeLength_m = 0.06;
constexpr double kBallRest_m = 0.02, kToeEndRest_m = 0.01;
constexpr double kToeOut = 7.0 * kDegree;
// Distance from the pelvis joint to the height of the shoulders.
constexpr double kTrunk_m = 0.288 * kStature_m - kHipDrop_m;

struct Builder {
  Skeleton skeleton;
  int add(const std::string& name, int parent, const vec3& offset_m, bool end = false) {
    skeleton.joints.push_back({name, parent, offset_m, end});
    return static_cast<int>(skeleton.joints.size()) - 1;
  }
};

vec3 turned_out(double sign, const vec3& v) { return rotation_y(sign * kToeOut) * v; }

LegModel add_leg(Builder& body, int hips, const std::string& side, double sign) {
  LegModel leg;
  leg.hip_m = vec3(sign * 0.052 * kStature_m, -kHipDrop_m, 0.0);
  leg.thigh_m = kThigh_m;
  leg.shank_m = kShank_m;
  leg.heel_m = turned_out(sign, vec3(0.0, -kAnkleHeight_m, -kHeelBack_m));
  leg.toe_m = turned_out(sign, vec3(0.0, kBallRest_m - kAnkleHeight_m, kBallForward_m));
  leg.toe_end_m = turned_out(sign, vec3(0.0, kToeEndRest_m - kBallRest_m, kToeLength_m));
  leg.toe_rest_m = kBallRest_m;
  leg.toe_end_rest_m = kToeEndRest_m;
  leg.standing = {kIdentity, kIdentity, kIdentity, kIdentity};
  LegJoints& j = leg.joints;
  j.hip = body.add(side + "UpLeg", hips, leg.hip_m);
  j.knee = body.add(side + "Leg", j.hip, vec3(0.0, -kThigh_m, 0.0));
  j.ankle = body.add(side + "Foot", j.knee, vec3(0.0, -kShank_m, 0.0));
  j.toe = body.add(side + "ToeBase", j.ankle, leg.toe_m);
  j.toe_end = body.add(side + "ToeBase_End", j.toe, leg.toe_end_m, true);
  return leg;
}

void add_arm(Builder& body, int chest, const std::string& side, double sign) {
  const double collar = 0.035 * kStature_m;
  const int shoulder =
      body.add(side + "Shoulder", chest, vec3(sign * collar, 0.45 * kTrunk_m, 0.0));
  const int arm =
      body.add(side + "Arm", shoulder, vec3(sign * (0.1295 * kStature_m - collar), 0.0, 0.0));
  const int forearm = body.add(side + "ForeArm", arm, vec3(0.0, -0.186 * kStature_m, 0.0));
  const int hand = body.add(side + "Hand", forearm, vec3(0.0, -0.146 * kStature_m, 0.0));
  body.add(side + "Hand_End", hand, vec3(0.0, -0.108 * kStature_m, 0.0), true);
}

}  // namespace

GaitCycle procedural_body() {
  GaitCycle cycle;
  Builder body;
  const int hips = body.add("Hips", -1, vec3(0.0));
  cycle.leg[kLeftSide] = add_leg(body, hips, "Left", 1.0);
  cycle.leg[kRightSide] = add_leg(body, hips, "Right", -1.0);
  const int spine = body.add("Spine", hips, vec3(0.0, 0.15 * kTrunk_m, 0.0));
  const int chest = body.add("Chest", spine, vec3(0.0, 0.40 * kTrunk_m, 0.0));
  add_arm(body, chest, "Left", 1.0);
  add_arm(body, chest, "Right", -1.0);
  const int neck = body.add("Neck", chest, vec3(0.0, 0.50 * kTrunk_m, 0.0));
  const int head = body.add("Head", neck, vec3(0.0, 0.05 * kStature_m, 0.0));
  body.add("Head_End", head, vec3(0.0, 0.115 * kStature_m, 0.0), true);
  cycle.name = "procedural";
  cycle.skeleton = body.skeleton;
  cycle.pelvis = hips;
  cycle.standing_local.assign(cycle.skeleton.joints.size(), kIdentity);
  return cycle;
}

// --- A leg given in the plane of travel ----------------------------------------------------------

LegSample right_leg_in_plane(const LegModel& model, const CycleSample& body,
                             const SagittalLeg& plane, double track_m) {
  const double drop =
      model.thigh_m * sin_cos(plane.thigh).cos + model.shank_m * sin_cos(plane.shank).cos;
  const double aside = -track_m - (body.pelvis_m + body.pelvis * model.hip_m).x;
  // A leg shorter than its sideways shift points sideways: it cannot reach down.
  const double down = std::sqrt(std::max(0.0, drop * drop - aside * aside));
  const quat tilt = rotation_z(gaitpad::atan2(aside, down));
  const quat thigh = tilt * rotation_x(plane.thigh), shank = tilt * rotation_x(plane.shank);
  const AnglesXzy hip = angles_xzy(glm::conjugate(body.pelvis) * thigh);
  const AnglesXzy ankle = angles_xzy(glm::conjugate(shank) * rotation_x(plane.foot));
  LegSample leg;
  leg.angles = {hip.x, hip.z, hip.y, plane.shank - plane.thigh, ankle.x, ankle.z, ankle.y};
  leg.toe_x = plane.toe;
  return leg;
}

LegSample mirrored(const LegSample& leg) {
  LegSample m = leg;
  for (const int d : {kHipZ, kHipY, kAnkleZ, kAnkleY}) m.angles[d] = -leg.angles[d];
  return m;
}

std::vector<double> heights_on_lower_foot(const GaitCycle& cycle, int samples, int harmonics) {
  std::vector<double> height(samples, -std::numeric_limits<double>::infinity()), smooth(samples);
  for (int i = 0; i < samples; ++i) {
    for (int side = 0; side < 2; ++side) {
      const LegModel& model = cycle.leg[side];
      const LegPose p = pose_of(cycle, side, cycle.samples[i]);
      height[i] = std::max({height[i], -p.heel_m.y, model.toe_rest_m - p.toe_m.y,
                            model.toe_end_rest_m - p.toe_end_m.y});
    }
  }
  for (int k = 0; k <= harmonics; ++k) {
    const auto wave = [&](int i) { return sin_cos(2.0 * kPi * k * i / samples); };
    double a = 0.0, b = 0.0;
    for (int i = 0; i < samples; ++i) a += height[i] * wave(i).cos, b += height[i] * wave(i).sin;
    const double share = (k == 0 ? 1.0 : 2.0) / samples;
    for (int i = 0; i < samples; ++i) smooth[i] += share * (a * wave(i).cos + b * wave(i).sin);
  }
  return smooth;
}

namespace {

// --- The walk ------------------------------------------------------------------------------------

// Published normative joint curves. Sources: hip, knee, ankle, pelvic tilt: six-harmonic fits of an
// adult data set (gaitutils, normal.gcd). Pelvic obliquity and rotation: fits of Schwartz,
// Rozumalski & Trost 2008 (free speed), odd harmonics only, which makes the two sides exact mirror
// images. Pelvis sway, shoulders, elbows: Boulic, Magnenat-Thalmann & Thalmann 1990, their knots
// replaced by the nearest few harmonics.

constexpr double kSpeed_m_s = 1.25;  // approximately: the stride's time is rounded to whole frames
constexpr double kFrameRate_hz = 120.0;   // of procedural_motion()
constexpr double kTrack_m = 0.05;         // distance of each foot from the middle line
constexpr int kHalf = kCycleSamples / 2;  // samples of half a cycle
constexpr int kStridesInMotion = 4;       // of procedural_motion()

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
// Flexions of hip, knee and ankle; tilt, obliquity and rotation of the pelvis; over a cycle, in
// degrees.
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

// The fit falls to 0 at heel strike, but a knee is never quite straight.
double knee_flexion(double phase) {
  return (1.5 + soft_positive(kKnee.at(phase) - 1.5, 2.0)) * kDegree;
}

// In the data set the foot is 5 degrees toe-up at mid-stance and its toe grazes the floor in late
// swing, because its markers are not on the sole. One cosine lays the standing foot flat and lifts
// the swinging toe.
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
                                            sagittal_leg(double(i) / kCycleSamples), kTrack_m);
    CycleSample& later = cycle.samples[(i + kHalf) % kCycleSamples];
    later.leg[kLeftSide] = mirrored(at.leg[kRightSide]);
  }
}

// The pelvis' height puts the lower foot on the floor. Fore and aft it swings by 70 % of the
// amplitude at which the standing foot slides least (least squares over heel and ball), so it is
// slowest over that foot. (Boulic's fore-aft curve, as ported, runs the other way and makes the
// foot slide.)
void fill_pelvis_path(GaitCycle& cycle) {
  // Even harmonics up to 6: it repeats every half cycle.
  const std::vector<double> height = heights_on_lower_foot(cycle, kHalf, 3);
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
  constexpr int kFlatSample = kCycleSamples * 6 / 100, kMiddleSample = kCycleSamples * 30 / 100,
                kRiseSample = kCycleSamples * 55 / 100;
  const auto point = [&](int i) {
    const LegPose p = pose_of(cycle, kRightSide, cycle.samples[i]);
    return vec2(p.heel_m.z, p.toe_m.z) - vec2(cycle.samples[i].pelvis_m.z);
  };
  const double back_m =
      (point(kFlatSample) - point(kMiddleSample)).x + (point(kMiddleSample) - point(kRiseSample)).y;
  return back_m * kCycleSamples / (kRiseSample - kFlatSample);
}

}  // namespace

GaitCycle procedural_gait() {
  constexpr double kToeOff = 0.62;  // phase at which the foot leaves: a share of the cycle
  GaitCycle cycle = procedural_body();
  cycle.pace = Pace::adult;
  fill_angles(cycle);
  fill_pelvis_path(cycle);
  fill_locals(cycle);
  cycle.stride_m = stride_length(cycle);
  cycle.duration_s = std::floor(cycle.stride_m / kSpeed_m_s * kFrameRate_hz + 0.5) / kFrameRate_hz;
  cycle.frames = cycle.duration_s * kFrameRate_hz;  // procedural_motion() from its frame 0 on
  cycle.step_m = {0.5 * cycle.stride_m, 0.5 * cycle.stride_m};
  // The toes point outwards, so the heels are closer.
  const double heel_m = cycle.leg[kLeftSide].heel_m.x;
  cycle.track_m = {kTrack_m + heel_m, -kTrack_m - heel_m};
  cycle.strike = {0.5, 0.0};
  cycle.toe_off = {kToeOff - 0.5, kToeOff};
  return cycle;
}

Motion procedural_motion() {
  const GaitCycle cycle = procedural_gait();
  Motion motion;
  motion.name = cycle.name;
  motion.pace = cycle.pace;
  motion.skeleton = cycle.skeleton;
  motion.pelvis = cycle.pelvis;
  motion.legs = {cycle.leg[kLeftSide].joints, cycle.leg[kRightSide].joints};
  motion.frame_time_s = 1.0 / kFrameRate_hz;
  const int stride_frames = static_cast<int>(std::floor(cycle.duration_s * kFrameRate_hz + 0.5));
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
