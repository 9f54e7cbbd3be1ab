#include "animation/ik.h"

#include <cassert>

#include "animation/ik_pose.h"
#include "base/math.h"

namespace gaitpad {
namespace {

struct Axes {
  vec3 x{1.0, 0.0, 0.0}, y{0.0, 1.0, 0.0}, z{0.0, 0.0, 1.0};
};

// Turns a frame about its own first axis: (y, z) are the other two, in cyclic order.
inline void turn(vec3& y, vec3& z, const SinCos& s) noexcept {
  const vec3 old = y;
  y = s.cos * old + s.sin * z;
  z = s.cos * z - s.sin * old;
}

// Turns about a unit axis that is given in the frame itself, by Rodrigues' formula; returns the
// axis in the base frame. The usual axes cost a third of it.
inline vec3 turn_about(const vec3& a, const SinCos& s, Axes& f) noexcept {
  vec3 axis;
  if (a.x == 1.0) return axis = f.x, turn(f.y, f.z, s), axis;
  if (a.y == 1.0) return axis = f.y, turn(f.z, f.x, s), axis;
  if (a.z == 1.0) return axis = f.z, turn(f.x, f.y, s), axis;
  axis = a.x * f.x + a.y * f.y + a.z * f.z;
  const double versine = 1.0 - s.cos;
  f.x = s.cos * f.x + s.sin * glm::cross(axis, f.x) + (versine * a.x) * axis;
  f.y = s.cos * f.y + s.sin * glm::cross(axis, f.y) + (versine * a.y) * axis;
  f.z = s.cos * f.z + s.sin * glm::cross(axis, f.z) + (versine * a.z) * axis;
  return axis;
}

}  // namespace

void pose_chain(const IkChain& chain, const IkAngles& angles_rad, IkPose& pose) noexcept {
  assert(chain.dofs >= 0 && chain.dofs <= kMaxIkDofs);
  // All calls first: the axes then stay in registers.
  std::array<SinCos, kMaxIkDofs> angle;
  for (int j = 0; j < chain.dofs; ++j) angle[j] = sin_cos(angles_rad[j]);
  Axes f;
  vec3 end(0.0);
  for (int j = 0; j < chain.dofs; ++j) {
    const IkDof& dof = chain.dof[j];
    pose.pivot_m[j] = end;
    pose.axis[j] = turn_about(dof.axis, angle[j], f);
    const vec3& l = dof.link_m;
    if (l.x != 0.0 || l.y != 0.0 || l.z != 0.0) end += l.x * f.x + l.y * f.y + l.z * f.z;
  }
  pose.x = f.x, pose.y = f.y, pose.z = f.z;
  pose.end_m = end;
}

void measure(const IkPose& pose, std::span<const IkRow> rows, IkErrors& errors) noexcept {
  assert(rows.size() <= kMaxIkRows);
  errors.squares = 0.0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const bool same_point = r > 0 && rows[r].point_m == rows[r - 1].point_m;
    errors.point_m[r] = same_point ? errors.point_m[r - 1] : point_in_base(pose, rows[r].point_m);
    errors.dx[r] = rows[r].goal_m - glm::dot(rows[r].direction, errors.point_m[r]);
    errors.squares += errors.dx[r] * errors.dx[r];
  }
}

bool finite_inputs(const IkChain& chain, const IkAngles& angles_rad) noexcept {
  double zero = 0.0;  // x - x is NaN for a NaN or an infinity
  bool ordered = true;
  for (int j = 0; j < chain.dofs; ++j) {
    const IkDof& dof = chain.dof[j];
    zero += (angles_rad[j] - angles_rad[j]) + (dof.weight - dof.weight);
    ordered = ordered && dof.min_rad <= dof.max_rad;
  }
  return zero == 0.0 && ordered;
}

void note(IkTrace* trace, const IkAngles& angles_rad, double error_m) noexcept {
  if (trace == nullptr) return;
  const auto row = static_cast<std::size_t>(trace->rows);
  if (row >= trace->angles_rad.size() || row >= trace->error_m.size()) return;
  trace->angles_rad[row] = angles_rad;
  trace->error_m[row] = error_m;
  ++trace->rows;
}

void note_answer(IkTrace* trace, const IkAngles& angles_rad, double error_m) noexcept {
  if (trace == nullptr || trace->rows == 0) return;
  if (trace->angles_rad[static_cast<std::size_t>(trace->rows - 1)] == angles_rad) return;
  const std::size_t room = std::min(trace->angles_rad.size(), trace->error_m.size());
  if (static_cast<std::size_t>(trace->rows) == room) --trace->rows;
  note(trace, angles_rad, error_m);
}

IkFrame end_frame(const IkChain& chain, const IkAngles& angles_rad) noexcept {
  IkPose pose;
  pose_chain(chain, angles_rad, pose);
  return {pose.end_m, from_axes(pose.x, pose.y, pose.z)};
}

void position_jacobian(const IkChain& chain, std::span<const IkRow> rows,
                       const IkAngles& angles_rad, IkJacobian& jacobian,
                       std::array<double, kMaxIkRows>& error_m) noexcept {
  IkPose pose;
  pose_chain(chain, angles_rad, pose);
  IkErrors errors;
  measure(pose, rows, errors);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    error_m[r] = errors.dx[r];
    for (int j = 0; j < chain.dofs; ++j) {
      const vec3 column = glm::cross(pose.axis[j], errors.point_m[r] - pose.pivot_m[j]);
      jacobian[r][j] = glm::dot(rows[r].direction, column);
    }
  }
}

std::array<IkRow, 3> point_goal(const vec3& point_m, const vec3& goal_m) noexcept {
  return {{{point_m, vec3(1.0, 0.0, 0.0), goal_m.x},
           {point_m, vec3(0.0, 1.0, 0.0), goal_m.y},
           {point_m, vec3(0.0, 0.0, 1.0), goal_m.z}}};
}

}  // namespace gaitpad
