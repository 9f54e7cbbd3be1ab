#include "motion/body_joints.h"

#include <algorithm>
#include <optional>

#include "motion/arm_names.h"
#include "motion/legs.h"

namespace gaitpad {
namespace {

using Arms = std::array<ArmJoints, 2>;

struct Body {
  const Skeleton& skeleton;
  const std::array<int, 2>& hips;
  std::span<const vec3> at;
  int parent(int joint) const { return skeleton.joints[joint].parent; }
  bool is_in_leg(int joint) const {
    return is_ancestor(skeleton, hips[0], joint) || is_ancestor(skeleton, hips[1], joint);
  }
};

int common_ancestor(const Skeleton& skeleton, int a, int b) {
  while (a >= 0 && !is_ancestor(skeleton, a, b)) a = skeleton.joints[a].parent;
  return a;
}

// The hand's own joint: a wrist above a joint named hand is a twist joint (CMU's lwrist).
int hand_of(const Body& body, NamedSide side) {
  const auto& joints = body.skeleton.joints;
  for (const ArmPart wanted : {ArmPart::hand, ArmPart::wrist}) {
    for (int j = 0; j < static_cast<int>(joints.size()); ++j) {
      const NamedArm named = named_arm(joints[j].name);
      if (!joints[j].is_end_site && named.side == side && named.part == wanted) return j;
    }
  }
  return -1;
}

// Upwards from the hand. "Shoulder" is the upper arm where nothing nearer to the elbow is, else the
// collar bone.
std::optional<ArmJoints> named_arm_of(const Body& body, NamedSide side) {
  ArmJoints arm;
  arm.wrist = hand_of(body, side);
  if (arm.wrist < 0) return std::nullopt;
  for (int j = body.parent(arm.wrist); j >= 0; j = body.parent(j)) {
    const NamedArm named = named_arm(body.skeleton.joints[j].name);
    if (named.side != side) continue;
    const bool is_upper = named.part == ArmPart::upper_arm || named.part == ArmPart::shoulder;
    const bool is_collar = named.part == ArmPart::clavicle || named.part == ArmPart::shoulder;
    if (arm.shoulder < 0 && named.part == ArmPart::forearm) {
      arm.elbow = j;
    } else if (arm.elbow >= 0 && arm.shoulder < 0 && is_upper) {
      arm.shoulder = j;
    } else if (arm.shoulder >= 0 && is_collar) {
      arm.clavicle = j;
      break;
    }
  }
  return arm.shoulder >= 0 ? std::optional(arm) : std::nullopt;
}

std::optional<Arms> named_arms(const Body& body) {
  const auto left = named_arm_of(body, NamedSide::left);
  const auto right = named_arm_of(body, NamedSide::right);
  if (!left || !right) return std::nullopt;
  return Arms{*left, *right};
}

// Joints from below `ancestor` down to `leaf`, those at one place only once, and their length.
struct Chain {
  std::vector<int> joints;
  double length_m = 0.0;
};
Chain chain_to(const Body& body, int ancestor, int leaf) {
  Chain chain;
  for (int j = leaf; j != ancestor; j = body.parent(j)) {
    if (!chain.joints.empty()) {
      const double bone_m = glm::distance(body.at[j], body.at[chain.joints.back()]);
      if (bone_m <= 0.0) continue;
      chain.length_m += bone_m;
    }
    chain.joints.push_back(j);
  }
  std::ranges::reverse(chain.joints);
  return chain;
}

// The chain's two longest neighbouring bones are upper arm and forearm; of two such pairs the one
// nearer to the hand: a collar bone may be as long as a forearm.
ArmJoints arm_of(const Body& body, const Chain& chain) {
  ArmJoints arm;
  double longest = 0.0;
  for (std::size_t i = 0; i + 2 < chain.joints.size(); ++i) {
    const int a = chain.joints[i], b = chain.joints[i + 1], c = chain.joints[i + 2];
    const double upper = glm::distance(body.at[a], body.at[b]);
    const double lower = glm::distance(body.at[b], body.at[c]);
    if (upper + lower <= 0.9 * longest || upper > 2.5 * lower || lower > 2.5 * upper) continue;
    longest = std::max(longest, upper + lower);
    arm = {i > 0 ? chain.joints[i - 1] : -1, a, b, body.skeleton.joints[c].is_end_site ? -1 : c};
  }
  return arm;
}

// Leaves outside the legs, at most so many: hands and faces may have a hundred.
std::vector<int> upper_leaves(const Body& body) {
  constexpr std::size_t kMostLeaves = 160;
  const int joints = static_cast<int>(body.skeleton.joints.size());
  std::vector<bool> has_child(static_cast<std::size_t>(joints), false);
  for (int j = 1; j < joints; ++j) has_child[static_cast<std::size_t>(body.parent(j))] = true;
  std::vector<int> leaves;
  for (int j = 1; j < joints && leaves.size() < kMostLeaves; ++j) {
    if (!has_child[static_cast<std::size_t>(j)] && !body.is_in_leg(j)) leaves.push_back(j);
  }
  return leaves;
}

std::optional<Arms> shaped_arms(const Body& body) {
  const std::vector<int> leaves = upper_leaves(body);
  std::optional<Arms> best;
  double longest = 0.0;
  for (const int a : leaves) {
    for (const int b : leaves) {
      const int ancestor = common_ancestor(body.skeleton, a, b);
      const double middle_m = body.at[ancestor].x;
      if (!(body.at[a].x > middle_m) || !(body.at[b].x < middle_m)) continue;
      const Chain left = chain_to(body, ancestor, a), right = chain_to(body, ancestor, b);
      const bool is_pair =
          left.length_m < 1.3 * right.length_m && right.length_m < 1.3 * left.length_m;
      if (!is_pair || left.length_m + right.length_m <= longest) continue;
      const Arms arms = {arm_of(body, left), arm_of(body, right)};
      if (arms[0].shoulder < 0 || arms[1].shoulder < 0) continue;
      longest = left.length_m + right.length_m;
      best = arms;
    }
  }
  return best;
}

bool is_in_arm(const Body& body, const BodyJoints& found, int joint) {
  return std::ranges::any_of(found.arm, [&](const ArmJoints& arm) {
    const int top = arm.clavicle >= 0 ? arm.clavicle : arm.shoulder;
    return top >= 0 && is_ancestor(body.skeleton, top, joint);
  });
}

bool is_fork(const Body& body, int joint) {
  return std::ranges::count(body.skeleton.joints, joint, &Joint::parent) > 1;
}

// From below the common ancestor of both down to `to`.
std::vector<int> path(const Body& body, int from, int to) {
  std::vector<int> joints;
  const int ancestor = common_ancestor(body.skeleton, from, to);
  for (int j = to; j >= 0 && j != ancestor; j = body.parent(j)) joints.push_back(j);
  std::ranges::reverse(joints);
  return joints;
}

// The topmost joint so named, else the one that carries the highest end or a face, else -1.
int head_of(const Body& body, const BodyJoints& found, int chest) {
  const auto& joints = body.skeleton.joints;
  const auto is_free = [&](int j) { return !body.is_in_leg(j) && !is_in_arm(body, found, j); };
  for (int j = 1; j < static_cast<int>(joints.size()); ++j) {
    if (!joints[j].is_end_site && is_free(j) && is_head_name(joints[j].name)) return j;
  }
  int highest = -1;
  for (const int leaf : upper_leaves(body)) {
    if (!is_free(leaf) || !is_ancestor(body.skeleton, chest, leaf)) continue;
    if (highest < 0 || body.at[leaf].y > body.at[highest].y) highest = leaf;
  }
  if (highest < 0) return -1;
  const int last = joints[highest].is_end_site ? body.parent(highest) : highest;
  for (const int j : path(body, chest, last)) {
    if (j == last || is_fork(body, j)) return j;
  }
  return -1;
}

}  // namespace

BodyJoints body_joints(const Skeleton& skeleton, int pelvis, const std::array<int, 2>& hips,
                       std::span<const vec3> standing_m) {
  const Body body{skeleton, hips, standing_m};
  BodyJoints found;
  auto arms = named_arms(body);
  if (!arms) arms = shaped_arms(body);
  if (arms) found.arm = *arms;
  const auto top = [](const ArmJoints& arm) {
    return arm.clavicle >= 0 ? arm.clavicle : arm.shoulder;
  };
  int chest = pelvis;
  if (arms) chest = common_ancestor(skeleton, top(found.arm[0]), top(found.arm[1]));
  if (arms) found.spine = path(body, pelvis, chest);
  const int head = head_of(body, found, chest);
  if (head >= 0) found.neck = path(body, chest, head);
  if (!arms && !found.neck.empty()) {  // without arms all below the head is spine
    found.spine.assign(found.neck.begin(), found.neck.end() - 1);
    found.neck = {head};
  }
  return found;
}

}  // namespace gaitpad
