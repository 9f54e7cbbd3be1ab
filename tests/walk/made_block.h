// Walks that a test moves on tick by tick below the public functions: blocks, and what is seen of
// their poses.
#pragma once
#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "gaitpad/config_files.h"
#include "tests/folders.h"
#include "tests/walk/made_walker.h"
#include "walk/block.h"
#include "walk/steer.h"
#include "walk/walk.h"
#include "walk/walk_frame.h"

namespace gaitpad {

inline StyleValues shipped(const std::string& name) {
  return value_of(load_style(kSourceFolder + "/config/styles/" + name + ".toml"));
}
inline GaitParams params_of(double x, double y, const StyleValues& style = {}) {
  Stick stick;
  stick.left = vec2(x, y);
  return gait_params(stick, style, gait_limits(adult()));
}

inline double turned_deg(const quat& a, const quat& b) {
  return glm::length(rotation_vector(glm::conjugate(a) * b)) / kDegree;
}
// Where a heel or toe is.
inline vec3 end_of(const Pose& pose, Side side, bool toe) {
  static JointFrames frames;
  forward_kinematics(adult().cycle.skeleton, pose, frames);
  const LegModel& leg = adult().leg[side].model;
  return frames.position_m[leg.joints.ankle] +
         frames.rotation[leg.joints.ankle] *
             (glm::conjugate(leg.standing[2]) * (toe ? leg.toe_m : leg.heel_m));
}

// The foot that stands on its heel or, while the other one flies, on its toe.
struct Planted {
  Side side = kLeftSide;
  bool toe = false;
  bool operator==(const Planted&) const = default;
};
inline Planted planted_of(const Block<1>& block) {
  return {block.state.right_swings != 0.0f ? kLeftSide : kRightSide, block.state.flies != 0.0f};
}

// The greatest second difference of the legs' rotations, degrees a tick^2.
class Jerks {
 public:
  void add(const Pose& pose) {
    for (int side : {0, 1}) {
      for (int j = 0; j < 3; ++j) {
        std::array<quat, 3>& q = last_[side][j];
        q = {pose.local[adult().leg[side].joint[j].joint], q[0], q[1]};
        if (ticks_ < 2) continue;
        const vec3 now = rotation_vector(glm::conjugate(q[1]) * q[0]),
                   before = rotation_vector(glm::conjugate(q[2]) * q[1]);
        most_deg = std::max(most_deg, glm::length(now - before) / kDegree);
      }
    }
    ++ticks_;
  }
  double most_deg = 0.0;

 private:
  std::array<std::array<std::array<quat, 3>, 3>, 2> last_;
  int ticks_ = 0;
};

// One walk from a stand on.
class Alone {
 public:
  explicit Alone(const WalkModel& model = adult(), const Origin& place = {},
                 IkMode mode = IkMode::robust)
      : tables(tables_of(model, kDt)), mode_(mode) {
    stand(tables, place, block);
    pose.joint_count = tables.joints;
  }
  void step(const GaitParams& params) {
    ask(params, block);
    step();
  }
  void step() {
    quat* local = pose.local.data();
    vec3* root = &pose.root_m;
    const Poses poses{&local, &root, 1};
    mode_ == IkMode::paper ? advance_by_paper(tables, block, poses) : advance(tables, block, poses);
  }
  void walk(const GaitParams& params, int ticks) {
    for (int tick = 0; tick < ticks; ++tick) step(params);
  }
  bool stands() const { return block.change.stands != 0.0f; }

  const Tables tables;
  Block<1> block;
  Pose pose;

 private:
  IkMode mode_;
};

// Expects of walks in a block of that width the bits of the same walks alone, tick by tick.
// `change(tick, block)`: what is asked for in that tick, of each walk.
template <int kWidth, class Change>
void expect_bits_of_one(const Tables& tables, std::vector<Block<1>> alone, int ticks,
                        const Change& change) {
  std::array<Pose, kWidth> pose;
  Pose one;
  Block<kWidth> block{};
  std::array<quat*, kWidth> local;
  std::array<vec3*, kWidth> root;
  for (int w = 0; w < kWidth; ++w) {
    local[w] = pose[w].local.data(), root[w] = &pose[w].root_m;
  }
  for (int tick = 0; tick < ticks; ++tick) {
    for (int w = 0; w < kWidth; ++w) {
      if (tick > 0 && !change(tick, w, alone[w])) continue;
      copy_walk(alone[w], 0, block, w);
    }
    advance(tables, block, Poses{local.data(), root.data(), kWidth});
    for (int w = 0; w < kWidth; ++w) {
      quat* to = one.local.data();
      vec3* root_m = &one.root_m;
      advance(tables, alone[w], Poses{&to, &root_m, 1});
      Block<1> lane_of;
      copy_walk(block, w, lane_of, 0);
      ASSERT_EQ(std::memcmp(&lane_of, &alone[w], kStateNumbers<float> * sizeof(float)), 0)
          << "tick " << tick << " walk " << w;
      ASSERT_EQ(one.root_m, pose[w].root_m);
      for (int j = 0; j < tables.joints; ++j) ASSERT_EQ(one.local[j], pose[w].local[j]) << j;
    }
  }
}
template <class Work>
void for_each_width(const Work& work) {
  work(std::integral_constant<int, 4>{});
  if (__builtin_cpu_supports("avx2")) work(std::integral_constant<int, 8>{});
  if (__builtin_cpu_supports("avx512dq")) work(std::integral_constant<int, 16>{});
}

}  // namespace gaitpad
