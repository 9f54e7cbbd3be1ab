// Seventh: the trunk from the pelvis to the head, where it moves otherwise than in the data. It
// leans into a change of speed and as a style asks; chest and head turn ahead; a style's weights
// share the spine's bend; the head looks at a goal. While a walk changes, bounds keep the angular
// acceleration of chest and head near that of a steady walk.
#pragma once
#include <cstddef>

#include "gaitpad/walk_model.h"
#include "walk/chain_solve.h"
#include "walk/idle.h"
#include "walk/weights.h"

namespace gaitpad {
namespace {

// --- Joints of a pose ----------------------------------------------------------------------------

// The rotation of each walk, transposed from its lanes.
template <class V>
void to_walks(const Turn<V>& q, Four (&of)[kLanes<V>]) noexcept {
  if constexpr (kLanes<V> == 1) {
    of[0] = Four{q.x, q.y, q.z, q.w};
  } else {
    for (int w = 0; w < kLanes<V>; w += 4) {
      Four row[4];
      int n = 0;
      for (const V* numbers : {&q.x, &q.y, &q.z, &q.w})
        row[n++] = part<Four>(reinterpret_cast<const float*>(numbers) + w);
      transpose(row);
      std::copy_n(row, 4, of + w);
    }
  }
}
template <class V>
void write_joint(const Turn<V>& q, int joint, const Poses& poses) noexcept {
  Four of[kLanes<V>];
  to_walks(q, of);
  for (int w = 0; w < poses.walks; ++w) store(of[w], poses.local[w][joint]);
}
// Writes a joint of the walks for which `is` is 1; it is 0 for the others.
template <class V>
void write_where(const Turn<V>& q, int joint, const V& is, const Poses& poses) noexcept {
  Four of[kLanes<V>];
  to_walks(q, of);
  for (int w = 0; w < poses.walks; ++w)
    if (lane(is, w) != 0.0f) store(of[w], poses.local[w][joint]);
}
template <class V>
Turn<V> read_joint(int joint, const V& is, const Poses& poses) noexcept {
  alignas(64) float row[kLanes<V>][4];
  for (int w = 0; w < kLanes<V>; ++w) {
    const bool reads = w < poses.walks && lane(is, w) != 0.0f;
    const Four q = reads ? load(poses.local[w][joint]) : Four{0.0f, 0.0f, 0.0f, 1.0f};
    std::memcpy(row[w], &q, sizeof q);
  }
  V n[4];
  to_lanes(&row[0][0], 4, n);
  return {n[3], n[0], n[1], n[2]};
}

// The rotation at a share of the shorter way from one to another.
template <class V>
Turn<V> between(const Turn<V>& a, const Turn<V>& b, const V& share) noexcept {
  const V along = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
  const auto other = along < V{};
  const auto part = [&](const V& from, const V& to) {
    return mix(from, other ? V(-to) : to, share);
  };
  return unit(Turn<V>{part(a.w, b.w), part(a.x, b.x), part(a.y, b.y), part(a.z, b.z)});
}

// A rotation about the x, y or z axis.
template <class V>
Turn<V> turn_x(const V& angle_rad) noexcept {
  return turn_about(Vec<V>{all<V>(1.0f), V{}, V{}}, angle_rad);
}
template <class V>
Turn<V> turn_y(const V& angle_rad) noexcept {
  return turn_about(Vec<V>{V{}, all<V>(1.0f), V{}}, angle_rad);
}
template <class V>
Turn<V> turn_z(const V& angle_rad) noexcept {
  return turn_about(Vec<V>{V{}, V{}, all<V>(1.0f)}, angle_rad);
}
template <class V>
Turn<V> every(const std::array<float, 4>& q) noexcept {
  return {all<V>(q[0]), all<V>(q[1]), all<V>(q[2]), all<V>(q[3])};
}
template <class V>
Vec<V> every(const std::array<float, 3>& v) noexcept {
  return {all<V>(v[0]), all<V>(v[1]), all<V>(v[2])};
}

// --- The trunk -----------------------------------------------------------------------------------

// An array for a path of any length. It is not set to 0, for that would take longer than what is
// done with the few joints of most paths.
template <class T>
class OfPath {
 public:
  T& operator[](int i) noexcept { return reinterpret_cast<T*>(bytes_)[i]; }
  const T& operator[](int i) const noexcept { return reinterpret_cast<const T*>(bytes_)[i]; }

 private:
  alignas(T) std::byte bytes_[kMaxBodyPath * sizeof(T)];
};

// The joints of the path from the pelvis to the head, in the step frame.
template <class V>
struct Trunk {
  Turn<V> base;  // what the path hangs from
  Vec<V> base_m;
  OfPath<Turn<V>> own, turned;  // each joint's rotation in its parent, and in the step frame
  OfPath<Vec<V>> place_m;
};

inline int joints_of_path(const Tables& tables) noexcept {
  return static_cast<int>(tables.path.size());
}
// The turn of a joint's parent.
template <class V>
const Turn<V>& below(const Trunk<V>& trunk, int joint) noexcept {
  return joint > 0 ? trunk.turned[joint - 1] : trunk.base;
}

template <class V>
void place_trunk(const Tables& tables, int from, Trunk<V>& trunk) noexcept {
  for (int i = from; i < joints_of_path(tables); ++i)
    trunk.place_m[i] = (i > 0 ? trunk.place_m[i - 1] : trunk.base_m) +
                       below(trunk, i) * every<V>(tables.path[i].offset_m);
}

// Bends the trunk `where`: turns each joint of the spine by `turn` of the joint's share.
template <class V, class TurnOf>
void bend(const Tables& tables, const TurnOf& turn, const Mask<V>& where,
          Trunk<V>& trunk) noexcept {
  Turn<V> above = trunk.base, by;
  float share = 0.0f;  // `by` is the turn of this share; most joints have the same
  const bool bends = any(where);
  for (int i = 0; i < joints_of_path(tables); ++i) {
    const PathJoint& joint = tables.path[i];
    if (bends && joint.bends > 0.0f) {
      if (joint.bends != share) by = turn(all<V>(joint.bends));
      share = joint.bends;
      const Turn<V> bent = unit(back(above) * by * above * trunk.own[i]);
      trunk.own[i] = chosen(where, bent, trunk.own[i]);
    }
    above = trunk.turned[i] = above * trunk.own[i];
  }
}

// Turns the joints of the neck by their shares of a turn, and the head by all of it.
template <class V>
void turn_head(const Tables& tables, const Turn<V>& turn, Trunk<V>& trunk) noexcept {
  for (int i = 0; i < joints_of_path(tables); ++i) {
    const float share = tables.path[i].of_look;
    if (share > 0.0f)
      trunk.turned[i] = between(no_turn<V>(), turn, all<V>(share)) * trunk.turned[i];
  }
}

// The trunk's differences from the data: its lean forwards and to the left, the chest's turn ahead,
// the head's turn beside the chest's, and its nod upwards.
template <class V>
struct Bearing {
  V forward_rad{}, left_rad{}, ahead_rad{}, turns_rad{}, nods_rad{};
};

template <class V>
Mask<V> leans(const Bearing<V>& bearing) noexcept {
  return either(either(bearing.forward_rad != V{}, bearing.left_rad != V{}),
                bearing.ahead_rad != V{});
}
template <class V>
void lean_trunk(const Tables& tables, const Turn<V>& heading, const Bearing<V>& bearing,
                Trunk<V>& trunk) noexcept {
  const Turn<V> from_heading = back(heading);
  const auto turn = [&](const V& share) {
    return heading *
           (turn_y(V(share * bearing.ahead_rad)) * turn_z(V(-share * bearing.left_rad)) *
            turn_x(V(share * bearing.forward_rad))) *
           from_heading;
  };
  bend(tables, turn, leans(bearing), trunk);
}
template <class V>
void nod(const Tables& tables, const Turn<V>& heading, const Bearing<V>& bearing,
         Trunk<V>& trunk) noexcept {
  turn_head(tables,
            heading * (turn_y(bearing.turns_rad) * turn_x(V(-bearing.nods_rad))) * back(heading),
            trunk);
}

// --- Chest and head while a walk changes ---------------------------------------------------------

// Advances the mean speed and the lean into a change of it. Returns the walks whose chest and head
// are to be eased. `is_new`: the plan has changed in this tick.
template <class V>
Mask<V> advance_poise(const Tables& tables, const Hips<V>& hips, const Mask<V>& is_new,
                      const Change<V>& change, const State<V>& state, Poise<V>& poise) noexcept {
  // The trunk leans forward while the walk is slower than asked, back while it is faster: by
  // kPush_rad for each m/s that is missing beyond the share kCalm of the speed. If the share
  // kFirstFrom of the asked speed is missing, it leans by up to kFirstPush_rad more, which it
  // reaches at kFirstAll, so that a slow walk leans as well.
  constexpr float kPush_rad = 3.0f * kDegree_rad, kFirstPush_rad = 2.0f * kDegree_rad,
                  kFirstFrom = 0.4f, kFirstAll = 0.8f, kCalm = 0.25f, kSoftCalm_m_s = 0.1f;
  // Chest and head are eased while the head's turn ahead changes faster than this, or is farther
  // from its goal.
  constexpr float kTurns_rad_s = 0.02f, kTurns_rad = 0.003f;
  constexpr float kSteady_s =
      0.3f;  // at the reference leg: a walk is steady so long after a change
  const Asked<V>& a = state.asked;
  const V pace = (a.length_m[0] + a.length_m[1]) /
                 most(V(a.time_s[0] + a.time_s[1]), all<V>(kLeastCycle_s)),
          asked = is_to_walk(tables, state, change) ? (a.backward != V{} ? V(-pace) : pace) : V{};
  const V goes_m = (state.pelvis_x_m[0] - state.pelvis_x_m[1]) * hips.heading.sine +
                   (state.pelvis_z_m[0] - state.pelvis_z_m[1]) * hips.heading.cosine;
  follow(V(goes_m * (1.0f / tables.tick_s)), tables.speed, poise.speed_m_s);
  const V lacks = asked - poise.speed_m_s.x, missing = size(lacks), way = size(asked),
          calm = kCalm * most(way, size(poise.speed_m_s.x));
  const auto unsteady = either(either(change.led != V{}, change.was_led != V{}), is_new);
  poise.unsteady_ticks = unsteady ? all<V>(kSteady_s * tables.time_scale / tables.tick_s)
                                  : most(V(poise.unsteady_ticks - 1.0f), V{});
  const auto leans = either(missing > calm, poise.push_rad.x != V{});
  if (any(leans)) {
    const V first =
                kFirstPush_rad * smooth(V((missing - kFirstFrom * way) /
                                          most(V((kFirstAll - kFirstFrom) * way), all<V>(1e-6f)))),
            more =
                kPush_rad * soft_positive(V(missing - calm - kSoftCalm_m_s), all<V>(kSoftCalm_m_s)),
            push = more + (asked != V{} ? first : V{}), goal = lacks < V{} ? V(-push) : push;
    follow_turn(goal, kStill_rad, tables.push, poise.push_rad);
  }
  const V ahead_rad = kHeadAhead_s * looked_turn(tables, state);
  const auto turns = either(size(state.head_ahead_rad.v) > all<V>(kTurns_rad_s),
                            size(V(ahead_rad - state.head_ahead_rad.x)) > all<V>(kTurns_rad));
  return either(either(poise.unsteady_ticks != V{}, poise.push_rad.x != V{}), turns);
}

// The axis of a turn times twice the sine of its half, which is nearly the rotation vector of a
// small turn; and back.
template <class V>
Vec<V> vector_of(const Turn<V>& q) noexcept {
  const V k = q.w < V{} ? all<V>(-2.0f) : all<V>(2.0f);
  return {k * q.x, k * q.y, k * q.z};
}
template <class V>
Turn<V> turn_of(const Vec<V>& v) noexcept {
  return {root(most(V(1.0f - 0.25f * dot(v, v)), V{})), 0.5f * v.x, 0.5f * v.y, 0.5f * v.z};
}
// The turns of chest and head from the standing pose, as such vectors in the walker's axes.
template <class V>
Vec<V> chest_turn(const Tables& tables, const Turn<V>& heading, const Trunk<V>& trunk) noexcept {
  return vector_of(back(heading) * below(trunk, tables.neck) *
                   back(every<V>(tables.chest_standing)));
}
template <class V>
Vec<V> head_turn(const Tables& tables, const Turn<V>& heading, const Trunk<V>& trunk) noexcept {
  return vector_of(back(heading) * trunk.turned[joints_of_path(tables) - 1] *
                   back(every<V>(tables.head_standing)));
}

// Follows `goal` with a turn, for walks where it `acts`. Where it also `eases`, the turn's second
// difference is bounded by `most_rad`; the turn is then off its goal. This difference fades in
// kEases_s or, if it is large, so slowly that the fade takes a third of the bound. `heading_rad`:
// second difference of the heading.
template <class V>
Vec<V> eased(const Tables& tables, const Vec<V>& goal, const V& most_rad, const V& heading_rad,
             const Mask<V>& acts, const Mask<V>& eases, Eased<V>& turn) noexcept {
  constexpr float kEases_s = 0.25f;
  Eased<V> of = turn;
  constexpr float kQuintic = 17.0f;  // three times the greatest bend of a quintic of length 1
  for (Off<V>& off : of.off) fade(of.ticks, off);
  const Vec<V> bend = goal + Vec<V>{of.off[0].x, of.off[1].x, of.off[2].x} - of.at - of.rate,
               turns{bend.x, V(bend.y + heading_rad), bend.z};
  const V square = dot(turns, turns);
  const auto clamps = both(eases, square > most_rad * most_rad);
  const V less = clamps ? V(most_rad / root(most(square, all<V>(1e-20f))) - 1.0f) : V{};
  const Vec<V> by = turns * less;
  const V parts[3] = {by.x, by.y, by.z};
  for (int k = 0; k < 3; ++k) {
    of.off[k].x = of.off[k].x + parts[k];
    of.off[k].v = of.off[k].v + parts[k];
  }
  const Vec<V> off{of.off[0].x, of.off[1].x, of.off[2].x};
  const V lasts = most(all<V>(kEases_s * tables.time_scale / tables.tick_s),
                       root(V(kQuintic * root(dot(off, off)) / most_rad)));
  of.ticks = clamps ? lasts : most(V(of.ticks - 1.0f), V{});
  const Vec<V> value = goal + off;
  of.rate = value - of.at;
  of.at = value;
  put_where<V>(acts, of, turn);
  return value;
}

// --- Spine ---------------------------------------------------------------------------------------

inline constexpr float kNeckLever_m = 0.2f;  // makes a length of the neck's turn, for its row

// The spine's joints share the movement that brings neck and shoulders to their place in the data.
// Three rows: the neck's place sideways and forward, and forward that of a point beside the neck.
// Each joint has the angles x, z, y, in the standing walker's axes turned with the joint below the
// spine.
template <class N>
struct SpineChain {
  using V = N;
  static constexpr int kRows = 3, kDofs = 3 * kMaxSpineIk;
  int dofs;
  Vec<V> link_m[kMaxSpineIk], neck_m, goal_m, beside_goal_m;
  V weight[kDofs], min_rad[kDofs], max_rad[kDofs];

  struct Place {
    Vec<V> axis[kDofs], pivot_m[kMaxSpineIk], neck_m, beside_m;
    V error_m[3];
  };
  void place(const V (&angle)[kDofs], Place& to) const noexcept {
    const V one = all<V>(1.0f);
    Axes<V> f{{one, V{}, V{}}, {V{}, one, V{}}, {V{}, V{}, one}};
    Vec<V> end_m;
    for (int d = 0; d < dofs; d += 3) {
      V s[3], c[3];
      for (int k = 0; k < 3; ++k) sin_cos(angle[d + k], s[k], c[k]);
      to.pivot_m[d / 3] = end_m;
      to.axis[d] = f.x;
      turn_axes(f.y, f.z, s[0], c[0]);
      to.axis[d + 1] = f.z;
      turn_axes(f.x, f.y, s[1], c[1]);
      to.axis[d + 2] = f.y;
      turn_axes(f.z, f.x, s[2], c[2]);
      end_m = end_m + f * link_m[d / 3];
    }
    to.neck_m = end_m + f * neck_m;
    to.beside_m = to.neck_m + f.x * kNeckLever_m;
    to.error_m[0] = goal_m.x - to.neck_m.x;
    to.error_m[1] = goal_m.z - to.neck_m.z;
    to.error_m[2] = beside_goal_m.z - to.beside_m.z;
  }
  void set_columns(const Place& at, V (&column)[kDofs][3]) const noexcept {
    for (int d = 0; d < dofs; ++d) {
      const Vec<V>& pivot_m = at.pivot_m[d / 3];
      const Vec<V> neck = cross(at.axis[d], at.neck_m - pivot_m);
      column[d][0] = neck.x, column[d][1] = neck.z;
      column[d][2] = cross(at.axis[d], at.beside_m - pivot_m).z;
    }
  }
};

template <class V>
Mask<V> has_uneven_spine(const Styled<V>& styled) noexcept {
  return size(V(styled.body[kSpineWeight].x - styled.body[kSpineWeight + 1].x)) >=
         all<V>(kEvenWeights);
}

// Pulls joints of small weight towards the standing pose; the others bring the neck back to its
// place.
template <class V>
void share_spine(const Tables& tables, const Styled<V>& styled, const Mask<V>& uneven,
                 Trunk<V>& trunk) noexcept {
  constexpr float kMostBend_rad = 60.0f * kDegree_rad;  // of one joint
  const int count = static_cast<int>(tables.spine.size());
  SpineChain<V> chain;
  chain.dofs = 3 * count;
  const Turn<V> base = below(trunk, tables.spine[0].at) * back(every<V>(tables.spine_base)),
                to_base = back(base);
  V angle_rad[SpineChain<V>::kDofs];
  Turn<V> last = no_turn<V>();
  const V lower = styled.body[kSpineWeight].x, upper = styled.body[kSpineWeight + 1].x,
          over = 1.0f / most(most(lower, upper), all<V>(1e-6f));
  for (int i = 0; i < count; ++i) {
    const SpineBone& bone = tables.spine[i];
    const Turn<V> own = to_base * trunk.turned[bone.at] * back(every<V>(bone.standing));
    V* const a = angle_rad + 3 * i;
    angles_xzy(back(last) * own, a[0], a[1], a[2]);
    const V w = within(V(mix(lower, upper, all<V>(bone.upper)) * over), 0.0f, 1.0f);
    for (int k = 0; k < 3; ++k) {
      chain.weight[3 * i + k] = w;
      chain.min_rad[3 * i + k] = all<V>(-kMostBend_rad);
      chain.max_rad[3 * i + k] = all<V>(kMostBend_rad);
      a[k] = a[k] * (1.0f - held_back(w));
    }
    chain.link_m[i] = {};
    if (i + 1 < count)
      chain.link_m[i] =
          back(own) * (to_base * (trunk.place_m[tables.spine[i + 1].at] - trunk.place_m[bone.at]));
    last = own;
  }
  chain.neck_m = every<V>(tables.neck_m);
  const Vec<V> end_m =
      to_base * (trunk.place_m[tables.spine[count - 1].at] - trunk.place_m[tables.spine[0].at]);
  chain.goal_m = end_m + last * chain.neck_m;
  chain.beside_goal_m = chain.goal_m + last * Vec<V>{all<V>(kNeckLever_m), V{}, V{}};
  solve_chains(chain, kOfTick, uneven, angle_rad);
  Turn<V> segment = no_turn<V>();
  int next = 0;
  for (int i = tables.spine[0].at; i < joints_of_path(tables); ++i) {
    const Turn<V>& above = below(trunk, i);
    if (next < count && tables.spine[next].at == i) {
      const V* const a = angle_rad + 3 * next;
      segment = segment * turn_xzy(a[0], a[1], a[2]);
      const Turn<V> to = unit(back(above) * base * segment * every<V>(tables.spine[next].standing));
      trunk.own[i] = chosen(uneven, to, trunk.own[i]);
      ++next;
    }
    trunk.turned[i] = above * trunk.own[i];
  }
}

// --- Head ----------------------------------------------------------------------------------------

// The head's rotation when it looks along `direction`: upright, and within the limits of the neck.
// `share` fades to 0 for goals that the head does not follow.
template <class V>
struct Gaze {
  Turn<V> head;
  V share;
};
template <class V>
Gaze<V> gaze(const Tables& tables, const Turn<V>& chest, const Vec<V>& direction) noexcept {
  // Limits of the neck, and the widths over which they are rounded.
  constexpr float kMostYaw_rad = 70 * kDegree_rad, kMostPitch_rad = 40 * kDegree_rad,
                  kSoftYaw_rad = 6 * kDegree_rad, kSoftHeadPitch_rad = 4 * kDegree_rad;
  // The head does not follow a goal behind it, for turning left and right would be equally far, nor
  // one straight above or below: shares of its direction that are level.
  constexpr float kBeside_rad = 105 * kDegree_rad, kBehind_rad = 150 * kDegree_rad,
                  kLevelFrom = 0.15f, kLevelTo = 0.4f;
  const auto limited = [](const V& x, float most, float soft) {
    const V below = soft_least(x, all<V>(most), all<V>(soft));
    return V(below + soft_positive(V(-most - below), all<V>(soft)));
  };
  const Vec<V> d = back(chest) * direction;
  const V level = root(V(d.x * d.x + d.z * d.z)), over = 1.0f / most(level, all<V>(1e-6f)),
          yaw = angle_of(V(d.x * over), V(d.z * over)), pitch = angle_of(d.y, level);
  Gaze<V> to;
  to.share =
      (1.0f - smooth(kBeside_rad, kBehind_rad, size(yaw))) * smooth(kLevelFrom, kLevelTo, level);
  V ys, yc, ps, pc;
  sin_cos(limited(yaw, kMostYaw_rad, kSoftYaw_rad), ys, yc);
  sin_cos(limited(pitch, kMostPitch_rad, kSoftHeadPitch_rad), ps, pc);
  const Vec<V> ahead = chest * Vec<V>{pc * ys, ps, pc * yc};
  // The head's sideways axis stays level: half angles of the heading, then of the pitch.
  const V flat = root(V(ahead.x * ahead.x + ahead.z * ahead.z)),
          turns = 1.0f / most(flat, all<V>(1e-6f));
  const auto half = [](const V& sine, const V& cosine, V& half_sine, V& half_cosine) {
    half_cosine = root(V(0.5f + 0.5f * most(cosine, all<V>(-0.9999f))));
    half_sine = 0.5f * sine / half_cosine;
  };
  V hys, hyc, hps, hpc;
  half(V(ahead.x * turns), V(ahead.z * turns), hys, hyc);
  half(ahead.y, flat, hps, hpc);
  to.head =
      Turn<V>{hyc, V{}, hys, V{}} * Turn<V>{hpc, -hps, V{}, V{}} * every<V>(tables.head_standing);
  return to;
}

// Turns the head by a share of the way from `own` to looking along `direction`.
template <class V>
void look_along(const Tables& tables, const Vec<V>& direction, const V& share, const Turn<V>& own,
                const Mask<V>& looks, Trunk<V>& trunk) noexcept {
  const int joints = joints_of_path(tables), neck = tables.neck;
  const Gaze<V> to =
      gaze<V>(tables, below(trunk, neck) * back(every<V>(tables.chest_standing)), direction);
  const Turn<V> wanted = between(own, to.head, V(within(share, 0.0f, 1.0f) * to.share));
  OfPath<Turn<V>> was;
  for (int i = neck; i < joints; ++i) was[i] = trunk.turned[i];
  turn_head(tables, wanted * back(trunk.turned[joints - 1]), trunk);
  for (int i = neck; i < joints; ++i) trunk.turned[i] = chosen(looks, trunk.turned[i], was[i]);
}

// A place of the world in the step frame of each walk.
template <int kWidth>
Vec<Floats<kWidth>> look_place(const Block<kWidth>& block, const Floats<kWidth>& is) noexcept {
  using V = Floats<kWidth>;
  const State<V>& state = block.state;
  Vec<V> p;
  for (int w = 0; w < kWidth; ++w) {
    if (lane(is, w) == 0.0f) continue;
    const auto of = [&](int n) {
      return static_cast<double>(lane(block.styled.body[kLookAt + n].x, w));
    };
    vec3 place_m(of(1), of(2), of(3));
    if (block.is_placed) place_m = from_world(block.placed[w], place_m);
    const Origin& origin = block.origin[w];
    set_lane(static_cast<float>(place_m.x - origin.x_m), w, p.x);
    set_lane(static_cast<float>(place_m.y - origin.y_m), w, p.y);
    set_lane(static_cast<float>(place_m.z - origin.z_m), w, p.z);
  }
  return back(way_of_half(state.frame_sine, state.frame_cosine)) * p;
}

// Turns the head as a style asks: to where the walk leads, in a direction, or to a place. Returns
// the walks whose style asks for it.
template <int kWidth>
Mask<Floats<kWidth>> look(const Tables& tables, const Block<kWidth>& block,
                          const Mask<Floats<kWidth>>& is_styled,
                          Trunk<Floats<kWidth>>& trunk) noexcept {
  using V = Floats<kWidth>;
  constexpr float kLead_s = 0.6f;    // how far ahead of the walk a leading head looks
  constexpr float kNear_m = 0.001f;  // nearer places are inside the head and have no direction
  const State<V>& state = block.state;
  const auto of = [&](int number) -> const V& { return block.styled.body[number].x; };
  const int head = joints_of_path(tables) - 1;
  const auto leads = both(is_styled, of(kLead) > V{}), looks = both(is_styled, of(kLook) > V{}),
             looks_at = both(is_styled, of(kLookAt) > V{});
  if (any(leads))
    turn_head(tables, turn_y(leads ? V(kLead_s * of(kLead) * state.turn_rad_s.x) : V{}), trunk);
  if (any(looks)) {
    V ys, yc, ps, pc;
    sin_cos(V(state.heading_rad + kDegree_rad * of(kLookYaw_deg)), ys, yc);
    sin_cos(V(kDegree_rad * of(kLookPitch_deg)), ps, pc);
    look_along(tables, Vec<V>{pc * ys, ps, pc * yc}, of(kLook), trunk.turned[head], looks, trunk);
  }
  const auto some = either(either(leads, looks), looks_at);
  if (!any(looks_at)) return some;
  const Vec<V> place_m = look_place<kWidth>(block, chosen<V>(looks_at, 1.0f, 0.0f));
  const Turn<V> own = trunk.turned[head];
  // The head moves when it turns, so a near place is aimed at twice.
  for (int pass = 0; pass < 2; ++pass) {
    place_trunk(tables, 0, trunk);
    const Vec<V> way_m = place_m - trunk.place_m[head];
    const V far_m = root(dot(way_m, way_m));
    look_along(tables, way_m * (1.0f / most(far_m, all<V>(kNear_m))), of(kLookAt), own,
               both(looks_at, far_m > all<V>(kNear_m)), trunk);
  }
  return some;
}

}  // namespace
}  // namespace gaitpad
