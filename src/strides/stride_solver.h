// A clean stride: the change of a captured stride that lets both feet stand exactly.
//
// A captured foot that stands slides by millimetres, and the model's bones are not the actor's. The
// inverse kinematics could hold the feet tick by tick, but what it changes there it changes without
// regard to what comes after: the posture of the data is lost. So the whole stride is solved at
// once: one least-squares problem over all samples of the periodic stride, whose unknowns are the
// pelvis' place and the angles of both legs. It looks for the least and the smoothest change of the
// data under which heel and toe stand where Table I of the paper (Meredith & Maddock 2005) plants
// them, and nothing goes through the floor.
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "gaitpad/gait_cycle.h"

namespace gaitpad {

// One sample of the stride that is wanted. Travel frame (see gait_cycle.h).
struct StrideSample {
  vec3 pelvis_m{0.0};
  quat pelvis = kIdentity;  // not changed by the solve
  std::array<LegAngles, 2> leg{};
};

// What is asked of a stride. `samples` are evenly spaced in phase; sample 0 is the right strike.
struct StrideProblem {
  std::array<LegModel, 2> leg;
  double stride_m = 0.0;  // travel in the stride
  double duration_s = 0.0;
  std::vector<StrideSample> wanted;  // the data, scaled to this stride
  std::array<double, 2> strike{};    // phases, as in GaitCycle
  std::array<double, 2> toe_off{};
  std::vector<double> time;  // of each sample, in cycles: 0 at sample 0
  // Where the heel stands along the path: the travel frame is at stride_m * time.
  std::array<vec3, 2> heel_m{};
  // Factors on what it costs to change the angles.
  std::array<LegAngles, 2> leg_weight{{{1, 1, 1, 1, 1, 1, 1}, {1, 1, 1, 1, 1, 1, 1}}};
  double smoothness = 1.0;  // and on what it costs to change them unevenly
  double least_knee_rad = 2.0 * kDegree;
  double soft_toe =
      3e3;  // how smoothly a toe begins to move: per square metre of second differences
  // How much the hips' speed along the path is the data's: per square metre of first differences.
  double forward_speed = 2e4;
  double most_heave_m_s2 = 7.0;  // how hard the hips rise and fall, about
};
// Whether half a stride later everything is the mirror image.
bool is_symmetric(const StrideProblem& problem);

class StrideSolver {
 public:
  StrideSolver();
  ~StrideSolver();
  // The solution of `problem`, found in `iterations` steps from `start`. Where the data of half a
  // stride mirror those of the other half, one half is solved. Empty where it cannot be solved.
  std::vector<StrideSample> solve(const StrideProblem& problem, std::vector<StrideSample> start,
                                  int iterations);

 private:
  struct System;
  void begin(const StrideProblem& problem);
  void fill(const StrideProblem& problem, const std::vector<StrideSample>& x);
  bool move(std::vector<StrideSample>& x);
  std::unique_ptr<System> system_;  // of the problem before, kept for its pattern
};

}  // namespace gaitpad
