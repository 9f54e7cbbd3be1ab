#include <algorithm>
#include <vector>

#include "motion/legs.h"
#include "motion/name_words.h"

namespace gaitpad {
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

}  // namespace gaitpad
