#include "walk/tick.h"
#include "walk/walk.h"

namespace gaitpad {

void advance(const Tables& tables, Block<1>& block, const Poses& poses) noexcept {
#ifndef GAITPAD_NO_VECTORS
  if (lanes_in_use() == 16) return advance_by_avx512(tables, block, poses);
  if (lanes_in_use() == 8) return advance_by_avx2(tables, block, poses);
#endif
  advance_block<1>(tables, block, poses);
}
#ifndef GAITPAD_NO_VECTORS
void advance(const Tables& tables, Block<4>& block, const Poses& poses) noexcept {
  advance_block<4>(tables, block, poses);
}
#endif

void advance_by_paper(const Tables& tables, Block<1>& block, const Poses& poses) noexcept {
  advance_block<1, true>(tables, block, poses);
}

namespace {

// Each foot goes to the nearest place where its sole has room.
void stand_on_ground(const Tables& tables, Block<1>& block) noexcept {
  State<float>& state = block.state;
  Footing<float>& footing = block.footing;
  const Origin from = block.origin[0];
  const Placement was{vec3(from.x_m, 0.0, from.z_m), from.heading_rad};
  const StandingPlace left =
                          standing_place(tables, block.placed[0], 0,
                                         to_world(was, vec3(state.print_x_m, 0.0, state.print_z_m)),
                                         from.heading_rad),
                      right =
                          standing_place(tables, block.placed[0], 1, was.place_m, from.heading_rad);
  const Placement is{right.heel_m, from.heading_rad};
  block.origin[0] = {right.heel_m.x, right.heel_m.z, from.heading_rad, right.heel_m.y};
  const vec3 print = from_world(is, left.heel_m),
             pelvis =
                 from_world(is, to_world(was, vec3(state.pelvis_x_m[0], 0.0, state.pelvis_z_m[0])));
  footing.stand = right.slope, footing.print = left.slope;
  state.print_x_m = static_cast<float>(print.x), state.print_z_m = static_cast<float>(print.z);
  footing.print_y_m = static_cast<float>(print.y);
  const Vec<float> line = tilt_of(left.slope) * sole_of<float>(tables, false).line_m;
  state.toe_x_m = state.print_x_m + line.x, state.toe_z_m = state.print_z_m + line.z;
  footing.toe_y_m = footing.print_y_m + line.y;
  for (int k : {0, 1, 2}) {
    state.pelvis_x_m[k] = static_cast<float>(pelvis.x);
    state.pelvis_z_m[k] = static_cast<float>(pelvis.z);
  }
  footing.hips_m.x = std::min(0.0f, footing.print_y_m);
}

}  // namespace

void stand(const Tables& tables, const Origin& place, Block<1>& block) noexcept {
  block = {};
  State<float>& state = block.state;
  const LegBones &left = tables.leg[0], &right = tables.leg[1];
  // The step frame is the right foot's.
  const vec3 heel_m = to_world({vec3(place.x_m, 0.0, place.z_m), place.heading_rad},
                               vec3(right.stance_m, 0.0, -tables.rest_lead_m));
  block.origin[0] = {heel_m.x, heel_m.z, place.heading_rad};
  sin_cos(static_cast<float>(0.5 * wrapped(place.heading_rad)), state.frame_sine,
          state.frame_cosine);
  state.print_x_m = left.stance_m - right.stance_m;
  const Vec<float> line = sole_of<float>(tables, false).line_m;
  state.toe_x_m = state.print_x_m + line.x, state.toe_z_m = line.z;
  for (int k : {0, 1, 2}) {
    state.pelvis_x_m[k] = -right.stance_m;
    state.pelvis_z_m[k] = tables.rest_lead_m;
  }
  state.wider_m = std::abs(left.stance_m) - std::abs(left.track_m);
  block.footing.toe_y_m = left.toe_rest_m;
  if (tables.terrain != nullptr) stand_on_ground(tables, block);
  state.roll_ticks = state.flight_ticks = 1.0f;
  state.lift[0].x = state.lift[1].x = state.bounce.x = state.sway.x = 1.0f;
  state.asked.lift[0] = state.asked.lift[1] = state.asked.bounce = state.asked.sway = 1.0f;
  state.step_time_s.x = 0.5f;
  block.change.stands = 1.0f;
  block.change.shown = 0.0f;
}

}  // namespace gaitpad
