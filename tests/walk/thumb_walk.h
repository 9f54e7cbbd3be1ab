// A walk from a stand on that a thumb steers, tick by tick, and what is measured of it.
#pragma once
#include <array>
#include <cmath>
#include <vector>

#include "tests/minimum_jerk.h"
#include "tests/walk/made_walker.h"
#include "walk/steer.h"
#include "walk/walk.h"

namespace gaitpad {

constexpr int kThumbTicks = 14;  // a thumb moves in 60 ms
constexpr int kCoarse = 4;       // ticks of a step of 60 Hz, over which accelerations are measured
constexpr int kMoments = 12;     // of a stride, at which a thumb moves

// What a walk did in a tick, in the world.
struct Trail {
  vec3 root_m;
  std::array<std::array<quat, 3>, 2> leg;  // hip, knee, ankle
  std::array<vec3, 2> knee_m, ankle_m, heel_m, toe_m;
  quat chest, head;
  double heading_rad = 0.0;
  bool stands = false, flies = false, right_swings = false;
};

class ThumbWalk {
 public:
  explicit ThumbWalk(const WalkModel& model)
      : model_(&model), limits_(gait_limits(model)), tables_(tables_of(model, kDt)) {
    pose_.joint_count = tables_.joints;
    stand(tables_, Origin{}, block_);
    const std::vector<int>& path = model.body.head_path;
    head_ = path.empty() ? -1 : path.back();
    chest_ = path.empty() ? -1 : path[std::max(0, model.body.neck_at - 1)];
  }

  // Moves the thumb to (x, y) and walks.
  void walk(double x, double y, int ticks) {
    const vec2 to(x, y);
    if (to != to_) from_ = at_, to_ = to, moves_ = 0;
    for (int tick = 0; tick < ticks; ++tick) {
      at_ = from_ + (to_ - from_) * minimum_jerk(++moves_ / double(kThumbTicks));
      Stick stick;
      stick.left = at_;
      step(gait_params(stick, StyleValues{}, limits_));
    }
  }
  void step(const GaitParams& params) {
    ask(params, block_);
    quat* local = pose_.local.data();
    vec3* root = &pose_.root_m;
    advance(tables_, block_, Poses{&local, &root, 1});
    record();
  }

  int ticks() const { return static_cast<int>(trails.size()); }
  const Trail& last() const { return trails.back(); }
  bool stands() const { return block_.change.stands != 0.0f; }
  const Block<1>& block() const { return block_; }
  const Pose& pose() const { return pose_; }
  const Tables& tables() const { return tables_; }
  const WalkModel& model() const { return *model_; }
  std::vector<Trail> trails;

 private:
  void record() {
    static JointFrames frames;
    forward_kinematics(model_->cycle.skeleton, pose_, frames);
    Trail trail;
    trail.root_m = pose_.root_m;
    for (int side : {0, 1}) {
      const LegBuild& leg = model_->leg[side];
      for (int j = 0; j < 3; ++j) trail.leg[side][j] = pose_.local[leg.joint[j].joint];
      const int ankle = leg.model.joints.ankle;
      trail.knee_m[side] = frames.position_m[leg.model.joints.knee];
      trail.ankle_m[side] = frames.position_m[ankle];
      const quat foot = frames.rotation[ankle] * glm::conjugate(leg.model.standing[2]);
      trail.heel_m[side] = trail.ankle_m[side] + foot * leg.model.heel_m;
      trail.toe_m[side] = trail.ankle_m[side] + foot * leg.model.toe_m;
    }
    if (head_ >= 0) trail.head = frames.rotation[head_], trail.chest = frames.rotation[chest_];
    trail.heading_rad =
        block_.origin[0].heading_rad + static_cast<double>(block_.state.heading_rad);
    trail.stands = stands();
    trail.flies = block_.state.flies != 0.0f;
    trail.right_swings = block_.state.right_swings != 0.0f;
    trails.push_back(trail);
  }

  const WalkModel* model_;
  GaitLimits limits_;
  Tables tables_;
  Block<1> block_;
  Pose pose_;
  vec2 from_{0.0}, to_{0.0}, at_{0.0};
  int moves_ = kThumbTicks, head_ = -1, chest_ = -1;
};

// --- Measures of the ticks from `from` until before `until` --------------------------------------

// The greatest second difference of a leg's rotations, degrees a tick^2.
inline double jerk_deg(const std::vector<Trail>& t, int from, int until) {
  double most = 0.0;
  for (int i = std::max(from, 2); i < until; ++i) {
    for (int side : {0, 1}) {
      for (int j = 0; j < 3; ++j) {
        const quat &a = t[i - 2].leg[side][j], &b = t[i - 1].leg[side][j], &c = t[i].leg[side][j];
        most = std::max(most, glm::length(rotation_vector(glm::conjugate(b) * c) -
                                          rotation_vector(glm::conjugate(a) * b)));
      }
    }
  }
  return most / kDegree;
}

// Of the hips on the ground, at 60 Hz, along a heading.
inline double speed_m_s(const std::vector<Trail>& t, int at) {
  return (t[at + kCoarse].root_m.z - t[at - kCoarse].root_m.z) * kRate / (2.0 * kCoarse);
}
inline vec3 acceleration_m_s2(const std::vector<Trail>& t, int at) {
  return (t[at + kCoarse].root_m - 2.0 * t[at].root_m + t[at - kCoarse].root_m) *
         (double(kRate * kRate) / (kCoarse * kCoarse));
}
struct Hips {
  double forwards_m_s2 = 0.0, aside_m_s2 = 0.0, fastest_m_s = -9.0, slowest_m_s = 9.0,
         lowest_m = 9.0, back_m = 0.0;
};
inline Hips hips_of(const std::vector<Trail>& t, int from, int until) {
  Hips hips;
  double farthest_m = -1e9;
  for (int i = from; i < until; ++i) {
    hips.lowest_m = std::min(hips.lowest_m, t[i].root_m.y);
    farthest_m = std::max(farthest_m, t[i].root_m.z);
    hips.back_m = std::max(hips.back_m, farthest_m - t[i].root_m.z);
    if (i < kCoarse || i + kCoarse >= static_cast<int>(t.size())) continue;
    const vec3 acceleration = acceleration_m_s2(t, i);
    hips.forwards_m_s2 = std::max(hips.forwards_m_s2, std::abs(acceleration.z));
    hips.aside_m_s2 = std::max(hips.aside_m_s2, std::abs(acceleration.x));
    hips.fastest_m_s = std::max(hips.fastest_m_s, speed_m_s(t, i));
    hips.slowest_m_s = std::min(hips.slowest_m_s, speed_m_s(t, i));
  }
  return hips;
}

// How far the planted end of the standing foot moves in a tick: its heel while the foot rolls, then
// its toe; and how far below the floor heels and toes are.
struct Contacts {
  double slid_m = 0.0, deep_m = 0.0;
};
inline Contacts contacts_of(const ThumbWalk& walk, int from, int until) {
  Contacts contacts;
  const std::vector<Trail>& t = walk.trails;
  for (int i = std::max(from, 2); i < until; ++i) {
    const Trail &was = t[i - 1], &before = t[i - 2];
    const int stands = was.right_swings ? kLeftSide : kRightSide;
    const auto end = was.flies ? &Trail::toe_m : &Trail::heel_m;
    if (was.right_swings == before.right_swings && was.flies == before.flies)
      contacts.slid_m =
          std::max(contacts.slid_m, glm::distance((t[i].*end)[stands], (was.*end)[stands]));
    for (int side : {0, 1}) {
      const double rest_m = walk.model().leg[side].model.toe_rest_m;
      contacts.deep_m =
          std::max({contacts.deep_m, -t[i].heel_m[side].y, rest_m - t[i].toe_m[side].y});
    }
  }
  return contacts;
}

// The least distance of two lines, from a to b and from c to d.
inline double distance_m(const vec3& a, const vec3& b, const vec3& c, const vec3& d) {
  constexpr int kParts = 8;
  double least = 1e9;
  for (int i = 0; i <= kParts; ++i)
    for (int k = 0; k <= kParts; ++k)
      least = std::min(least, glm::distance(a + (b - a) * (i / double(kParts)),
                                            c + (d - c) * (k / double(kParts))));
  return least;
}
inline double shins_m(const Trail& t) {
  return distance_m(t.knee_m[0], t.ankle_m[0], t.knee_m[1], t.ankle_m[1]);
}
inline double feet_m(const Trail& t) {
  const vec3 flat(1.0, 0.0, 1.0);
  return distance_m(t.heel_m[0] * flat, t.toe_m[0] * flat, t.heel_m[1] * flat, t.toe_m[1] * flat);
}

// A steady walk at a stick.
struct Steady {
  double speed_m_s = 0.0, cycle_s = 0.0, jerk_deg = 0.0;
  Hips hips;
};
inline bool strikes(const std::vector<Trail>& t, int i) {
  return t[i].right_swings != t[i - 1].right_swings;
}
inline Steady steady_of(const std::vector<Trail>& t, int from) {
  Steady steady;
  std::vector<int> marks;  // strikes of one foot
  const int until = static_cast<int>(t.size()) - kCoarse;
  for (int i = from; i < until; ++i)
    if (strikes(t, i) && t[i].right_swings) marks.push_back(i);
  const int ticks = marks.back() - marks.front();
  steady.speed_m_s = (t[marks.back()].root_m.z - t[marks.front()].root_m.z) / ticks * kRate;
  steady.cycle_s = ticks / (marks.size() - 1.0) / kRate;
  steady.jerk_deg = jerk_deg(t, from, until);
  steady.hips = hips_of(t, from, until);
  return steady;
}

}  // namespace gaitpad
