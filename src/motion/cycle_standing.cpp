#include "motion/cycle_standing.h"

#include <algorithm>

#include "motion/cycle_leg.h"

namespace gaitpad {
namespace {

constexpr double kHeelShare = 0.3;       // heel behind the ankle, of ankle to toe
constexpr double kOwnToe_legs = 0.155;   // where the skeleton has no toe: ball before the ankle
constexpr double kOwnAnkle_legs = 0.08;  // and ankle above the floor
constexpr double kShortestFoot_legs = 0.04;
constexpr double kLowestToe_legs = 0.16;  // a foot point deeper under the ankle is no sole
constexpr double kLeastAnkle_legs = 0.02;
constexpr double kMostToe = 70.0 * kDegree;  // what toes bend; some clips turn them all round

// Joints below `from` down to and without `to`, topmost first.
std::vector<int> joints_between(const Skeleton& skeleton, int from, int to) {
  std::vector<int> chain;
  for (int j = skeleton.joints[to].parent; j >= 0 && j != from; j = skeleton.joints[j].parent) {
    chain.insert(chain.begin(), j);
  }
  return chain;
}

// From joint `from` to joint `to`, in the frame of `from`, with the locals given.
vec3 link(const Skeleton& skeleton, const std::vector<quat>& local, int from, int to) {
  vec3 v = skeleton.joints[to].offset_m;
  for (int j = skeleton.joints[to].parent; j >= 0 && j != from; j = skeleton.joints[j].parent) {
    v = skeleton.joints[j].offset_m + local[j] * v;
  }
  return from == to ? vec3(0.0) : v;
}

std::vector<quat> mean_locals(const CapturedCycle& c) {
  std::vector<quat> mean, all(kCycleSamples);
  for (std::size_t j = 0; j < c.joints(); ++j) {
    for (int i = 0; i < kCycleSamples; ++i) all[i] = c.local[i * c.joints() + j];
    mean.push_back(mean_of(all));
  }
  return mean;
}

// The knee's hinge in the thigh's and the shank's joint frame: across the plane of hip, knee and
// ankle, where the knee is bent, positive for flexion.
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
    across[i] = glm::cross(thigh, shank);  // its length is the sine of the flexion
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
  quat foot, toe;  // joint frames
};
FlatPose flat_pose(const CapturedCycle& c, int side) {
  const FlatFoot flat = flat_foot(c, side);
  const CapturedLeg& leg = c.leg[side];
  return {mean_around(leg.ankle_m, flat.middle, FlatFoot::reach),
          mean_around(leg.ankle, flat.middle, FlatFoot::reach),
          mean_around(leg.toe, flat.middle, FlatFoot::reach)};
}

// Toe and toe end from the ankle and the toe, standing. An End Site may be anything: one of no
// length becomes a toe of usual length, one far under the foot does not count.
void build_toes(const FlatPose& flat, const std::vector<quat>& local, GaitCycle& out,
                LegModel& leg) {
  std::vector<Joint>& joints = out.skeleton.joints;
  LegJoints& j = leg.joints;
  const double leg_m = leg.length_m();
  const auto from_ankle = [&](int joint) {
    return flat.foot * link(out.skeleton, local, j.ankle, joint);
  };
  const auto is_short = [&](const vec3& v) {
    return std::sqrt(v.x * v.x + v.z * v.z) < kShortestFoot_legs * leg_m;
  };
  if (is_short(from_ankle(j.toe)) && !is_short(from_ankle(j.toe_end))) j.toe = j.toe_end;
  if (is_short(from_ankle(j.toe))) {
    const vec3 wanted(0.0, -kOwnAnkle_legs * leg_m, kOwnToe_legs * leg_m);
    const vec3 missing = glm::conjugate(flat.foot) * (wanted - from_ankle(j.toe));
    vec3 turned = missing;  // into the frame of the toe's parent
    for (const int k : joints_between(out.skeleton, j.ankle, j.toe)) {
      turned = glm::conjugate(local[k]) * turned;
    }
    joints[j.toe].offset_m += turned;
  }
  leg.toe_m = from_ankle(j.toe);
  leg.toe_end_m = joints[j.toe].is_end_site || j.toe == j.toe_end
                      ? vec3(0.0)
                      : flat.toe * link(out.skeleton, local, j.toe, j.toe_end);
  const bool is_odd = leg.toe_m.y + leg.toe_end_m.y < -kLowestToe_legs * leg_m ||
                      leg.toe_m.y + leg.toe_end_m.y > 0.0;
  if (is_odd) {
    j.toe_end = j.toe;
    leg.toe_end_m = vec3(0.0);
  }
}

// Heel point and the toes' rest heights for an ankle that stands so high above the floor.
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
  if (j.toe < 0 || j.toe_end < 0) return Error{"has no joint and no End Site below an ankle"};
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
  quat above = kIdentity;
  for (int j = c.skeleton.joints[c.pelvis].parent; j >= 0; j = c.skeleton.joints[j].parent) {
    above = local[j] * above;
  }
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
  std::array<FlatPose, 2> flat;
  double floor_m = 0.0;
  for (int side = 0; side < 2; ++side) {
    Result<LegModel> leg = leg_bones(c, side, out, local);
    if (!leg) return leg.error();
    flat[side] = flat_pose(c, side);
    build_toes(flat[side], local, out, *leg);
    leg->standing[2] = flat[side].foot;
    leg->standing[3] = flat[side].toe;
    const double lowest = std::min(
        {leg->toe_m.y, leg->toe_m.y + leg->toe_end_m.y, -kLeastAnkle_legs * leg->length_m()});
    const double under_m = flat[side].ankle_m.y + lowest;
    // Each foot stands on its own lowest point: captured floors are uneven by a centimetre or two,
    // and a character with one foot in the air would stand crooked.
    floor_m += 0.5 * under_m;
    build_sole(-lowest, *leg);
    out.leg[side] = *leg;
  }
  build_standing_local(c, local, out);
  return floor_m;
}

namespace {

// 0 below -width, x above +width, smooth between.
double soft_positive(double x, double width) {
  if (x <= -width) return 0.0;
  if (x >= width) return x;
  return (x + width) * (x + width) / (4.0 * width);
}

// Flexion that carries the ankle to `reach_m` from the hip; a nearly straight knee keeps the
// captured angle, because there the distance says nothing.
double knee_angle(const LegModel& leg, double captured_rad, double reach_m) {
  const double cosine =
      (reach_m * reach_m - leg.thigh_m * leg.thigh_m - leg.shank_m * leg.shank_m) /
      (2.0 * leg.thigh_m * leg.shank_m);
  const double by_reach = gaitpad::acos(cosine);
  const double share = smoothstep(4.0 * kDegree, 12.0 * kDegree, captured_rad);
  const double knee = mix(captured_rad, by_reach, share);
  // A knee that stops short of straight must do so over some degrees: it comes at 300 degrees/s.
  constexpr double kLeast = 1.5 * kDegree, kWidth = 5.0 * kDegree;
  return kLeast + soft_positive(knee - kLeast, kWidth);
}

// The knee's hinge in the frame of the joint above the knee (a twist joint where there is one).
vec3 hinge_above_knee(const GaitCycle& cycle, int side) {
  const LegModel& leg = cycle.leg[side];
  vec3 hinge = glm::conjugate(leg.standing[0]) * kLeft;
  for (const int j : joints_between(cycle.skeleton, leg.joints.hip, leg.joints.knee)) {
    hinge = glm::conjugate(cycle.standing_local[j]) * hinge;
  }
  return hinge;
}

// Leg angles that put the ankle and the foot where they were captured, the knee's hinge as near to
// its captured direction as the leg's line allows.
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

// Angles go on from the sample before; quaternions stay in its hemisphere.
void make_continuous(GaitCycle& out) {
  for (int i = 1; i < kCycleSamples; ++i) {
    for (int side = 0; side < 2; ++side) {
      const LegSample& before = out.samples[i - 1].leg[side];
      LegSample& leg = out.samples[i].leg[side];
      for (int d = 0; d < kLegDofs; ++d) {
        leg.angles[d] = before.angles[d] + wrapped(leg.angles[d] - before.angles[d]);
      }
      leg.toe_x = before.toe_x + wrapped(leg.toe_x - before.toe_x);
      if (glm::dot(leg.foot, before.foot) < 0.0) leg.foot = -leg.foot;
    }
    quat& pelvis = out.samples[i].pelvis;
    if (glm::dot(pelvis, out.samples[i - 1].pelvis) < 0.0) pelvis = -pelvis;
  }
  const std::size_t joints = out.standing_local.size();
  for (std::size_t k = joints; k < out.local.size(); ++k) {
    if (glm::dot(out.local[k], out.local[k - joints]) < 0.0) out.local[k] = -out.local[k];
  }
}

}  // namespace

void build_samples(const CapturedCycle& c, double floor_m, GaitCycle& out) {
  const vec3 down = -floor_m * kUp;
  out.local = c.local;
  out.samples.assign(kCycleSamples, CycleSample{});
  const std::array<vec3, 2> hinge = {hinge_above_knee(out, kLeftSide),
                                     hinge_above_knee(out, kRightSide)};
  for (int i = 0; i < kCycleSamples; ++i) {
    CycleSample& at = out.samples[i];
    at.pelvis_m = c.pelvis_m[i] + down;
    at.pelvis = c.pelvis_rotation[i] * glm::conjugate(out.pelvis_standing);
    quat* local = out.local.data() + i * c.joints();
    for (int side = 0; side < 2; ++side) {
      const LegModel& model = out.leg[side];
      const LegJoints& j = model.joints;
      const vec3 hip_m = c.pelvis_m[i] + at.pelvis * model.hip_m;
      LegSample& leg = at.leg[side];
      leg = leg_sample(c.leg[side], i, model, hinge[side], hip_m, at.pelvis);
      leg.ankle_m += down;
      for (const auto& [from, to] :
           {std::pair{c.pelvis, j.hip}, {j.hip, j.knee}, {j.knee, j.ankle}, {j.ankle, j.toe}}) {
        for (const int k : joints_between(c.skeleton, from, to)) local[k] = out.standing_local[k];
      }
      const LegPose pose = leg_pose(model, at.pelvis_m, at.pelvis, leg.angles, leg.toe_x);
      set_leg_locals(out.skeleton, model, pose, local);
    }
  }
  make_continuous(out);
}

}  // namespace gaitpad
