// Which joints are the legs: by name where the names are known, else by the skeleton's shape.
#pragma once
#include <array>
#include <string>
#include <string_view>

#include "base/result.h"
#include "motion/motion.h"

namespace gaitpad {

// Joints of one leg given by hand. Empty: found.
struct LegNames {
  std::string hip, knee, ankle, toe;
};

// What a joint's name says. Prefixes such as "mixamorig:" or "CC_Base_" do not matter.
enum class NamedSide { none, left, right };
enum class NamedPart { none, hip, knee, ankle, toe };
struct NamedJoint {
  NamedSide side = NamedSide::none;
  NamedPart part = NamedPart::none;
};
NamedJoint named_joint(std::string_view name);

// Fills in motion.legs and motion.pelvis. `motion` may still be in file units and have any axis up:
// names come first; where they fail, the two lowest chains of the middle frame that hang on one
// joint, for y up and for z up. Left and right follow the names, else the geometry (toes point
// forward). Error without file name: `no two legs: ...`.
Result<std::array<LegJoints, 2>> find_legs(const Motion& motion,
                                           const std::array<LegNames, 2>& given = {});

// Lowest joint that carries both legs.
int pelvis_of(const Skeleton& skeleton, const std::array<LegJoints, 2>& legs);

bool is_ancestor(const Skeleton& skeleton, int ancestor, int joint);

}  // namespace gaitpad
