// How thick a body is where: an adult's measures, legs scaled by the leg, the rest by the trunk.
#include "view/body.h"

#include <iterator>

#include "gaitpad/anatomy.h"
#include "view/body_parts.h"

namespace gaitpad {
namespace {

constexpr double kAdultTrunk_m = 0.50;  // hip joints to shoulder joints
constexpr double kAdultArm_m = 0.57;    // shoulder to elbow to wrist
// A trunk's half depth, and how many times wider it is, from the hips (0) to the shoulders (1).
struct Girth {
  double height, radius_m, width;
};
constexpr Girth kTrunk[] = {{-0.02, 0.094, 1.62}, {0.18, 0.091, 1.48}, {0.40, 0.086, 1.38},
                            {0.70, 0.106, 1.54},  {0.90, 0.090, 1.70}, {1.02, 0.054, 1.40},
                            {1.14, 0.047, 1.0}};

Girth girth_at(double height) {
  if (height <= kTrunk[0].height) return kTrunk[0];
  for (std::size_t i = 1; i < std::size(kTrunk); ++i) {
    const Girth &below = kTrunk[i - 1], &above = kTrunk[i];
    if (height > above.height) continue;
    const double share = (height - below.height) / (above.height - below.height);
    return {height, mix(below.radius_m, above.radius_m, share),
            mix(below.width, above.width, share)};
  }
  return kTrunk[std::size(kTrunk) - 1];
}

vec3 mix(const vec3& a, const vec3& b, double t) { return a + (b - a) * t; }

// A place that a joint carries.
struct Held {
  int joint = 0;
  vec3 at_m{0.0};  // in the world, standing
};

class Builder {
 public:
  explicit Builder(Body& body)
      : body_(body), model_(*body.model), parts_(body_parts(*body.model)), leg_(model_.size) {
    const vec3 trunk = parts_.shoulders_m - parts_.hips_m;
    size_ = std::clamp((glm::length(trunk) / kAdultTrunk_m + arm_size() + leg_) / 3.0, 0.4 * leg_,
                       2.5 * leg_);
    along_ = glm::length(trunk) > 1e-3 ? trunk / glm::dot(trunk, trunk) : kUp / kAdultTrunk_m;
  }
  void build();

 private:
  vec3 at(int joint) const { return parts_.standing.position_m[joint]; }
  Held held(int joint) const { return {joint, at(joint)}; }
  Held held(int joint, const vec3& offset_m) const { return {joint, at(joint) + offset_m}; }
  vec3 local(int joint, const vec3& world_m) const {
    return glm::conjugate(parts_.standing.rotation[joint]) * (world_m - at(joint));
  }
  // Radii in metres of the character; `wide` as it stands.
  BodyBone& add(const Held& from, const Held& to, double radius_from_m, double radius_to_m,
                const vec3& wide = vec3(0.0), double width = 1.0);
  void add_leg(Side side);
  void add_foot(const LegModel& leg);
  void add_pelvis();
  void add_trunk();
  void add_head();
  void add_arm(Side side);
  void add_hand(const ArmJoints& arm);

  Body& body_;
  const WalkModel& model_;
  const BodyParts parts_;
  double leg_, size_;  // times an adult's: of the legs, of the rest by trunk, arms and legs
  vec3 along_{0.0};    // dot product with a place above the hips: 0 .. 1 at the shoulders

  double arm_size() const;
  double height_of(const vec3& at_m) const { return glm::dot(at_m - parts_.hips_m, along_); }
};

// Of the longer arm, as the leg's where there is none.
double Builder::arm_size() const {
  double longest_m = 0.0;
  for (const ArmJoints& arm : parts_.arm) {
    if (!arm.is_known()) continue;
    longest_m = std::max(longest_m, glm::distance(at(arm.shoulder), at(arm.elbow)) +
                                        glm::distance(at(arm.elbow), at(arm.wrist)));
  }
  return longest_m > 0.0 ? longest_m / kAdultArm_m : leg_;
}

BodyBone& Builder::add(const Held& from, const Held& to, double radius_from_m, double radius_to_m,
                       const vec3& wide, double width) {
  BodyBone bone;
  bone.from = from.joint;
  bone.to = to.joint;
  bone.from_m = local(from.joint, from.at_m);
  bone.to_m = local(to.joint, to.at_m);
  bone.radius_from_m = radius_from_m;
  bone.radius_to_m = radius_to_m;
  bone.wide = glm::conjugate(parts_.standing.rotation[from.joint]) * wide;
  bone.width_from = bone.width_to = width;
  return body_.bones.emplace_back(bone);
}

// Twist joints between hip and knee or knee and ankle keep a fixed rotation.
void Builder::add_leg(Side side) {
  const LegModel& leg = model_.leg[side].model;
  const Held hip = held(leg.joints.hip), knee = held(leg.joints.knee),
             ankle = held(leg.joints.ankle);
  add(hip, knee, 0.082 * leg_, 0.049 * leg_);
  const vec3 behind(0.0, 0.0, -0.010 * leg_);
  const Held calf{leg.joints.knee, knee.at_m + (ankle.at_m - knee.at_m) * 0.30 + behind};
  add(knee, calf, 0.047 * leg_, 0.053 * leg_);
  add(calf, ankle, 0.053 * leg_, 0.034 * leg_);
  add_foot(leg);
}

// Heel to ball of the foot, ball to toe end. The undersides are on the floor: what carries a ball
// of radius r there stands r above it.
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
  add(instep, back, 0.034 * leg_, heel_m);
  for (auto bone = body_.bones.end() - 3; bone != body_.bones.end(); ++bone) bone->is_pale = true;
  const vec3 tip = on_floor(end - ahead * tip_m, tip_m);
  if (glm::dot(tip - ball.at_m, ahead) < 0.01 * leg_) return;  // no toes, or toes that end nowhere
  BodyBone& toes = add({j.toe, ball.at_m}, {j.toe, tip}, ball_m, tip_m, side, 1.55);
  toes.width_to = 1.7;
  toes.is_pale = true;
}

void Builder::add_pelvis() {
  const vec3 up(0.0, 0.026 * size_, 0.0);
  const int pelvis = model_.cycle.pelvis;
  const auto hip = [&](Side side) {
    return Held{pelvis, at(model_.leg[side].model.joints.hip) + up};
  };
  const double radius_m = 0.5 * (leg_ + size_) * 0.084;
  add(hip(kLeftSide), hip(kRightSide), radius_m, radius_m);
}

// Along the spine, cut where its girth changes. Short pieces of spine go together.
void Builder::add_trunk() {
  if (parts_.trunk.empty()) return;
  const double shortest_m = 0.05 * size_;
  const auto add_piece = [&](const Held& from, const Held& to) {
    const Girth a = girth_at(height_of(from.at_m)), b = girth_at(height_of(to.at_m));
    add(from, to, a.radius_m * size_, b.radius_m * size_, kLeft, a.width).width_to = b.width;
  };
  Held from = held(parts_.trunk.front());
  for (std::size_t i = 1; i < parts_.trunk.size(); ++i) {
    const Held to = held(parts_.trunk[i]);
    const bool is_last = i + 1 == parts_.trunk.size();
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

// A jaw and a skull: a head shows where it looks. Its height is the skeleton's where that is
// likely; a head joint between the shoulders carries it on a neck.
void Builder::add_head() {
  if (parts_.head < 0) return;
  constexpr double kHeight_m = 0.224;
  const double wish_m = at(parts_.top).y - at(parts_.head).y;
  const bool is_likely = wish_m > 0.16 * size_ && wish_m < 0.27 * size_;
  const double part = (is_likely ? wish_m : 0.222 * size_) / kHeight_m;
  vec3 base = at(parts_.head);
  base.y = std::max(base.y, parts_.shoulders_m.y + 0.075 * size_);
  const auto place = [&](double y, double z) {
    return Held{parts_.head, base + vec3(0.0, y, z) * part};
  };
  const Held jaw = place(0.050, 0.034), skull = place(0.130, 0.010);
  add(held(parts_.head), place(0.045, 0.004), 0.047 * size_, 0.045 * size_);
  add(jaw, skull, 0.054 * part, 0.094 * part, kLeft, 0.92).width_to = 0.86;
  add(place(0.095, 0.088), place(0.080, 0.102), 0.008 * part, 0.011 * part);
  for (auto bone = body_.bones.end() - 3; bone != body_.bones.end(); ++bone) bone->is_pale = true;
  body_.top = parts_.head;
  const vec3 top = base + vec3(0.0, kHeight_m * part, 0.0);
  body_.top_m = local(parts_.head, top);
  body_.height_m = top.y;
}

void Builder::add_arm(Side side) {
  const ArmJoints& arm = parts_.arm[side];
  if (!arm.is_known()) return;
  const Held elbow = held(arm.elbow), wrist = held(arm.wrist);
  // From the root of the neck, carried by what carries the arm.
  int chest = parts_.trunk.front();
  for (const int j : parts_.trunk) {
    if (is_ancestor(model_.cycle.skeleton, j, arm.shoulder)) chest = j;
  }
  // Flesh lies inside the joint's place in most skeletons: they are measured from outside.
  vec3 inwards = parts_.shoulders_m - at(arm.shoulder);
  inwards *= 0.016 * size_ / std::max(glm::length(inwards), 0.016 * size_);
  const Held shoulder = held(arm.shoulder, inwards - kUp * (0.008 * size_));
  const vec3 neck = mix(at(chest), shoulder.at_m, 0.28);
  const Held collar{
      chest, vec3(neck.x, shoulder.at_m.y + 0.026 * size_, 0.5 * (neck.z + shoulder.at_m.z))};
  add(collar, shoulder, 0.046 * size_, 0.050 * size_);
  add(shoulder, elbow, 0.050 * size_, 0.036 * size_);
  const Held bulge{arm.elbow, mix(elbow.at_m, wrist.at_m, 0.26)};
  add(elbow, bulge, 0.035 * size_, 0.038 * size_).is_pale = true;
  add(bulge, wrist, 0.038 * size_, 0.025 * size_).is_pale = true;
  add_hand(arm);
}

// A mitten with a thumb: flat, as wide as it points forward in whoever stands.
void Builder::add_hand(const ArmJoints& arm) {
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
  add(spot(0.08, 0.0), spot(0.50, 0.0), 0.020 * size_, 0.021 * size_, wide, 1.5).width_to = 1.95;
  add(spot(0.50, 0.0), spot(0.93, -0.004), 0.020 * size_, 0.012 * size_, wide, 1.95).width_to = 2.1;
  add(spot(0.18, 0.014), spot(0.55, 0.048), 0.015 * size_, 0.0105 * size_);
  for (auto bone = body_.bones.end() - 3; bone != body_.bones.end(); ++bone) bone->is_pale = true;
}

void Builder::build() {
  body_.top = model_.cycle.pelvis;
  body_.height_m = at(body_.top).y;
  add_pelvis();
  for (const Side side : {kLeftSide, kRightSide}) add_leg(side);
  add_trunk();
  for (const Side side : {kLeftSide, kRightSide}) add_arm(side);
  add_head();
}

}  // namespace

Body body_of(std::shared_ptr<const WalkModel> model) {
  Body body;
  body.model = std::move(model);
  Builder(body).build();
  return body;
}

}  // namespace gaitpad
