// A clean stride: the change of a captured stride that lets both feet stand exactly.
//
// A captured standing foot slides by millimetres, and the model's bones differ from the actor's.
// Inverse kinematics could hold the feet in every tick, but it knows nothing of the following
// ticks, so the captured posture would be lost. So the whole stride is solved at once: one
// least-squares problem over all samples of the periodic stride. Its unknowns are the pelvis' place
// and the angles of both legs. It finds the smallest and smoothest change of the data under which
// heel and toe stand where Table I of the paper (Meredith & Maddock 2005) plants them and no part
// of a foot goes through the floor.
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "gaitpad/gait_cycle.h"

namespace gaitpad {

// One sample of a stride. Travel frame (see gait_cycle.h).
struct StrideSample {
  vec3 pelvis_m{0.0};
  quat pelvis = kIdentity;  // the pelvis' rotation, which the solve does not change
  std::array<LegAngles, 2> leg{};
};

// Input of a solve. Samples are evenly spaced in phase; sample 0 is the right strike.
struct StrideProblem {
  std::array<LegModel, 2> leg;
  double stride_m = 0.0;  // distance that is travelled in the stride
  double duration_s = 0.0;
  std::vector<StrideSample> wanted;  // samples of the data, scaled to this stride
  std::array<double, 2> strike{};    // phases of the strikes, as in GaitCycle
  std::array<double, 2> toe_off{};
  std::vector<double> time;  // time of each sample in cycles, 0 at sample 0
  // Footprints of the heels; the travel frame is at stride_m * time.
  std::array<vec3, 2> heel_m{};
  // Factors on the cost of changing the angles.
  std::array<LegAngles, 2> leg_weight{{{1, 1, 1, 1, 1, 1, 1}, {1, 1, 1, 1, 1, 1, 1}}};
  double smoothness = 1.0;  // factor on the cost of uneven changes
  // Length of the data's stride: a change of the pelvis' forward speed costs by its share of the
  // data's mean speed. 0: it costs nothing.
  double own_stride_m = 0.0;
  double speed_weight = 1.0;       // factor on that cost
  double leg_smoothness = 1.0;     // factor on the cost of uneven changes of the angles alone
  double pelvis_smoothness = 1.0;  // and of the pelvis' place alone
  std::array<double, 2> least_knee_rad{};  // soft limits on the knees' bend
  double soft_toe = 3e3;  // cost of a toe's jerky start, per square metre of second differences
};
class StrideSolver {
 public:
  StrideSolver();
  ~StrideSolver();
  // Solves `problem` in `iterations` Gauss-Newton steps from `start`. If everything half a stride
  // later is the mirror image, only half of the stride is solved and mirrored. Empty if there is no
  // solution.
  std::vector<StrideSample> solve(const StrideProblem& problem, std::vector<StrideSample> start,
                                  int iterations);

 private:
  // Equations of the previous problem, kept for their sparsity pattern.
  struct System;
  std::unique_ptr<System> system_;
};

}  // namespace gaitpad
