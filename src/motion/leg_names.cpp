#include <algorithm>
#include <vector>

#include "motion/legs.h"

namespace gaitpad {
namespace {

char lower(char c) { return (c >= 'A' && c <= 'Z') ? static_cast<char>(c + 32) : c; }
bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
bool is_lower(char c) { return c >= 'a' && c <= 'z'; }

// "CC_Base_L_ToeBase" -> cc base l toe base; "LHipJoint" -> l hip joint; digits and marks separate.
std::vector<std::string> words(std::string_view name) {
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

NamedSide side_of(const std::string& word) {
  if (word == "l" || word == "left" || word == "lft") return NamedSide::left;
  if (word == "r" || word == "right" || word == "rgt") return NamedSide::right;
  return NamedSide::none;
}

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
    const NamedSide side = side_of(word.substr(0, n));
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
  const std::vector<std::string> all = words(name);
  bool is_upper_part = false, is_buttock = false;
  for (const std::string& word : all) {
    if (is_helper(word)) return {};
    if (joint.side == NamedSide::none) joint.side = side_of(word);
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
