#include "walk/walk_frame.h"

#include "animation/floor.h"
#include "motion/leg_pose.h"
#include "walk/feet.h"
#include "walk/sound_input.h"

namespace gaitpad {
namespace {

Side side_of(bool right) noexcept { return right ? kRightSide : kLeftSide; }

// The part of the step that the pose of the last tick shows. After a strike it still shows the
// flight.
struct Moment {
  bool stands, settles;  // after a stop; its last roll is still shown
  bool struck, flies;    // a foot has landed in this tick; a foot is in flight
  bool right;            // the right foot swings, or has just landed
  int ticks;             // of the step
};
Moment moment_of(const Block<1>& block) noexcept {
  const State<float>& state = block.state;
  Moment at;
  at.struck = block.told.struck != 0.0f;
  at.stands = block.change.stands != 0.0f && !at.struck;
  at.settles = at.stands && block.told.settle_ticks > 0.0f;
  const bool turned = !at.stands && state.tick == 0.0f;  // a stage has ended
  at.flies = at.struck || (!turned && state.flies != 0.0f);
  at.right = (state.right_swings != 0.0f) != at.struck;
  at.ticks = static_cast<int>(state.roll_ticks + state.flight_ticks);
  return at;
}

// True if the pose shows the phase of leading hips, not that of the clock.
bool runs_by_hips(const Moment& at, const Block<1>& block) noexcept {
  const Change<float>& change = block.change;
  return change.was_led != 0.0f || (!at.struck && change.led != 0.0f) || change.off_ticks != 0.0f;
}

// Length of the running step along the heading at its strike.
float step_m(const Tables& tables, const State<float>& state) noexcept {
  return way_at_strike(tables, time_of(tables, state), state)
      .ahead(state.landing_x_m, state.landing_z_m);
}

void report_feet(const WalkModel& model, const Tables& tables, const Placement& placed,
                 const vec3& root_m, std::span<const quat> local, WalkFrame& frame) noexcept {
  for (const Side side : {kLeftSide, kRightSide}) {
    const LegModel& leg = model.leg[side].model;
    const Skeleton& skeleton = model.cycle.skeleton;
    const int ankle = leg.joints.ankle;
    const vec3 ankle_m = root_m + local[0] * link(skeleton, local, 0, ankle);
    const quat foot =
        world_rotation(skeleton, local.data(), ankle) * glm::conjugate(leg.standing[2]);
    frame.heel_m[side] = ankle_m + foot * leg.heel_m;
    frame.toe_m[side] = ankle_m + foot * leg.toe_m;
  }
  if (!is_uneven(tables)) {
    frame.heel_ground_m = frame.toe_ground_m = {placed.place_m.y, placed.place_m.y};
    return;
  }
  const std::array<double, 4> ground =
      heights_at<4>(Floor{*tables.terrain, placed},
                    {from_world(placed, frame.heel_m[0]), from_world(placed, frame.heel_m[1]),
                     from_world(placed, frame.toe_m[0]), from_world(placed, frame.toe_m[1])});
  for (const int side : {0, 1}) {
    frame.heel_ground_m[side] = ground[side] + placed.place_m.y;
    frame.toe_ground_m[side] = ground[2 + side] + placed.place_m.y;
  }
}

}  // namespace

Placement root_of(const RootNumbers& numbers) noexcept {
  const Origin& origin = numbers.origin;
  const Vec<float> beside =
      way_of(numbers.heading_rad) * Vec<float>{numbers.beside_x_m, 0.0f, numbers.beside_z_m};
  const vec3 hips_m(numbers.pelvis_x_m - beside.x, 0.0, numbers.pelvis_z_m - beside.z);
  return {to_world({vec3(origin.x_m, 0.0, origin.z_m), origin.heading_rad}, hips_m),
          origin.heading_rad + static_cast<double>(numbers.heading_rad)};
}

float phase_of(const Block<1>& block) noexcept {
  return runs_by_hips(moment_of(block), block) ? block.change.phase : block.state.phase;
}

WalkSteps walk_steps(const WalkState& state) noexcept {
  const Moment at = moment_of(state.walk);
  WalkSteps now;
  now.stage = at.flies ? Stage::flight : at.stands && !at.settles ? Stage::idle : Stage::roll;
  // While standing, the foot that has landed last.
  now.swing = at.stands ? side_of(!at.right) : side_of(at.flies == at.right);
  const bool is_idle = now.stage == Stage::idle;
  for (const Side side : {kLeftSide, kRightSide}) {
    const bool swings = now.swing == side, counts = at.struck && swings;
    now.heel_planted[side] = is_idle || (now.stage == Stage::roll && swings);
    now.toe_planted[side] = is_idle || !swings;
    now.steps[side] = static_cast<int>(state.walk.told.steps[side]) - counts;
  }
  return now;
}

WalkFrame frame_of(const WalkModel& model, const WalkState& state, const vec3& root_m,
                   std::span<const quat> local) noexcept {
  const Tables tables = tables_of(model, state.tick_s / tick_parts(state.tick_s));
  const State<float>& walk = state.walk.state;
  const Told<float>& told = state.walk.told;
  const Placement &placed = state.walk.placed[0], &root = state.root, &before = state.root_before;
  const Moment at = moment_of(state.walk);
  WalkFrame frame{walk_steps(state)};
  int step_ticks = at.ticks, last_ticks = static_cast<int>(told.step_ticks[0]);
  if (at.struck) {  // the pose still shows the step that has ended
    step_ticks = last_ticks;
    last_ticks = static_cast<int>(told.step_ticks[1]);
  }
  for (const Side side : {kLeftSide, kRightSide}) {
    frame.stride_m[side] = frame.stage == Stage::idle ? 0.0 : told.stride_m[side];
    frame.ik_iterations[side] = static_cast<int>(told.iterations[side]);
    frame.ik_error_m[side] = told.error_m[side];
    frame.ik_failed[side] = told.failed[side] != 0.0f;
  }
  if (!at.stands && !at.struck) frame.stride_m[side_of(at.right)] = step_m(tables, walk);
  frame.overhangs = static_cast<int>(told.overhangs);
  const int ticks = step_ticks + (last_ticks > 0 ? last_ticks : step_ticks);
  frame.speed_m_s = at.stands ? 0.0
                              : (frame.stride_m[0] + frame.stride_m[1]) /
                                    (ticks * static_cast<double>(tables.tick_s));
  frame.root_moved_m = from_world({vec3(0.0), before.heading_rad}, root.place_m - before.place_m);
  frame.root_turned_rad = root.heading_rad - before.heading_rad;
  frame.root_m = to_world(placed, root.place_m);
  frame.heading_rad = placed.heading_rad + root.heading_rad;
  frame.turn_rate_rad_s = walk.turn_rad_s.x;
  frame.pelvis_m = root_m;
  report_feet(model, tables, placed, root_m, local, frame);
  return frame;
}

WalkFrame walk_frame(const WalkModel& model, const WalkState& state, const Pose& pose) noexcept {
  return frame_of(model, state, pose.root_m,
                  {pose.local.data(), model.cycle.skeleton.joints.size()});
}

std::array<LegAngles, 2> leg_angles(const WalkModel& model, const Pose& pose) noexcept {
  std::array<LegAngles, 2> angles_rad{};
  for (const int side : {0, 1}) {
    const auto turn = [&](int j) {
      const LegJointFrame& frame = model.leg[side].joint[j];
      return glm::conjugate(frame.before) * pose.local[frame.joint] * glm::conjugate(frame.after);
    };
    const AnglesXzy hip = angles_xzy(turn(0)), knee = angles_xzy(turn(1)),
                    ankle = angles_xzy(turn(2));
    angles_rad[side] = {hip.x, hip.z, hip.y, knee.x, ankle.x, ankle.z, ankle.y};
  }
  return angles_rad;
}

}  // namespace gaitpad
