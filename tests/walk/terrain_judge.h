// Judges a walk over terrain from its poses alone: its own forward kinematics, the whole sole on a
// grid, the ground's height point by point. Only the stages are taken from the walk's report.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "gaitpad/control.h"
#include "gaitpad/walk.h"

namespace gaitpad {

// Worst values of a walk; lengths in millimetres, angles in degrees.
struct TerrainWorst {
  double height_mm = 0;    // distance of a planted point from its rest height over the ground
  double slide_mm = 0;     // movement of a planted point
  double sunk_mm = 0;      // depth of any part of either sole in the ground at any tick
  double overhang_mm = 0;  // length of a sole beyond the edge of the tread that it stands on
  double jump_deg = 0;     // second difference of any leg angle, per tick
  double pelvis_mm = 0;    // second difference of the pelvis' place, per tick
  double knee_min_deg = 180, knee_max_deg = 0;
  int failures = 0, landings = 0;
  double jump_z_m = 0, sunk_z_m = 0;  // z of the places with the worst jump and the deepest sole
  double end_z_m = 0;
};

class TerrainJudge {
 public:
  explicit TerrainJudge(const WalkModel& model) : model_(model) {}

  void see(const WalkState& state, const Pose& pose) {
    const WalkFrame frame = walk_frame(model_, state, pose);
    pose_skeleton(pose);
    for (Side side : {kLeftSide, kRightSide}) see_foot(frame, side);
    see_smoothness(pose);
    for (bool failed : frame.ik_failed) worst.failures += failed;
    worst.landings = frame.steps[0] + frame.steps[1];
    worst.end_z_m = pose.root_m.z;
    ++tick_;
  }
  TerrainWorst worst;

  // A sole: heel, ball and tip of one side, and half its width.
  struct Sole {
    vec3 heel, toe, ball, tip, across, toes_across;
  };
  Sole sole(Side side) const {
    const LegBuild& leg = model_.leg[side];
    const LegModel& m = leg.model;
    const quat foot = rotation_[m.joints.ankle] * glm::inverse(m.standing[2]);
    const bool has_toe = !model_.cycle.skeleton.joints[m.joints.toe].is_end_site;
    const quat toes = has_toe ? rotation_[m.joints.toe] * glm::inverse(m.standing[3]) : foot;
    const vec3 ankle = place_[m.joints.ankle];
    Sole s;
    s.heel = ankle + foot * m.heel_m;
    s.toe = place_[m.joints.toe];
    s.ball = s.toe + foot * vec3(0.0, -m.toe_rest_m, 0.0);
    s.tip = s.toe + toes * (m.toe_end_m - vec3(0.0, m.toe_end_rest_m, 0.0));
    const vec3 half = leg.side * (0.045 * m.length_m() / kReferenceLeg_m);
    s.across = foot * half;
    s.toes_across = toes * half;
    return s;
  }

 private:
  void pose_skeleton(const Pose& pose) {
    const auto& joints = model_.cycle.skeleton.joints;
    rotation_.resize(joints.size());
    place_.resize(joints.size());
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const int p = joints[j].parent;
      rotation_[j] = p < 0 ? pose.local[j] : rotation_[p] * pose.local[j];
      place_[j] = p < 0 ? pose.root_m : place_[p] + rotation_[p] * joints[j].offset_m;
    }
  }

  double ground(const vec3& p) const { return ground_at(*model_.terrain, p.x, p.z).height_m; }

  // The depth of a point in the ground: the shorter distance out of it, upwards or through a
  // riser's face.
  double depth_mm(const vec3& p) const {
    const double up = ground(p) - p.y;
    if (up <= 0.0) return 0.0;
    const Stretch piece = piece_at(*model_.terrain, p.z);
    double out = up;
    if (ground(vec3(p.x, 0.0, piece.from_m - 1e-6)) <= p.y) out = std::min(out, p.z - piece.from_m);
    if (ground(vec3(p.x, 0.0, piece.to_m + 1e-6)) <= p.y) out = std::min(out, piece.to_m - p.z);
    return 1e3 * out;
  }

  void see_foot(const WalkFrame& frame, Side side) {
    const LegModel& leg = model_.leg[side].model;
    const Sole s = sole(side);
    const struct {
      bool planted;
      vec3 place;
      double rest_m;
    } points[2] = {{frame.heel_planted[side], s.heel, 0.0},
                   {frame.toe_planted[side], s.toe, leg.toe_rest_m}};
    for (int k : {0, 1}) {
      const auto& point = points[k];
      bool& was = planted_[side][k];
      if (point.planted) {
        const Ground g = ground_at(*model_.terrain, point.place.x, point.place.z);
        const double off = 1e3 * std::abs((point.place.y - g.height_m) * g.normal.y - point.rest_m);
        worst.height_mm = std::max(worst.height_mm, off);
        if (!was) anchor_[side][k] = point.place;
        worst.slide_mm =
            std::max(worst.slide_mm, 1e3 * glm::distance(anchor_[side][k], point.place));
      }
      was = point.planted;
    }
    for (int i = 0; i <= 12; ++i) {
      const vec3 line = i <= 8 ? s.heel + (s.ball - s.heel) * (i / 8.0)
                               : s.ball + (s.tip - s.ball) * ((i - 8) / 4.0);
      for (double c : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
        const double deep = depth_mm(line + (i <= 8 ? s.across : s.toes_across) * c);
        if (deep > worst.sunk_mm) worst.sunk_mm = deep, worst.sunk_z_m = s.heel.z;
      }
    }
    // The foot is flat on the ground if the toe is down and the heel has not left yet.
    const bool toe_down = frame.toe_planted[side] && s.heel.y - ground(s.heel) < 0.004;
    if (toe_down) see_edges(s);
  }

  void see_edges(const Sole& s) {
    const vec3 middle = 0.5 * (s.heel + s.tip);
    const Stretch piece = piece_at(*model_.terrain, middle.z);
    for (const vec3& p :
         {s.heel - s.across, s.heel + s.across, s.tip - s.toes_across, s.tip + s.toes_across})
      worst.overhang_mm =
          std::max({worst.overhang_mm, 1e3 * (piece.from_m - p.z), 1e3 * (p.z - piece.to_m)});
  }

  void see_smoothness(const Pose& pose) {
    const std::array<LegAngles, 2> angles_rad = leg_angles(model_, pose);
    for (int side : {0, 1}) {
      for (int j = 0; j < kLegDofs; ++j) {
        const double now = angles_rad[side][j];
        if (j == kKneeX) {
          worst.knee_min_deg = std::min(worst.knee_min_deg, now / kDegree);
          worst.knee_max_deg = std::max(worst.knee_max_deg, now / kDegree);
        }
        if (tick_ < 2) continue;
        const double jump =
            std::abs(now - 2.0 * angles_[0][side][j] + angles_[1][side][j]) / kDegree;
        if (jump > worst.jump_deg) worst.jump_deg = jump, worst.jump_z_m = pose.root_m.z;
      }
    }
    if (tick_ >= 2) {
      worst.pelvis_mm =
          std::max(worst.pelvis_mm, 1e3 * glm::length(pose.root_m - 2.0 * root_[0] + root_[1]));
    }
    angles_ = {angles_rad, angles_[0]};
    root_ = {pose.root_m, root_[0]};
  }

  const WalkModel& model_;
  int tick_ = 0;
  std::vector<quat> rotation_;
  std::vector<vec3> place_;
  std::array<std::array<bool, 2>, 2> planted_{};
  std::array<std::array<vec3, 2>, 2> anchor_{};
  std::array<std::array<LegAngles, 2>, 2> angles_{};
  std::array<vec3, 2> root_{vec3(0.0), vec3(0.0)};
};

}  // namespace gaitpad
