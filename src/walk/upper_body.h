// Sixth: the joints that the legs do not set, from the data at this phase.
#pragma once
#include "gaitpad/math.h"
#include "walk/idle.h"
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
                const Mask<V>& is_styled, const Poses& poses) noexcept {
  const V chest_rad = state.chest_ahead_rad.x, head_rad = state.head_ahead_rad.x;
  const auto leads = both(no(is_styled), either(chest_rad != V{}, head_rad != V{}));
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

// --- What a style asks of the upper body ---------------------------------------------------------

inline constexpr float kRadians = 0.017453293f;  // a degree

// Brings its numbers nearer to those asked for; those of no style are the data's.
template <class V>
void smooth_body(const Tables& tables, const Mask<V>& is_styled, Styled<V>& styled) noexcept {
  constexpr float kSettled = 1e-5f;
  const auto asked = styled.asked != V{}, acted = styled.acts != V{};
  auto plain = no(asked);
  for (int n = 0; n < kBodyNumbers; ++n) {
    const V none = all<V>(tables.plain_body[n]), goal = asked ? styled.goal[n] : none;
    Smoothed<V> number{acted ? styled.body[n].x : none, acted ? styled.body[n].v : V{}};
    follow(goal, tables.body, number);
    const auto there =
        both(size(V(number.x - goal)) < all<V>(kSettled), size(number.v) < all<V>(kSettled));
    const V value = there ? goal : number.x, rate = there ? V{} : number.v;
    styled.body[n].x = is_styled ? value : styled.body[n].x;
    styled.body[n].v = is_styled ? rate : styled.body[n].v;
    plain = both(plain, value == none);
  }
  styled.acts = chosen<V>(plain, 0.0f, 1.0f);
}

// From one rotation to another, the shorter way.
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

// 1 in the middle of the time that a leg stands alone, 0 in that of the other.
template <class V>
V stands_alone(const Tables& tables, const V& phase, bool right) noexcept {
  const auto& share = tables.stage_share;
  const float middle =
      right ? share[0] + 0.5f * share[1] : share[0] + share[1] + share[2] + 0.5f * share[3];
  V sine, cosine;
  sin_cos(V(6.2831853f * (phase - middle)), sine, cosine);
  const V half = 0.5f + 0.5f * cosine;
  return half * half;
}

// The joints from the pelvis to the head, and how they are turned in the step frame.
inline constexpr int kMostPath = 24;
template <class V>
struct Trunk {
  Turn<V> own[kMostPath], turned[kMostPath];
};

// Turns neck and head: the neck by its share, the head by all of it.
template <class V>
void turn_head(const Tables& tables, const Turn<V>& turn, Trunk<V>& trunk) noexcept {
  const Turn<V> none{all<V>(1.0f), V{}, V{}, V{}};
  const int joints = static_cast<int>(tables.path.size());
  for (int i = 0; i < joints; ++i) {
    const float share = tables.path[i].of_look;
    if (share > 0.0f) trunk.turned[i] = between(none, turn, all<V>(share)) * trunk.turned[i];
  }
}

// The head's rotation when it looks along `direction`: upright, and within the limits of the neck.
// `share` fades to 0 for goals that the head does not follow.
template <class V>
struct Gaze {
  Turn<V> head;
  V share;
};
template <class V>
Gaze<V> gaze(const Tables& tables, const Turn<V>& chest, const Vec<V>& direction) noexcept {
  constexpr float kMostYaw_rad = 70 * kRadians, kMostPitch_rad = 40 * kRadians,
                  kSoftYaw_rad = 6 * kRadians, kSoftHeadPitch_rad = 4 * kRadians;
  // It does not follow a goal behind it, for turning left and right would be equally far, nor one
  // straight above or below.
  constexpr float kBeside_rad = 105 * kRadians, kBehind_rad = 150 * kRadians, kLevelFrom = 0.15f,
                  kLevelTo = 0.4f;
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
  // Its left stays level: half angles of its heading, then of its pitch.
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

// Leans the trunk, spreads the arms, and turns the head to where it is to look.
template <class V>
void pose_style(const Tables& tables, const Hips<V>& hips, const Pelvis<V>& pelvis,
                const Idle<V>& idle, const V& phase, const V& shown, const Mask<V>& is_styled,
                const State<V>& state, const Styled<V>& styled, const Poses& poses) noexcept {
  constexpr float kHeadStays = 0.8f;  // of the trunk's breath: the head stays so upright
  constexpr float kLead_s = 0.6f;     // how far ahead of the walk a leading head looks
  const auto of = [&](int number) -> const V& { return styled.body[number].x; };
  const V is = chosen<V>(is_styled, 1.0f, 0.0f);
  const auto write = [&](const Turn<V>& q, int joint) {
    for (int w = 0; w < poses.walks; ++w)
      if (lane(is, w) != 0.0f) write_joint(q, joint, w, poses);
  };
  const Turn<V> heading = hips.heading.turn(), from_heading = back(heading);
  const auto seen = [&](const Turn<V>& turn) { return heading * turn * from_heading; };
  const V forward_rad = kRadians * of(kLean_deg) - idle.breath_rad,
          left_rad = kRadians * shown *
                     (of(kOverLeft_deg) * stands_alone(tables, phase, false) -
                      of(kOverRight_deg) * stands_alone(tables, phase, true));
  const V chest_rad = state.chest_ahead_rad.x;
  // The spine's joints share the lean.
  const int joints = static_cast<int>(tables.path.size());
  Trunk<V> trunk;
  const Turn<V> base = pelvis.turn * every<V>(tables.pelvis_standing);
  Turn<V> above = base;
  for (int i = 0; i < joints; ++i) {
    const PathJoint& joint = tables.path[i];
    Turn<V> q = read_joint<V>(joint.joint, poses);
    if (joint.bends > 0.0f) {
      const V share = all<V>(joint.bends);
      const Turn<V> bends = seen(turn_y(V(share * chest_rad)) * turn_z(V(-share * left_rad)) *
                                 turn_x(V(share * forward_rad)));
      q = unit(back(above) * bends * above * q);
    }
    trunk.own[i] = q;
    above = trunk.turned[i] = above * q;
    if (joint.bends > 0.0f) write(q, joint.joint);
  }
  // Arms keep hanging as they did, and are spread.
  for (int side : {0, 1}) {
    const std::vector<int>& path = tables.arm[side].path;
    if (path.empty()) continue;
    above = base;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) above = above * read_joint<V>(path[i], poses);
    const V out_rad = (side == 0 ? kRadians : -kRadians) * of(kArmOut_deg + side);
    const Turn<V> turn = seen(turn_z(out_rad) * turn_x(V(-forward_rad)) * turn_z(left_rad));
    write(unit(back(above) * turn * above * read_joint<V>(path.back(), poses)), path.back());
  }
  // The head.
  if (joints == 0) return;
  const int head = joints - 1;
  int neck = 0;
  while (neck < head && tables.path[neck].of_look == 0.0f) ++neck;
  const Turn<V> below = neck > 0 ? trunk.turned[neck - 1] : base;
  const V turns = state.head_ahead_rad.x - chest_rad + idle.glance_rad,
          nods = -kHeadStays * idle.breath_rad - idle.nod_rad;
  turn_head(tables, seen(turn_y(turns) * turn_x(V(-nods))), trunk);
  turn_head(tables, turn_y(V(kLead_s * of(kLead) * state.turn_rad_s.x)), trunk);
  const auto looks = of(kLook) != V{};
  if (any(looks)) {
    V ys, yc, ps, pc;
    sin_cos(V(state.heading_rad + kRadians * of(kLookYaw_deg)), ys, yc);
    sin_cos(V(kRadians * of(kLookPitch_deg)), ps, pc);
    const Gaze<V> to = gaze<V>(tables, below * back(every<V>(tables.chest_standing)),
                               Vec<V>{pc * ys, ps, pc * yc});
    const Turn<V> wanted =
        between(trunk.turned[head], to.head, V(within(of(kLook), 0.0f, 1.0f) * to.share));
    Trunk<V> looking = trunk;
    turn_head(tables, wanted * back(trunk.turned[head]), looking);
    for (int i = neck; i < joints; ++i)
      trunk.turned[i] = chosen(looks, looking.turned[i], trunk.turned[i]);
  }
  for (int i = neck; i < joints; ++i) {
    const Turn<V>& parent = i > 0 ? trunk.turned[i - 1] : base;
    write(unit(back(parent) * trunk.turned[i]), tables.path[i].joint);
  }
}

template <class V>
void write_upper_body(const Tables& tables, const Hips<V>& hips, const Pelvis<V>& pelvis,
                      const Idle<V>& idle, const V& phase, const V& presence, const V& swing,
                      const State<V>& state, Styled<V>& styled, const Poses& poses) noexcept {
  constexpr float kSoftElbow = 0.1f;
  const Knots<V> knots = knots_at(phase);
  const V shown = presence * within(state.posture.x, 0.0f, 1.0f);
  const auto idles = styled.idle_share != V{},
             is_styled = either(either(styled.asked != V{}, styled.acts != V{}), idles);
  const bool any_style = any(is_styled);
  if (any_style) smooth_body(tables, is_styled, styled);
  V shoulder[2], elbow[2];
  for (int side : {0, 1}) {
    shoulder[side] = swing;
    if (any_style)
      shoulder[side] = styled.acts != V{} ? V(swing * styled.body[kArmSwing + side].x) : swing;
    elbow[side] =
        soft_least(shoulder[side], all<V>(tables.most_elbow_swing[side]), all<V>(kSoftElbow));
  }
  const std::size_t count = tables.upper.size();
  for (int w = 0; w < poses.walks; ++w) {
    const float* row =
        tables.upper_rows.data() + static_cast<int>(lane(knots.first, w)) * count * 4;
    const float k0 = lane(knots.weight[0], w), k1 = lane(knots.weight[1], w),
                k2 = lane(knots.weight[2], w), k3 = lane(knots.weight[3], w),
                shows = lane(shown, w);
    const float swings[5] = {1.0f, lane(shoulder[0], w), lane(elbow[0], w), lane(shoulder[1], w),
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
  turn_ahead(tables, pelvis, state, is_styled, poses);
  if (any_style)
    pose_style(tables, hips, pelvis, idle, phase, shown, is_styled, state, styled, poses);
}

}  // namespace
}  // namespace gaitpad::anew
