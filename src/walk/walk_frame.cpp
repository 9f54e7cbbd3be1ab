#include "walk/walk_frame.h"

#include "walk/feet.h"
#include "walk/ground_plan.h"

namespace gaitpad::anew {
namespace {

Side side_of(bool right) noexcept { return right ? kRightSide : kLeftSide; }

// Where a walk is in its step, as its last tick left it.
struct Moment {
  bool stands, struck, flies, right;  // the right foot swings, or has just landed
  int ticks;                          // of the step
};
Moment moment_of(const Block<1>& block) noexcept {
  const State<float>& state = block.state;
  Moment at;
  at.stands = block.change.stands != 0.0f;
  const bool turned = !at.stands && state.tick == 0.0f;  // a stage has ended
  at.struck = turned && state.flies == 0.0f;
  at.flies = at.struck || (!turned && state.flies != 0.0f);
  at.right = (state.right_swings != 0.0f) != at.struck;
  at.ticks = static_cast<int>(state.roll_ticks + state.flight_ticks);
  return at;
}

// The step that runs: along the heading at its landing.
float step_m(const Tables& tables, const State<float>& state) noexcept {
  const float ticks = state.flies != 0.0f ? state.flight_ticks : state.roll_ticks,
              left = ticks - state.tick + (state.flies != 0.0f ? 0.0f : state.flight_ticks);
  const Way<float> to = way_of(heading_ahead(tables, state, left + 1.0f));
  return state.landing_x_m * to.sine + state.landing_z_m * to.cosine;
}

// The hips without the tables' oscillation, on the ground of the step frame.
Vec<float> hips_of(const Tables& tables, const Moment& at, const Block<1>& block) noexcept {
  const State<float>& state = block.state;
  const Change<float>& change = block.change;
  const bool led = change.was_led != 0.0f || (!at.struck && change.led != 0.0f),
             runs = led || change.off_ticks != 0.0f;
  const Time<float> time = time_of(tables, state);
  float ahead = state.ratio_behind, share = 1.0f;
  if (!at.struck && !at.stands) {
    const Way<float> to = way_of(heading_ahead(tables, state, time.to_strike + 1.0f));
    ahead = is_uneven(tables) ? ratio_on_ground(change, state, block.footing)
                              : planned_landing(tables, time, to, change, state).ratio;
    share = planned_over(time, change) + change.off_over.x;
  }
  const float shown = at.stands ? 0.0f : runs ? change.shown : 1.0f;
  const Vec<float> off =
      way_of(state.heading_rad) * (read_pelvis(tables, time, runs ? change.phase : state.phase,
                                               state.ratio_behind, ahead, share) *
                                   shown);
  return {state.pelvis_x_m[0] - off.x, 0.0f, state.pelvis_z_m[0] - off.z};
}

void report_feet(const WalkModel& model, const Tables& tables, const Placement& placed,
                 const Pose& pose, WalkFrame& frame) noexcept {
  JointFrames joints;
  forward_kinematics(model.cycle.skeleton, pose, joints);
  for (const Side side : {kLeftSide, kRightSide}) {
    const LegModel& leg = model.leg[side].model;
    const quat foot = joints.rotation[leg.joints.ankle] * glm::conjugate(leg.standing[2]);
    const vec3& ankle_m = joints.position_m[leg.joints.ankle];
    frame.heel_m[side] = ankle_m + foot * leg.heel_m;
    frame.toe_m[side] = ankle_m + foot * leg.toe_m;
    const auto ground_m = [&](const vec3& place_m) {
      return ground_height(tables, placed, from_world(placed, place_m)) + placed.place_m.y;
    };
    frame.heel_ground_m[side] = ground_m(frame.heel_m[side]);
    frame.toe_ground_m[side] = ground_m(frame.toe_m[side]);
  }
}

}  // namespace

void report(const WalkModel& model, const Tables& tables, const Block<1>& block, const Pose& pose,
            Report& report) noexcept {
  const State<float>& state = block.state;
  const Origin& origin = block.origin[0];
  const Placement& placed = block.placed[0];
  const Moment at = moment_of(block);
  WalkFrame& frame = report.frame;
  const Stage stage = at.stands ? Stage::idle : at.flies ? Stage::flight : Stage::roll;
  if (frame.stage == Stage::flight && stage != Stage::flight) {
    ++frame.steps[frame.swing];
    frame.overhangs += report.overhangs;
    report.last_step_ticks = report.step_ticks;
  }
  frame.stage = stage;
  if (!at.stands) frame.swing = side_of(at.flies == at.right);
  for (const Side side : {kLeftSide, kRightSide}) {
    const bool swings = frame.swing == side;
    frame.heel_planted[side] = at.stands || (stage == Stage::roll && swings);
    frame.toe_planted[side] = at.stands || !swings;
  }
  if (at.stands) {
    frame.stride_m = {};
    report.step_ticks = report.last_step_ticks = 0;
  } else if (!at.struck) {
    frame.stride_m[side_of(at.right)] = step_m(tables, state);
    report.step_ticks = at.ticks;
    report.overhangs = block.footing.overhangs != 0.0f;
  }
  const int before = report.last_step_ticks > 0 ? report.last_step_ticks : report.step_ticks;
  frame.speed_m_s = at.stands
                        ? 0.0
                        : (frame.stride_m[0] + frame.stride_m[1]) /
                              ((report.step_ticks + before) * static_cast<double>(tables.tick_s));
  const Vec<float> hips = hips_of(tables, at, block);
  const vec3 hips_m =
      to_world({vec3(origin.x_m, 0.0, origin.z_m), origin.heading_rad}, vec3(hips.x, 0.0, hips.z));
  const double heading_rad = origin.heading_rad + static_cast<double>(state.heading_rad);
  const Placement was = report.has_root ? report.root : Placement{hips_m, heading_rad};
  frame.root_moved_m = from_world({vec3(0.0), was.heading_rad}, hips_m - was.place_m);
  frame.root_turned_rad = heading_rad - was.heading_rad;
  report.root = {hips_m, heading_rad};
  report.has_root = true;
  frame.root_m = to_world(placed, hips_m);
  frame.heading_rad = placed.heading_rad + heading_rad;
  frame.turn_rate_rad_s = state.turn_rad_s.x;
  frame.pelvis_m = pose.root_m;
  report_feet(model, tables, placed, pose, frame);
}

}  // namespace gaitpad::anew
