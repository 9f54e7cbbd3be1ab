// Uneven grounds, and what is seen of a walk over them.
#pragma once
#include <gtest/gtest.h>

#include "tests/walk/made_block.h"

namespace gaitpad {
namespace {

constexpr double kPlanted_m = 1e-5;

[[maybe_unused]] std::shared_ptr<const Terrain> ground_of(
    const std::vector<SectionShape>& sections) {
  Terrain terrain;
  for (const SectionShape& s : sections) {
    const auto problem = add_section(terrain, s);
    EXPECT_FALSE(problem) << problem->message;
  }
  return std::make_shared<const Terrain>(terrain);
}
[[maybe_unused]] WalkModel model_on(std::shared_ptr<const Terrain> terrain) {
  WalkModel model = adult();
  model.terrain = std::move(terrain);
  return model;
}

// Waves and a slope in a direction of its own; counts how often it is asked.
struct Hills {
  double slope_x = 0.0, slope_z = 0.0, wave_m = 0.0;
  mutable int calls = 0;
  static Ground ask(const void* game, double x_m, double z_m) noexcept {
    const Hills& hills = *static_cast<const Hills*>(game);
    ++hills.calls;
    Ground ground;
    ground.height_m = hills.slope_x * x_m + hills.slope_z * z_m +
                      hills.wave_m * std::sin(1.3 * x_m + 0.4) * std::sin(0.9 * z_m);
    return ground;
  }
  static void ask_several(const void* game, std::span<const GroundPlace> places,
                          std::span<Ground> grounds) noexcept {
    const Hills& hills = *static_cast<const Hills*>(game);
    const int calls = hills.calls;
    for (std::size_t i = 0; i < places.size(); ++i)
      grounds[i] = ask(game, places[i].x_m, places[i].z_m);
    hills.calls = calls + 1;
  }
};
[[maybe_unused]] std::shared_ptr<const Terrain> asked_of(const Hills& hills) {
  Terrain terrain;
  terrain.asked = {&Hills::ask, &hills, &Hills::ask_several};
  return std::make_shared<const Terrain>(terrain);
}

// Soles and the stairs: how deep a heel, ball or tip is below the ground at most.
constexpr double kBeside_m = 0.002;
[[maybe_unused]] double deepest_m(const WalkModel& model, const Pose& pose) {
  static JointFrames frames;
  forward_kinematics(model.cycle.skeleton, pose, frames);
  double deep_m = 0.0;
  for (const Side side : {kLeftSide, kRightSide}) {
    const LegBuild& leg = model.leg[side];
    const quat foot =
        frames.rotation[leg.model.joints.ankle] * glm::conjugate(leg.model.standing[2]);
    for (const vec3& point : {leg.model.heel_m, leg.ball_m}) {
      const vec3 p = frames.position_m[leg.model.joints.ankle] + foot * point;
      double deep = 1.0;  // a heel may come down along a riser
      for (const double z : {p.z - kBeside_m, p.z, p.z + kBeside_m})
        deep = std::min(deep, ground_at(*model.terrain, p.x, z).height_m - p.y);
      deep_m = std::max(deep_m, deep);
    }
  }
  return deep_m;
}

// The same on level ground without a terrain.
[[maybe_unused]] double deepest_on_floor_m(const WalkModel&, const Pose& pose) {
  double deep_m = 0.0;
  for (const Side side : {kLeftSide, kRightSide})
    for (const bool toe : {false, true}) {
      const LegModel& leg = adult().leg[side].model;
      const double rest_m = toe ? leg.toe_m.y - leg.heel_m.y : 0.0;
      deep_m = std::max(deep_m, rest_m - end_of(pose, side, toe).y);
    }
  return deep_m;
}

// The greatest second difference of the legs' rotations, degrees a tick^2.
[[maybe_unused]] double second_difference_deg(const Pose& before, const Pose& last,
                                              const Pose& now) {
  double most_rad = 0.0;
  for (const LegBuild& leg : adult().leg)
    for (int j : {0, 1, 2}) {
      const int joint = leg.joint[j].joint;
      const vec3 is = rotation_vector(now.local[joint] * glm::conjugate(last.local[joint])),
                 was = rotation_vector(last.local[joint] * glm::conjugate(before.local[joint]));
      most_rad = std::max(most_rad, glm::length(is - was));
    }
  return most_rad / kDegree;
}

}  // namespace
}  // namespace gaitpad
