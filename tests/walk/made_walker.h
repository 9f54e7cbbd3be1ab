// Characters on the built-in motion that a test walks tick by tick, and what it measures of them.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "gaitpad/control.h"
#include "gaitpad/walk.h"
#include "tests/clean_cycle.h"
#include "tests/value_of.h"

namespace gaitpad {

constexpr int kRate = 240;
constexpr double kDt = 1.0 / kRate;

inline WalkModel model_of(const GaitCycle& cycle, const Character& character = {}) {
  return value_of(walk_model(clean_cycle(cycle), character));
}
inline WalkModel model_of(double leg_ratio, double scale = 1.0) {
  Character character;
  character.leg_ratio = leg_ratio;
  character.scale = scale;
  return model_of(procedural_gait(), character);
}
inline const WalkModel& adult() {
  static const WalkModel model = model_of(1.0);
  return model;
}

inline StyleValues limp() {
  StyleValues style;
  style.stride[kLeftSide] = {.length = 0.5, .speed = 1.3, .flight_height = 0.5};
  return style;
}

inline StyleValues high_steps() {
  StyleValues style;
  for (StrideFactors& stride : style.stride) stride.flight_height = 3.0;
  return style;
}

// A character with a stick and a style; it keeps the frames of its ticks.
class MadeWalker {
 public:
  explicit MadeWalker(const WalkModel& model = adult(), IkMode mode = IkMode::robust,
                      double z_m = 0.0)
      : model_(model), mode_(mode), state_(standing(model, vec3(0.0, 0.0, z_m), pose_)) {}

  void walk(double x, double y, int ticks, const StyleValues& style = {}) {
    Stick stick;
    stick.left = vec2(x, y);
    walk(gait_params(stick, style, gait_limits(model_)), ticks);
  }
  void walk(const GaitParams& params, int ticks) {
    for (int i = 0; i < ticks; ++i) {
      advance(model_, params, mode_, kDt, state_, pose_);
      frames_.push_back(last());
      angles_rad_.push_back(leg_angles(model_, pose_));
    }
  }
  const WalkModel& model() const { return model_; }
  const WalkState& state() const { return state_; }
  const Pose& pose() const { return pose_; }
  WalkFrame last() const { return walk_frame(model_, state_, pose_); }
  const std::vector<WalkFrame>& frames() const { return frames_; }
  const std::vector<std::array<LegAngles, 2>>& angles_rad() const { return angles_rad_; }

  // The farthest that a planted point moves while it is planted.
  double drift_m() const {
    double farthest = 0.0;
    for (int point = 0; point < 4; ++point) {
      const int side = point / 2;
      const bool heel = point % 2 == 0;
      vec3 anchor(0.0);
      bool planted = false;
      for (const WalkFrame& f : frames_) {
        const bool now = heel ? f.heel_planted[side] : f.toe_planted[side];
        const vec3& place = heel ? f.heel_m[side] : f.toe_m[side];
        if (now && !planted) anchor = place;
        if (now) farthest = std::max(farthest, glm::distance(anchor, place));
        planted = now;
      }
    }
    return farthest;
  }
  // Largest second difference of any leg angle, radians per tick squared.
  double sharpest_turn_rad() const {
    double largest = 0.0;
    for (std::size_t k = 2; k < angles_rad_.size(); ++k) {
      const auto &a = angles_rad_[k - 2], &b = angles_rad_[k - 1], &c = angles_rad_[k];
      for (int side : {0, 1}) {
        for (int j = 0; j < kLegDofs; ++j)
          largest = std::max(largest, std::abs(c[side][j] - 2.0 * b[side][j] + a[side][j]));
      }
    }
    return largest;
  }

 private:
  const WalkModel& model_;
  IkMode mode_;
  Pose pose_;
  WalkState state_;
  std::vector<WalkFrame> frames_;
  std::vector<std::array<LegAngles, 2>> angles_rad_;
};

}  // namespace gaitpad
