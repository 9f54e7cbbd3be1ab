#include "gaitpad/anatomy.h"

#include <algorithm>
#include <optional>

#include "gaitpad/limbs.h"

namespace gaitpad {
namespace {

// --- What a name says ---------------------------------------------------------------------------

// Words are in lower case, separated by spaces.
struct PartWords {
  NamedPart part;
  std::string_view words;
};
constexpr PartWords kPartWords[] = {
    {NamedPart::toe, "toe toes ball bale toebase forefoot"},
    {NamedPart::ankle, "ankle foot"},
    // "UpLeg" and "Upper Leg" are the hip: named_joint() sees to that.
    {NamedPart::knee, "knee shin calf tibia leg lowleg lowerleg loleg shank"},
    {NamedPart::hip, "thigh femur hip upleg upperleg"},
    {NamedPart::collar, "collar clavicle clav collarbone scapula"},
    {NamedPart::shoulder, "shoulder shoulderjoint"},
    {NamedPart::upper_arm, "humerus shldr uparm upperarm upprarm bicep biceps"},
    {NamedPart::elbow, "elbow forearm radius ulna lowerarm lowarm loarm"},
    {NamedPart::wrist, "wrist hand"},
};
constexpr std::string_view kNeckWords = "neck lowerneck upperneck", kHeadWords = "head skull";
// Joints beside or inside a bone, or at its tip: never the joint that turns it.
constexpr std::string_view kHelperWords = "twist share roll rigmesh pole ik metatarsals end nub";
// Joints beyond the wrist, beside an arm or on a head. Leg joints may contain these words
// ("MiddleToe").
constexpr std::string_view kBesideArmWords =
    "dum thumb index middle mid ring pinky little finger fingers palm carpal metacarpal carpals "
    "pectoral eye top weapon prop leg foot hip";
// Joints beside the hip joint, under the thigh.
constexpr std::string_view kBesideLegWords = "buttock buttocks";

bool is_among(std::string_view words, std::string_view word) {
  for (std::size_t at = words.find(word); at != words.npos; at = words.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || words[at - 1] == ' ') && (end == words.size() || words[end] == ' '))
      return true;
  }
  return false;
}

bool is_upper_case(char c) { return c >= 'A' && c <= 'Z'; }
bool is_lower_case(char c) { return c >= 'a' && c <= 'z'; }

// The words of a name in lower case: "CC_Base_L_ToeBase" gives cc base l toe base, "LHipJoint"
// gives l hip joint. Digits and marks separate words. A prefix up to the last colon is dropped.
std::vector<std::string> name_words(std::string_view name) {
  if (const auto colon = name.rfind(':'); colon != name.npos) name.remove_prefix(colon + 1);
  std::vector<std::string> words(1);
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    if (!is_upper_case(c) && !is_lower_case(c)) {
      words.emplace_back();
      continue;
    }
    const bool starts_word =
        is_upper_case(c) && i > 0 &&
        (is_lower_case(name[i - 1]) || (i + 1 < name.size() && is_lower_case(name[i + 1])));
    if (starts_word) words.emplace_back();
    words.back() += is_upper_case(c) ? static_cast<char>(c + 32) : c;
  }
  std::erase_if(words, [](const std::string& w) { return w.empty(); });
  return words;
}

NamedSide side_of(std::string_view word) {
  if (is_among("l left lft", word)) return NamedSide::left;
  if (is_among("r right rgt", word)) return NamedSide::right;
  return NamedSide::none;
}

NamedPart part_of(std::string_view word) {
  for (const PartWords& known : kPartWords) {
    if (is_among(known.words, word)) return known.part;
  }
  return NamedPart::none;
}

bool is_leg_part(NamedPart part) { return part >= NamedPart::hip && part <= NamedPart::toe; }

// "lfoot", "rightelbow": a side and a part in one word.
std::optional<NamedJoint> joined(std::string_view word) {
  for (const std::size_t n : {std::size_t{5}, std::size_t{4}, std::size_t{1}}) {
    if (word.size() <= n) continue;
    const NamedJoint joint{side_of(word.substr(0, n)), part_of(word.substr(n))};
    if (joint.side != NamedSide::none && joint.part != NamedPart::none) return joint;
  }
  return std::nullopt;
}

// Neck or head, otherwise none: "Neck", "upperneck", "Neck1". A neck may contain a helper word,
// because "NeckTwist01" is the only neck of some skeletons; a head may not ("HeadEnd", "HeadTop").
NamedPart middle_part(const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if (is_among(kNeckWords, word)) return NamedPart::neck;
    if (!is_among(kHeadWords, word)) continue;
    const bool is_beside = std::any_of(words.begin(), words.end(), [](const std::string& w) {
      return is_among(kHelperWords, w) || is_among(kBesideArmWords, w);
    });
    return is_beside ? NamedPart::none : NamedPart::head;
  }
  return NamedPart::none;
}

}  // namespace

NamedJoint named_joint(std::string_view name) {
  const std::vector<std::string> words = name_words(name);
  NamedJoint joint{NamedSide::none, middle_part(words)};
  if (joint.part != NamedPart::none) return joint;
  bool is_upper = false, is_lower = false, is_arm = false, is_beside_arm = false,
       is_beside_leg = false;
  for (const std::string& word : words) {
    if (is_among(kHelperWords, word)) return {};
    if (joint.side == NamedSide::none) joint.side = side_of(word);
    // Toe words win over foot words: "FootToes" and "LeftFootBall" are toes.
    const NamedPart part = part_of(word);
    if (joint.part == NamedPart::none || part == NamedPart::toe) joint.part = part;
    is_upper |= is_among("up upper", word);
    is_lower |= is_among("fore low lower lo", word);
    is_arm |= word == "arm";
    is_beside_arm |= is_among(kBesideArmWords, word);
    is_beside_leg |= is_among(kBesideLegWords, word);
  }
  // "Fore Arm", "Lower Arm", "Upper Arm"; "Arm" alone is the upper one.
  if (is_arm && !is_leg_part(joint.part))
    joint.part = is_lower ? NamedPart::elbow : NamedPart::upper_arm;
  if (joint.part == NamedPart::none || joint.side == NamedSide::none) {
    for (const std::string& word : words) {
      const auto found = joined(word);
      if (!found) continue;
      joint = *found;
      break;
    }
  }
  if (joint.part == NamedPart::knee && is_upper) joint.part = NamedPart::hip;
  if (is_leg_part(joint.part) ? is_beside_leg : is_beside_arm) joint.part = NamedPart::none;
  return joint.side == NamedSide::none ? NamedJoint{} : joint;
}

namespace {

// --- Legs and arms alike: two bones of like length -----------------------------------------------

// A skeleton and the places of its joints in one pose.
struct Figure {
  const Skeleton& skeleton;
  std::span<const vec3> at;

  const Joint& joint(int j) const { return skeleton.joints[j]; }
  int parent(int j) const { return joint(j).parent; }
  NamedJoint named(int j) const { return named_joint(joint(j).name); }
  int count() const { return static_cast<int>(skeleton.joints.size()); }
  double distance(int a, int b) const { return glm::distance(at[a], at[b]); }
  bool carries(int ancestor, int j) const { return is_ancestor(skeleton, ancestor, j); }
  // The index after a joint's last descendant: all descendants follow their ancestor.
  int branch_end(int ancestor) const {
    int end = ancestor + 1;
    while (end < count() && carries(ancestor, end)) ++end;
    return end;
  }
};

// Hip, knee and ankle, or shoulder, elbow and wrist.
struct Limb {
  int upper = -1, middle = -1, lower = -1;
};
Limb limb_of(const LegJoints& leg) { return {leg.hip, leg.knee, leg.ankle}; }
Limb limb_of(const ArmChain& arm) { return {arm.shoulder, arm.elbow, arm.wrist}; }

double length_of(const Figure& figure, const Limb& limb) {
  return figure.distance(limb.upper, limb.middle) + figure.distance(limb.middle, limb.lower);
}

// Thigh and shank, and upper arm and forearm, have similar lengths: their ratio is below 2.5.
bool is_limb(const Figure& figure, const Limb& limb) {
  const double upper = figure.distance(limb.upper, limb.middle);
  const double lower = figure.distance(limb.middle, limb.lower);
  return upper > 0.0 && lower > 0.0 && upper < 2.5 * lower && lower < 2.5 * upper;
}

// The longest limb of three neighbouring joints of a chain. Returns the index of the first of them;
// -1 if there is none.
int longest_limb(const Figure& figure, std::span<const int> chain) {
  int best = -1;
  double longest = 0.0;
  for (std::size_t i = 0; i + 2 < chain.size(); ++i) {
    const Limb limb{chain[i], chain[i + 1], chain[i + 2]};
    const double length = length_of(figure, limb);
    if (length <= longest || !is_limb(figure, limb)) continue;
    longest = length;
    best = static_cast<int>(i);
  }
  return best;
}

// Adds a joint to a chain, unless it is in the last one's place.
void add_apart(const Figure& figure, int joint, std::vector<int>& chain) {
  if (chain.empty() || figure.distance(joint, chain.back()) > 0.0) chain.push_back(joint);
}

// Two limbs of similar length (ratio below 1.5), neither of which is a descendant of the other.
bool is_pair(const Figure& figure, const Limb& left, const Limb& right) {
  const double left_m = length_of(figure, left), right_m = length_of(figure, right);
  return left_m < 1.5 * right_m && right_m < 1.5 * left_m &&
         !figure.carries(left.upper, right.upper) && !figure.carries(right.upper, left.upper);
}

int common_ancestor(const Skeleton& skeleton, int a, int b) {
  while (a >= 0 && !is_ancestor(skeleton, a, b)) a = skeleton.joints[a].parent;
  return a;
}

// The nearest ancestor of `joint` with that side and part; -1 if there is none.
int named_ancestor(const Figure& figure, int joint, NamedSide side, NamedPart part) {
  for (int j = figure.parent(joint); j >= 0; j = figure.parent(j)) {
    const NamedJoint named = figure.named(j);
    if (named.side == side && named.part == part) return j;
  }
  return -1;
}

// --- Legs ----------------------------------------------------------------------------------------

using Legs = std::array<LegJoints, 2>;

// The End Site of a joint; -1 if it has none.
int end_site_of(const Skeleton& skeleton, int joint) {
  for (const int child : children_of(skeleton, joint)) {
    if (skeleton.joints[child].is_end_site) return child;
  }
  return -1;
}

// The toe joint's own End Site, otherwise its last descendant in the file's order. Scripts that
// read exported poses follow the same rule.
int toe_end_of(const Figure& figure, int toe) {
  const int end = end_site_of(figure.skeleton, toe);
  return end >= 0 ? end : figure.branch_end(toe) - 1;
}

// The toe joint of a foot: the first joint named as a toe, because it carries the others; otherwise
// the farthest child joint; otherwise the farthest End Site. -1 if the foot has no length.
int toe_of(const Figure& figure, int ankle) {
  int best = -1, best_rank = 0;
  double best_length = 0.0;
  for (int j = ankle + 1, end = figure.branch_end(ankle); j < end; ++j) {
    const Joint& joint = figure.joint(j);
    const bool is_named = !joint.is_end_site && figure.named(j).part == NamedPart::toe;
    const double length = figure.distance(ankle, j);
    if ((!is_named && joint.parent != ankle) || length <= 0.0) continue;
    const int rank = is_named ? 3 : joint.is_end_site ? 1 : 2;
    if (rank > best_rank || (rank < 3 && rank == best_rank && length > best_length)) {
      best = j;
      best_rank = rank;
      best_length = length;
    }
  }
  return best;
}

// Finds the toe, if it is not given, and its end. Returns false if the foot has no length.
bool complete_foot(const Figure& figure, LegJoints& leg) {
  if (leg.toe < 0) leg.toe = toe_of(figure, leg.ankle);
  if (leg.toe < 0) return false;
  leg.toe_end = toe_end_of(figure, leg.toe);
  return true;
}

// The first ankle of that side that is below a knee that is below a hip.
std::optional<LegJoints> named_leg(const Figure& figure, NamedSide side) {
  for (int j = 0; j < figure.count(); ++j) {
    const NamedJoint named = figure.named(j);
    if (figure.joint(j).is_end_site || named.side != side || named.part != NamedPart::ankle)
      continue;
    LegJoints leg;
    leg.ankle = j;
    leg.knee = named_ancestor(figure, j, side, NamedPart::knee);
    if (leg.knee < 0) continue;
    leg.hip = named_ancestor(figure, leg.knee, side, NamedPart::hip);
    if (leg.hip < 0 || !is_limb(figure, limb_of(leg))) continue;
    // Accept a foot without length, which old Acclaim skeletons have, if its ankle has a name.
    // build_toes() gives it the usual length.
    if (toe_of(figure, j) < 0) leg.toe = end_site_of(figure.skeleton, j);
    if (complete_foot(figure, leg)) return leg;
  }
  return std::nullopt;
}

// The leg between `ancestor` and a leaf: its two longest neighbouring bones. The foot follows them,
// so the leaf itself is no ankle.
std::optional<LegJoints> shaped_leg(const Figure& figure, int ancestor, int leaf) {
  std::vector<int> chain;  // joints from the leaf upwards; of joints in one place only one
  for (int j = leaf; j != ancestor; j = figure.parent(j)) add_apart(figure, j, chain);
  if (chain.empty()) return std::nullopt;
  const std::span<const int> above_leaf = std::span(chain).subspan(1);
  const int first = longest_limb(figure, above_leaf);
  if (first < 0) return std::nullopt;
  LegJoints leg;
  leg.ankle = above_leaf[first], leg.knee = above_leaf[first + 1], leg.hip = above_leaf[first + 2];
  return complete_foot(figure, leg) ? std::optional(leg) : std::nullopt;
}

// Takes pairs of leaves from the lowest upwards, and returns the first pair that hangs on one joint
// in two branches and makes a pair of legs. At most the 24 lowest leaves are tried.
std::optional<Legs> shaped_legs(const Figure& figure, int up_axis) {
  const auto height = [&](int j) { return figure.at[j][up_axis]; };
  const auto is_lower = [&](int a, int b) { return height(a) < height(b); };
  std::vector<int> leaves;
  for (int j = 1; j < figure.count(); ++j) {
    if (children_of(figure.skeleton, j).empty()) leaves.push_back(j);
  }
  std::stable_sort(leaves.begin(), leaves.end(), is_lower);
  if (leaves.size() > 24) leaves.resize(24);
  for (std::size_t b = 1; b < leaves.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      const int ancestor = common_ancestor(figure.skeleton, leaves[a], leaves[b]);
      const auto one = shaped_leg(figure, ancestor, leaves[a]);
      const auto two = shaped_leg(figure, ancestor, leaves[b]);
      if (!one || !two) continue;
      const bool hangs =
          height(one->hip) > height(one->ankle) && height(two->hip) > height(two->ankle);
      if (hangs && is_pair(figure, limb_of(*one), limb_of(*two))) return Legs{*one, *two};
    }
  }
  return std::nullopt;
}

// Swaps the legs if the first is the right one. Left is up x forward, with up from ankle to hip and
// forward from ankle to toe, so the file's axes need not be known.
void put_left_first(const std::vector<JointFrames>& frames, Legs& legs) {
  double left = 0.0;
  for (const JointFrames& frame : frames) {
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

bool is_given(const LegNames& names) {
  return !names.hip.empty() || !names.knee.empty() || !names.ankle.empty() || !names.toe.empty();
}

// Replaces found joints by those that the user named.
std::optional<Error> take_given_joints(const Figure& figure, const LegNames& names,
                                       const std::string& side, LegJoints& leg) {
  const std::array<std::pair<const std::string*, int*>, 4> parts = {{{&names.hip, &leg.hip},
                                                                     {&names.knee, &leg.knee},
                                                                     {&names.ankle, &leg.ankle},
                                                                     {&names.toe, &leg.toe}}};
  if (!names.ankle.empty() && names.toe.empty()) leg.toe = -1;
  for (const auto& [name, joint] : parts) {
    if (name->empty()) continue;
    *joint = figure.skeleton.find(*name);
    if (*joint < 0) return Error{"no joint \"" + *name + "\" for the " + side + " leg"};
  }
  const bool is_chain = leg.hip >= 0 && leg.knee >= 0 && leg.ankle >= 0 && leg.hip != leg.knee &&
                        leg.knee != leg.ankle && figure.carries(leg.hip, leg.knee) &&
                        figure.carries(leg.knee, leg.ankle);
  if (!is_chain || !complete_foot(figure, leg) || leg.toe == leg.ankle ||
      !figure.carries(leg.ankle, leg.toe)) {
    return Error{"the " + side + " leg's joints are not hip, knee, ankle and toe of one chain"};
  }
  return std::nullopt;
}

// World places of the joints in up to nine frames spread over the motion.
std::vector<JointFrames> spread_frames(const Motion& motion) {
  std::vector<JointFrames> frames(std::min<std::size_t>(motion.frames.size(), 9));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::size_t last = motion.frames.size() - 1;
    const std::size_t frame = frames.size() < 2 ? 0 : i * last / (frames.size() - 1);
    forward_kinematics(motion, motion.frames[frame], frames[i]);
  }
  return frames;
}

}  // namespace

bool is_ancestor(const Skeleton& skeleton, int ancestor, int joint) {
  while (joint > ancestor) joint = skeleton.joints[joint].parent;
  return joint == ancestor;
}

std::vector<int> children_of(const Skeleton& skeleton, int joint) {
  std::vector<int> out;
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    if (skeleton.joints[j].parent == joint) out.push_back(static_cast<int>(j));
  }
  return out;
}

std::vector<int> path_below(const Skeleton& skeleton, int top, int joint) {
  std::vector<int> path;
  for (int j = joint; j > top && j >= 0; j = skeleton.joints[j].parent) path.push_back(j);
  std::reverse(path.begin(), path.end());
  return path;
}

int pelvis_of(const Skeleton& skeleton, const std::array<LegJoints, 2>& legs) {
  return common_ancestor(skeleton, legs[0].hip, legs[1].hip);
}

Result<std::array<LegJoints, 2>> find_legs(const Motion& motion,
                                           const std::array<LegNames, 2>& given) {
  if (auto problem = check(motion)) return *problem;
  const std::vector<JointFrames> frames = spread_frames(motion);
  const Figure figure{motion.skeleton, frames[frames.size() / 2].position_m};
  Legs legs;
  const auto left = named_leg(figure, NamedSide::left);
  const auto right = named_leg(figure, NamedSide::right);
  bool is_found = left && right && is_pair(figure, limb_of(*left), limb_of(*right));
  if (is_found) legs = {*left, *right};
  for (int up_axis = 1; up_axis <= 2 && !is_found; ++up_axis) {
    if (const auto lowest = shaped_legs(figure, up_axis)) {
      legs = *lowest;
      put_left_first(frames, legs);
      is_found = true;
    }
  }
  for (int s = 0; s < 2; ++s) {
    if (!is_given(given[s])) continue;
    if (const auto error = take_given_joints(figure, given[s], kSideNames[s], legs[s]))
      return *error;
  }
  const bool both_given = is_given(given[0]) && is_given(given[1]);
  if (!is_found && !both_given) {
    return Error{"no two legs (hip, knee, ankle and foot on two sides) in the skeleton"};
  }
  const Limb one = limb_of(legs[0]), two = limb_of(legs[1]);
  if (!is_limb(figure, one) || !is_limb(figure, two) || !is_pair(figure, one, two)) {
    return Error{"the two legs are not a pair of like length"};
  }
  return legs;
}

namespace {

// --- Arms, spine, neck and head ------------------------------------------------------------------

bool is_in_leg(const Figure& figure, const Legs& legs, int j) {
  return figure.carries(legs[0].hip, j) || figure.carries(legs[1].hip, j);
}

// The lowest joint below the elbow that is named a wrist or a hand; a higher one turns the forearm
// (CMU's lwrist). Without such a name: the farthest child.
int wrist_below(const Figure& figure, int elbow, NamedSide side) {
  int farthest = -1, lowest_named = -1;
  for (int j = elbow + 1, end = figure.branch_end(elbow); j < end; ++j) {
    const NamedJoint named = figure.named(j);
    const bool is_lower = lowest_named < 0 || figure.carries(lowest_named, j);
    if (named.side == side && named.part == NamedPart::wrist && is_lower) lowest_named = j;
    const bool is_child = figure.parent(j) == elbow;
    if (is_child && (farthest < 0 || figure.distance(elbow, j) > figure.distance(elbow, farthest)))
      farthest = j;
  }
  return lowest_named >= 0 ? lowest_named : farthest;
}

ArmChain named_arm(const Figure& figure, const Legs& legs, NamedSide side) {
  const auto above = [&](int joint, NamedPart part) {
    return named_ancestor(figure, joint, side, part);
  };
  for (int j = 0; j < figure.count(); ++j) {
    const NamedJoint named = figure.named(j);
    if (named.side != side || named.part != NamedPart::elbow || is_in_leg(figure, legs, j))
      continue;
    ArmChain arm;
    arm.elbow = j;
    arm.wrist = wrist_below(figure, j, side);
    arm.shoulder = above(j, NamedPart::upper_arm);
    if (arm.shoulder < 0) arm.shoulder = above(j, NamedPart::shoulder);
    if (arm.shoulder < 0 || arm.wrist < 0 || !is_limb(figure, limb_of(arm))) continue;
    arm.collar = above(arm.shoulder, NamedPart::collar);
    if (arm.collar < 0) arm.collar = above(arm.shoulder, NamedPart::shoulder);
    return arm;
  }
  return {};
}

// The arm between `top` and a leaf: its two longest neighbouring bones of similar length.
ArmChain shaped_arm(const Figure& figure, int top, int leaf) {
  std::vector<int> chain;  // joints from the top; of joints in one place only one
  for (const int j : path_below(figure.skeleton, top, leaf)) add_apart(figure, j, chain);
  const int first = longest_limb(figure, chain);
  ArmChain arm;
  if (first < 0) return arm;
  arm.collar = first > 0 ? chain[first - 1] : -1;
  arm.shoulder = chain[first], arm.elbow = chain[first + 1], arm.wrist = chain[first + 2];
  return arm;
}

// The longest arm on each side of the trunk. The left hip tells which side is left.
std::array<ArmChain, 2> shaped_arms(const Figure& figure, const Legs& legs, int top) {
  std::array<ArmChain, 2> arms;
  const vec3 left = figure.at[legs[0].hip] - figure.at[legs[1].hip];
  for (int j = 0; j < figure.count(); ++j) {
    if (!children_of(figure.skeleton, j).empty() || is_in_leg(figure, legs, j) || j == top)
      continue;
    const ArmChain arm = shaped_arm(figure, common_ancestor(figure.skeleton, j, top), j);
    if (!arm.is_found()) continue;
    const vec3 out = figure.at[arm.shoulder] - figure.at[top];
    ArmChain& place = arms[glm::dot(out, left) > 0.0 ? kLeftSide : kRightSide];
    const bool is_longer =
        !place.is_found() || length_of(figure, limb_of(arm)) > length_of(figure, limb_of(place));
    if (is_longer) place = arm;
  }
  const bool are_both = arms[0].is_found() && arms[1].is_found();
  if (!are_both || !is_pair(figure, limb_of(arms[0]), limb_of(arms[1]))) return {};
  return arms;
}

// The joint of the hand that is farthest from the wrist along the bones. Thumbs and joints of
// meshes are skipped.
int hand_end_of(const Figure& figure, int wrist) {
  int farthest = -1;
  double longest = 0.0;
  for (int j = wrist + 1, end = figure.branch_end(wrist); j < end; ++j) {
    const std::vector<std::string> words = name_words(figure.joint(j).name);
    const bool is_beside = std::any_of(words.begin(), words.end(), [](const std::string& word) {
      return word.ends_with("thumb") || word.ends_with("mesh");
    });
    double length = 0.0;
    for (int k = j; k != wrist; k = figure.parent(k))
      length += figure.distance(k, figure.parent(k));
    if (is_beside || length <= longest) continue;
    longest = length;
    farthest = j;
  }
  return farthest;
}

// The top of the trunk: the highest joint that is not in a leg.
int highest_joint(const Figure& figure, const Legs& legs) {
  int top = -1;
  for (int j = 0; j < figure.count(); ++j) {
    if (is_in_leg(figure, legs, j)) continue;
    if (top < 0 || figure.at[j].y > figure.at[top].y) top = j;
  }
  return top;
}

// The joint named a head, otherwise the joint that ends highest.
int head_of(const Figure& figure, const Legs& legs, int top) {
  for (int j = 0; j < figure.count(); ++j) {
    const Joint& joint = figure.joint(j);
    const bool is_head = figure.named(j).part == NamedPart::head;
    if (is_head && !joint.is_end_site && !is_in_leg(figure, legs, j)) return j;
  }
  if (top <= 0) return -1;
  return figure.joint(top).is_end_site ? figure.parent(top) : top;
}

int head_top_of(const Figure& figure, int head) {
  if (head < 0) return -1;
  int top = head;
  for (int j = head + 1, end = figure.branch_end(head); j < end; ++j) {
    if (figure.at[j].y > figure.at[top].y) top = j;
  }
  return top;
}

// The common ancestor of both arms; with one arm, of that arm and the head.
int chest_of(const Figure& figure, const UpperBodyJoints& found) {
  const auto& [left, right] = found.arm;
  if (left.is_found() && right.is_found())
    return common_ancestor(figure.skeleton, left.shoulder, right.shoulder);
  const ArmChain& arm = left.is_found() ? left : right;
  if (!arm.is_found() || found.head < 0) return -1;
  return common_ancestor(figure.skeleton, arm.shoulder, found.head);
}

}  // namespace

UpperBodyJoints find_upper_body(const Skeleton& skeleton, const std::array<LegJoints, 2>& legs,
                                int pelvis, std::span<const vec3> position_m) {
  UpperBodyJoints found;
  if (position_m.size() < skeleton.joints.size() || skeleton.joints.empty()) return found;
  const Figure figure{skeleton, position_m};
  const int top = highest_joint(figure, legs);
  found.head = head_of(figure, legs, top);
  found.head_top = head_top_of(figure, found.head);
  found.arm = {named_arm(figure, legs, NamedSide::left), named_arm(figure, legs, NamedSide::right)};
  if (!found.arm[0].is_found() && !found.arm[1].is_found() && top > 0) {
    found.arm = shaped_arms(figure, legs, found.head >= 0 ? found.head : top);
  }
  for (ArmChain& arm : found.arm) {
    if (arm.is_found()) arm.hand_end = hand_end_of(figure, arm.wrist);
  }
  const int chest = chest_of(figure, found);
  if (chest < 0) return found;
  found.spine = path_below(skeleton, common_ancestor(skeleton, pelvis, chest), chest);
  if (found.head >= 0 && is_ancestor(skeleton, chest, found.head)) {
    found.neck = path_below(skeleton, chest, found.head);
    if (!found.neck.empty()) found.neck.pop_back();
  }
  return found;
}

}  // namespace gaitpad
