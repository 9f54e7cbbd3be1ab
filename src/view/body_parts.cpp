#include "view/body_parts.h"

#include <string>
#include <string_view>

#include "base/text.h"
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
  const std::string name = lower_case(joints_[j].name);
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

}  // namespace

BodyParts body_parts(const WalkModel& model) { return Reading(model).parts(); }

}  // namespace gaitpad
