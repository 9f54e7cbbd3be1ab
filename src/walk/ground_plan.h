// Plans on uneven ground for one walk, in doubles: its next foothold, and how the flying foot
// clears the ground on its way. Called when a landing is planned or moves.
#pragma once
#include "walk/block.h"
#include "walk/tables.h"

namespace gaitpad {

// The step that is asked for, as it would be on level ground.
struct AskedFoothold {
  float sine = 0.0f, cosine = 1.0f;  // of its direction in the step frame
  float length_m = 0.0f;
  bool begins = false;   // the step begins: no piece of ground is chosen yet
  bool settles = false;  // it may still go to another piece of ground
  bool goes_on = true;   // another step follows
};

// Chooses the landing that changes the step least from level ground.
void choose_foothold(const Tables& tables, const AskedFoothold& asked, Block<1>& block) noexcept;

// Plans how the flying foot clears the ground. `begins`: true at its lift-off.
void plan_room(const Tables& tables, bool begins, Block<1>& block) noexcept;

// The greatest depth in metres by which the rest of the flight leads into the ground.
float depth_of_flight(const Tables& tables, const Block<1>& block) noexcept;

// The place nearest to `heel_m` where a heel can stand without an edge under the sole, in the
// walk's own coordinates, and the slope of its ground to the left and ahead of the foot.
struct StandingPlace {
  vec3 heel_m{0.0};
  Slope<float> slope;
};
StandingPlace standing_place(const Tables& tables, const Placement& placed, int side,
                             const vec3& heel_m, double heading_rad) noexcept;

// Height of the ground below a place in the walk's own coordinates.
double ground_height(const Tables& tables, const Placement& placed, const vec3& place_m) noexcept;

}  // namespace gaitpad
