// One pose of an IK chain as screws, from which every Jacobian entry is one product. Internal to
// ik*.
#pragma once
#include "animation/ik.h"

namespace gaitpad {

struct IkPose {
  std::array<vec3, kMaxIkDofs> axis;     // of each DOF, base frame
  std::array<vec3, kMaxIkDofs> pivot_m;  // a point on that axis
  vec3 x, y, z;                          // images of the last frame's axes
  vec3 end_m;                            // its origin
};
void pose_chain(const IkChain& chain, const IkAngles& angles_rad, IkPose& pose) noexcept;

inline vec3 point_in_base(const IkPose& pose, const vec3& p) noexcept {
  return pose.end_m + p.x * pose.x + p.y * pose.y + p.z * pose.z;
}

// Step 1.
struct IkErrors {
  std::array<double, kMaxIkRows> dx;
  std::array<vec3, kMaxIkRows> point_m;  // the rows' points, base frame
  double squares = 0.0;                  // |dX|^2
};
void measure(const IkPose& pose, std::span<const IkRow> rows, IkErrors& errors) noexcept;

// Finite angles, weights and limits (limits may be infinite). Links, axes, points and goals show in
// the error.
bool finite_inputs(const IkChain& chain, const IkAngles& angles_rad) noexcept;

// A further row of the trace; and the last row, unless it is the answer already.
void note(IkTrace* trace, const IkAngles& angles_rad, double error_m) noexcept;
void note_answer(IkTrace* trace, const IkAngles& angles_rad, double error_m) noexcept;

}  // namespace gaitpad
