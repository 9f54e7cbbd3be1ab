#include "view/mannequin.h"

#include <cctype>
#include <iterator>
#include <string>
#include <string_view>

#include "gaitpad/anatomy.h"

namespace gaitpad {
namespace {

// An adult's measures in metres, for a leg of kReferenceLeg_m.
constexpr double kTrunk_m = 0.50;           // hip joints to shoulder joints
constexpr double kShoulderReach_m = 0.075;  // a shoulder joint is farther from the spine than that
constexpr double kShortestArm_m = 0.25, kUpperShare = 0.54, kWristShare = 0.78;

class Reading {
 public:
  explicit Reading(const WalkModel& model) : model_(model), joints_(model.cycle.skeleton.joints) {}
  BodyParts parts();

 private:
  int count() const { return static_cast<int>(joints_.size()); }
  int parent(int j) const { return joints_[j].parent; }
  vec3 at(int j) const { return parts_.standing.position_m[j]; }
  bool is_named(int j, std::initializer_list<std::string_view> words) const;
  bool is_of_leg(int j) const;
  std::vector<int> path_up_to(int j) const;  // from the root
  double length_from(int ancestor, int j) const;

  void stand();
  void find_head();
  void find_trunk();
  void find_arms();
  int arm_end(Side side) const;
  void divide_arm(int end, ArmJoints& arm) const;
  int branch_of(int j) const;  // the trunk's joint that it hangs on

  const WalkModel& model_;
  const std::vector<Joint>& joints_;
  BodyParts parts_;
};

bool Reading::is_named(int j, std::initializer_list<std::string_view> words) const {
  std::string name = joints_[j].name;
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const std::string_view word : words) {
    if (name.find(word) != std::string::npos) return true;
  }
  return false;
}

bool Reading::is_of_leg(int j) const {
  for (const LegBuild& leg : model_.leg) {
    if (is_ancestor(model_.cycle.skeleton, leg.model.joints.hip, j)) return true;
  }
  return false;
}

std::vector<int> Reading::path_up_to(int j) const {
  std::vector<int> path;
  for (; j >= 0; j = parent(j)) path.insert(path.begin(), j);
  return path;
}

double Reading::length_from(int ancestor, int j) const {
  double length_m = 0.0;
  for (; j != ancestor && parent(j) >= 0; j = parent(j)) {
    length_m += glm::length(joints_[j].offset_m);
  }
  return length_m;
}

void Reading::stand() {
  Pose pose;
  pose.joint_count = count();
  for (int j = 0; j < count(); ++j) pose.local[j] = model_.cycle.standing_local[j];
  forward_kinematics(model_.cycle.skeleton, pose, parts_.standing);
  double lowest_m = at(model_.leg[kLeftSide].model.joints.ankle).y;
  for (const LegBuild& leg : model_.leg) {
    lowest_m = std::min(lowest_m, at(leg.model.joints.ankle).y + leg.model.heel_m.y);
  }
  for (int j = 0; j < count(); ++j) parts_.standing.position_m[j].y -= lowest_m;
  parts_.hips_m = 0.5 * (at(model_.leg[kLeftSide].model.joints.hip) +
                         at(model_.leg[kRightSide].model.joints.hip));
  parts_.shoulders_m = parts_.hips_m + kUp * (kTrunk_m * model_.size);
}

// By its name, else the highest joint that is not far to the side.
void Reading::find_head() {
  int highest = -1;
  for (int j = 0; j < count(); ++j) {
    if (is_of_leg(j) || joints_[j].is_end_site) continue;
    if (is_named(j, {"head"}) && !is_named(j, {"top", "end", "fore", "site"})) {
      parts_.head = j;
      break;
    }
    const double aside_m = std::abs(at(j).x - at(model_.cycle.pelvis).x);
    if (aside_m > 0.1 * model_.leg_length_m || at(j).y < parts_.hips_m.y) continue;
    if (highest < 0 || at(j).y > at(highest).y) highest = j;
  }
  if (parts_.head < 0 && highest > 0) parts_.head = highest;
  if (parts_.head < 0) return;
  parts_.top = parts_.head;
  for (int j = parts_.head + 1; j < count(); ++j) {
    if (!is_ancestor(model_.cycle.skeleton, parts_.head, j)) break;  // depth first
    if (at(j).y > at(parts_.top).y) parts_.top = j;
  }
}

void Reading::find_trunk() {
  if (parts_.head < 0) return;
  for (const int j : path_up_to(parts_.head)) {
    // Of joints in the same place the last one turns what comes next.
    if (!parts_.trunk.empty() && glm::distance(at(j), at(parts_.trunk.back())) < 1e-4) {
      parts_.trunk.pop_back();
    }
    parts_.trunk.push_back(j);
  }
}

int Reading::branch_of(int j) const {
  const auto on_trunk = [this](int k) {
    return is_ancestor(model_.cycle.skeleton, k, parts_.head);
  };
  while (j >= 0 && !on_trunk(j)) j = parent(j);
  return j;
}

// A wrist by its name, else the end of the longest chain on that side that hangs on the trunk.
int Reading::arm_end(Side side) const {
  int best = -1;
  double longest_m = kShortestArm_m * model_.size;
  const double middle_m = at(model_.cycle.pelvis).x;
  for (int j = 0; j < count(); ++j) {
    const double aside_m = (at(j).x - middle_m) * (side == kLeftSide ? 1.0 : -1.0);
    if (is_of_leg(j) || aside_m < 0.03 * model_.leg_length_m) continue;
    if (is_ancestor(model_.cycle.skeleton, parts_.head, j)) continue;
    const int branch = branch_of(j);
    if (branch < 0 || branch == j) continue;
    const double length_m = length_from(branch, j);
    const bool is_wrist = is_named(j, {"hand", "wrist"}) && !joints_[j].is_end_site;
    if (is_wrist && length_m > kShortestArm_m * model_.size) return j;  // fingers come after it
    if (length_m > longest_m) {
      longest_m = length_m;
      best = j;
    }
  }
  return best;
}

// `end`: the wrist or a finger. Twist joints between two of the three do not matter.
void Reading::divide_arm(int end, ArmJoints& arm) const {
  std::vector<int> path = path_up_to(end);
  const int branch = branch_of(end);
  while (path.front() != branch) path.erase(path.begin());
  const double spine_x = at(branch).x;
  const auto first = std::find_if(path.begin(), path.end(), [&](int j) {
    return std::abs(at(j).x - spine_x) > kShoulderReach_m * model_.size;
  });
  arm.shoulder = first != path.end() && *first != end ? *first : path[path.size() / 2];
  const auto nearest = [&](double share, double whole_m) {
    int best = arm.shoulder;
    for (const int j : path) {
      const auto off = [&](int k) {
        return std::abs(length_from(arm.shoulder, k) - share * whole_m);
      };
      if (is_ancestor(model_.cycle.skeleton, arm.shoulder, j) && off(j) < off(best)) best = j;
    }
    return best;
  };
  const bool is_wrist = is_named(end, {"hand", "wrist"});
  arm.wrist = is_wrist ? end : nearest(kWristShare, length_from(arm.shoulder, end));
  arm.elbow = nearest(kUpperShare, length_from(arm.shoulder, arm.wrist));
  double farthest_m = 0.0;
  for (int j = arm.wrist + 1; j < count(); ++j) {
    if (!is_ancestor(model_.cycle.skeleton, arm.wrist, j)) break;
    if (is_named(j, {"thumb", "mesh"}) || length_from(arm.wrist, j) <= farthest_m) continue;
    farthest_m = length_from(arm.wrist, j);
    arm.hand_end = j;
  }
}

void Reading::find_arms() {
  if (parts_.head < 0) return;
  for (const Side side : {kLeftSide, kRightSide}) {
    const int end = arm_end(side);
    if (end >= 0) divide_arm(end, parts_.arm[side]);
  }
  const ArmJoints &left = parts_.arm[kLeftSide], &right = parts_.arm[kRightSide];
  if (!left.is_known() || !right.is_known()) return;
  parts_.shoulders_m = 0.5 * (at(left.shoulder) + at(right.shoulder));
}

BodyParts Reading::parts() {
  stand();
  find_head();
  find_trunk();
  find_arms();
  return parts_;
}

// How thick a body is where: an adult's measures, legs scaled by the leg, the rest by the trunk.

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

// Bodies and stick figures in a pose, as capsules and lines in the world.

constexpr Colour kPale = {0.83, 0.84, 0.86};
constexpr double kPaleShare = 0.48;
constexpr double kStickLine_px = 3.2;
constexpr double kLongestEnd = 0.5,
                 kLongestLine = 0.9;  // of the leg: joints of meshes lie anywhere
constexpr double kShortestLine = 0.015, kShortestDotted = 0.045;  // of the leg: fingers have none

Colour mixed(const Colour& a, const Colour& b, double share) {
  return {mix(a.red, b.red, share), mix(a.green, b.green, share), mix(a.blue, b.blue, share),
          a.alpha};
}

// The shorter way round; the poses are a tick apart.
quat between(const quat& a, const quat& b, double share) noexcept {
  const quat near = glm::dot(a, b) < 0.0 ? -b : b;
  const quat sum = a * (1.0 - share) + near * share;
  const double length = glm::length(sum);
  return length > 1e-9 ? sum * (1.0 / length) : a;
}

// An end that is lower than its own thickness is lifted onto the floor.
void put_on_floor(vec3& end_m, double radius_m, const vec3& wide, double width) {
  const double upright = wide.y * wide.y * std::max(width * width - 1.0, 0.0);
  end_m.y = std::max(end_m.y, radius_m * std::sqrt(1.0 + upright));
}

}  // namespace

BodyParts body_parts(const WalkModel& model) { return Reading(model).parts(); }

Body body_of(std::shared_ptr<const WalkModel> model) {
  Body body;
  body.model = std::move(model);
  Builder(body).build();
  return body;
}

void interpolate(const Pose& before, const Pose& pose, double share, Pose& shown) noexcept {
  const double t = std::clamp(share, 0.0, 1.0);
  shown.joint_count = pose.joint_count;
  shown.root_m = before.root_m + (pose.root_m - before.root_m) * t;
  for (int j = 0; j < pose.joint_count; ++j) {
    shown.local[j] = between(before.local[j], pose.local[j], t);
  }
}

void add_body(const Body& body, const Pose& pose, const Colour& colour, SceneContent& content) {
  JointFrames frames;
  forward_kinematics(body.model->cycle.skeleton, pose, frames);
  const Colour pale = mixed(colour, kPale, kPaleShare);
  for (const BodyBone& bone : body.bones) {
    Capsule c;
    c.a_m = frames.position_m[bone.from] + frames.rotation[bone.from] * bone.from_m;
    c.b_m = frames.position_m[bone.to] + frames.rotation[bone.to] * bone.to_m;
    c.radius_a_m = bone.radius_from_m;
    c.radius_b_m = bone.radius_to_m;
    c.wide = frames.rotation[bone.from] * bone.wide;
    c.width_a = bone.width_from;
    c.width_b = bone.width_to;
    c.colour = bone.is_pale ? pale : colour;
    put_on_floor(c.a_m, c.radius_a_m, c.wide, c.width_a);
    put_on_floor(c.b_m, c.radius_b_m, c.wide, c.width_b);
    content.bodies.push_back(c);
  }
}

vec3 head_m(const Body& body, const Pose& pose) noexcept {
  JointFrames frames;
  forward_kinematics(body.model->cycle.skeleton, pose, frames);
  return frames.position_m[body.top] + frames.rotation[body.top] * body.top_m;
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
