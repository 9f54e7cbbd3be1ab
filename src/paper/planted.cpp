#include "paper/planted.h"

namespace gaitpad {
namespace {

double slide_of(const Walk& walk, std::size_t from, std::array<bool, 2> WalkFrame::*planted,
                std::array<vec3, 2> WalkFrame::*place, Side side) {
  double most = 0.0;
  bool stood = true;  // a plant that runs at `from` is not judged
  vec3 anchor(0.0);
  bool counts = false;
  for (std::size_t k = from; k < walk.samples.size(); ++k) {
    const WalkFrame& f = walk.samples[k].frame;
    const bool stands = (f.*planted)[side];
    if (stands && (!stood || k == 0)) {
      anchor = (f.*place)[side];
      counts = true;
    }
    if (stands && counts) most = std::max(most, glm::distance((f.*place)[side], anchor));
    stood = stands;
  }
  return 1e3 * most;
}

}  // namespace

double planted_slide_mm(const Walk& walk, std::size_t from) {
  double most = 0.0;
  for (const Side side : {kLeftSide, kRightSide}) {
    most = std::max({most, slide_of(walk, from, &WalkFrame::heel_planted, &WalkFrame::heel_m, side),
                     slide_of(walk, from, &WalkFrame::toe_planted, &WalkFrame::toe_m, side)});
  }
  return most;
}

}  // namespace gaitpad
