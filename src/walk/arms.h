// The arms, where a style gives their joints different weights or asks a hand to carry something or
// hold a rail: weighted half-Jacobian IK over six angles, with the middle of the hand as the
// end-effector. Other arms swing as in the data.
#pragma once
#include "walk/chain_solve.h"
#include "walk/trunk.h"

namespace gaitpad {
namespace {

// An arm to be solved. All of its members are numbers V, of arms side by side.
template <class N>
struct ArmChain {
  using V = N;
  static constexpr int kRows = 3, dofs = kArmDofs;
  V solves{};  // 1: solve it
  Vec<V> upper_m, fore_m, grip_m, goal_m;
  V has_height{};  // 1: the hand also goes to the height of its goal
  V weight[kArmDofs]{}, min_rad[kArmDofs]{}, max_rad[kArmDofs]{}, angle_rad[kArmDofs]{};

  struct Place {
    Vec<V> axis[kArmDofs], elbow_m, wrist_m, end_m;
    V error_m[3];
  };
  void place(const V (&angle)[kArmDofs], Place& to) const noexcept {
    V s[kArmDofs], c[kArmDofs];
    for (int j = 0; j < kArmDofs; ++j) sin_cos(angle[j], s[j], c[j]);
    Axes<V> f = axes_xz(s, c);
    to.axis[0] = {all<V>(1.0f), V{}, V{}};
    to.axis[1] = f.z;
    to.axis[2] = f.y;
    turn_axes(f.z, f.x, s[2], c[2]);
    to.elbow_m = f * upper_m;
    to.axis[3] = f.x;
    turn_axes(f.y, f.z, s[3], c[3]);
    to.wrist_m = to.elbow_m + f * fore_m;
    to.axis[4] = f.x;
    turn_axes(f.y, f.z, s[4], c[4]);
    to.axis[5] = f.z;
    turn_axes(f.x, f.y, s[5], c[5]);
    to.end_m = to.wrist_m + f * grip_m;
    const Vec<V> off = goal_m - to.end_m;
    to.error_m[0] = off.x, to.error_m[1] = off.y * has_height, to.error_m[2] = off.z;
  }
  void set_columns(const Place& at, V (&column)[kArmDofs][3]) const noexcept {
    for (int j = 0; j < kArmDofs; ++j) {
      const Vec<V> arm = j < 3 ? at.end_m : at.end_m - (j == 3 ? at.elbow_m : at.wrist_m),
                   moves = cross(at.axis[j], arm);
      column[j][0] = moves.x, column[j][1] = moves.y * has_height, column[j][2] = moves.z;
    }
  }
};

template <class V>
void solve_arms(ArmChain<V> (&arms)[2]) noexcept {
  constexpr int kNumbers = sizeof(ArmChain<float>) / sizeof(float);
  const Mask<V> solves[2] = {arms[0].solves != V{}, arms[1].solves != V{}};
  work_packed<kNumbers, kNumbers - kArmDofs>(solves, arms, [](auto& packed) {
    solve_chains(packed, kOfTick, packed.solves != decltype(packed.solves){}, packed.angle_rad);
  });
}

// One arm of each walk, as it is posed in the step frame.
template <class V>
struct Arm {
  ArmChain<V>& chain;
  Turn<V> above{}, base{}, upper{};  // the shoulder's parent; the walker's axes there; hanging axes
  Turn<V> fore_rest{}, hand_rest{};  // frames of elbow and wrist, from the forearm's hanging axes
  Vec<V> shoulder_m{}, hand_m{};
};

// Computes the place of the shoulder, and the turn of its parent.
template <class V>
void place_shoulder(const ArmBones& bones, const Trunk<V>& trunk, const V& is, const Poses& poses,
                    Arm<V>& arm) noexcept {
  const int begin = bones.on_trunk;
  Turn<V> turn = below(trunk, begin);
  Vec<V> place_m = begin > 0 ? trunk.place_m[begin - 1] : trunk.base_m;
  for (int i = begin; i <= bones.shoulder; ++i) {
    place_m = place_m + turn * every<V>(bones.path[i].offset_m);
    if (i < bones.shoulder) turn = turn * read_joint<V>(bones.path[i].joint, is, poses);
  }
  arm.above = turn;
  arm.shoulder_m = place_m;
}

// Takes the arm's angles and lengths from the pose as it is written so far.
template <class V>
void take_arm(const ArmBones& bones, const Turn<V>& shoulder, const V& is, const Poses& poses,
              Arm<V>& arm) noexcept {
  const Turn<V> upper_joint = arm.above * shoulder;
  Turn<V> turn = upper_joint, elbow = no_turn<V>();
  Vec<V> place_m = arm.shoulder_m, elbow_m;
  const int last = static_cast<int>(bones.path.size()) - 1;
  for (int i = bones.shoulder + 1; i <= last; ++i) {
    place_m = place_m + turn * every<V>(bones.path[i].offset_m);
    turn = turn * read_joint<V>(bones.path[i].joint, is, poses);
    if (i == bones.elbow) elbow_m = place_m, elbow = turn;
  }
  arm.hand_m = place_m + turn * every<V>(bones.grip_m);
  arm.base = arm.above * every<V>(bones.chest);
  arm.upper = upper_joint * every<V>(bones.hanging);
  ArmChain<V>& chain = arm.chain;
  V* const a = chain.angle_rad;
  angles_xzy(back(arm.base) * arm.upper, a[kShoulderX], a[kShoulderZ], a[kShoulderY]);
  const Turn<V> to_upper = back(arm.upper);
  chain.upper_m = to_upper * (elbow_m - arm.shoulder_m);
  const Vec<V> fore_m = place_m - elbow_m, in_upper = to_upper * fore_m;
  a[kElbowX] = arc_of(V(-in_upper.z), V(-in_upper.y));
  a[kWristX] = a[kWristZ] = V{};
  V sine, cosine;
  sin_cos(V(0.5f * a[kElbowX]), sine, cosine);
  const Turn<V> to_fore = back(arm.upper * Turn<V>{cosine, sine, V{}, V{}});
  chain.fore_m = to_fore * fore_m;
  arm.fore_rest = to_fore * elbow;
  arm.hand_rest = to_fore * turn;
  chain.grip_m = arm.hand_rest * every<V>(bones.grip_m);
  for (int j = 0; j < kArmDofs; ++j) {
    chain.min_rad[j] = all<V>(bones.min_rad[j]);
    chain.max_rad[j] = all<V>(bones.max_rad[j]);
    chain.weight[j] = all<V>(1.0f);
  }
}

template <class V>
void write_arm(const ArmBones& bones, const V& is, const Arm<V>& arm, const Poses& poses) noexcept {
  const V* const a = arm.chain.angle_rad;
  const auto half_turn = [](const V& angle_rad, V& sine, V& cosine) {
    sin_cos(V(0.5f * angle_rad), sine, cosine);
  };
  V es, ec, xs, xc, zs, zc;
  half_turn(a[kElbowX], es, ec), half_turn(a[kWristX], xs, xc), half_turn(a[kWristZ], zs, zc);
  const Turn<V> upper = arm.base * turn_xzy(a[kShoulderX], a[kShoulderZ], a[kShoulderY]),
                fore = upper * Turn<V>{ec, es, V{}, V{}},
                hand = fore * Turn<V>{xc, xs, V{}, V{}} * Turn<V>{zc, V{}, V{}, zs};
  Turn<V> above = arm.above;
  const int last = static_cast<int>(bones.path.size()) - 1;
  for (int i = bones.shoulder; i <= last; ++i) {
    const int joint = bones.path[i].joint;
    Turn<V> local;
    if (i == bones.shoulder)
      local = back(above) * upper * back(every<V>(bones.hanging));
    else if (i == bones.elbow)
      local = back(above) * fore * arm.fore_rest;
    else if (i == last && bones.turns_wrist)
      local = back(above) * hand * arm.hand_rest;
    else
      local = read_joint<V>(joint, is, poses);
    local = unit(local);
    write_where(local, joint, is, poses);
    above = above * local;
  }
}

// --- What is asked of arms -----------------------------------------------------------------------

template <class V>
Mask<V> has_uneven_arm(const Styled<V>& styled, int side) noexcept {
  const Smoothed<V>* weight = styled.body + kArmWeight + kArmDofs * side;
  V low = weight[0].x, high = low;
  for (int j = 1; j < kArmDofs; ++j) low = least(low, weight[j].x), high = most(high, weight[j].x);
  return high - low >= all<V>(kEvenWeights);
}
enum : int { kCarry, kCarryX, kCarryY, kCarryZ, kRail, kRailHeight, kRailSide, kHandNumbers };
template <class V>
const V& of_hand(const Styled<V>& styled, int side, int number) noexcept {
  return styled.body[kHand + kHandNumbers * side + number].x;
}
// Arms that do not swing as in the data.
template <class V>
Mask<V> is_arm_posed(const Styled<V>& styled, int side) noexcept {
  return either(has_uneven_arm(styled, side),
                either(of_hand(styled, side, kCarry) > V{}, of_hand(styled, side, kRail) > V{}));
}

// Keeps joints of small weight near the middle of their swing. The others compensate, so that the
// hand keeps its way forward and sideways. Its height is free: with three rows the hand's path
// alone would determine the shoulder's angle.
template <class V>
void stiffen_arm(const ArmBones& bones, const Styled<V>& styled, int side, const Mask<V>& uneven,
                 const Vec<V>& own_m, Arm<V>& arm) noexcept {
  ArmChain<V>& chain = arm.chain;
  for (int j = 0; j < kArmDofs; ++j)
    chain.weight[j] = uneven ? styled.body[kArmWeight + kArmDofs * side + j].x : all<V>(1.0f);
  make_relative(kArmDofs, chain.weight);
  for (int j = 0; j < kArmDofs; ++j)
    chain.angle_rad[j] = chain.angle_rad[j] +
                         held_back(chain.weight[j]) * (bones.middle_rad[j] - chain.angle_rad[j]);
  chain.goal_m = back(arm.base) * (own_m - arm.shoulder_m);
  chain.has_height = V{};
  chain.solves = chosen<V>(uneven, 1.0f, 0.0f);
}

// Moves a place to where the arm can reach it: neither too far from the shoulder nor too near.
template <class V>
Vec<V> within_reach(const Vec<V>& way_m, const V& full_m) noexcept {
  // Greatest and least distance of a held hand, and the widths over which these limits are rounded;
  // shares of the stretched arm.
  constexpr float kFarthest = 0.985f, kSoftFar = 0.03f, kNearest = 0.3f, kSoftNear = 0.1f;
  const V far = root(dot(way_m, way_m)), nearest = kNearest * full_m,
          near = nearest + soft_positive(V(far - nearest), V(kSoftNear * full_m)),
          to = soft_least(near, V(kFarthest * full_m), V(kSoftFar * full_m));
  return way_m * (to / most(far, all<V>(1e-6f)));
}

// Turns the whole arm at the shoulder towards its goal. The solver then starts near its answer and
// hardly turns the wrist.
template <class V>
void aim_arm(const Mask<V>& where, ArmChain<V>& chain) noexcept {
  typename ArmChain<V>::Place at;
  chain.place(chain.angle_rad, at);
  const V far = root(dot(at.end_m, at.end_m)), goal_far = root(dot(chain.goal_m, chain.goal_m));
  const Vec<V> from = at.end_m * (1.0f / most(far, all<V>(1e-6f))),
               to = chain.goal_m * (1.0f / most(goal_far, all<V>(1e-6f))), axis = cross(from, to);
  const Turn<V> turn =
      unit(Turn<V>{most(V(1.0f + dot(from, to)), all<V>(1e-6f)), axis.x, axis.y, axis.z});
  V *const a = chain.angle_rad, x, z, y;
  angles_xzy(turn * turn_xzy(a[kShoulderX], a[kShoulderZ], a[kShoulderY]), x, z, y);
  const auto aims = both(where, both(far > all<V>(1e-6f), goal_far > all<V>(1e-6f)));
  const V next_x = a[kShoulderX] + within_half_turn(V(x - a[kShoulderX])),
          next_y = a[kShoulderY] + within_half_turn(V(y - a[kShoulderY]));
  a[kShoulderX] = aims ? next_x : a[kShoulderX];
  a[kShoulderZ] = aims ? z : a[kShoulderZ];
  a[kShoulderY] = aims ? next_y : a[kShoulderY];
}

// The frames in which hands are held. A carrying hand is placed in the upright frame that turns
// with the shoulders, so that a tray in both hands stays level; a rail runs along the hips' path.
template <class V>
struct Holds {
  Vec<V> middle_m;  // between the shoulders
  V sine, cosine;   // of their turn about the vertical
  Vec<V> hips_m;    // on the ground, without the data's oscillation
  Way<V> heading;
};

template <class V>
void hold_hand(const Tables& tables, const Styled<V>& styled, int side, const Mask<V>& is_posed,
               const Holds<V>& holds, Arm<V>& arm) noexcept {
  constexpr float kRailAhead_m = 0.15f;  // how far ahead of the hips a hand holds a rail
  // Angles x, z, y of a left shoulder at which the solver starts: the elbow points down and a
  // little outwards if the hand carries a tray, and back if it holds a rail.
  constexpr float kCarrying_rad[3] = {-15 * kDegree_rad, 12 * kDegree_rad, -15 * kDegree_rad},
                  kAtRail_rad[3] = {25 * kDegree_rad, 4 * kDegree_rad, 5 * kDegree_rad};
  // Weights of a held arm: shoulder and elbow bring the hand to its place, and the wrist hardly
  // takes part. A hand held by the share kFullFrom has all of them.
  constexpr float kHeldWeight[kArmDofs] = {1.0f, 1.0f, 0.7f, 1.0f, 0.25f, 0.25f};
  constexpr float kFullFrom = 0.1f;
  const float outwards = side == kLeftSide ? 1.0f : -1.0f;
  const V carry = within(of_hand(styled, side, kCarry), 0.0f, 1.0f),
          rail = within(of_hand(styled, side, kRail), 0.0f, 1.0f),
          held = 1.0f - (1.0f - carry) * (1.0f - rail);
  const auto holds_it = both(is_posed, held > V{});
  ArmChain<V>& chain = arm.chain;
  chain.solves = chosen<V>(holds_it, 1.0f, 0.0f);
  if (!any(holds_it)) return;
  typename ArmChain<V>::Place at;
  chain.place(chain.angle_rad, at);
  const Vec<V> lower_m = chain.fore_m + chain.grip_m;
  const V a = root(dot(chain.upper_m, chain.upper_m)), b = root(dot(lower_m, lower_m));
  const Turn<V> to_base = back(arm.base);
  const auto move_to = [&](const Vec<V>& place_m, const V& share, Vec<V>& goal_m) {
    const Vec<V> to = within_reach(to_base * (place_m - arm.shoulder_m), V(a + b));
    goal_m = goal_m + (to - goal_m) * share;
  };
  Vec<V> goal_m = at.end_m;
  const float arm_scale = tables.arm_m / static_cast<float>(kReferenceArm_m),
              rail_scale = tables.shoulder_height_m / static_cast<float>(kReferenceShoulder_m);
  const V x_m = (outwards * arm_scale) * of_hand(styled, side, kCarryX),
          y_m = arm_scale * of_hand(styled, side, kCarryY),
          z_m = arm_scale * of_hand(styled, side, kCarryZ);
  move_to(holds.middle_m + Vec<V>{V(holds.cosine * x_m + holds.sine * z_m), y_m,
                                  V(holds.cosine * z_m - holds.sine * x_m)},
          carry, goal_m);
  const V aside_m = (outwards * rail_scale) * of_hand(styled, side, kRailSide),
          over_m = styled.rail_ground_m[side].x + rail_scale * of_hand(styled, side, kRailHeight);
  const Way<V>& way = holds.heading;
  const V ahead_m = all<V>(kRailAhead_m * rail_scale);
  move_to(Vec<V>{V(holds.hips_m.x + (way.cosine * aside_m + way.sine * ahead_m)), over_m,
                 V(holds.hips_m.z + (way.cosine * ahead_m - way.sine * aside_m))},
          rail, goal_m);
  // The solver starts with the elbow outwards, and bent for the distance of the goal.
  const V far2 = dot(goal_m, goal_m),
          cosine =
              within(V((far2 - a * a - b * b) / most(V(2.0f * a * b), all<V>(1e-6f))), -1.0f, 1.0f),
          bend = arc_of(V(root(V(1.0f - cosine * cosine))), cosine);
  const V start[kArmDofs] = {mix(all<V>(kCarrying_rad[0]), all<V>(kAtRail_rad[0]), rail),
                             outwards * mix(all<V>(kCarrying_rad[1]), all<V>(kAtRail_rad[1]), rail),
                             outwards * mix(all<V>(kCarrying_rad[2]), all<V>(kAtRail_rad[2]), rail),
                             -bend,
                             V{},
                             V{}};
  const V shows = smooth(0.0f, kFullFrom, held);
  for (int j = 0; j < kArmDofs; ++j) {
    const V angle = chain.angle_rad[j] + held * (start[j] - chain.angle_rad[j]),
            weight = chain.weight[j] * (1.0f + shows * (kHeldWeight[j] - 1.0f));
    chain.angle_rad[j] = holds_it ? angle : chain.angle_rad[j];
    chain.weight[j] = weight;
  }
  make_relative(kArmDofs, chain.weight);
  chain.goal_m = goal_m;
  chain.has_height = all<V>(1.0f);
  aim_arm(holds_it, chain);
}

// Poses arms, where `is_posed` by side. `own_m`: places of the hands in the data.
template <class V>
void pose_arms(const Tables& tables, const Hips<V>& hips, const Vec<V>& hips_m,
               const Trunk<V>& trunk, const Mask<V> (&is_posed)[2], const Vec<V> (&own_m)[2],
               const Turn<V> (&shoulder)[2], const Styled<V>& styled, const Poses& poses) noexcept {
  const V some = chosen<V>(either(is_posed[0], is_posed[1]), 1.0f, 0.0f);
  ArmChain<V> chains[2];
  Arm<V> arms[2] = {{chains[0]}, {chains[1]}};
  const bool has[2] = {!tables.arm[0].path.empty(), !tables.arm[1].path.empty()};
  for (int side : {0, 1}) {
    if (!has[side]) continue;
    place_shoulder(tables.arm[side], trunk, some, poses, arms[side]);
    take_arm(tables.arm[side], shoulder[side], some, poses, arms[side]);
  }
  Holds<V> holds{{}, V{}, all<V>(1.0f), hips_m, hips.heading};
  Vec<V> across;  // to the left
  if (has[0] && has[1]) {
    holds.middle_m = (arms[0].shoulder_m + arms[1].shoulder_m) * 0.5f;
    across = arms[0].shoulder_m - arms[1].shoulder_m;
  } else {
    const Arm<V>& only = arms[has[0] ? 0 : 1];
    const Vec<V> ahead = only.base * Vec<V>{V{}, V{}, all<V>(1.0f)};
    holds.middle_m = only.shoulder_m;
    across = {ahead.z, V{}, -ahead.x};
  }
  const V over = 1.0f / most(V(root(V(across.x * across.x + across.z * across.z))), all<V>(1e-6f));
  holds.cosine = across.x * over, holds.sine = -across.z * over;
  for (int side : {0, 1}) {
    const auto uneven = both(is_posed[side], has_uneven_arm(styled, side));
    if (has[side] && any(uneven))
      stiffen_arm(tables.arm[side], styled, side, uneven, own_m[side], arms[side]);
  }
  solve_arms(chains);
  for (int side : {0, 1}) {
    chains[side].solves = V{};
    if (has[side] && any(is_posed[side]))
      hold_hand(tables, styled, side, is_posed[side], holds, arms[side]);
  }
  solve_arms(chains);
  for (int side : {0, 1})
    if (has[side] && any(is_posed[side]))
      write_arm(tables.arm[side], chosen<V>(is_posed[side], 1.0f, 0.0f), arms[side], poses);
}

}  // namespace
}  // namespace gaitpad
