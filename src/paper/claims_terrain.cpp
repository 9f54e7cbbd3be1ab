// Assertion 22: uneven ground.
#include "paper/claims.h"

namespace gaitpad {

std::vector<Claim> terrain_claims(const Study&, IkMode mode) {
  ClaimList list("3.3", mode);
  return list.take();
}

}  // namespace gaitpad
