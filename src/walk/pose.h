// Last: writes the joints of the legs, the pelvis and the root's place into the pose, in the world.
#pragma once
#include "walk/upper_body.h"

namespace gaitpad {

namespace {

// A product of rotations is off its length, by 1e-4 where the paper's solver, which has no limits,
// bends a joint to 170 degrees. A step of Newton's method leaves the rounding of floats.
template <class V>
void write_product(const Turn<V>& q, int joint, const Poses& poses) noexcept {
  const V k = 1.5f - 0.5f * ((q.w * q.w + q.x * q.x) + (q.y * q.y + q.z * q.z));
  write_joint(Turn<V>{q.w * k, q.x * k, q.y * k, q.z * k}, joint, poses);
}

// The toes' angle in the foot. Toes stay level while the heel is higher than they are; in the air
// they begin to bend gradually. `flown`: time since the lift-off, over kToFly_s, as a change of
// plan may move the flight's end; `u`: share of the flight.
template <class V>
V level_toe(const V& pitch_rad, const V& flown, const V& u) noexcept {
  constexpr float kSoftToe_rad = 0.2617994f;  // 15 degrees of pitch around 0
  const V air = smooth(flown) * (1.0f - smooth(0.85f, 1.0f, u));
  return -soft_positive(pitch_rad, most(V(kSoftToe_rad * air), all<V>(1e-6f)));
}

template <class V>
void write_legs(const Tables& tables, const Time<V>& time, const State<V>& state,
                const Feet<V>& feet, const Leg<V> (&legs)[2], const Poses& poses) noexcept {
  constexpr float kToFly_s = 0.08f;  // at the reference leg
  const V flown =
      time.flies ? V(state.tick * (tables.tick_s / (kToFly_s * tables.time_scale))) : V{};
  Turn<V> toes[2];
  for (int k : {0, 1}) {
    const Foot<V>& foot = feet.foot[k];
    toes[k] = back(foot.edge) *
              turn_about(feet.sole[k].side, level_toe(V(foot.pitch_rad + legs[k].more_pitch_rad),
                                                      k == 0 ? flown : V{}, k == 0 ? time.u : V{}));
  }
  for (int side : {0, 1}) {
    const LegBones& bones = tables.leg[side];
    const auto swings = side == 1 ? time.right : no(time.right);
    const Turn<V> turn[4] = {
        chosen(swings, legs[0].hip, legs[1].hip), chosen(swings, legs[0].knee, legs[1].knee),
        chosen(swings, legs[0].ankle, legs[1].ankle), chosen(swings, toes[0], toes[1])};
    for (int j = 0; j < 4; ++j) {
      if (bones.joint[j] < 0) continue;
      write_product(tables.legs_are_plain
                        ? turn[j]
                        : every<V>(bones.before[j]) * turn[j] * every<V>(bones.after[j]),
                    bones.joint[j], poses);
    }
  }
}

template <int kWidth>
void write_root(const Tables& tables, const Hips<Floats<kWidth>>& hips,
                const Pelvis<Floats<kWidth>>& pelvis, const Block<kWidth>& block,
                const Poses& poses) noexcept {
  using V = Floats<kWidth>;
  const State<V>& state = block.state;
  const Way<V> way = way_of_half(state.frame_sine, state.frame_cosine);
  const Vec<V> place_m = way * pelvis.place_m;
  for (int w = 0; w < poses.walks; ++w) {
    const Origin& origin = block.origin[w];
    *poses.root_m[w] = vec3(origin.x_m + lane(place_m.x, w), origin.y_m + lane(place_m.y, w),
                            origin.z_m + lane(place_m.z, w));
  }
  const Turn<V> frame = way.turn();
  Turn<V> turn = frame * pelvis.turn * every<V>(tables.pelvis_standing);
  if (!tables.build.above_pelvis.empty()) {
    // Joints between root and pelvis turn with the heading; beside that they move as in the data.
    Turn<V> above = frame * hips.heading.turn();
    for (std::size_t i = 0; i < tables.build.above_pelvis.size(); ++i) {
      const int joint = tables.build.above_pelvis[i].joint;
      above = above * read_joint<V>(joint, all<V>(1.0f), poses);
      if (i == 0) write_product(above, joint, poses);
    }
    turn = back(above) * turn;
  }
  write_product(turn, tables.pelvis, poses);
  for (int w = 0; block.is_placed && w < poses.walks; ++w) {
    const Placement& placed = block.placed[w];
    if (placed == Placement{}) continue;
    *poses.root_m[w] = to_world(placed, *poses.root_m[w]);
    quat& root = poses.local[w][0];
    root = rotation_y(placed.heading_rad) * root;
  }
}

}  // namespace
}  // namespace gaitpad
