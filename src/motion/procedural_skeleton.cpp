#include "motion/procedural_skeleton.h"

namespace gaitpad {
namespace {

// Segment lengths as fractions of the stature H (Drillis & Contini, in Winter's tables). The hip
// joints stand closer than Winter's .0955 H, which is half the pelvis' outer breadth.
constexpr double kLeg = 0.84;              // thigh + shank, metres
constexpr double kStature = kLeg / 0.491;  // .245 + .246
constexpr double kThigh = kLeg * 0.245 / 0.491;
constexpr double kShank = kLeg - kThigh;
constexpr double kHipHalf = 0.052 * kStature;
constexpr double kHipDrop = 0.03 * kStature;  // hip joints under the pelvis joint
constexpr double kAnkleHeight = 0.039 * kStature;
constexpr double kHeelBack = 0.05, kBallForward = 0.13, kToeLength = 0.06;
constexpr double kBallRest = 0.02, kToeEndRest = 0.01;
constexpr double kToeOut = 7.0 * kDegree;
constexpr double kShoulderHalf = 0.1295 * kStature;
constexpr double kUpperArm = 0.186 * kStature, kForearm = 0.146 * kStature,
                 kHand = 0.108 * kStature;
constexpr double kTrunk = 0.288 * kStature - kHipDrop;  // pelvis joint to shoulder height

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
  leg.hip_m = vec3(sign * kHipHalf, -kHipDrop, 0.0);
  leg.thigh_m = kThigh;
  leg.shank_m = kShank;
  leg.heel_m = turned_out(sign, vec3(0.0, -kAnkleHeight, -kHeelBack));
  leg.toe_m = turned_out(sign, vec3(0.0, kBallRest - kAnkleHeight, kBallForward));
  leg.toe_end_m = turned_out(sign, vec3(0.0, kToeEndRest - kBallRest, kToeLength));
  leg.toe_rest_m = kBallRest;
  leg.toe_end_rest_m = kToeEndRest;
  leg.standing = {kIdentity, kIdentity, kIdentity, kIdentity};
  LegJoints& j = leg.joints;
  j.hip = body.add(side + "UpLeg", hips, leg.hip_m);
  j.knee = body.add(side + "Leg", j.hip, vec3(0.0, -kThigh, 0.0));
  j.ankle = body.add(side + "Foot", j.knee, vec3(0.0, -kShank, 0.0));
  j.toe = body.add(side + "ToeBase", j.ankle, leg.toe_m);
  j.toe_end = body.add(side + "ToeBase_End", j.toe, leg.toe_end_m, true);
  return leg;
}

void add_arm(Builder& body, int chest, const std::string& side, double sign) {
  const double collar = 0.035 * kStature;
  const int shoulder = body.add(side + "Shoulder", chest, vec3(sign * collar, 0.45 * kTrunk, 0.0));
  const int arm = body.add(side + "Arm", shoulder, vec3(sign * (kShoulderHalf - collar), 0.0, 0.0));
  const int forearm = body.add(side + "ForeArm", arm, vec3(0.0, -kUpperArm, 0.0));
  const int hand = body.add(side + "Hand", forearm, vec3(0.0, -kForearm, 0.0));
  body.add(side + "Hand_End", hand, vec3(0.0, -kHand, 0.0), true);
}

}  // namespace

GaitCycle procedural_body() {
  GaitCycle cycle;
  Builder body;
  const int hips = body.add("Hips", -1, vec3(0.0));
  cycle.leg[kLeftSide] = add_leg(body, hips, "Left", 1.0);
  cycle.leg[kRightSide] = add_leg(body, hips, "Right", -1.0);
  const int spine = body.add("Spine", hips, vec3(0.0, 0.15 * kTrunk, 0.0));
  const int chest = body.add("Chest", spine, vec3(0.0, 0.40 * kTrunk, 0.0));
  add_arm(body, chest, "Left", 1.0);
  add_arm(body, chest, "Right", -1.0);
  const int neck = body.add("Neck", chest, vec3(0.0, 0.50 * kTrunk, 0.0));
  const int head = body.add("Head", neck, vec3(0.0, 0.05 * kStature, 0.0));
  body.add("Head_End", head, vec3(0.0, 0.115 * kStature, 0.0), true);
  cycle.name = "procedural";
  cycle.skeleton = body.skeleton;
  cycle.pelvis = hips;
  cycle.standing_local.assign(cycle.skeleton.joints.size(), kIdentity);
  return cycle;
}

}  // namespace gaitpad
