// The functions of gaitpad/gaitpad.h over the core.
#include "gaitpad/gaitpad.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <memory>
#include <string>

#include "gaitpad/anatomy.h"
#include "gaitpad/clean_strides.h"
#include "gaitpad/control.h"
#include "gaitpad/walk.h"
#include "gaitpad/walk_output.h"

// Functions of C stand outside of namespaces.
using namespace gaitpad;  // NOLINT(google-build-using-namespace)

namespace {

struct AskedOfC {
  gaitpad_ground ask = nullptr;
  const void* game = nullptr;
};
// What a model and its walkers share.
struct Shared {
  WalkModel model;
  GaitLimits limits;
  AskedOfC asked;
};

}  // namespace

struct gaitpad_model {
  std::shared_ptr<const Shared> shared;
};
struct gaitpad_walker {
  std::shared_ptr<const Shared> shared;
  StyleValues style;
  Stick stick;
  int bad_sticks = 0;
  WalkState state;
  WalkEvents events;  // of the last tick
  Pose pose;
};

namespace {

vec3 vector_of(const double (&v)[3]) noexcept { return {v[0], v[1], v[2]}; }
vec3 vector_at(const double* v) noexcept { return {v[0], v[1], v[2]}; }
void write(const vec3& v, double* out) noexcept {
  for (int axis = 0; axis < 3; ++axis) out[axis] = v[axis];
}

// Cut to the room, between two bytes at worst: the sentence is for people.
void write_error(const std::string& message, char* error, std::size_t size) noexcept {
  if (!error || size == 0) return;
  const std::size_t length = std::min(message.size(), size - 1);
  std::memcpy(error, message.data(), length);
  error[length] = '\0';
}

Ground ask_c(const void* asked, double x_m, double z_m) noexcept {
  const auto& of = *static_cast<const AskedOfC*>(asked);
  double normal[3] = {0.0, 1.0, 0.0};
  const double height_m = of.ask(of.game, x_m, z_m, normal);
  return {height_m, vector_of(normal), 0};
}

Result<Motion> motion_of(const gaitpad_model_def& def) {
  Motion body;
  body.name = "bones";
  for (std::uint32_t i = 0; i < def.bone_count; ++i) {
    const gaitpad_bone& bone = def.bones[i];
    if (!bone.name) return Error{"bones[" + std::to_string(i) + "].name is NULL"};
    const vec3 offset_m = i == 0 ? vec3(0.0) : vector_of(bone.offset_m);
    body.skeleton.joints.push_back({bone.name, bone.parent, offset_m, bone.is_tip != 0});
  }
  body.frames = {
      {vector_of(def.bones[0].offset_m), std::vector<quat>(def.bone_count, kIdentity), {}}};
  if (const auto wrong = check(body)) return *wrong;
  const auto legs = find_legs(body);
  if (!legs) return Error{body.name + ": " + legs.error().message};
  body.legs = *legs;
  return body;
}

Result<std::shared_ptr<const Shared>> shared_of(const gaitpad_model_def& def) {
  if (def.bone_count > static_cast<std::uint32_t>(kMaxJoints))
    return Error{"bone_count is " + std::to_string(def.bone_count) + ", more than " +
                 std::to_string(kMaxJoints)};
  if (def.bone_count > 0 && !def.bones) return Error{"bones is NULL"};
  Result<GaitCycle> cycle = procedural_gait();
  if (def.bone_count > 0) {
    const auto body = motion_of(def);
    if (!body) return body.error();
    cycle = cycle_on_skeleton(*cycle, *body);
  }
  if (cycle) cycle = with_clean_strides(*cycle);
  if (!cycle) return cycle.error();
  Character character;
  character.name = "scale";
  if (def.scale != 0.0) character.scale = def.scale;
  auto model = walk_model(*cycle, character);
  if (!model) return model.error();
  const auto shared = std::make_shared<Shared>();
  shared->model = *std::move(model);
  shared->limits = gait_limits(shared->model);
  shared->asked = {def.ground, def.game};
  if (def.ground) {
    auto terrain = std::make_shared<Terrain>();
    terrain->asked = {&ask_c, &shared->asked};
    shared->model.terrain = terrain;
  }
  return std::shared_ptr<const Shared>(shared);
}

bool is_finite(const vec3& v) noexcept {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

gaitpad_model* gaitpad_model_create(const gaitpad_model_def* def, char* error, size_t error_size) {
  try {
    gaitpad_model_def known = {};
    if (def) std::memcpy(&known, def, std::min<std::size_t>(def->size, sizeof(known)));
    if (known.size < sizeof(known.size)) {
      write_error("gaitpad_model_def: size is not sizeof(gaitpad_model_def)", error, error_size);
      return nullptr;
    }
    const auto shared = shared_of(known);
    if (shared) return new gaitpad_model{*shared};
    write_error(shared.error().message, error, error_size);
  } catch (const std::exception& e) {
    write_error(e.what(), error, error_size);
  }
  return nullptr;
}

void gaitpad_model_destroy(gaitpad_model* model) { delete model; }

int32_t gaitpad_model_joint_count(const gaitpad_model* model) {
  return static_cast<int32_t>(model->shared->model.cycle.skeleton.joints.size());
}

const char* gaitpad_model_joint_name(const gaitpad_model* model, int32_t joint) {
  const bool is_there = joint >= 0 && joint < gaitpad_model_joint_count(model);
  return is_there ? model->shared->model.cycle.skeleton.joints[joint].name.c_str() : nullptr;
}

int32_t gaitpad_model_find_joint(const gaitpad_model* model, const char* name) {
  for (int32_t joint = 0; joint < gaitpad_model_joint_count(model); ++joint) {
    if (name && std::strcmp(gaitpad_model_joint_name(model, joint), name) == 0) return joint;
  }
  return -1;
}

gaitpad_walker* gaitpad_walker_create(const gaitpad_model* model, const double place_m[3],
                                      double heading_rad, char* error, size_t error_size) {
  if (!model || !is_finite(vector_at(place_m)) || !std::isfinite(heading_rad)) {
    write_error(model ? "place or heading is not finite" : "model is NULL", error, error_size);
    return nullptr;
  }
  try {
    auto walker = std::make_unique<gaitpad_walker>();
    walker->shared = model->shared;
    walker->state = standing(walker->shared->model, vector_at(place_m), heading_rad, walker->pose);
    return walker.release();
  } catch (const std::exception& e) {
    write_error(e.what(), error, error_size);
  }
  return nullptr;
}

void gaitpad_walker_destroy(gaitpad_walker* walker) { delete walker; }

int gaitpad_walker_set_style(gaitpad_walker* walker, const char* key, double value) {
  return key && set_value(walker->style, key, value) ? 0 : -1;
}

void gaitpad_walker_advance(gaitpad_walker* walker, double stick_x, double stick_y, double dt_s) {
  const vec2 left(stick_x, stick_y);
  if (std::isfinite(stick_x) && std::isfinite(stick_y)) {
    walker->stick.left = left / std::max(1.0, std::sqrt(left.x * left.x + left.y * left.y));
  } else {
    ++walker->bad_sticks;
  }
  const Shared& shared = *walker->shared;
  const WalkFrame before = walker->state.frame;
  advance(shared.model, gait_params(walker->stick, walker->style, shared.limits), IkMode::robust,
          dt_s, walker->state, walker->pose);
  walker->events = walk_events(before, walker->state);
}

void gaitpad_walker_move(gaitpad_walker* walker, const double shift_m[3], double turn_rad) {
  if (is_finite(vector_at(shift_m)) && std::isfinite(turn_rad))
    move_walk({vector_at(shift_m), turn_rad}, walker->state, walker->pose);
}

void gaitpad_walker_put(gaitpad_walker* walker, const double place_m[3], double heading_rad) {
  if (is_finite(vector_at(place_m)) && std::isfinite(heading_rad))
    put_walk(vector_at(place_m), heading_rad, walker->state, walker->pose);
}

int gaitpad_walker_frame(const gaitpad_walker* walker, gaitpad_frame* frame) {
  if (frame->size < sizeof(frame->size)) return -1;
  const WalkFrame& walk = walker->state.frame;
  gaitpad_frame all = {};
  all.size = frame->size;
  all.stage = static_cast<int32_t>(walk.stage);
  all.swing = walk.swing;
  all.bad_inputs = walk.bad_inputs + walker->bad_sticks;
  all.heading_rad = walk.heading_rad;
  all.speed_m_s = walk.speed_m_s;
  write(walk.root_m, all.root_m);
  write(walk.root_moved_m, all.root_moved_m);
  all.root_turned_rad = walk.root_turned_rad;
  for (const int side : {0, 1}) {
    write(walk.heel_m[side], all.heel_m[side]);
    write(walk.toe_m[side], all.toe_m[side]);
    all.heel_planted[side] = walk.heel_planted[side];
    all.toe_planted[side] = walk.toe_planted[side];
    all.steps[side] = walk.steps[side];
    all.ik_failed[side] = walk.ik_failed[side];
  }
  std::memcpy(frame, &all, std::min<std::size_t>(frame->size, sizeof(all)));
  return 0;
}

int32_t gaitpad_walker_events(const gaitpad_walker* walker, gaitpad_event* events, int32_t room) {
  const int count = std::clamp(static_cast<int>(room), 0, walker->events.count);
  for (int i = 0; i < count; ++i) {
    const WalkEvent& event = walker->events.event[i];
    events[i].kind = static_cast<int32_t>(event.kind);
    events[i].side = event.side;
    write(event.place_m, events[i].place_m);
  }
  return count;
}

void gaitpad_walker_rotations(const gaitpad_walker* walker, const int32_t* joints,
                              int32_t bone_count, float* out, float root_m[3]) {
  const std::size_t count = std::max(bone_count, 0);
  const WalkFrame& frame = walker->state.frame;
  std::array<float, 3> root{};
  write_rotations(walker->pose, {frame.root_m, frame.heading_rad}, {joints, count},
                  {out, 4 * count}, root);
  std::copy(root.begin(), root.end(), root_m);
}

void gaitpad_walker_matrices(const gaitpad_walker* walker, const int32_t* joints,
                             int32_t bone_count, float* out) {
  const std::size_t count = std::max(bone_count, 0);
  const WalkFrame& frame = walker->state.frame;
  write_matrices(walker->shared->model.cycle.skeleton, walker->pose,
                 {frame.root_m, frame.heading_rad}, {joints, count}, {out, 16 * count});
}
