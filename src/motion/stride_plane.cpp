#include "motion/stride_plane.h"

#include <algorithm>

namespace gaitpad {

LegSample right_leg_in_plane(const LegModel& model, const CycleSample& body,
                             const SagittalLeg& plane, double track_m) {
  const double drop =
      model.thigh_m * sin_cos(plane.thigh).cos + model.shank_m * sin_cos(plane.shank).cos;
  const double aside = -track_m - (body.pelvis_m + body.pelvis * model.hip_m).x;
  // A leg that reaches no farther down than it has to go aside lies in the floor's plane.
  const double down = std::sqrt(std::max(0.0, drop * drop - aside * aside));
  const quat tilt = rotation_z(gaitpad::atan2(aside, down));
  const quat thigh = tilt * rotation_x(plane.thigh), shank = tilt * rotation_x(plane.shank);
  const AnglesXzy hip = angles_xzy(glm::conjugate(body.pelvis) * thigh);
  const AnglesXzy ankle = angles_xzy(glm::conjugate(shank) * rotation_x(plane.foot));
  LegSample leg;
  leg.angles = {hip.x, hip.z, hip.y, plane.shank - plane.thigh, ankle.x, ankle.z, ankle.y};
  leg.toe_x = plane.toe;
  return leg;
}

LegSample mirrored(const LegSample& leg) {
  LegSample m = leg;
  for (const int d : {kHipZ, kHipY, kAnkleZ, kAnkleY}) m.angles[d] = -leg.angles[d];
  return m;
}

CycleSample mirrored_pelvis(const CycleSample& body) {
  CycleSample m = body;
  m.pelvis_m = mirrored(body.pelvis_m);
  m.pelvis = mirrored(body.pelvis);
  return m;
}

LegPose pose_of(const GaitCycle& cycle, int side, const CycleSample& at) {
  const LegSample& leg = at.leg[side];
  return leg_pose(cycle.leg[side], at.pelvis_m, at.pelvis, leg.angles, leg.toe_x);
}

double foot_clearance(const GaitCycle& cycle, int side, const CycleSample& at) {
  const LegModel& model = cycle.leg[side];
  const LegPose p = pose_of(cycle, side, at);
  return std::min({p.heel_m.y, p.toe_m.y - model.toe_rest_m, p.toe_end_m.y - model.toe_end_rest_m});
}

double soft_positive(double x, double width) {
  if (x <= -width) return 0.0;
  if (x >= width) return x;
  return (x + width) * (x + width) / (4.0 * width);
}

}  // namespace gaitpad
