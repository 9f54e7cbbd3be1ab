// The simple structure of figure 4: four links in a plane, with a reduced weight at the root.
#pragma once
#include <vector>

#include "gaitpad/ik.h"
#include "gaitpad/walk.h"

namespace gaitpad {

inline constexpr int kChainLinks = 4;
inline constexpr double kChainLink_m = 0.25;
inline constexpr double kChainTolerance_m = 1e-5;
// The root's weights in figure 4; 1 gives the chain with even weights.
inline constexpr std::array<double, 5> kRootWeights = {1.0, 0.5, 0.2, 0.1, 0.05};

// Makes the chain. Its links turn about z; at angles of 0 it points from the origin along x.
IkChain plane_chain(const std::array<double, kChainLinks>& weights);
vec2 plane_end(const IkChain& chain, const IkAngles& angles_rad);
// Positions of the chain's joints, from the origin to the end.
std::vector<vec2> plane_joints(const IkChain& chain, const IkAngles& angles_rad);

struct ChainTask {
  IkAngles start_rad{};
  vec2 goal_m{0.0};
};
ChainTask figure_4_task();

struct ChainSolve {
  std::vector<IkAngles> angles_rad;  // row k holds the angles after k iterations
  std::vector<double> error_m;
  IkResult result;
  const IkAngles& answer() const { return angles_rad.back(); }
  int iterations() const { return static_cast<int>(angles_rad.size()) - 1; }
};
// Solves with two rows of the Jacobian, x and y.
ChainSolve solve_chain(const IkChain& chain, const ChainTask& task, IkMode mode);

// Random numbers that are equal on every machine (Knuth's MMIX multiplier).
class Lcg {
 public:
  explicit Lcg(std::uint64_t seed) : state_(seed) {}
  double between(double a, double b) {
    state_ = state_ * 6364136223846793005ull + 1442695040888963407ull;
    return a + (b - a) * (static_cast<double>(state_ >> 11) * 0x1p-53);
  }

 private:
  std::uint64_t state_;
};
// A chain bent by at most `bend_rad` at each joint, and a goal within `reach_links` of its end on
// both axes.
struct NearGoals {
  double bend_rad = kPi;
  double reach_links = 0.6;
};
ChainTask near_task(Lcg& random, const NearGoals& what);

}  // namespace gaitpad
