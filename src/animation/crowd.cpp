#include "gaitpad/crowd.h"

#include <algorithm>
#include <map>

#include "animation/placement.h"
#include "animation/sound_input.h"
#include "animation/walk_parts.h"
#include "base/ranges.h"

namespace gaitpad {
namespace {

// Most characters of a block: as many as the widest registers have lanes.
constexpr std::size_t kTogether = 8;

template <int kWidth>
void advance_all(const WalkModel& model, double dt_s, std::span<const Walking> walks) noexcept {
  while (!walks.empty()) {
    const std::size_t count = std::min<std::size_t>(kWidth, walks.size());
    advance_lanes<kWidth>(model, dt_s, walks.first(count));
    walks = walks.subspan(count);
  }
}

}  // namespace

Crowd::Crowd(std::span<const CrowdMember> members, IkMode mode)
    : mode_(mode), params_(members.size()), states_(members.size()), roots_m_(members.size()) {
  models_.reserve(members.size());
  first_joint_.reserve(members.size() + 1);
  for (const CrowdMember& member : members) {
    models_.push_back(member.model);
    first_joint_.push_back(first_joint_.back() + member.model->cycle.skeleton.joints.size());
  }
  local_.resize(first_joint_.back());
  block_begin_.clear();
  std::map<const WalkModel*, std::vector<int>> by_model;
  for (std::size_t i = 0; i < members.size(); ++i)
    by_model[members[i].model.get()].push_back(static_cast<int>(i));
  for (const auto& [model, numbers] : by_model) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (i % kTogether == 0) block_begin_.push_back(static_cast<int>(order_.size()));
      order_.push_back(numbers[i]);
    }
  }
  block_begin_.push_back(size());
  for (std::size_t i = 0; i < members.size(); ++i) restart(static_cast<int>(i), members[i].place_m);
}

Result<Crowd> Crowd::create(std::span<const CrowdMember> members, IkMode mode) {
  for (std::size_t i = 0; i < members.size(); ++i) {
    const std::string member = "members[" + std::to_string(i) + "]";
    if (!members[i].model) return Error{member + ".model is null"};
    if (auto problem = vector_problem(member + ".place_m", members[i].place_m, kFarthest_m))
      return *problem;
  }
  return Crowd(members, mode);
}

void Crowd::restart(int member, const vec3& place_m) noexcept {
  if (!has(member)) return;
  Pose pose;
  states_[member] = standing(*models_[member], place_m, pose);
  store_pose(member, pose);
}

void Crowd::move(int member, const Placement& by) noexcept {
  if (!has(member)) return;
  Pose pose;
  copy_pose(member, pose);
  move_walk(by, states_[member], pose);
  store_pose(member, pose);
}

void Crowd::put(int member, const vec3& place_m, double heading_rad) noexcept {
  if (!has(member)) return;
  Pose pose;
  copy_pose(member, pose);
  put_walk(place_m, heading_rad, states_[member], pose);
  store_pose(member, pose);
}

void Crowd::store_pose(int member, const Pose& pose) noexcept {
  roots_m_[member] = pose.root_m;
  std::copy_n(pose.local.begin(), pose.joint_count,
              local_.begin() + static_cast<std::ptrdiff_t>(first_joint_[member]));
}

void Crowd::copy_pose(int member, Pose& pose) const noexcept {
  if (!has(member)) return;
  pose.root_m = roots_m_[member];
  const std::span<const quat> from = local(member);
  pose.joint_count = static_cast<int>(from.size());
  std::copy(from.begin(), from.end(), pose.local.begin());
}

int Crowd::blocks() const noexcept { return static_cast<int>(block_begin_.size()) - 1; }

void Crowd::advance_block(int number, double dt_s) noexcept {
  if (number < 0 || number >= blocks()) return;
  const std::span<const int> block(order_.data() + block_begin_[number],
                                   order_.data() + block_begin_[number + 1]);
  const WalkModel& model = *models_[block[0]];
  if (!is_flat(*model.terrain) || mode_ != IkMode::robust || block.size() == 1 ||
      lanes_in_use() == 1) {
    Pose pose;
    for (const int member : block) {
      gaitpad::advance(model, params_[member], mode_, dt_s, states_[member], pose);
      store_pose(member, pose);
    }
    return;
  }
  if (!is_sound_tick(dt_s)) {
    for (const int member : block) mended_tick(states_[member]);
    dt_s = states_[block[0]].clock.tick_s;
  }
  std::array<Walking, kTogether> walks;
  for (std::size_t i = 0; i < block.size(); ++i) {
    const int member = block[i];
    if (!is_sound(params_[member], states_[member]))
      params_[member] = mended_params(params_[member], states_[member]);
    states_[member].clock.tick_s = dt_s;
    const std::size_t first = first_joint_[member];
    walks[i] = {&params_[member], &states_[member], &roots_m_[member], local_.data() + first,
                first_joint_[member + 1] - first};
  }
  const std::span<const Walking> all(walks.data(), block.size());
  const int parts = tick_parts(dt_s);
  std::array<RootBefore, kTogether> before;
  for (std::size_t i = 0; i < block.size(); ++i) before[i] = root_of(*walks[i].state);
  for (int part = 0; part < parts; ++part) {
    with_width(lanes_in_use(), [&](auto width) {
      if constexpr (width > 1) advance_all<width>(model, dt_s / parts, all);
    });
  }
  for (std::size_t i = 0; i < block.size(); ++i) {
    WalkState& state = *walks[i].state;
    report_root(before[i], state);
    place_in_world(state.placed, state.frame, *walks[i].root_m, walks[i].local[0]);
  }
}

void Crowd::advance(double dt_s) noexcept {
  for (int block = 0; block < blocks(); ++block) advance_block(block, dt_s);
}

}  // namespace gaitpad
