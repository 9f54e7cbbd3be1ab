// Uneven ground of one walk, in doubles: where its foot may land, and what keeps it clear of what
// lies between two footholds. Asked where a landing is planned or moves, never else.
#pragma once
#include "walk/block.h"
#include "walk/tables.h"

namespace gaitpad {

// The step that is asked for: along this way in the step frame, so far on level ground.
struct AskedFoothold {
  float sine = 0.0f, cosine = 1.0f, length_m = 0.0f;
  bool begins = false;   // the step begins: nothing is settled
  bool settles = false;  // it may still go to another piece of ground
  bool goes_on = true;   // another step follows
};

// Chooses the landing nearest to where the step would go on level ground.
void choose_foothold(const Tables& tables, const AskedFoothold& asked, Block<1>& block) noexcept;

// Plans how the flying foot clears the ground. `begins`: at its lift-off.
void plan_room(const Tables& tables, bool begins, Block<1>& block) noexcept;

// How deep the rest of the flight leads into the ground at most, in metres.
float depth_of_flight(const Tables& tables, const Block<1>& block) noexcept;

// Where a heel stands nearest to a place in the walk's own coordinates, without an edge under the
// sole, and how the ground rises there to the left and ahead of the foot.
struct StandingPlace {
  vec3 heel_m{0.0};
  Slope<float> slope;
};
StandingPlace standing_place(const Tables& tables, const Placement& placed, int side,
                             const vec3& heel_m, double heading_rad) noexcept;

// Height of the ground below a place in the walk's own coordinates.
double ground_height(const Tables& tables, const Placement& placed, const vec3& place_m) noexcept;

}  // namespace gaitpad
