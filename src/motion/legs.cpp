#include "motion/legs.h"

#include <fmt/format.h>

#include <memory>
#include <optional>

#include "motion/tracks.h"

namespace gaitpad {
namespace {

using Legs = std::array<LegJoints, 2>;

// World positions of the joints in a few frames spread over the motion, and of bare offsets.
struct Shape {
  const Skeleton& skeleton;
  std::vector<JointFrames> frames;
};

Shape shape_of(const Motion& motion) {
  Shape shape{motion.skeleton, {}};
  const std::size_t count = std::min<std::size_t>(motion.frames.size(), 9);
  shape.frames.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t frame = count < 2 ? 0 : i * (motion.frames.size() - 1) / (count - 1);
    forward_kinematics(motion, motion.frames[frame], shape.frames[i]);
  }
  return shape;
}

double bone_length(const Shape& shape, int upper, int lower) {
  const auto& at = shape.frames[shape.frames.size() / 2].position_m;
  return glm::distance(at[upper], at[lower]);
}

std::vector<int> children_of(const Skeleton& skeleton, int joint) {
  std::vector<int> out;
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    if (skeleton.joints[j].parent == joint) out.push_back(static_cast<int>(j));
  }
  return out;
}

int common_ancestor(const Skeleton& skeleton, int a, int b) {
  while (a >= 0 && !is_ancestor(skeleton, a, b)) a = skeleton.joints[a].parent;
  return a;
}

// The toe joint's own End Site, else the last of its descendants in the file's order: the rule that
// readers of an exported pose know.
int toe_end_of(const Skeleton& skeleton, int toe) {
  const auto& joints = skeleton.joints;
  for (const int child : children_of(skeleton, toe)) {
    if (joints[child].is_end_site) return child;
  }
  int last = toe;
  for (int j = toe + 1; j < static_cast<int>(joints.size()); ++j) {
    if (!is_ancestor(skeleton, toe, j)) break;
    last = j;
  }
  return last;
}

// The toe joint of a foot: named so (the one with the most below it); else the furthest child, else
// an End Site. -1 where the foot has no length.
int toe_of(const Shape& shape, int ankle) {
  const auto& joints = shape.skeleton.joints;
  int best = -1, best_rank = 0;
  double best_size = 0.0;
  for (int j = ankle + 1; j < static_cast<int>(joints.size()); ++j) {
    if (!is_ancestor(shape.skeleton, ankle, j)) break;
    const bool is_named =
        !joints[j].is_end_site && named_joint(joints[j].name).part == NamedPart::toe;
    const bool is_child = joints[j].parent == ankle;
    const double length = bone_length(shape, ankle, j);
    if ((!is_named && !is_child) || length <= 0.0) continue;
    const int rank = is_named ? 3 : joints[j].is_end_site ? 1 : 2;
    // Among toes of one name class the first one down the chain wins: it carries the others.
    if (rank > best_rank || (rank < 3 && rank == best_rank && length > best_size)) {
      best = j;
      best_rank = rank;
      best_size = length;
    }
  }
  return best;
}

bool complete(const Shape& shape, LegJoints& leg) {
  if (leg.toe < 0) leg.toe = toe_of(shape, leg.ankle);
  if (leg.toe < 0) return false;
  leg.toe_end = toe_end_of(shape.skeleton, leg.toe);
  return true;
}

// A thigh and a shank of like length, as all walkers on two legs have.
bool is_leg(const Shape& shape, const LegJoints& leg) {
  const double thigh = bone_length(shape, leg.hip, leg.knee);
  const double shank = bone_length(shape, leg.knee, leg.ankle);
  return thigh > 0.0 && shank > 0.0 && thigh < 2.5 * shank && shank < 2.5 * thigh;
}

bool is_pair(const Shape& shape, const Legs& legs) {
  std::array<double, 2> length{};
  for (int s = 0; s < 2; ++s) {
    if (!is_leg(shape, legs[s])) return false;
    length[s] = bone_length(shape, legs[s].hip, legs[s].knee) +
                bone_length(shape, legs[s].knee, legs[s].ankle);
  }
  const bool is_separate = !is_ancestor(shape.skeleton, legs[0].hip, legs[1].hip) &&
                           !is_ancestor(shape.skeleton, legs[1].hip, legs[0].hip);
  return is_separate && length[0] < 1.5 * length[1] && length[1] < 1.5 * length[0];
}

int nearest_ancestor(const Skeleton& skeleton, int joint, NamedJoint wanted) {
  for (int j = skeleton.joints[joint].parent; j >= 0; j = skeleton.joints[j].parent) {
    const NamedJoint n = named_joint(skeleton.joints[j].name);
    if (n.part == wanted.part && n.side == wanted.side) return j;
  }
  return -1;
}

// The first ankle of that side below a knee below a hip.
std::optional<LegJoints> named_leg(const Shape& shape, NamedSide side) {
  const auto& joints = shape.skeleton.joints;
  for (int j = 0; j < static_cast<int>(joints.size()); ++j) {
    const NamedJoint n = named_joint(joints[j].name);
    if (joints[j].is_end_site || n.side != side || n.part != NamedPart::ankle) continue;
    LegJoints leg;
    leg.ankle = j;
    leg.knee = nearest_ancestor(shape.skeleton, j, {side, NamedPart::knee});
    if (leg.knee < 0) continue;
    leg.hip = nearest_ancestor(shape.skeleton, leg.knee, {side, NamedPart::hip});
    if (leg.hip >= 0 && is_leg(shape, leg) && complete(shape, leg)) return leg;
  }
  return std::nullopt;
}

// Chain from below the common ancestor to a leaf; its two longest neighbouring bones are the leg's.
std::optional<LegJoints> chain_leg(const Shape& shape, int ancestor, int leaf) {
  std::vector<int> chain;  // leaf upwards, joints at one place only once
  for (int j = leaf; j != ancestor; j = shape.skeleton.joints[j].parent) {
    if (chain.empty() || bone_length(shape, j, chain.back()) > 0.0) chain.push_back(j);
  }
  LegJoints best;
  double longest = 0.0;
  for (std::size_t i = 1; i + 2 < chain.size(); ++i) {
    LegJoints leg;
    leg.ankle = chain[i];
    leg.knee = chain[i + 1];
    leg.hip = chain[i + 2];
    const double length =
        bone_length(shape, leg.hip, leg.knee) + bone_length(shape, leg.knee, leg.ankle);
    if (length > longest && is_leg(shape, leg)) {
      best = leg;
      longest = length;
    }
  }
  if (longest == 0.0 || !complete(shape, best)) return std::nullopt;
  return best;
}

// Leaves from the lowest upwards; the first pair that hangs on one joint in two branches and is a
// pair of legs. At most the 24 lowest leaves are tried.
std::optional<Legs> lowest_chains(const Shape& shape, int up_axis) {
  const auto& at = shape.frames[shape.frames.size() / 2].position_m;
  std::vector<int> leaves;
  for (int j = 1; j < static_cast<int>(shape.skeleton.joints.size()); ++j) {
    if (children_of(shape.skeleton, j).empty()) leaves.push_back(j);
  }
  std::ranges::stable_sort(leaves, {}, [&](int j) { return at[j][up_axis]; });
  if (leaves.size() > 24) leaves.resize(24);
  for (std::size_t b = 1; b < leaves.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      const int ancestor = common_ancestor(shape.skeleton, leaves[a], leaves[b]);
      const auto one = chain_leg(shape, ancestor, leaves[a]);
      const auto two = chain_leg(shape, ancestor, leaves[b]);
      if (!one || !two) continue;
      const Legs legs = {*one, *two};
      const bool hangs = at[one->hip][up_axis] > at[one->ankle][up_axis] &&
                         at[two->hip][up_axis] > at[two->ankle][up_axis];
      if (hangs && is_pair(shape, legs)) return legs;
    }
  }
  return std::nullopt;
}

// Toes point forward and ankles lie below hips, so left = up x forward needs no axis of the file.
void put_left_first(const Shape& shape, Legs& legs) {
  double left = 0.0;
  for (const JointFrames& frame : shape.frames) {
    const auto& at = frame.position_m;
    const vec3 across = at[legs[0].hip] - at[legs[1].hip];
    vec3 up(0.0), forward(0.0);
    for (const LegJoints& leg : legs) {
      up += at[leg.hip] - at[leg.ankle];
      forward += at[leg.toe] - at[leg.ankle];
    }
    left += glm::dot(across, glm::cross(up, forward));
  }
  if (left < 0.0) std::swap(legs[0], legs[1]);
}

bool is_given(const LegNames& n) {
  return !n.hip.empty() || !n.knee.empty() || !n.ankle.empty() || !n.toe.empty();
}

// The joints given by hand over those that were found (if any).
std::optional<Error> apply(const Shape& shape, const LegNames& names, const char* side,
                           LegJoints& leg) {
  const std::array<std::pair<const std::string*, int*>, 4> parts = {{{&names.hip, &leg.hip},
                                                                     {&names.knee, &leg.knee},
                                                                     {&names.ankle, &leg.ankle},
                                                                     {&names.toe, &leg.toe}}};
  if (!names.ankle.empty() && names.toe.empty()) leg.toe = -1;
  for (const auto& [name, joint] : parts) {
    if (name->empty()) continue;
    *joint = shape.skeleton.find(*name);
    if (*joint < 0) return Error{fmt::format("no joint \"{}\" for the {} leg", *name, side)};
  }
  const auto& s = shape.skeleton;
  const bool is_chain = leg.hip >= 0 && leg.knee >= 0 && leg.ankle >= 0 && leg.hip != leg.knee &&
                        leg.knee != leg.ankle && is_ancestor(s, leg.hip, leg.knee) &&
                        is_ancestor(s, leg.knee, leg.ankle);
  if (!is_chain || !complete(shape, leg) || leg.toe == leg.ankle ||
      !is_ancestor(s, leg.ankle, leg.toe)) {
    return Error{
        fmt::format("the {} leg's joints are not hip, knee, ankle and toe of one chain", side)};
  }
  return std::nullopt;
}

}  // namespace

bool is_ancestor(const Skeleton& skeleton, int ancestor, int joint) {
  while (joint > ancestor) joint = skeleton.joints[joint].parent;
  return joint == ancestor;
}

int pelvis_of(const Skeleton& skeleton, const std::array<LegJoints, 2>& legs) {
  return common_ancestor(skeleton, legs[0].hip, legs[1].hip);
}

Result<std::array<LegJoints, 2>> find_legs(const Motion& motion,
                                           const std::array<LegNames, 2>& given) {
  const Shape shape = shape_of(motion);
  Legs legs;
  const auto left = named_leg(shape, NamedSide::left);
  const auto right = named_leg(shape, NamedSide::right);
  bool is_found = left && right && is_pair(shape, {*left, *right});
  if (is_found) legs = {*left, *right};
  for (int up_axis = 1; up_axis <= 2 && !is_found; ++up_axis) {
    if (const auto chains = lowest_chains(shape, up_axis)) {
      legs = *chains;
      put_left_first(shape, legs);
      is_found = true;
    }
  }
  constexpr std::array<const char*, 2> kSides = {"left", "right"};
  for (int s = 0; s < 2; ++s) {
    if (!is_given(given[s])) continue;
    if (const auto error = apply(shape, given[s], kSides[s], legs[s])) return *error;
  }
  const bool both_given = is_given(given[0]) && is_given(given[1]);
  if (!is_found && !both_given) {
    return Error{"no two legs (hip, knee, ankle and foot on two sides) in the skeleton"};
  }
  if (!is_pair(shape, legs)) return Error{"the two legs are not a pair of like length"};
  return legs;
}

}  // namespace gaitpad
