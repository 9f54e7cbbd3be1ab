// The body above the legs on another skeleton: spine, neck, arms and what has the same name.
#pragma once
#include "motion/gait_cycle.h"

namespace gaitpad {

// Which joints of a skeleton follow which of the source's.
// - Arms by their parts: collar bone, upper arm, forearm, hand. What stands between (twist joints)
//   rests; what one of the two lacks is left out.
// - Spine and neck as chains: of n joints that follow m, the k-th (from 1) turns in the world as
// the
//   source does k m / n of the way up its chain, so that chest and head turn as the source's do.
// - Fingers and all else above the legs: joints of equal names. The others rest.
struct Counterpart {
  int lower = -1, upper = -1;  // joints of the source; -1: none, this joint rests
  double share = 0.0;          // of the way from lower to upper
};
struct UpperBody {
  std::vector<Counterpart> from;  // one a joint
  std::vector<int> aim;         // whose place each joint's bone points to; -1: none; others inside
  std::vector<vec3> direction;  // where it points, as the source stands
};
UpperBody upper_body(const GaitCycle& source, const GaitCycle& character);

// A T pose hangs its arms: bones that both bodies have point as they do in the source's standing
// pose. Arms and hands do so bone by bone; spine and neck as wholes, unless their joints have the
// source's names, because backs are curved in different ways (the head then looks ahead as it did);
// collar bones only then, too.
void stand_alike(const UpperBody& body, GaitCycle& character);

// World rotations of the joints in `from` at sample i: away from the standing pose as the source's.
// The character has been made to stand alike.
class UpperBodyTurn {
 public:
  UpperBodyTurn(const GaitCycle& source, const UpperBody& body, const GaitCycle& character);
  void set_sample(int i);
  bool has(int joint) const { return body_.from[joint].lower >= 0; }
  quat world(int joint) const;

 private:
  const GaitCycle& source_;
  const UpperBody& body_;
  std::vector<quat> before_, after_, standing_;
};

}  // namespace gaitpad
