// Sixth: the joints that the legs do not set, from the data at this phase, and the changes that a
// style or a change of the walk makes to them.
#pragma once
#include "walk/arms.h"
#include "walk/ground_plan.h"

namespace gaitpad {
namespace {

// How much quicker the walk's steps are than the data's.
template <class V>
V quickness(const Tables& tables, const State<V>& state) noexcept {
  return tables.own_step_s / most(state.step_time_s.x, all<V>(0.25f * tables.own_step_s));
}

// The factor on the data's arm swing: proportional to speed (Boulic et al. 1990) and 1 at the
// data's own pace; the pace alone approaches 1 + kMostExtra. Below kLeastPace of the data's step it
// stays, for there the whole posture fades.
template <class V>
V arm_swing(const Tables& tables, const State<V>& state) noexcept {
  constexpr float kMostExtra = 0.4f, kLeastPace = 0.5f;
  const V extra = most(state.pace.x, all<V>(kLeastPace)) * quickness(tables, state) - 1.0f;
  return 1.0f + (extra > V{} ? V(extra / (1.0f + extra * (1.0f / kMostExtra))) : extra);
}

// --- What a style asks of the upper body ---------------------------------------------------------

// True if a style, or a stand's breath and glances, change the upper body.
template <class V>
Mask<V> has_style(const Styled<V>& styled) noexcept {
  return either(either(styled.asked != V{}, styled.acts != V{}), styled.idle_share != V{});
}

template <class V>
void smooth_body(const Tables& tables, const Mask<V>& is_styled, Styled<V>& styled) noexcept {
  const auto there = [](const V& goal, const Smoothed<V>& number) {
    const V unit = most(size(goal), all<V>(1.0f));
    return both(size(V(number.x - goal)) < kSettled * unit, size(number.v) < kStill_per_s * unit);
  };
  const auto acts = follow_style(
      tables.body, Mask<V>(styled.asked != V{}), Mask<V>(styled.acts != V{}), is_styled,
      kBodyNumbers, styled.goal, [&](int n) { return all<V>(tables.build.plain_body[n]); }, there,
      styled.body);
  styled.acts = chosen<V>(acts, 1.0f, 0.0f);
}

// 1 in the middle of the time in which this leg stands alone, 0 in the middle of the other's.
template <class V>
V stands_alone(const Tables& tables, const V& phase, bool right) noexcept {
  const auto& share = tables.stage_share;
  const float middle =
      right ? share[0] + 0.5f * share[1] : share[0] + share[1] + share[2] + 0.5f * share[3];
  V sine, cosine;
  sin_cos(V(kTurn_rad * (phase - middle)), sine, cosine);
  const V half = 0.5f + 0.5f * cosine;
  return half * half;
}

// Moves the ground under a rail, over the step frame. A rail rises evenly over stairs, so this is
// the mean of the ground along the way under the hand, taken as far ahead as the filter after it
// lags.
template <int kWidth>
void follow_rails(const Tables& tables, const Vec<Floats<kWidth>>& hips_m,
                  const Mask<Floats<kWidth>>& is_styled, Block<kWidth>& block) noexcept {
  using V = Floats<kWidth>;
  constexpr float kProbe_m = 0.035f;
  constexpr int kProbes = 15;  // on either side, 1.05 m in all: a mean over two treads rises evenly
  const State<V>& state = block.state;
  Styled<V>& styled = block.styled;
  for (int side : {0, 1}) {
    const V& held = of_hand(styled, side, kRail);
    const auto follows =
        both(is_styled, either(held > V{}, styled.goal[kHand + kHandNumbers * side + kRail] > V{}));
    if (!any(follows)) continue;
    const V is = chosen<V>(follows, 1.0f, 0.0f);
    Smoothed<V>& ground_m = styled.rail_ground_m[side];
    if (tables.terrain == nullptr) continue;
    const float ahead =
                    2.0f * static_cast<float>(kRailSmoothing_s) * tables.time_scale / tables.tick_s,
                scale = tables.shoulder_height_m / static_cast<float>(kReferenceShoulder_m);
    V mean_m{};
    for (int w = 0; w < kWidth; ++w) {
      if (lane(is, w) == 0.0f) continue;
      const Origin& origin = block.origin[w];
      const double heading = origin.heading_rad + static_cast<double>(lane(state.heading_rad, w));
      const SinCos at = gaitpad::sin_cos(heading), frame = gaitpad::sin_cos(origin.heading_rad);
      const double x = lane(hips_m.x, w) +
                       ahead * (lane(state.pelvis_x_m[0], w) - lane(state.pelvis_x_m[1], w)),
                   z = lane(hips_m.z, w) +
                       ahead * (lane(state.pelvis_z_m[0], w) - lane(state.pelvis_z_m[1], w)),
                   aside = (side == kLeftSide ? scale : -scale) *
                           lane(of_hand(styled, side, kRailSide), w);
      const vec3 under(origin.x_m + frame.cos * x + frame.sin * z + aside * at.cos, 0.0,
                       origin.z_m + frame.cos * z - frame.sin * x - aside * at.sin);
      double sum = 0.0;
      for (int i = -kProbes; i <= kProbes; ++i) {
        const double weight = kProbes + 1.0 - std::abs(i),
                     along = i * static_cast<double>(kProbe_m * tables.size);
        sum += weight *
               ground_height(tables, block.placed[w], under + vec3(at.sin, 0.0, at.cos) * along);
      }
      // The weights' sum is a square.
      set_lane(static_cast<float>(sum / ((kProbes + 1.0) * (kProbes + 1.0)) - origin.y_m), w,
               mean_m);
    }
    Smoothed<V> next = ground_m;
    follow(mean_m, tables.rail, next);
    // A rail that the hand takes hold of begins at its height.
    const auto begins = held <= V{};
    ground_m.x = follows ? (begins ? mean_m : next.x) : ground_m.x;
    ground_m.v = follows ? (begins ? V{} : next.v) : ground_m.v;
  }
}

// Keeps rails at their place in the world at a strike, which moves the step frame up by `up_m`.
template <class V>
void move_rails(const Mask<V>& strikes, const V& up_m, Styled<V>& styled) noexcept {
  for (Smoothed<V>& ground_m : styled.rail_ground_m)
    ground_m.x = strikes ? V(ground_m.x - up_m) : ground_m.x;
}

// --- Trunk, arms and head ------------------------------------------------------------------------

// A joint of the path in the data, for walks whose `is` is 1.
template <class V>
Turn<V> data_turn(const Tables& tables, const PathJoint& joint, const Knots<V>& knots,
                  const V& shown, const V& is) noexcept {
  const std::size_t count = tables.build.upper.size();
  Turn<V> turn = no_turn<V>();
  for (int w = 0; w < kLanes<V>; ++w) {
    if (lane(is, w) == 0.0f) continue;
    const float* from = tables.build.upper_rows.data() +
                        (static_cast<int>(lane(knots.first, w)) * count + joint.upper) * 4;
    Four q{};
    for (int k = 0; k < 4; ++k) q = q + part<Four>(from + 4 * k * count) * lane(knots.weight[k], w);
    const Four stand = part<Four>(tables.build.upper[joint.upper].standing.data());
    q = unit(stand + (unit(q) - stand) * lane(shown, w));
    set_lane(q[0], w, turn.x), set_lane(q[1], w, turn.y), set_lane(q[2], w, turn.z);
    set_lane(q[3], w, turn.w);
  }
  return turn;
}

// The turn of the trunk's base: the pelvis, or the walk's heading if the trunk hangs from the root.
template <class V>
Turn<V> base_turn(const Tables& tables, const Turn<V>& heading, const Turn<V>& pelvis) noexcept {
  return tables.on_pelvis ? pelvis * every<V>(tables.pelvis_standing) : heading;
}
// The place of the base: the pelvis' joint, over the root by the joints between them, or the root.
template <class V>
Vec<V> base_place(const Tables& tables, const Turn<V>& heading, const Vec<V>& root_m, const V& is,
                  const Poses& poses) noexcept {
  if (!tables.on_pelvis) return root_m;
  Vec<V> place_m = root_m;
  Turn<V> turn = heading;
  for (std::size_t i = 0; i < tables.build.above_pelvis.size(); ++i) {
    if (i > 0) place_m = place_m + turn * every<V>(tables.build.above_pelvis[i].offset_m);
    turn = turn * read_joint<V>(tables.build.above_pelvis[i].joint, is, poses);
  }
  return tables.build.above_pelvis.empty() ? place_m
                                           : place_m + turn * every<V>(tables.pelvis_offset_m);
}

// Turns chest and head ahead of the pelvis, in walks whose upper body is not posed otherwise: each
// joint of the path turns about the vertical, as seen from its parent.
template <class V>
void turn_ahead(const Tables& tables, const Turn<V>& heading, const Turn<V>& pelvis,
                const State<V>& state, const Mask<V>& is_posed, const Poses& poses) noexcept {
  const V chest_rad = state.chest_ahead_rad.x, head_rad = state.head_ahead_rad.x;
  const auto leads = both(no(is_posed), either(chest_rad != V{}, head_rad != V{}));
  if (!any(leads)) return;
  const V is = chosen<V>(leads, 1.0f, 0.0f);
  Vec<V> up = back(base_turn(tables, heading, pelvis)) * Vec<V>{V{}, all<V>(1.0f), V{}};
  for (const PathJoint& joint : tables.path) {
    const Turn<V> q = read_joint<V>(joint.joint, is, poses);
    const Turn<V> turned =
        turn_about(up, V(joint.of_chest * chest_rad + joint.of_head * head_rad)) * q;
    write_where(turned, joint.joint, is, poses);
    up = back(q) * up;
  }
}

// The parts of a tick that its upper body depends on.
template <class V>
struct BodyTick {
  const Time<V>& time;
  const Landing<V>& landing;
  const Hips<V>& hips;
  const Stride<V>& stride;
  const Pelvis<V>& pelvis;
  const Idle<V>& idle;
  V phase, shown;  // the phase that the pose shows, and how much of the data it shows
};
// The phase at which the data are read.
template <class V>
V data_phase(const Tables& tables, const Time<V>& time, const V& phase) noexcept {
  // Walking backward is walking forward run back (Thorstensson 1986).
  const auto& share = tables.stage_share;
  return time.back ? V(share[0] + share[1] + share[2] - phase) : phase;
}

// Moves the arms in a turn. They follow the twist of the trunk: the arm on the outer side is
// carried out and forward with the chest, the other one stays behind. On the spot, where the data
// show nothing, each also goes forward with the other leg, and elbows bend; a walk's own swing
// takes over as its posture grows.
template <class V>
void swing_in_turn(const Tables& tables, const BodyTick<V>& tick, const State<V>& state,
                   const Poses& poses) noexcept {
  // Small beside a walk's: a shoulder that swings by 9 degrees moves the hand by 10 cm to either
  // side. Elbows bend by kBend_rad, and by kBends_rad more where the arm is ahead. A turn carries
  // one hand forward and one back by kReach_rad, 7 cm.
  constexpr float kSwing_rad = 9.0f * kDegree_rad, kBend_rad = 14.0f * kDegree_rad,
                  kBends_rad = 5.0f * kDegree_rad, kOut_rad = 6.0f * kDegree_rad,
                  kReach_rad = 6.0f * kDegree_rad;
  constexpr float kWhole_rad = 0.13f;  // turn of the chest ahead: as of a turn by 1 rad/s
  constexpr float kWalks = 0.9f;       // of the posture: from here on the data's swing is enough
  const V &ahead_rad = state.chest_ahead_rad.x, own = 1.0f - smooth(0.0f, kWalks, state.posture.x),
          carried = smooth(0.0f, kWhole_rad, size(ahead_rad)) * within(tick.shown, 0.0f, 1.0f),
          share = own * carried;
  const auto swings = carried > V{};
  if (!any(swings)) return;
  const V is = chosen<V>(swings, 1.0f, 0.0f);
  V sine, swing;  // 1 when the right foot strikes, with the left arm ahead
  sin_cos(V(kTurn_rad * data_phase(tables, tick.time, tick.phase)), sine, swing);
  for (int side : {0, 1}) {
    const ArmBones& bones = tables.arm[side];
    if (bones.path.empty()) continue;
    const float left = side == kLeftSide ? 1.0f : -1.0f;
    const V forward = left * swing, outer = left * ahead_rad < V{} ? all<V>(1.0f) : all<V>(-1.0f),
            out_rad = (0.5f * kOut_rad * left) * carried * (1.0f + outer),
            reach_rad = kReach_rad * carried * outer;
    const auto turn = [&](int at, const std::array<float, 4>& axes, const Turn<V>& by) {
      const Turn<V> frame = every<V>(axes), q = read_joint<V>(bones.path[at].joint, is, poses);
      write_where(unit(frame * by * back(frame) * q), bones.path[at].joint, is, poses);
    };
    turn(bones.shoulder, bones.chest,
         turn_z(out_rad) * turn_x(V(-kSwing_rad * share * forward - reach_rad)));
    if (bones.elbow == bones.shoulder + 1)  // else a joint between them turns the elbow's axis
      turn(bones.elbow, bones.hanging, turn_x(V(-share * (kBend_rad + kBends_rad * forward))));
  }
}

// The differences of a walk's trunk from the data: its turn ahead, its lean into a change of speed,
// its style, and a stand's breath and glances.
template <class V>
Bearing<V> bearing_of(const Tables& tables, const BodyTick<V>& tick, const Mask<V>& is_styled,
                      const V& chest_rad, const V& head_rad, const V& push_rad,
                      const Styled<V>& styled) noexcept {
  constexpr float kHeadStays = 0.8f;  // the head makes up for this share of the trunk's lean
  const auto of = [&](int number) -> const V& { return styled.body[number].x; };
  const Idle<V>& idle = tick.idle;
  Bearing<V> to;
  const V phase = data_phase(tables, tick.time, tick.phase);
  to.forward_rad = push_rad - idle.breath_rad;
  if (any(is_styled)) {
    const V lean_rad = kDegree_rad * of(kLean_deg) + to.forward_rad,
            left_rad = kDegree_rad * tick.shown *
                       (of(kOverLeft_deg) * stands_alone(tables, phase, false) -
                        of(kOverRight_deg) * stands_alone(tables, phase, true));
    to.forward_rad = is_styled ? lean_rad : to.forward_rad;
    to.left_rad = is_styled ? left_rad : V{};
  }
  to.ahead_rad = chest_rad;
  to.turns_rad = head_rad - chest_rad + idle.glance_rad;
  to.nods_rad = kHeadStays * (push_rad - idle.breath_rad) - idle.nod_rad;
  return to;
}

// Computes how chest and head were turned in the two ticks before easing begins, for steady walks
// do not store it.
template <class V>
[[gnu::noinline]] void begin_easing(const Tables& tables, const BodyTick<V>& tick,
                                    const Mask<V>& is_styled, const Mask<V>& begins,
                                    const Change<V>& change, const State<V>& state,
                                    const Styled<V>& styled, Poise<V>& poise) noexcept {
  const V is = chosen<V>(begins, 1.0f, 0.0f), over = planned_over(tick.time, change),
          rate = either(change.stands != V{}, change.starting != V{}) ? V{} : state.phase_rate;
  const Turn<V> heading = tick.hips.heading.turn(),
                upright = tick.pelvis.turn * back(tilted(tables, tick.stride, state));
  const StrideMix<V> mix =
      mix_of_strides(tables, tick.time, state.ratio_behind, tick.landing.ratio, over, begins);
  Vec<V> chest[2], head[2];
  for (int k : {0, 1}) {
    const float ago = static_cast<float>(k + 1);
    const V phase = tick.phase - ago * rate, ago_s = all<V>(tables.tick_s * ago);
    // The lean was 0 and the turns ahead had settled; breath and glances had their own past.
    const Idle<V> idle = idle_at(tables, most(V(styled.idle_ticks - (ago + 1.0f)), V{}), styled);
    const BodyTick<V> then{tick.time,   tick.landing, tick.hips, tick.stride,
                           tick.pelvis, idle,         phase,     tick.shown};
    const Bearing<V> before = bearing_of(
        tables, then, is_styled, V(state.chest_ahead_rad.x - ago_s * state.chest_ahead_rad.v),
        V(state.head_ahead_rad.x - ago_s * state.head_ahead_rad.v), V{}, styled);
    Stride<V> stride = read_stride(mix, tick.time, phase);
    show(change.shown, stride);
    Trunk<V> trunk;
    trunk.base = base_turn(tables, heading, upright * tilted(tables, stride, state));
    const Knots<V> knots = knots_at(data_phase(tables, tick.time, phase));
    for (int i = 0; i < joints_of_path(tables); ++i)
      trunk.own[i] = data_turn(tables, tables.path[i], knots, tick.shown, is);
    lean_trunk(tables, heading, before, trunk);
    chest[k] = chest_turn(tables, heading, trunk);
    nod(tables, heading, before, trunk);
    head[k] = head_turn(tables, heading, trunk);
  }
  const auto begin = [&](const Vec<V>(&turn)[2], Eased<V>& eased) {
    eased.at = chosen(begins, turn[0], eased.at);
    eased.rate = chosen(begins, turn[0] - turn[1], eased.rate);
    eased.ticks = begins ? V{} : eased.ticks;
  };
  begin(chest, poise.chest), begin(head, poise.head);
}

// Poses the upper body of walks that differ from the data, where `is_posed`: the trunk leans, arms
// are spread and posed, the head turns. Where it `eases`, chest and head are bounded.
template <int kWidth, bool kPaper>
[[gnu::noinline]] void pose_body(const Tables& tables, const BodyTick<Floats<kWidth>>& tick,
                                 const Mask<Floats<kWidth>>& is_posed,
                                 const Mask<Floats<kWidth>>& is_styled,
                                 const Mask<Floats<kWidth>>& eases, Block<kWidth>& block,
                                 const Poses& poses) noexcept {
  using V = Floats<kWidth>;
  // A turning walk raises the bounds, for its own turn is a part of the chest's and the head's: by
  // kMoreTurning rad/s^2 times the fourth power of the turn's rate, up to kMostTurning. A turn that
  // is let go counts until it has ended: the head has to stop with it. The chest, which the head
  // leads, has kChestLess of the head's bound. Steps that are slower than the data's
  // turn both by less, on a straight way shorter ones as well.
  constexpr float kMoreTurning = 320.0f * kDegree_rad, kMostTurning = 300.0f * kDegree_rad,
                  kChestLess = 0.8f;
  constexpr float kLeastChest_s2 = 252.0f * kDegree_rad;  // rad/s^2: the built-in walk's, at least
  constexpr float kLeastHead_s2 = 139.0f * kDegree_rad;   // the same of the head
  const State<V>& state = block.state;
  Styled<V>& styled = block.styled;
  Poise<V>& poise = block.poise;
  const V is = chosen<V>(is_posed, 1.0f, 0.0f);
  const Turn<V> heading = tick.hips.heading.turn(), from_heading = back(heading),
                none = no_turn<V>();
  const auto seen = [&](const Turn<V>& turn) { return heading * turn * from_heading; };
  Bearing<V> bearing = bearing_of(tables, tick, is_styled, state.chest_ahead_rad.x,
                                  state.head_ahead_rad.x, poise.push_rad.x, styled);
  if constexpr (kPaper) bearing.forward_rad = bearing.left_rad = V{};
  Trunk<V> trunk;
  trunk.base = base_turn(tables, heading, tick.pelvis.turn);
  trunk.base_m = base_place(tables, heading, tick.pelvis.place_m, is, poses);
  const int joints = joints_of_path(tables);
  for (int i = 0; i < joints; ++i) trunk.own[i] = read_joint<V>(tables.path[i].joint, is, poses);
  lean_trunk(tables, heading, bearing, trunk);
  // Arms keep hanging as in the data while the trunk leans.
  Turn<V> shoulder[2];
  const auto turn_shoulder = [&](int side, const Turn<V>& turn, const Mask<V>& where) {
    const ArmBones& bones = tables.arm[side];
    Turn<V> above = below(trunk, bones.on_trunk);
    for (int i = bones.on_trunk; i < bones.shoulder; ++i)
      above = above * read_joint<V>(bones.path[i].joint, is, poses);
    shoulder[side] =
        chosen(where, unit(back(above) * turn * above * shoulder[side]), shoulder[side]);
  };
  const auto tilts = either(bearing.forward_rad != V{}, bearing.left_rad != V{});
  // Only walks whose trunk differs from the data are written: the others keep their bits.
  const auto nods = either(bearing.turns_rad != V{}, bearing.nods_rad != V{});
  auto moves = either(leans(bearing), nods);
  const bool has[2] = {!tables.arm[0].path.empty(), !tables.arm[1].path.empty()};
  for (int side : {0, 1}) {
    if (!has[side]) continue;
    const ArmBones& bones = tables.arm[side];
    shoulder[side] = read_joint<V>(bones.path[bones.shoulder].joint, is, poses);
    if (!any(tilts)) continue;
    turn_shoulder(side, seen(turn_x(V(-bearing.forward_rad)) * turn_z(bearing.left_rad)), tilts);
  }
  // Bound the turn of the chest.
  const float dt = tables.tick_s;
  const auto acts = either(eases, either(poise.chest.ticks > V{}, poise.head.ticks > V{}));
  const bool may_ease = !kPaper && tables.has_head && any(acts);
  const V turns_rad = state.turn_rad_s.v * (dt * dt), asked = state.asked.turn_rad_s,
          turn = most(size(asked), size(state.turn_rad_s.x)), square = turn * turn,
          quick = least(quickness(tables, state), all<V>(1.0f)), ratio = asked_ratio(tables, state),
          pace = both(ratio > V{}, asked == V{}) ? least(most(ratio, state.pace.x), all<V>(1.0f))
                                                 : all<V>(1.0f),
          slower = quick * quick * pace,
          more = least(V(kMoreTurning * square * square), all<V>(kMostTurning)),
          of_head = most(V(tables.most_head_s2 * slower), all<V>(kLeastHead_s2)) + more,
          of_chest = most(most(V(tables.most_chest_s2 * slower), all<V>(kLeastChest_s2)),
                          V(kChestLess * (kLeastHead_s2 + more)));
  if (may_ease) {
    const auto begins = both(acts, poise.acts == V{});
    if (any(begins))
      begin_easing(tables, tick, is_styled, begins, block.change, state, styled, poise);
    const Vec<V> goal = chest_turn(tables, heading, trunk),
                 to = eased(tables, goal, V(of_chest * (dt * dt)), turns_rad, acts, eases,
                            poise.chest);
    const auto off = both(acts, poise.chest.ticks > V{});
    moves = either(moves, off);
    if (any(off)) {
      const Turn<V> turn = chosen(off, seen(turn_of(to) * back(turn_of(goal))), none);
      bend(
          tables, [&](const V& share) { return between(none, turn, share); }, off, trunk);
    }
  }
  poise.acts = chosen<V>(acts, 1.0f, 0.0f);
  auto hangs = tilts;
  for (int side : {0, 1}) {
    const V out_rad = (side == 0 ? kDegree_rad : -kDegree_rad) * styled.body[kArmOut_deg + side].x;
    const auto spreads = both(is_styled, out_rad != V{});
    if (!has[side] || kPaper || !any(spreads)) continue;
    turn_shoulder(side, seen(turn_z(spreads ? out_rad : V{})), spreads);
    hangs = either(hangs, spreads);
  }
  // Pose arms and spine by their weights.
  const Mask<V> arms[2] = {both(is_styled, is_arm_posed(styled, 0)),
                           both(is_styled, is_arm_posed(styled, 1))};
  const auto poses_arms = either(arms[0], arms[1]),
             uneven = both(is_styled, has_uneven_spine(styled));
  const bool shares = !tables.spine.empty() && any(uneven);
  if (any(poses_arms) || shares) place_trunk(tables, 0, trunk);
  Vec<V> own_m[2];
  for (int side : {0, 1}) {
    if (!has[side] || !any(both(arms[side], has_uneven_arm(styled, side)))) continue;
    ArmChain<V> chain;
    Arm<V> arm{chain};
    place_shoulder(tables.arm[side], trunk, is, poses, arm);
    take_arm(tables.arm[side], shoulder[side], is, poses, arm);
    own_m[side] = arm.hand_m;
  }
  if (shares) {
    share_spine(tables, styled, uneven, trunk);
    moves = either(moves, uneven);
    if (any(poses_arms)) place_trunk(tables, 0, trunk);
  }
  if (any(hangs)) {
    for (int side : {0, 1})
      if (has[side])
        write_where(shoulder[side], tables.arm[side].path[tables.arm[side].shoulder].joint,
                    chosen<V>(both(is_posed, hangs), 1.0f, 0.0f), poses);
  }
  if (any(poses_arms)) {
    const Vec<V> off_m = tick.hips.heading * tick.stride.pelvis_m,
                 hips_m{V(tick.hips.x_m - off_m.x), V{}, V(tick.hips.z_m - off_m.z)};
    follow_rails<kWidth>(tables, hips_m, is_styled, block);
    pose_arms(tables, tick.hips, hips_m, trunk, arms, own_m, shoulder, styled, poses);
  }
  if (tables.has_head) {
    if (any(nods)) nod(tables, heading, bearing, trunk);
    if (may_ease) {
      const Vec<V> goal = head_turn(tables, heading, trunk),
                   to = eased(tables, goal, V(of_head * (dt * dt)), turns_rad, acts, eases,
                              poise.head);
      const auto off = both(acts, poise.head.ticks > V{});
      moves = either(moves, off);
      if (any(off))
        turn_head(tables, chosen(off, seen(turn_of(to) * back(turn_of(goal))), none), trunk);
    }
    if (any(is_styled)) moves = either(moves, look<kWidth>(tables, block, is_styled, trunk));
  }
  if (!any(moves)) return;
  const V writes = chosen<V>(both(is_posed, moves), 1.0f, 0.0f);
  for (int i = 0; i < joints; ++i)
    if (tables.path[i].bends > 0.0f || tables.path[i].of_look > 0.0f)
      write_where(unit(back(below(trunk, i)) * trunk.turned[i]), tables.path[i].joint, writes,
                  poses);
}

// --- The data ------------------------------------------------------------------------------------

// How a tick reads the data: where, the share of the posture that it shows, and the factors on the
// swing of an arm's shoulder and elbow, by Side.
template <class V>
struct DataRead {
  Knots<V> knots;
  V shown, shoulder[2], elbow[2];
};
// `swing`: the factor on the swing of both arms, by Side.
template <class V>
DataRead<V> data_read(const Tables& tables, const BodyTick<V>& tick, const V (&swing)[2],
                      const State<V>& state) noexcept {
  constexpr float kSoftElbow = 0.1f;  // of the factor: rounds the limit that keeps elbows bent
  DataRead<V> data;
  data.knots = knots_at(data_phase(tables, tick.time, tick.phase));
  // A filter comes near to 1 but not to it; a joint that the pose shows fully is read faster.
  constexpr float kWholly = 0.99999f;  // share of the posture that counts as all of it
  const V posture = within(state.posture.x, 0.0f, 1.0f);
  data.shown = tick.shown * (posture > all<V>(kWholly) ? all<V>(1.0f) : posture);
  for (int side : {0, 1}) {
    data.shoulder[side] = swing[side];
    data.elbow[side] =
        soft_least(swing[side], all<V>(tables.most_elbow_swing[side]), all<V>(kSoftElbow));
  }
  return data;
}
// A share of the way from a joint's rotation in the pose to another one.
inline Four over(const quat& from, const Four& q, float share) noexcept {
  const Four was = load(from);
  const float along = (was[0] * q[0] + was[1] * q[1]) + (was[2] * q[2] + was[3] * q[3]);
  return unit(was + (q * (along < 0.0f ? -1.0f : 1.0f) - was) * share);
}
// Writes the joints that the legs do not set as the data have them, by that share over what the
// pose holds.
template <class V>
void write_data(const Tables& tables, const DataRead<V>& data, const V& share,
                const Poses& poses) noexcept {
  const std::size_t count = tables.build.upper.size();
  const Knots<V>& knots = data.knots;
  for (int w = 0; w < poses.walks; ++w) {
    const float part_of = lane(share, w);
    if (part_of == 0.0f) continue;
    const float* row =
        tables.build.upper_rows.data() + static_cast<int>(lane(knots.first, w)) * count * 4;
    const float k0 = lane(knots.weight[0], w), k1 = lane(knots.weight[1], w),
                k2 = lane(knots.weight[2], w), k3 = lane(knots.weight[3], w),
                shows = lane(data.shown, w);
    const UpperJoint* joint = tables.build.upper.data();
    quat* const local = poses.local[w];
    const float swings[5] = {1.0f, lane(data.shoulder[0], w), lane(data.elbow[0], w),
                             lane(data.shoulder[1], w), lane(data.elbow[1], w)};
    for (const float* from = row; from < row + 4 * count; from += 4, ++joint) {
      Four q = part<Four>(from) * k0 + part<Four>(from + 4 * count) * k1 +
               part<Four>(from + 8 * count) * k2 + part<Four>(from + 12 * count) * k3;
      if (joint->swings != 0) {
        const Four middle = part<Four>(joint->middle.data());
        q = middle + (q - middle) * swings[joint->swings];
      }
      q = unit(q);
      if (shows < 1.0f) {
        const Four stand = part<Four>(joint->standing.data());
        q = unit(stand + (q - stand) * shows);
      }
      quat& to = local[joint->joint];
      if (part_of < 1.0f) q = over(to, q, part_of);
      store(q, to);
    }
    for (const int still : tables.build.still) local[still] = kIdentity;
    for (const auto& [kept, turn] : tables.build.kept) local[kept] = turn;
  }
}

// Writes the joints that the legs do not set. `swing`: the factor on the arms' swing. `eases`: the
// result of advance_poise(). `is_styled`: has_style() before smooth_body().
template <int kWidth, bool kPaper>
void write_upper_body(const Tables& tables, const BodyTick<Floats<kWidth>>& of,
                      const Floats<kWidth>& swing, const Mask<Floats<kWidth>>& eases,
                      const Mask<Floats<kWidth>>& is_styled, Block<kWidth>& block,
                      const Poses& poses) noexcept {
  using V = Floats<kWidth>;
  State<V>& state = block.state;
  Styled<V>& styled = block.styled;
  Poise<V>& poise = block.poise;
  V swings[2] = {swing, swing};
  if (any(is_styled)) {
    for (int side : {0, 1})
      swings[side] = styled.acts != V{} ? V(swing * styled.body[kArmSwing + side].x) : swing;
  }
  const DataRead<V> data = data_read(tables, of, swings, state);
  BodyTick<V> tick = of;
  tick.shown = data.shown;
  write_data(tables, data, all<V>(1.0f), poses);
  if constexpr (!kPaper) swing_in_turn(tables, of, state, poses);
  const auto is_posed =
      either(either(is_styled, eases),
             either(poise.acts != V{}, either(poise.chest.ticks > V{}, poise.head.ticks > V{})));
  turn_ahead(tables, tick.hips.heading.turn(), tick.pelvis.turn, state, is_posed, poses);
  if (any(is_posed))
    pose_body<kWidth, kPaper>(tables, tick, is_posed, is_styled, eases, block, poses);
}

}  // namespace
}  // namespace gaitpad
