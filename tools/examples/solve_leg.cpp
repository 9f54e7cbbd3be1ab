// Moves an ankle to a goal with a leg whose hip is stiff, then with one whose joints are all free.
// A chain is a list of single rotations; each is followed by a fixed link. The paper's equation (5)
// gives every rotation a weight: 0 locked, 1 free.
#include <gaitpad/ik.h>

#include <cstdio>

namespace {

// Hip (3 rotations), knee and ankle of an adult's left leg. The base is the hip, y points up.
gaitpad::IkChain leg(double hip_weight) {
  const gaitpad::vec3 x(1.0, 0.0, 0.0), y(0.0, 1.0, 0.0), z(0.0, 0.0, 1.0), none(0.0);
  gaitpad::IkChain chain;
  chain.dofs = 5;
  chain.dof[0] = {.axis = x, .link_m = none, .min_rad = -2.1, .max_rad = 1.0, .weight = hip_weight};
  chain.dof[1] = {.axis = z, .link_m = none, .min_rad = -0.9, .max_rad = 0.9, .weight = hip_weight};
  chain.dof[2] = {.axis = y,
                  .link_m = {0.0, -0.42, 0.0},
                  .min_rad = -1.2,
                  .max_rad = 1.2,
                  .weight = hip_weight};
  chain.dof[3] = {.axis = x, .link_m = {0.0, -0.42, 0.0}, .min_rad = 0.02, .max_rad = 2.6};
  chain.dof[4] = {.axis = x, .link_m = none, .min_rad = -0.7, .max_rad = 0.9};
  return chain;
}

}  // namespace

int main() {
  const gaitpad::vec3 heel_m(0.0, -0.08, -0.05);  // the heel in the foot's frame
  // The goal, seen from the hip: in front of it and a little to the side.
  const gaitpad::vec3 goal_m(0.05, -0.75, 0.25);
  bool all_reached = true;
  for (const double hip_weight : {1.0, 0.2}) {
    gaitpad::IkAngles angles_rad = {-0.2, 0.0, 0.0, 0.4, 0.0};
    const gaitpad::IkResult result = gaitpad::solve_robust(
        leg(hip_weight), gaitpad::point_goal(heel_m, goal_m), gaitpad::RobustOptions{}, angles_rad);
    std::printf("hip weight %.1f: %d iterations, %.7f m from the goal, angles in radians:",
                hip_weight, result.iterations, result.error_m);
    for (int i = 0; i < 5; ++i) std::printf(" %+.4f", angles_rad[i]);
    std::putchar('\n');
    all_reached = all_reached && result.status == gaitpad::IkStatus::converged;
  }
  return all_reached ? 0 : 1;
}
