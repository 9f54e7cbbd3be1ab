#include "motion/body_joints.h"

#include <algorithm>

#include "motion/body_names.h"
#include "motion/legs.h"

namespace gaitpad {
namespace {

constexpr std::size_t kMostLeaves = 96;  // looked at for a shape: fingers and faces have many

struct Body {
  const Skeleton& skeleton;
  const std::array<LegJoints, 2>& legs;
  std::span<const vec3> at;

  int parent(int j) const { return skeleton.joints[static_cast<std::size_t>(j)].parent; }
  int count() const { return static_cast<int>(skeleton.joints.size()); }
  double distance(int a, int b) const {
    return glm::distance(at[static_cast<std::size_t>(a)], at[static_cast<std::size_t>(b)]);
  }
  bool in_leg(int j) const {
    return is_ancestor(skeleton, legs[0].hip, j) || is_ancestor(skeleton, legs[1].hip, j);
  }
};

int common_ancestor(const Body& body, int a, int b) {
  while (a >= 0 && !is_ancestor(body.skeleton, a, b)) a = body.parent(a);
  return a;
}

// From below `top` down to `joint`, both as given: empty where top is no ancestor.
std::vector<int> path_below(const Body& body, int top, int joint) {
  std::vector<int> path;
  for (int j = joint; j > top && j >= 0; j = body.parent(j)) path.push_back(j);
  std::reverse(path.begin(), path.end());
  return path;
}

// Upper arm and forearm of like length, as all arms have.
bool is_arm(const Body& body, const ArmChain& arm) {
  const double upper = body.distance(arm.shoulder, arm.elbow);
  const double fore = body.distance(arm.elbow, arm.wrist);
  return upper > 0.0 && fore > 0.0 && upper < 2.5 * fore && fore < 2.5 * upper;
}

int above(const Body& body, int joint, NamedSide side, BodyPart wanted) {
  for (int j = body.parent(joint); j >= 0; j = body.parent(j)) {
    const BodyName n = body_name(body.skeleton.joints[static_cast<std::size_t>(j)].name);
    if (n.side == side && n.part == wanted) return j;
  }
  return -1;
}

// Of the joints below the elbow the lowest one named a wrist or a hand: above it such a joint turns
// the forearm (CMU's lwrist). Without one the farthest child.
int wrist_below(const Body& body, int elbow, NamedSide side) {
  int farthest = -1, named = -1;
  for (int j = elbow + 1; j < body.count(); ++j) {
    if (!is_ancestor(body.skeleton, elbow, j)) break;
    const BodyName n = body_name(body.skeleton.joints[static_cast<std::size_t>(j)].name);
    const bool is_lower = named < 0 || is_ancestor(body.skeleton, named, j);
    if (n.side == side && n.part == BodyPart::wrist && is_lower) named = j;
    const bool is_child = body.parent(j) == elbow;
    if (is_child && (farthest < 0 || body.distance(elbow, j) > body.distance(elbow, farthest)))
      farthest = j;
  }
  return named >= 0 ? named : farthest;
}

ArmChain named_arm(const Body& body, NamedSide side) {
  for (int j = 0; j < body.count(); ++j) {
    const BodyName n = body_name(body.skeleton.joints[static_cast<std::size_t>(j)].name);
    if (n.side != side || n.part != BodyPart::elbow || body.in_leg(j)) continue;
    ArmChain arm;
    arm.elbow = j;
    arm.wrist = wrist_below(body, j, side);
    arm.shoulder = above(body, j, side, BodyPart::upper_arm);
    if (arm.shoulder < 0) arm.shoulder = above(body, j, side, BodyPart::shoulder);
    if (arm.shoulder < 0 || arm.wrist < 0 || !is_arm(body, arm)) continue;
    arm.collar = above(body, arm.shoulder, side, BodyPart::collar);
    if (arm.collar < 0) arm.collar = above(body, arm.shoulder, side, BodyPart::shoulder);
    return arm;
  }
  return {};
}

// The two longest neighbouring bones of like length on the way from below `top` to a leaf.
ArmChain chain_arm(const Body& body, int top, int leaf) {
  std::vector<int> chain;  // from the top, joints at one place only once
  for (const int j : path_below(body, top, leaf)) {
    if (chain.empty() || body.distance(j, chain.back()) > 0.0) chain.push_back(j);
  }
  ArmChain best;
  double longest = 0.0;
  for (std::size_t i = 0; i + 2 < chain.size(); ++i) {
    ArmChain arm;
    arm.collar = i > 0 ? chain[i - 1] : -1;
    arm.shoulder = chain[i], arm.elbow = chain[i + 1], arm.wrist = chain[i + 2];
    const double length =
        body.distance(arm.shoulder, arm.elbow) + body.distance(arm.elbow, arm.wrist);
    if (length <= longest || !is_arm(body, arm)) continue;
    longest = length;
    best = arm;
  }
  return best;
}

double arm_length(const Body& body, const ArmChain& arm) {
  return body.distance(arm.shoulder, arm.elbow) + body.distance(arm.elbow, arm.wrist);
}

// The joint that ends the trunk: of all that is not in a leg the highest.
int highest(const Body& body) {
  int top = -1;
  for (int j = 0; j < body.count(); ++j) {
    if (body.in_leg(j)) continue;
    if (top < 0 ||
        body.at[static_cast<std::size_t>(j)].y > body.at[static_cast<std::size_t>(top)].y)
      top = j;
  }
  return top;
}

// On each side of the trunk the longest arm that leaves it. Left is where the left hip is.
void shaped_arms(const Body& body, int top, std::array<ArmChain, 2>& arms) {
  const vec3 left = body.at[static_cast<std::size_t>(body.legs[0].hip)] -
                    body.at[static_cast<std::size_t>(body.legs[1].hip)];
  std::vector<bool> is_parent(static_cast<std::size_t>(body.count()), false);
  for (int j = 1; j < body.count(); ++j) is_parent[static_cast<std::size_t>(body.parent(j))] = true;
  std::size_t looked_at = 0;
  for (int j = 0; j < body.count() && looked_at < kMostLeaves; ++j) {
    if (is_parent[static_cast<std::size_t>(j)] || body.in_leg(j) || j == top) continue;
    ++looked_at;
    const ArmChain arm = chain_arm(body, common_ancestor(body, j, top), j);
    if (!arm.is_found()) continue;
    const vec3 out =
        body.at[static_cast<std::size_t>(arm.shoulder)] - body.at[static_cast<std::size_t>(top)];
    ArmChain& place = arms[glm::dot(out, left) > 0.0 ? kLeftSide : kRightSide];
    if (!place.is_found() || arm_length(body, arm) > arm_length(body, place)) place = arm;
  }
}

bool is_pair(const Body& body, const std::array<ArmChain, 2>& arms) {
  if (!arms[0].is_found() || !arms[1].is_found()) return false;
  const double left = arm_length(body, arms[0]), right = arm_length(body, arms[1]);
  return left < 1.5 * right && right < 1.5 * left &&
         !is_ancestor(body.skeleton, arms[0].shoulder, arms[1].shoulder) &&
         !is_ancestor(body.skeleton, arms[1].shoulder, arms[0].shoulder);
}

int named_head(const Body& body) {
  for (int j = 0; j < body.count(); ++j) {
    const Joint& joint = body.skeleton.joints[static_cast<std::size_t>(j)];
    if (!joint.is_end_site && !body.in_leg(j) && body_name(joint.name).part == BodyPart::head)
      return j;
  }
  return -1;
}

// The joint whose end is the highest of all.
int shaped_head(const Body& body, int top) {
  if (top <= 0) return -1;
  return body.skeleton.joints[static_cast<std::size_t>(top)].is_end_site ? body.parent(top) : top;
}

// What carries the arms; with one arm, what carries it and the head.
int chest_of(const Body& body, const BodyJoints& found) {
  const auto& [left, right] = found.arm;
  if (left.is_found() && right.is_found())
    return common_ancestor(body, left.shoulder, right.shoulder);
  const ArmChain& arm = left.is_found() ? left : right;
  if (arm.is_found() && found.head >= 0) return common_ancestor(body, arm.shoulder, found.head);
  return -1;
}

}  // namespace

BodyJoints find_body(const Skeleton& skeleton, const std::array<LegJoints, 2>& legs, int pelvis,
                     std::span<const vec3> position_m) {
  BodyJoints found;
  if (position_m.size() < skeleton.joints.size() || skeleton.joints.empty()) return found;
  const Body body{skeleton, legs, position_m};
  const int top = highest(body);
  found.head = named_head(body);
  if (found.head < 0) found.head = shaped_head(body, top);
  found.arm = {named_arm(body, NamedSide::left), named_arm(body, NamedSide::right)};
  if (!found.arm[0].is_found() && !found.arm[1].is_found() && top > 0) {
    shaped_arms(body, found.head >= 0 ? found.head : top, found.arm);
    if (!is_pair(body, found.arm)) found.arm = {};
  }
  const int chest = chest_of(body, found);
  if (chest < 0) return found;
  found.spine = path_below(body, common_ancestor(body, pelvis, chest), chest);
  if (found.head >= 0 && is_ancestor(skeleton, chest, found.head)) {
    found.neck = path_below(body, chest, found.head);
    if (!found.neck.empty()) found.neck.pop_back();
  }
  return found;
}

}  // namespace gaitpad
