// gaitpad.h over gaitpad::core.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "base/ranges.h"
#include "gaitpad.h"
#include "gaitpad/anatomy.h"
#include "gaitpad/clean_strides.h"
#include "gaitpad/control.h"
#include "gaitpad/walk.h"
#include "gaitpad/walk_output.h"

// C functions belong to no namespace.
using namespace gaitpad;  // NOLINT(google-build-using-namespace)

// The ground as a function of the C API.
struct AskedInC {
  gaitpad_ground ask = nullptr;
  const void* game = nullptr;
};
struct SharedModel {
  WalkModel model;
  AskedInC ground;
};
struct gaitpad_model {
  std::shared_ptr<const SharedModel> shared;
};
struct gaitpad_walk {
  std::shared_ptr<const SharedModel> shared;
  GaitLimits limits;
  StyleValues style;
  vec2 stick{0.0};      // the stick that was taken last
  int bad_numbers = 0;  // sticks and null pointers that were not taken
  WalkState state;
  WalkEvents events;  // events of the last tick
  Pose before, pose;  // poses of the last tick but one and of the last
  Pose drawn;         // the pose that the functions give
};

namespace {

void tell(const std::string& sentence, char* error, size_t error_size) noexcept {
  if (!error || error_size == 0) return;
  const std::size_t length = std::min(sentence.size(), error_size - 1);
  std::memcpy(error, sentence.data(), length);
  error[length] = 0;
}

// Returns what `make` has made; null if it failed or threw, with the cause in `error`.
template <class T, class Make>
T* made_or_null(const Make& make, char* error, size_t error_size) noexcept {
  try {
    Result<std::unique_ptr<T>> made = make();
    if (made) return std::move(*made).release();
    tell(made.error().message, error, error_size);
  } catch (const std::exception& e) {
    try {
      tell(std::string("gaitpad: ") + e.what(), error, error_size);
    } catch (...) {
      tell({}, error, error_size);
    }
  }
  return nullptr;
}

vec3 vector_of(const double v[3]) noexcept { return {v[0], v[1], v[2]}; }
void write(const vec3& v, double out[3]) noexcept {
  for (int i = 0; i < 3; ++i) out[i] = v[i];
}

Ground ask(const void* asked, double x_m, double z_m) noexcept {
  const auto& ground = *static_cast<const AskedInC*>(asked);
  return {ground.ask(ground.game, x_m, z_m), kUp, 0};
}

// The skeleton as it stands.
Result<Motion> standing_motion(const gaitpad_model_options& options) {
  if (options.bone_count < 1 || options.bone_count > kMaxJoints)
    return Error{"gaitpad_model_options: bone_count is " + std::to_string(options.bone_count) +
                 ", outside [1, " + std::to_string(kMaxJoints) + "]"};
  if (auto problem = range_problem("gaitpad_model_options: root_height_m", options.root_height_m,
                                   -kFarthest_m, kFarthest_m))
    return *problem;
  Motion body;
  body.name = "bones";
  for (int i = 0; i < options.bone_count; ++i) {
    const gaitpad_bone& bone = options.bones[i];
    if (!bone.name)
      return Error{"gaitpad_model_options: bone " + std::to_string(i) + " has no name"};
    body.skeleton.joints.push_back(
        {bone.name, bone.parent, vector_of(bone.offset_m), bone.is_tip != 0});
  }
  body.frames = {{vec3(0.0, options.root_height_m, 0.0),
                  std::vector<quat>(body.skeleton.joints.size(), kIdentity),
                  {}}};
  if (auto problem = check(body)) return *problem;
  const auto legs = find_legs(body);
  if (!legs) return legs.error();
  body.legs = *legs;
  return body;
}

Result<GaitCycle> cycle_of(const gaitpad_model_options& options) {
  if (!options.bones) return procedural_gait();
  const auto body = standing_motion(options);
  if (!body) return body.error();
  return cycle_on_skeleton(procedural_gait(), *body);
}

Result<std::unique_ptr<gaitpad_model>> model_of(const gaitpad_model_options* options) {
  if (!options) return Error{"gaitpad_model_create: options is null"};
  if (options->size < sizeof *options)
    return Error{"gaitpad_model_options: size is " + std::to_string(options->size) +
                 ", but the struct has " + std::to_string(sizeof *options) +
                 " bytes; gaitpad_model_defaults() sets it"};
  auto cycle = cycle_of(*options);
  if (!cycle) return cycle.error();
  cycle = with_clean_strides(std::move(*cycle));
  if (!cycle) return cycle.error();
  Character character;
  character.scale = options->scale;
  character.leg_ratio = options->leg_ratio;
  auto model = walk_model(*cycle, character);
  if (!model) return model.error();
  const auto shared = std::make_shared<SharedModel>();
  shared->model = std::move(*model);
  if (options->ground) {
    shared->ground = {options->ground, options->game};
    const auto terrain = std::make_shared<Terrain>();
    terrain->asked = {&ask, &shared->ground};
    shared->model.terrain = terrain;
  }
  return std::make_unique<gaitpad_model>(gaitpad_model{shared});
}

// A stick out of -1 .. 1 leaves the last one in force.
double sound_axis(double value, double last, int& bad) noexcept {
  if (value >= -1.0 && value <= 1.0) return value;
  ++bad;
  return last;
}

void write_matrix(const vec3& place, const quat& q, float* m) noexcept {
  const vec3 axes[] = {q * vec3(1.0, 0.0, 0.0), q * vec3(0.0, 1.0, 0.0), q * vec3(0.0, 0.0, 1.0)};
  for (int column = 0; column < 4; ++column) {
    const vec3& v = column < 3 ? axes[column] : place;
    for (int row = 0; row < 3; ++row) m[4 * column + row] = static_cast<float>(v[row]);
    m[4 * column + 3] = column < 3 ? 0.0f : 1.0f;
  }
}

const Skeleton& skeleton_of(const SharedModel& shared) { return shared.model.cycle.skeleton; }

const Joint* joint_of(const gaitpad_model* model, int32_t joint) noexcept {
  if (!model) return nullptr;
  const auto& joints = skeleton_of(*model->shared).joints;
  return joint >= 0 && joint < static_cast<int32_t>(joints.size()) ? &joints[joint] : nullptr;
}

std::optional<Error> start_problem(const gaitpad_model* model, const double* place_m,
                                   double heading_rad) {
  const std::string what = "gaitpad_walk_create: ";
  if (!model) return Error{what + "model is null"};
  if (!place_m) return Error{what + "place_m is null"};
  for (const int i : {0, 2}) {
    if (auto problem = range_problem(what + "place_m[" + std::to_string(i) + "]", place_m[i],
                                     -kFarthest_m, kFarthest_m))
      return problem;
  }
  return range_problem(what + "heading_rad", heading_rad, -kFarthest_m, kFarthest_m);
}

// True if the pointer is null; counts it in gaitpad_walk::bad_numbers.
bool is_missing(const double* place_m, gaitpad_walk& walk) noexcept {
  walk.bad_numbers += !place_m;
  return !place_m;
}

// The number of the first `count` joints that can be written to `out`.
int32_t joints_for(const gaitpad_walk* walk, const float* out, int32_t count) noexcept {
  return walk && out ? std::clamp(count, 0, walk->drawn.joint_count) : 0;
}

void copy_pose(const Pose& from, Pose& to) noexcept {
  to.root_m = from.root_m;
  to.joint_count = from.joint_count;
  std::copy_n(from.local.begin(), from.joint_count, to.local.begin());
}

// One tick with these parameters.
void advance_walk(const GaitParams& params, double dt_s, gaitpad_walk& walk) noexcept {
  const WalkSteps before = walk_steps(walk.state);
  copy_pose(walk.pose, walk.before);
  advance(walk.shared->model, params, IkMode::robust, dt_s, walk.state, walk.pose);
  walk.events = walk_events(before, walk.state);
  copy_pose(walk.pose, walk.drawn);
}

Placement placement_of(const double place_m[3], double heading_rad) noexcept {
  return {vec3(place_m[0], 0.0, place_m[2]), heading_rad};
}

gaitpad_frame frame_of(const gaitpad_walk& walk) noexcept {
  const WalkFrame f = walk_frame(walk.shared->model, walk.state, walk.pose);
  gaitpad_frame out = {};
  out.stage = static_cast<int32_t>(f.stage);
  out.swing = f.swing;
  out.heading_rad = f.heading_rad;
  out.speed_m_s = f.speed_m_s;
  write(f.root_m, out.root_m);
  write(f.root_moved_m, out.root_moved_m);
  out.root_turned_rad = f.root_turned_rad;
  for (std::size_t side = 0; side < 2; ++side) {
    write(f.heel_m[side], out.heel_m[side]);
    write(f.toe_m[side], out.toe_m[side]);
    out.heel_planted[side] = f.heel_planted[side];
    out.toe_planted[side] = f.toe_planted[side];
    out.landings[side] = f.steps[side];
  }
  for (const WalkEvent& event : walk.events) {
    if (event.kind == WalkEventKind::heel_strike) out.heel_struck[event.side] = 1;
    if (event.kind == WalkEventKind::toe_off) out.toe_off[event.side] = 1;
  }
  out.bad_inputs = walk.state.bad_inputs + walk.bad_numbers;
  return out;
}

}  // namespace

uint32_t gaitpad_api_version(void) { return GAITPAD_API_VERSION; }

void gaitpad_model_defaults(gaitpad_model_options* options) {
  if (!options) return;
  *options = {};
  options->size = sizeof *options;
  options->scale = options->leg_ratio = 1.0;
}

gaitpad_model* gaitpad_model_create(const gaitpad_model_options* options, char* error,
                                    size_t error_size) {
  return made_or_null<gaitpad_model>([options] { return model_of(options); }, error, error_size);
}
void gaitpad_model_destroy(gaitpad_model* model) { delete model; }

int32_t gaitpad_joint_count(const gaitpad_model* model) {
  return model ? static_cast<int32_t>(skeleton_of(*model->shared).joints.size()) : 0;
}
const char* gaitpad_joint_name(const gaitpad_model* model, int32_t joint) {
  const Joint* found = joint_of(model, joint);
  return found ? found->name.c_str() : nullptr;
}
int32_t gaitpad_joint_parent(const gaitpad_model* model, int32_t joint) {
  const Joint* found = joint_of(model, joint);
  return found ? found->parent : -1;
}

gaitpad_walk* gaitpad_walk_create(const gaitpad_model* model, const double place_m[3],
                                  double heading_rad, char* error, size_t error_size) {
  const auto make = [&]() -> Result<std::unique_ptr<gaitpad_walk>> {
    if (auto problem = start_problem(model, place_m, heading_rad)) return *problem;
    auto walk = std::make_unique<gaitpad_walk>();
    walk->shared = model->shared;
    walk->limits = gait_limits(model->shared->model);
    const vec3 start_m(place_m[0], 0.0, place_m[2]);
    walk->state = standing(model->shared->model, start_m, heading_rad, walk->pose);
    copy_pose(walk->pose, walk->before);
    copy_pose(walk->pose, walk->drawn);
    return walk;
  };
  return made_or_null<gaitpad_walk>(make, error, error_size);
}
void gaitpad_walk_destroy(gaitpad_walk* walk) { delete walk; }

int32_t gaitpad_walk_set(gaitpad_walk* walk, const char* key, double value) {
  return walk && key && set_value(walk->style, key, value);
}

void gaitpad_walk_step(gaitpad_walk* walk, double stick_right, double stick_forward, double dt_s) {
  if (!walk) return;
  walk->stick.x = sound_axis(stick_right, walk->stick.x, walk->bad_numbers);
  walk->stick.y = sound_axis(stick_forward, walk->stick.y, walk->bad_numbers);
  advance_walk(gait_params({.left = walk->stick}, walk->style, walk->limits), dt_s, *walk);
}

int32_t gaitpad_walk_follow(gaitpad_walk* walk, const gaitpad_capsule* capsule, double dt_s) {
  // The struct of version 2 is the smallest there is.
  if (!walk || !capsule || capsule->size < sizeof *capsule) return 0;
  const CapsuleMotion motion = {vector_of(capsule->place_m), capsule->heading_rad,
                                vector_of(capsule->velocity_m_s), capsule->turn_rate_rad_s};
  advance_walk(following(motion, walk->state, walk->style, walk->limits), dt_s, *walk);
  return 1;
}

void gaitpad_walk_move(gaitpad_walk* walk, const double shift_m[3], double turn_rad) {
  if (!walk || is_missing(shift_m, *walk)) return;
  const Placement by = {vector_of(shift_m), turn_rad};
  WalkState state = walk->state;
  move_walk(by, state, walk->before);
  move_walk(by, walk->state, walk->pose);
  copy_pose(walk->pose, walk->drawn);
}
void gaitpad_walk_put(gaitpad_walk* walk, const double place_m[3], double heading_rad) {
  if (!walk || is_missing(place_m, *walk)) return;
  WalkState state = walk->state;
  put_walk(vector_of(place_m), heading_rad, state, walk->before);
  put_walk(vector_of(place_m), heading_rad, walk->state, walk->pose);
  copy_pose(walk->pose, walk->drawn);
}

int32_t gaitpad_walk_step_to(gaitpad_walk* walk, const double place_m[3], double heading_rad) {
  return walk && place_m &&
         step_to(walk->shared->model, placement_of(place_m, heading_rad), walk->state);
}
int32_t gaitpad_walk_nearest_step(const gaitpad_walk* walk, double place_m[3],
                                  double* heading_rad) {
  if (!walk || !place_m || !heading_rad) return 0;
  const auto near =
      nearest_step(walk->shared->model, placement_of(place_m, *heading_rad), walk->state);
  if (!near) return 0;
  write(near->place_m, place_m);
  *heading_rad = near->heading_rad;
  return 1;
}
int32_t gaitpad_walk_push(gaitpad_walk* walk, const double velocity_m_s[3]) {
  return walk && velocity_m_s && push_walk(vector_of(velocity_m_s), walk->state);
}

int32_t gaitpad_walk_set_detail(gaitpad_walk* walk, int32_t detail) {
  if (!walk || (detail != GAITPAD_FULL && detail != GAITPAD_TABLES)) return 0;
  walk->state.detail = detail == GAITPAD_FULL ? Detail::full : Detail::tables;
  return 1;
}

int32_t gaitpad_walk_frame(const gaitpad_walk* walk, gaitpad_frame* frame) {
  // The struct of version 1 is the smallest there is.
  if (!walk || !frame || frame->size < sizeof(gaitpad_frame)) return 0;
  const size_t size = frame->size;
  const gaitpad_frame filled = frame_of(*walk);
  std::memcpy(frame, &filled, sizeof filled);
  frame->size = size;
  return 1;
}

int32_t gaitpad_walk_events(const gaitpad_walk* walk, gaitpad_event* events, int32_t count) {
  if (!walk || !events) return 0;
  const int32_t written = std::clamp(count, 0, static_cast<int32_t>(walk->events.count));
  for (int32_t i = 0; i < written; ++i) {
    const WalkEvent& event = walk->events.event[i];
    events[i].kind = static_cast<int32_t>(event.kind);
    events[i].side = event.side;
    write(event.place_m, events[i].place_m);
  }
  return written;
}

int32_t gaitpad_walk_draw(gaitpad_walk* walk, double share) {
  return walk && pose_between(walk->shared->model, walk->before, walk->pose, share, walk->drawn);
}

int32_t gaitpad_pose_local(const gaitpad_walk* walk, float* xyzw, int32_t count, float* root_m) {
  const int32_t joints = joints_for(walk, xyzw, count);
  for (int32_t j = 0; j < joints; ++j) {
    const quat& q = walk->drawn.local[j];
    const double parts[] = {q.x, q.y, q.z, q.w};
    for (int i = 0; i < 4; ++i) xyzw[4 * j + i] = static_cast<float>(parts[i]);
  }
  if (walk && root_m) {
    for (int i = 0; i < 3; ++i) root_m[i] = static_cast<float>(walk->drawn.root_m[i]);
  }
  return joints;
}

int32_t gaitpad_pose_world(const gaitpad_walk* walk, float* matrices, int32_t count) {
  const int32_t joints = joints_for(walk, matrices, count);
  if (joints == 0) return 0;
  JointFrames frames;
  forward_kinematics(skeleton_of(*walk->shared), walk->drawn, frames);
  for (int32_t j = 0; j < joints; ++j)
    write_matrix(frames.position_m[j], frames.rotation[j], matrices + 16 * j);
  return joints;
}
