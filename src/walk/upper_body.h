// Sixth: the joints that the legs do not set, from the data at this phase.
#pragma once
#include "gaitpad/math.h"
#include "walk/pose_places.h"
#include "walk/weights.h"

namespace gaitpad::anew {
namespace {

inline Four unit(const Four& q) noexcept {
  const Four square = q * q, pairs = square + __builtin_shufflevector(square, square, 1, 0, 3, 2),
             sum = pairs + __builtin_shufflevector(pairs, pairs, 2, 3, 0, 1);
  return q / root(sum);
}
inline void store(const Four& q, quat& to) noexcept {
  using Doubles __attribute__((vector_size(32))) = double;
  const Doubles wide = __builtin_convertvector(q, Doubles);
  std::memcpy(&to, &wide, sizeof wide);
}

// The factor on the data's arm swing: proportional to speed (Boulic et al. 1990), 1 at the data's
// own pace, at most 1.4 by pace alone; below half the data's step the whole posture fades instead.
template <class V>
V arm_swing(const Tables& tables, const State<V>& state) noexcept {
  constexpr float kMostExtra = 0.4f, kLeastPace = 0.5f;
  const V quicker =
      tables.own_step_s / most(state.step_time_s.x, all<V>(0.25f * tables.own_step_s));
  const V extra = most(state.pace.x, all<V>(kLeastPace)) * quicker - 1.0f;
  return 1.0f + (extra > V{} ? V(extra / (1.0f + extra * (1.0f / kMostExtra))) : extra);
}

template <class V>
void write_joint(const Turn<V>& q, int joint, int w, const Poses& poses) noexcept {
  store(Four{lane(q.x, w), lane(q.y, w), lane(q.z, w), lane(q.w, w)}, poses.local[w][joint]);
}

template <class V>
Turn<V> read_joint(int joint, const Poses& poses) noexcept {
  Turn<V> q;
  for (int w = 0; w < poses.walks; ++w) {
    const quat& from = poses.local[w][joint];
    set_lane(static_cast<float>(from.w), w, q.w);
    set_lane(static_cast<float>(from.x), w, q.x);
    set_lane(static_cast<float>(from.y), w, q.y);
    set_lane(static_cast<float>(from.z), w, q.z);
  }
  return q;
}

// Turns the joints from the pelvis to the head about the vertical, where chest and head are ahead:
// each about its parent's upward axis, which that turn does not change.
template <class V>
void turn_ahead(const Tables& tables, const Pelvis<V>& pelvis, const State<V>& state,
                const Poses& poses) noexcept {
  const V chest_rad = state.chest_ahead_rad.x, head_rad = state.head_ahead_rad.x;
  const auto leads = either(chest_rad != V{}, head_rad != V{});
  if (!any(leads)) return;
  const V is = chosen<V>(leads, 1.0f, 0.0f);
  const auto& s = tables.pelvis_standing;
  const Turn<V> standing{all<V>(s[0]), all<V>(s[1]), all<V>(s[2]), all<V>(s[3])};
  Vec<V> up = back(pelvis.turn * standing) * Vec<V>{V{}, all<V>(1.0f), V{}};
  for (const PathJoint& joint : tables.path) {
    const Turn<V> q = read_joint<V>(joint.joint, poses);
    const Turn<V> turned =
        turn_about(up, V(joint.of_chest * chest_rad + joint.of_head * head_rad)) * q;
    for (int w = 0; w < poses.walks; ++w)
      if (lane(is, w) != 0.0f) write_joint(turned, joint.joint, w, poses);
    up = back(q) * up;
  }
}

template <class V>
void write_upper_body(const Tables& tables, const Pelvis<V>& pelvis, const V& phase,
                      const V& presence, const State<V>& state, const Poses& poses) noexcept {
  constexpr float kSoftElbow = 0.1f;
  const Knots<V> knots = knots_at(phase);
  const V swing = arm_swing(tables, state), shown = presence * within(state.posture.x, 0.0f, 1.0f);
  V elbow[2];
  for (int side : {0, 1})
    elbow[side] = soft_least(swing, all<V>(tables.most_elbow_swing[side]), all<V>(kSoftElbow));
  const std::size_t count = tables.upper.size();
  for (int w = 0; w < poses.walks; ++w) {
    const float* row =
        tables.upper_rows.data() + static_cast<int>(lane(knots.first, w)) * count * 4;
    const float k0 = lane(knots.weight[0], w), k1 = lane(knots.weight[1], w),
                k2 = lane(knots.weight[2], w), k3 = lane(knots.weight[3], w),
                shows = lane(shown, w);
    const float swings[5] = {1.0f, lane(swing, w), lane(elbow[0], w), lane(swing, w),
                             lane(elbow[1], w)};
    for (std::size_t i = 0; i < count; ++i) {
      const UpperJoint& joint = tables.upper[i];
      const float* from = row + 4 * i;
      Four q = part<Four>(from) * k0 + part<Four>(from + 4 * count) * k1 +
               part<Four>(from + 8 * count) * k2 + part<Four>(from + 12 * count) * k3;
      if (joint.swings != 0) {
        const Four middle = part<Four>(joint.middle.data());
        q = middle + (q - middle) * swings[joint.swings];
      }
      q = unit(q);
      if (shows < 1.0f) {
        const Four stand = part<Four>(joint.standing.data());
        q = unit(stand + (q - stand) * shows);
      }
      store(q, poses.local[w][joint.joint]);
    }
  }
  turn_ahead(tables, pelvis, state, poses);
}

}  // namespace
}  // namespace gaitpad::anew
