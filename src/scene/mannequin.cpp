#include "scene/mannequin.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "gaitpad/anatomy.h"

namespace gaitpad {
namespace {

// An adult's distance from the hip joints to the shoulder joints.
constexpr double kAdultTrunk_m = 0.50;
constexpr double kAdultArm_m = 0.57;  // an adult's distance from shoulder over elbow to wrist
// Half depth of the trunk, its width / depth, and the distance of its middle ahead of the spine's
// joints, from the hips (height 0) to the shoulders (1). Proportions:
// tests/view/mannequin_test.cpp.
struct Girth {
  double height, radius_m, width, ahead_m;
};
constexpr Girth kTrunk[] = {{-0.02, 0.098, 1.68, -0.010}, {0.18, 0.093, 1.62, 0.000},
                            {0.40, 0.090, 1.56, 0.010},   {0.70, 0.106, 1.43, 0.006},
                            {0.90, 0.100, 1.42, -0.006},  {1.02, 0.060, 1.15, -0.012},
                            {1.10, 0.056, 1.0, -0.006}};

Girth girth_at(double height) {
  if (height <= kTrunk[0].height) return kTrunk[0];
  for (std::size_t i = 1; i < std::size(kTrunk); ++i) {
    const Girth &below = kTrunk[i - 1], &above = kTrunk[i];
    if (height > above.height) continue;
    const double share = (height - below.height) / (above.height - below.height);
    return {height, mix(below.radius_m, above.radius_m, share),
            mix(below.width, above.width, share), mix(below.ahead_m, above.ahead_m, share)};
  }
  return kTrunk[std::size(kTrunk) - 1];
}

vec3 between(const vec3& a, const vec3& b, double t) { return a + (b - a) * t; }

// A place that is fixed to a joint.
struct Held {
  int joint = 0;
  vec3 at_m{0.0};  // the place in the standing pose, world frame
};

class Builder {
 public:
  explicit Builder(Mannequin& mannequin)
      : mannequin_(mannequin),
        model_(*mannequin.model),
        joints_(model_.body.joints),
        leg_(model_.size) {
    stand();
    find_trunk();
    const vec3 trunk = shoulders_m_ - hips_m_;
    size_ = std::clamp((glm::length(trunk) / kAdultTrunk_m + arm_size() + leg_) / 3.0, 0.4 * leg_,
                       2.5 * leg_);
    along_ = glm::length(trunk) > 1e-3 ? trunk / glm::dot(trunk, trunk) : kUp / kAdultTrunk_m;
  }
  void build();
  void build_coarsely();

 private:
  void stand();
  void find_trunk();
  vec3 at(int joint) const { return standing_.position_m[joint]; }
  Held held(int joint) const { return {joint, at(joint)}; }
  Held held(int joint, const vec3& offset_m) const { return {joint, at(joint) + offset_m}; }
  vec3 local(int joint, const vec3& world_m) const {
    return glm::conjugate(standing_.rotation[joint]) * (world_m - at(joint));
  }
  // Radii are in metres of the character; `wide` is a direction of the world in the standing pose.
  MannequinBone& add(const Held& from, const Held& to, double radius_from_m, double radius_to_m,
                     const vec3& wide = vec3(0.0), double width = 1.0);
  void make_pale(int last);  // Marks the bones from number `last` on as pale.
  void add_leg(Side side);
  void add_foot(const LegModel& leg);
  void add_pelvis();
  void add_trunk();
  void add_head();
  void add_arm(Side side);
  void add_hand(const ArmChain& arm);
  double arm_size() const;
  double height_of(const vec3& at_m) const { return glm::dot(at_m - hips_m_, along_); }

  Mannequin& mannequin_;
  const WalkModel& model_;
  const UpperBodyJoints& joints_;
  JointFrames standing_;    // joint frames in the world, facing +z, the feet on the floor
  std::vector<int> trunk_;  // the trunk's joints from the root upwards to the head
  // Middles of the left and right joints; estimated if an arm is missing.
  vec3 hips_m_{0.0}, shoulders_m_{0.0};
  double leg_, size_ = 1.0;  // lengths relative to an adult's: of the legs, of the rest
  vec3 along_{0.0};          // along_ * (place - hips) is 0 at the hips and 1 at the shoulders
};

void Builder::stand() {
  Pose pose;
  pose.joint_count = static_cast<int>(model_.cycle.skeleton.joints.size());
  for (int j = 0; j < pose.joint_count; ++j) pose.local[j] = model_.cycle.standing_local[j];
  forward_kinematics(model_.cycle.skeleton, pose, standing_);
  double lowest_m = at(model_.leg[kLeftSide].model.joints.ankle).y;
  for (const LegBuild& leg : model_.leg) {
    lowest_m = std::min(lowest_m, at(leg.model.joints.ankle).y + leg.model.heel_m.y);
  }
  for (int j = 0; j < pose.joint_count; ++j) standing_.position_m[j].y -= lowest_m;
  hips_m_ = 0.5 * (at(model_.leg[kLeftSide].model.joints.hip) +
                   at(model_.leg[kRightSide].model.joints.hip));
  const ArmChain &left = joints_.arm[kLeftSide], &right = joints_.arm[kRightSide];
  shoulders_m_ = left.is_found() && right.is_found()
                     ? 0.5 * (at(left.shoulder) + at(right.shoulder))
                     : hips_m_ + kUp * (kAdultTrunk_m * leg_);
}

// Finds the joints from the root to the head, or to the joint that carries the arms if there is no
// head. If several joints are at one place, the last one is used, because it rotates the following
// bone.
void Builder::find_trunk() {
  int top = joints_.head;
  if (top < 0 && !joints_.spine.empty()) top = joints_.spine.back();
  for (int j = top; j >= 0; j = model_.cycle.skeleton.joints[j].parent) {
    if (trunk_.empty() || glm::distance(at(j), at(trunk_.front())) >= 1e-4) {
      trunk_.insert(trunk_.begin(), j);
    }
  }
}

// Size of the longer arm relative to an adult's; the legs' size if there is no arm.
double Builder::arm_size() const {
  double longest_m = 0.0;
  for (const ArmChain& arm : joints_.arm) {
    if (!arm.is_found()) continue;
    longest_m = std::max(longest_m, glm::distance(at(arm.shoulder), at(arm.elbow)) +
                                        glm::distance(at(arm.elbow), at(arm.wrist)));
  }
  return longest_m > 0.0 ? longest_m / kAdultArm_m : leg_;
}

MannequinBone& Builder::add(const Held& from, const Held& to, double radius_from_m,
                            double radius_to_m, const vec3& wide, double width) {
  MannequinBone bone;
  bone.from = from.joint;
  bone.to = to.joint;
  bone.from_m = local(from.joint, from.at_m);
  bone.to_m = local(to.joint, to.at_m);
  bone.radius_from_m = radius_from_m;
  bone.radius_to_m = radius_to_m;
  bone.wide = glm::conjugate(standing_.rotation[from.joint]) * wide;
  bone.wide_to = glm::conjugate(standing_.rotation[to.joint]) * wide;
  bone.width_from = bone.width_to = width;
  return mannequin_.bones.emplace_back(bone);
}

void Builder::make_pale(int last) {
  for (auto bone = mannequin_.bones.end() - last; bone != mannequin_.bones.end(); ++bone) {
    bone->is_pale = true;
  }
}

// Twist joints between hip and knee or knee and ankle have a constant rotation, so they need no
// bone.
void Builder::add_leg(Side side) {
  const LegModel& leg = model_.leg[side].model;
  const Held hip = held(leg.joints.hip), knee = held(leg.joints.knee),
             ankle = held(leg.joints.ankle);
  const double inwards_m = std::copysign(0.010 * leg_, hips_m_.x - hip.at_m.x);
  add({hip.joint, hip.at_m + vec3(inwards_m, 0.0, 0.0)}, knee, 0.085 * leg_, 0.051 * leg_);
  const vec3 behind(0.0, 0.0, -0.016 * leg_);
  const Held calf{leg.joints.knee, knee.at_m + (ankle.at_m - knee.at_m) * 0.30 + behind};
  add(knee, calf, 0.049 * leg_, 0.060 * leg_);
  add(calf, ankle, 0.060 * leg_, 0.034 * leg_);
  add_foot(leg);
}

// Adds bones from the heel to the ball of the foot and from there to the end of the toes. The sole
// lies on the floor: the centre of a ball of radius r is r above it.
void Builder::add_foot(const LegModel& leg) {
  const LegJoints& j = leg.joints;
  const vec3 heel = at(j.ankle) + leg.heel_m, toe = at(j.toe), end = at(j.toe_end);
  vec3 ahead = toe - heel;
  ahead.y = 0.0;
  const double length_m = glm::length(ahead);
  if (length_m < 1e-3) return;
  ahead /= length_m;
  const vec3 side = glm::cross(kUp, ahead);
  const auto on_floor = [](const vec3& v, double radius_m) { return vec3(v.x, radius_m, v.z); };
  const double heel_m = std::min(0.036 * leg_, 0.35 * length_m), ball_m = 0.027 * leg_,
               tip_m = 0.019 * leg_;
  const Held back{j.ankle, on_floor(heel + ahead * (0.75 * heel_m), heel_m)};
  const Held ball{j.ankle, on_floor(toe, ball_m)};
  add(back, ball, heel_m, ball_m, side, 1.0).width_to = 1.55;
  const Held instep{j.ankle, at(j.ankle) + vec3(0.0, -0.012 * leg_, 0.0) + ahead * (0.012 * leg_)};
  add(instep, ball, 0.036 * leg_, 0.026 * leg_, side, 1.0).width_to = 1.45;
  make_pale(2);
  const vec3 tip = on_floor(end - ahead * tip_m, tip_m);
  if (glm::dot(tip - ball.at_m, ahead) < 0.01 * leg_) return;  // no toes, or toes without length
  MannequinBone& toes = add({j.toe, ball.at_m}, {j.toe, tip}, ball_m, tip_m, side, 1.55);
  toes.width_to = 1.7;
  toes.is_pale = true;
}

void Builder::add_pelvis() {
  const vec3 off(0.0, -0.014 * size_, -0.006 * size_);
  const int pelvis = model_.cycle.pelvis;
  const auto hip = [&](Side side) {
    return Held{pelvis, at(model_.leg[side].model.joints.hip) + off};
  };
  const double radius_m = 0.5 * (leg_ + size_) * 0.080;
  add(hip(kLeftSide), hip(kRightSide), radius_m, radius_m);
}

// Divides the trunk along the spine where its girth changes. Short bones of the spine are joined.
void Builder::add_trunk() {
  if (trunk_.empty()) return;
  const double shortest_m = 0.05 * size_;
  const auto add_piece = [&](const Held& from, const Held& to) {
    const Girth a = girth_at(height_of(from.at_m)), b = girth_at(height_of(to.at_m));
    const vec3 ahead_a = kForward * (a.ahead_m * size_), ahead_b = kForward * (b.ahead_m * size_);
    add({from.joint, from.at_m + ahead_a}, {to.joint, to.at_m + ahead_b}, a.radius_m * size_,
        b.radius_m * size_, kLeft, a.width)
        .width_to = b.width;
  };
  Held from = held(trunk_.front());
  for (std::size_t i = 1; i < trunk_.size(); ++i) {
    const Held to = held(trunk_[i]);
    const bool is_last = i + 1 == trunk_.size();
    if (!is_last && glm::distance(from.at_m, to.at_m) < shortest_m) continue;
    const int joint = from.joint;
    const vec3 start = from.at_m, way = to.at_m - start;
    const double below = height_of(start), rise = height_of(to.at_m) - below;
    const double margin = shortest_m / std::max(glm::length(way), shortest_m);
    for (const Girth& cut : kTrunk) {
      const double share = (cut.height - below) / std::max(rise, 1e-3);
      if (share < margin || share > 1.0 - margin) continue;
      const Held middle{joint, start + way * share};
      add_piece(from, middle);
      from = middle;
    }
    add_piece(from, to);
    from = to;
  }
}

// Neck, jaw with skull, and a nose that shows the direction of the head. The head has the
// skeleton's head height if that is plausible; a head joint between the shoulders gets a longer
// neck.
void Builder::add_head() {
  if (joints_.head < 0) return;
  constexpr double kHeight_m = 0.224;
  const double own_m = at(joints_.head_top).y - at(joints_.head).y;
  const bool is_likely = own_m > 0.16 * size_ && own_m < 0.27 * size_;
  // Skeletons measure the height from the joint below the skull; the chin is lower.
  const double from_joint = (is_likely ? own_m : 0.222 * size_) / kHeight_m;
  const double part = 1.13 * from_joint;
  vec3 base = at(joints_.head);
  base.y = std::max(base.y, shoulders_m_.y + 0.075 * size_) - (part - from_joint) * kHeight_m;
  const auto place = [&](double y, double z) {
    return Held{joints_.head, base + vec3(0.0, y, z) * part};
  };
  const Held jaw = place(0.050, 0.034), skull = place(0.130, 0.010);
  add(held(joints_.head), place(0.060, 0.000), 0.056 * size_, 0.053 * size_);
  add(jaw, skull, 0.054 * part, 0.094 * part, kLeft, 0.90).width_to = 0.81;
  add(place(0.112, 0.088), place(0.080, 0.092), 0.010 * part, 0.016 * part);
  make_pale(3);
  mannequin_.top = joints_.head;
  const vec3 top = base + vec3(0.0, kHeight_m * part, 0.0);
  mannequin_.top_m = local(joints_.head, top);
  mannequin_.height_m = top.y;
}

void Builder::add_arm(Side side) {
  const ArmChain& arm = joints_.arm[side];
  if (!arm.is_found()) return;
  const Held elbow = held(arm.elbow), wrist = held(arm.wrist);
  // The collar starts at the root of the neck and moves with the trunk joint that carries the arm.
  int chest = trunk_.front();
  for (const int j : trunk_) {
    if (is_ancestor(model_.cycle.skeleton, j, arm.shoulder)) chest = j;
  }
  // Most skeletons place the shoulder joint on the skin, so the shoulder is drawn further inwards.
  vec3 inwards = shoulders_m_ - at(arm.shoulder);
  inwards *= 0.036 * size_ / std::max(glm::length(inwards), 0.036 * size_);
  const Held shoulder = held(arm.shoulder, inwards - kUp * (0.008 * size_));
  const vec3 neck = between(at(chest), shoulder.at_m, 0.20);
  const Held collar{
      chest, vec3(neck.x, shoulder.at_m.y + 0.052 * size_, 0.5 * (neck.z + shoulder.at_m.z))};
  add(collar, shoulder, 0.046 * size_, 0.054 * size_);
  const Held deltoid{arm.shoulder, between(shoulder.at_m, elbow.at_m, 0.18)};
  add(shoulder, deltoid, 0.058 * size_, 0.062 * size_);
  add(deltoid, elbow, 0.062 * size_, 0.040 * size_);
  const Held bulge{arm.elbow, between(elbow.at_m, wrist.at_m, 0.26)};
  add(elbow, bulge, 0.039 * size_, 0.043 * size_).is_pale = true;
  add(bulge, wrist, 0.043 * size_, 0.027 * size_).is_pale = true;
  add_hand(arm);
}

// A flat hand with a thumb; its wide side points forward when standing.
void Builder::add_hand(const ArmChain& arm) {
  const Held wrist = held(arm.wrist);
  const vec3 forearm = at(arm.wrist) - at(arm.elbow);
  vec3 along = arm.hand_end >= 0 ? at(arm.hand_end) - wrist.at_m : forearm;
  double length_m = glm::length(along);
  if (length_m < 1e-4 || glm::length(forearm) < 1e-4) return;
  along /= length_m;
  length_m = arm.hand_end >= 0 ? std::clamp(length_m, 0.15 * size_, 0.20 * size_) : 0.17 * size_;
  vec3 wide = kForward - along * glm::dot(kForward, along);
  if (glm::length(wide) < 0.2) wide = kLeft - along * glm::dot(kLeft, along);
  wide = glm::normalize(wide);
  const auto spot = [&](double share, double aside_m) {
    return Held{arm.wrist, wrist.at_m + along * (share * length_m) + wide * (aside_m * size_)};
  };
  const Held knuckles = spot(0.50, 0.0);
  // Relaxed fingers are bent by 20 degrees towards the body.
  vec3 palmwards = shoulders_m_ - at(arm.shoulder);
  palmwards -= along * glm::dot(palmwards, along) + wide * glm::dot(palmwards, wide);
  if (glm::length(palmwards) > 1e-6) palmwards = glm::normalize(palmwards);
  const Held tips{arm.wrist,
                  knuckles.at_m + (along * 0.940 + palmwards * 0.342) * (0.43 * length_m)};
  add(spot(0.0, 0.0), knuckles, 0.022 * size_, 0.021 * size_, wide, 1.3).width_to = 1.95;
  add(knuckles, tips, 0.020 * size_, 0.012 * size_, wide, 1.95).width_to = 2.1;
  add(spot(0.18, 0.014), spot(0.55, 0.048), 0.015 * size_, 0.0105 * size_);
  make_pale(3);
}

void Builder::build() {
  mannequin_.top = model_.cycle.pelvis;
  mannequin_.height_m = at(mannequin_.top).y;
  add_pelvis();
  for (const Side side : {kLeftSide, kRightSide}) add_leg(side);
  add_trunk();
  for (const Side side : {kLeftSide, kRightSide}) add_arm(side);
  add_head();
}

// Adds one bone for each limb and three for the trunk.
void Builder::build_coarsely() {
  add_pelvis();
  for (const LegBuild& leg : model_.leg) {
    const LegJoints& j = leg.model.joints;
    add(held(j.hip), held(j.knee), 0.082 * leg_, 0.051 * leg_);
    add(held(j.knee), held(j.ankle), 0.053 * leg_, 0.034 * leg_);
    const double sole_m = 0.03 * leg_;
    const vec3 heel = at(j.ankle) + leg.model.heel_m, toe = at(j.toe);
    add({j.ankle, vec3(heel.x, sole_m, heel.z)}, {j.ankle, vec3(toe.x, sole_m, toe.z)}, sole_m,
        sole_m, kLeft, 1.4);
    make_pale(1);
  }
  if (!trunk_.empty()) {
    const auto nearest = [this](double height) {
      return *std::ranges::min_element(trunk_, {},
                                       [&](int j) { return std::fabs(height_of(at(j)) - height); });
    };
    const int middle = nearest(0.5), top = nearest(0.95);
    for (const auto& [from, to] : {std::pair(trunk_.front(), middle), {middle, top}}) {
      if (from == to) continue;
      const Girth a = girth_at(height_of(at(from)));
      const Girth b = girth_at(std::min(height_of(at(to)), 0.85));
      add(held(from), held(to), a.radius_m * size_, b.radius_m * size_, kLeft, a.width).width_to =
          b.width;
    }
  }
  for (const ArmChain& arm : joints_.arm) {
    if (!arm.is_found()) continue;
    add(held(arm.shoulder), held(arm.elbow), 0.058 * size_, 0.040 * size_);
    const vec3 forearm = at(arm.wrist) - at(arm.elbow);
    add(held(arm.elbow), held(arm.wrist, 0.5 * forearm), 0.038 * size_, 0.024 * size_);
    make_pale(1);
  }
  const ArmChain &left = joints_.arm[kLeftSide], &right = joints_.arm[kRightSide];
  if (left.is_found() && right.is_found()) {
    const int chest = model_.cycle.skeleton.joints[left.shoulder].parent;
    const vec3 inwards = 0.1 * (at(right.shoulder) - at(left.shoulder));
    add({chest, at(left.shoulder) + inwards}, {chest, at(right.shoulder) - inwards}, 0.058 * size_,
        0.058 * size_);
  }
  if (joints_.head < 0) return;
  const Held skull = held(joints_.head, vec3(0.0, 0.125 * size_, 0.014 * size_));
  add(held(joints_.head), held(joints_.head, vec3(0.0, 0.05 * size_, 0.0)), 0.047 * size_,
      0.045 * size_);
  add(held(joints_.head, vec3(0.0, 0.06 * size_, 0.03 * size_)), skull, 0.070 * size_,
      0.088 * size_);
  make_pale(2);
}

constexpr Colour kPale = {0.83, 0.84, 0.86};
constexpr double kPaleShare = 0.48;
constexpr double kStickLine_px = 3.2;
// Longest bones of a stick figure that are drawn, in leg lengths: joints of meshes may be far off.
constexpr double kLongestEnd = 0.5, kLongestLine = 0.9;
// Greatest depth of a foot in the ground; a deeper foot is beside a riser.
constexpr double kDeepest_m = 0.05;
// Shortest bones that are drawn, and that get a dot at the joint, in leg lengths: fingers get none.
constexpr double kShortestLine = 0.015, kShortestDotted = 0.045;

// Lifts an end that is slightly below the ground. A deeper end is beside a riser, not on its tread,
// and stays.
void put_on_ground(const Terrain* terrain, vec3& end_m, double radius_m, const vec3& wide,
                   double width) {
  const Ground ground = terrain == nullptr ? Ground() : ground_at(*terrain, end_m.x, end_m.z);
  const double upright = glm::dot(wide, ground.normal);
  const double reach_m =
      radius_m * std::sqrt(1.0 + upright * upright * std::max(width * width - 1.0, 0.0));
  const double above_m = (end_m.y - ground.height_m) * ground.normal.y;
  if (above_m > -kDeepest_m && above_m < reach_m) end_m.y += (reach_m - above_m) / ground.normal.y;
}

}  // namespace

Mannequin mannequin_of(std::shared_ptr<const WalkModel> model, MannequinDetail detail) {
  Mannequin mannequin;
  mannequin.model = std::move(model);
  Builder builder(mannequin);
  if (detail == MannequinDetail::full) {
    builder.build();
  } else {
    builder.build_coarsely();
  }
  return mannequin;
}

BonePlace place_of(const MannequinBone& bone, const JointFrames& frames) noexcept {
  return {frames.position_m[bone.from] + frames.rotation[bone.from] * bone.from_m,
          frames.position_m[bone.to] + frames.rotation[bone.to] * bone.to_m};
}

// The poses are a tick apart, so a normalised sum is exact enough.
quat between(const quat& a, const quat& b, double share) noexcept {
  const quat near = glm::dot(a, b) < 0.0 ? -b : b;
  const quat sum = a * (1.0 - share) + near * share;
  const double length = glm::length(sum);
  return length > 1e-9 ? sum * (1.0 / length) : a;
}

void interpolate(const Pose& before, const Pose& pose, double share, Pose& shown) noexcept {
  const double t = std::clamp(share, 0.0, 1.0);
  shown.joint_count = pose.joint_count;
  shown.root_m = before.root_m + (pose.root_m - before.root_m) * t;
  for (int j = 0; j < pose.joint_count; ++j) {
    shown.local[j] = between(before.local[j], pose.local[j], t);
  }
}

void add_mannequin(const Mannequin& mannequin, const Pose& pose, const Terrain* terrain,
                   const Colour& colour, SceneContent& content) {
  JointFrames frames;
  forward_kinematics(mannequin.model->cycle.skeleton, pose, frames);
  const Colour pale = mixed(colour, kPale, kPaleShare);
  for (const MannequinBone& bone : mannequin.bones) {
    Capsule c;
    const BonePlace place = place_of(bone, frames);
    c.a_m = place.from_m;
    c.b_m = place.to_m;
    c.radius_a_m = bone.radius_from_m;
    c.radius_b_m = bone.radius_to_m;
    c.wide = frames.rotation[bone.from] * bone.wide;
    c.wide_b = frames.rotation[bone.to] * bone.wide_to;
    c.width_a = bone.width_from;
    c.width_b = bone.width_to;
    c.colour = bone.is_pale ? pale : colour;
    put_on_ground(terrain, c.a_m, c.radius_a_m, c.wide, c.width_a);
    put_on_ground(terrain, c.b_m, c.radius_b_m, c.wide_b, c.width_b);
    content.capsules.push_back(c);
  }
}

vec3 head_m(const Mannequin& mannequin, const Pose& pose) noexcept {
  JointFrames frames;
  forward_kinematics(mannequin.model->cycle.skeleton, pose, frames);
  return frames.position_m[mannequin.top] + frames.rotation[mannequin.top] * mannequin.top_m;
}

void add_stick_figure(const GaitCycle& source, double phase, double presence, const vec3& place_m,
                      double heading_rad, const Colour& colour, SceneContent& content) {
  const double share = std::clamp(presence, 0.0, 1.0);
  Pose pose;
  sample_local(source, phase, pose);
  for (int j = 0; j < pose.joint_count; ++j) {
    pose.local[j] = between(source.standing_local[j], pose.local[j], share);
  }
  const LegModel &left = source.leg[kLeftSide], &right = source.leg[kRightSide];
  const double stand_m = 0.5 * (left.length_m() - left.heel_m.y - left.hip_m.y + right.length_m() -
                                right.heel_m.y - right.hip_m.y);
  const vec3 sway_m = sample_at(source, phase).pelvis_m;
  const quat turn = rotation_y(heading_rad);
  pose.local[0] = turn * pose.local[0];
  pose.root_m = vec3(place_m.x, 0.0, place_m.z) + turn * vec3(sway_m.x, 0.0, sway_m.z) * share;
  pose.root_m.y = place_m.y + mix(stand_m, sway_m.y, share);
  JointFrames frames;
  forward_kinematics(source.skeleton, pose, frames);
  const double leg_m = left.length_m();
  for (int j = 1; j < pose.joint_count; ++j) {
    const vec3 a = frames.position_m[source.skeleton.joints[j].parent], b = frames.position_m[j];
    const double length_m = glm::distance(a, b);
    const double longest = source.skeleton.joints[j].is_end_site ? kLongestEnd : kLongestLine;
    if (length_m < kShortestLine * leg_m || length_m > longest * leg_m) continue;
    content.lines.push_back({a, b, colour, kStickLine_px});
    if (length_m > kShortestDotted * leg_m) content.joints_m.push_back(b);
  }
}

}  // namespace gaitpad
