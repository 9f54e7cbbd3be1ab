#include "walk/tick.h"
#include "walk/walk.h"

namespace gaitpad::anew {

void advance(const Tables& tables, Block<1>& block, const Poses& poses) noexcept {
  advance_block<1>(tables, block, poses);
}
void advance(const Tables& tables, Block<4>& block, const Poses& poses) noexcept {
  advance_block<4>(tables, block, poses);
}

void advance_by_paper(const Tables& tables, Block<1>& block, const Poses& poses) noexcept {
  advance_block<1, true>(tables, block, poses);
}

void stand(const Tables& tables, const Origin& place, Block<1>& block) noexcept {
  block = {};
  State<float>& state = block.state;
  const LegBones &left = tables.leg[0], &right = tables.leg[1];
  // The step frame is the right foot's.
  const float half_rad = static_cast<float>(0.5 * wrapped(place.heading_rad));
  const Way<float> way = way_of(2.0f * half_rad);
  const Vec<float> from = way * Vec<float>{right.track_m, 0.0f, -tables.rest_lead_m};
  block.origin[0] = {place.x_m + from.x, place.z_m + from.z, place.heading_rad};
  sin_cos(half_rad, state.frame_sine, state.frame_cosine);
  state.print_x_m = left.track_m - right.track_m;
  const Vec<float> line = sole_of<float>(tables, false).line_m;
  state.toe_x_m = state.print_x_m + line.x, state.toe_z_m = line.z;
  for (int k : {0, 1, 2}) {
    state.pelvis_x_m[k] = -right.track_m;
    state.pelvis_z_m[k] = tables.rest_lead_m;
  }
  state.roll_ticks = state.flight_ticks = 1.0f;
  state.lift[0].x = state.lift[1].x = state.bounce.x = state.sway.x = 1.0f;
  state.step_time_s.x = 0.5f;
  block.change.stands = 1.0f;
  block.change.shown = 0.0f;
}

}  // namespace gaitpad::anew
