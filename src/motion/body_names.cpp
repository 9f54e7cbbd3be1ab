#include "motion/body_names.h"

#include <algorithm>

#include "motion/name_words.h"

namespace gaitpad {
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

BodyPart part_of(std::string_view word) {
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
    const BodyPart part = part_of(word.substr(n));
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
    if (joint.part == BodyPart::none) joint.part = part_of(word);
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

}  // namespace gaitpad
