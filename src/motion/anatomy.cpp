// The words of a joint's name, for those who look for legs, arms and spine.

#include "gaitpad/anatomy.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/motion.h"

namespace gaitpad {

// "CC_Base_L_ToeBase" -> cc base l toe base; "LHipJoint" -> l hip joint; digits and marks separate,
// what stands before the last colon is left out.
std::vector<std::string> name_words(std::string_view name);

// Of a whole word: l, left, lft, r, right, rgt.
NamedSide named_side(std::string_view word);

// What a joint's name says about arms, neck and head. Part of body_joints.

enum class BodyPart {
  none,
  collar,
  shoulder,   // "LeftShoulder": the collar where an upper arm follows, else the upper arm itself
  upper_arm,  // the joint at its upper end
  elbow,
  wrist,
  neck,
  head,
};
struct BodyName {
  NamedSide side = NamedSide::none;
  BodyPart part = BodyPart::none;
};
// Twist joints, fingers and the like are none.
BodyName body_name(std::string_view name);

namespace {

char lower(char c) { return (c >= 'A' && c <= 'Z') ? static_cast<char>(c + 32) : c; }
bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
bool is_lower(char c) { return c >= 'a' && c <= 'z'; }

}  // namespace

std::vector<std::string> name_words(std::string_view name) {
  if (const auto colon = name.rfind(':'); colon != name.npos) name.remove_prefix(colon + 1);
  std::vector<std::string> out(1);
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    if (!is_upper(c) && !is_lower(c)) {
      out.emplace_back();
      continue;
    }
    const bool starts_word =
        is_upper(c) && i > 0 &&
        (is_lower(name[i - 1]) || (i + 1 < name.size() && is_lower(name[i + 1])));
    if (starts_word) out.emplace_back();
    out.back() += lower(c);
  }
  std::erase_if(out, [](const std::string& w) { return w.empty(); });
  return out;
}

NamedSide named_side(std::string_view word) {
  if (word == "l" || word == "left" || word == "lft") return NamedSide::left;
  if (word == "r" || word == "right" || word == "rgt") return NamedSide::right;
  return NamedSide::none;
}

namespace {

constexpr std::string_view kHipWords[] = {"thigh", "femur", "hip", "upleg", "upperleg", "buttock"};
constexpr std::string_view kKneeWords[] = {"knee",   "shin",     "calf",  "tibia", "leg",
                                           "lowleg", "lowerleg", "loleg", "shank"};
constexpr std::string_view kAnkleWords[] = {"ankle", "foot"};
constexpr std::string_view kToeWords[] = {"toe", "toes", "ball", "bale", "toebase", "forefoot"};

NamedPart part_of(std::string_view word) {
  const auto among = [&](const auto& list) {
    return std::ranges::find(list, word) != std::end(list);
  };
  if (among(kToeWords)) return NamedPart::toe;
  if (among(kAnkleWords)) return NamedPart::ankle;
  if (among(kKneeWords)) return NamedPart::knee;
  if (among(kHipWords)) return NamedPart::hip;
  return NamedPart::none;
}

// Helper joints beside or inside a bone, never its end.
bool is_helper(std::string_view word) {
  return word == "twist" || word == "share" || word == "roll" || word == "rigmesh" ||
         word == "pole" || word == "ik" || word == "metatarsals" || word == "end" || word == "nub";
}

// "lfoot", "rightankle": a side and a part in one word.
bool joined(const std::string& word, NamedJoint& joint) {
  for (const std::size_t n : {std::size_t{5}, std::size_t{4}, std::size_t{1}}) {
    if (word.size() <= n) continue;
    const NamedSide side = named_side(std::string_view(word).substr(0, n));
    const NamedPart part = part_of(std::string_view(word).substr(n));
    if (side == NamedSide::none || part == NamedPart::none) continue;
    joint = {side, part};
    return true;
  }
  return false;
}

}  // namespace

NamedJoint named_joint(std::string_view name) {
  NamedJoint joint;
  const std::vector<std::string> all = name_words(name);
  bool is_upper_part = false, is_buttock = false;
  for (const std::string& word : all) {
    if (is_helper(word)) return {};
    if (joint.side == NamedSide::none) joint.side = named_side(word);
    is_upper_part |= word == "up" || word == "upper";
    is_buttock |= word == "buttock" || word == "buttocks";
    if (joint.part == NamedPart::none) joint.part = part_of(word);
    // "ToeBase", "FootToes": the outer word counts; "ball" of "LeftFootBall" too.
    if (part_of(word) == NamedPart::toe) joint.part = NamedPart::toe;
  }
  if (joint.part == NamedPart::none || joint.side == NamedSide::none) {
    for (const std::string& word : all) {
      if (joined(word, joint)) break;
    }
  }
  if (joint.part == NamedPart::knee && is_upper_part) joint.part = NamedPart::hip;
  if (joint.side == NamedSide::none || is_buttock) joint.part = NamedPart::none;
  return joint;
}

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

namespace {

constexpr std::string_view kCollarWords[] = {"collar", "clavicle", "clav", "collarbone", "scapula"};
constexpr std::string_view kShoulderWords[] = {"shoulder", "shoulderjoint"};
constexpr std::string_view kUpperWords[] = {"humerus", "shldr", "uparm", "upperarm",
                                            "upprarm", "bicep", "biceps"};
constexpr std::string_view kElbowWords[] = {"elbow",    "forearm", "radius", "ulna",
                                            "lowerarm", "lowarm",  "loarm"};
constexpr std::string_view kWristWords[] = {"wrist", "hand"};
// Beside or inside a bone, at its end, or beyond the wrist.
constexpr std::string_view kHelperWords[] = {
    "twist",  "share",   "roll",  "rigmesh", "pole",       "ik",      "end",      "nub",
    "dum",    "thumb",   "index", "middle",  "mid",        "ring",    "pinky",    "little",
    "finger", "fingers", "palm",  "carpal",  "metacarpal", "carpals", "pectoral", "eye",
    "top",    "weapon",  "prop",  "leg",     "foot",       "hip"};

template <std::size_t n>
bool among(const std::string_view (&list)[n], std::string_view word) {
  return std::find(list, list + n, word) != list + n;
}

BodyPart body_part_of(std::string_view word) {
  if (among(kCollarWords, word)) return BodyPart::collar;
  if (among(kShoulderWords, word)) return BodyPart::shoulder;
  if (among(kUpperWords, word)) return BodyPart::upper_arm;
  if (among(kElbowWords, word)) return BodyPart::elbow;
  if (among(kWristWords, word)) return BodyPart::wrist;
  return BodyPart::none;
}

// "lhumerus", "rightelbow": a side and a part in one word.
bool joined(std::string_view word, BodyName& joint) {
  for (const std::size_t n : {std::size_t{5}, std::size_t{4}, std::size_t{1}}) {
    if (word.size() <= n) continue;
    const NamedSide side = named_side(word.substr(0, n));
    const BodyPart part = body_part_of(word.substr(n));
    if (side == NamedSide::none || part == BodyPart::none) continue;
    joint = {side, part};
    return true;
  }
  return false;
}

// Two words of one: "Fore Arm", "Lower Arm", "Upper Arm"; "Arm" alone is the upper one.
BodyPart arm_of(const std::vector<std::string>& all) {
  bool is_arm = false, is_lower = false;
  for (const std::string& word : all) {
    is_arm |= word == "arm";
    is_lower |= word == "fore" || word == "low" || word == "lower" || word == "lo";
  }
  if (!is_arm) return BodyPart::none;
  return is_lower ? BodyPart::elbow : BodyPart::upper_arm;
}

// "Neck", "upperneck", "Neck1"; "NeckTwist01" is the only neck that its skeletons have.
BodyPart middle_part(const std::vector<std::string>& all) {
  for (const std::string& word : all) {
    if (word == "neck" || word == "lowerneck" || word == "upperneck") return BodyPart::neck;
    if (word == "head" || word == "skull") {
      const bool is_helper = std::any_of(
          all.begin(), all.end(), [](const std::string& w) { return among(kHelperWords, w); });
      return is_helper ? BodyPart::none : BodyPart::head;
    }
  }
  return BodyPart::none;
}

}  // namespace

BodyName body_name(std::string_view name) {
  const std::vector<std::string> all = name_words(name);
  BodyName joint{NamedSide::none, middle_part(all)};
  if (joint.part != BodyPart::none) return joint;
  for (const std::string& word : all) {
    if (among(kHelperWords, word)) return {};
    if (joint.side == NamedSide::none) joint.side = named_side(word);
    if (joint.part == BodyPart::none) joint.part = body_part_of(word);
  }
  if (const BodyPart arm = arm_of(all); arm != BodyPart::none) joint.part = arm;
  if (joint.side == NamedSide::none || joint.part == BodyPart::none) {
    for (const std::string& word : all) {
      if (joined(word, joint)) break;
    }
  }
  if (joint.side == NamedSide::none) return {};
  return joint;
}

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
