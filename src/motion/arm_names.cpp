#include "motion/arm_names.h"

#include <algorithm>

#include "motion/joint_words.h"

namespace gaitpad {
namespace {

constexpr std::string_view kFingerWords[] = {"thumb", "index",  "mid",       "middle",  "ring",
                                             "pinky", "little", "finger",    "fingers", "carpal",
                                             "meta",  "palm",   "metacarpal"};

ArmPart part_of(std::string_view word) {
  if (word.size() > 5 && word.ends_with("joint")) word.remove_suffix(5);
  const auto among = [word](std::initializer_list<std::string_view> list) {
    return std::ranges::find(list, word) != list.end();
  };
  if (among({"clavicle", "collar", "collarbone"})) return ArmPart::clavicle;
  if (among({"shoulder", "shldr", "shoulders"})) return ArmPart::shoulder;
  if (among({"humerus", "upperarm", "uparm", "bicep", "arm"})) return ArmPart::upper_arm;
  if (among({"forearm", "elbow", "radius", "ulna", "lowerarm", "loarm", "lowarm"}))
    return ArmPart::forearm;
  if (word == "wrist") return ArmPart::wrist;
  if (word == "hand") return ArmPart::hand;
  return ArmPart::none;
}

// "lhumerus", "rightelbow": a side and a part in one word.
NamedArm joined(std::string_view word) {
  for (const std::size_t n : {std::size_t{5}, std::size_t{4}, std::size_t{1}}) {
    if (word.size() <= n) continue;
    const NamedSide side = side_of_word(word.substr(0, n));
    const ArmPart part = part_of(word.substr(n));
    if (side != NamedSide::none && part != ArmPart::none) return {side, part};
  }
  return {};
}

}  // namespace

NamedArm named_arm(std::string_view name) {
  NamedArm arm;
  bool is_lower = false;
  for (const std::string& word : name_words(name)) {
    if (is_helper_word(word) || std::ranges::find(kFingerWords, word) != std::end(kFingerWords))
      return {};
    if (arm.side == NamedSide::none) arm.side = side_of_word(word);
    if (arm.part == ArmPart::none) arm.part = part_of(word);
    is_lower |= word == "fore" || word == "lower" || word == "low" || word == "lo";
    if (const NamedArm both = joined(word); both.part != ArmPart::none) arm = both;
  }
  if (arm.part == ArmPart::upper_arm && is_lower) arm.part = ArmPart::forearm;
  if (arm.side == NamedSide::none) return {};
  return arm;
}

bool is_head_name(std::string_view name) {
  const auto words = name_words(name);
  const bool is_helper =
      std::ranges::any_of(words, [](const auto& w) { return is_helper_word(w); });
  return !is_helper && std::ranges::find(words, "head") != words.end();
}

}  // namespace gaitpad
