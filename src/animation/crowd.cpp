#include "gaitpad/crowd.h"

#include <algorithm>
#include <map>
#include <optional>

#include "animation/walk_parts.h"

namespace gaitpad {
namespace {

// Characters whose ticks run side by side: enough to fill the widest registers with their legs, and
// few enough for their plans to stay in the cache.
constexpr int kTogether = 8;

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
  std::map<const WalkModel*, std::vector<int>> by_model;
  for (std::size_t i = 0; i < members.size(); ++i)
    by_model[members[i].model.get()].push_back(static_cast<int>(i));
  for (const auto& [model, numbers] : by_model)
    order_.insert(order_.end(), numbers.begin(), numbers.end());
  for (std::size_t i = 0; i < members.size(); ++i) restart(static_cast<int>(i), members[i].place_m);
}

void Crowd::restart(int member, const vec3& place_m) noexcept {
  Pose pose;
  states_[member] = standing(*models_[member], place_m, pose);
  store_pose(member, pose);
}

void Crowd::store_pose(int member, const Pose& pose) noexcept {
  roots_m_[member] = pose.root_m;
  std::copy_n(pose.local.begin(), pose.joint_count,
              local_.begin() + static_cast<std::ptrdiff_t>(first_joint_[member]));
}

void Crowd::copy_pose(int member, Pose& pose) const noexcept {
  pose.root_m = roots_m_[member];
  const std::span<const quat> from = local(member);
  pose.joint_count = static_cast<int>(from.size());
  std::copy(from.begin(), from.end(), pose.local.begin());
}

int Crowd::blocks() const noexcept { return (size() + kTogether - 1) / kTogether; }

void Crowd::advance_block(int number, double dt_s) noexcept {
  // Kept from call to call, for clearing it costs more than a leg.
  static thread_local std::array<PlannedTick, kTogether> planned;
  std::array<std::optional<Tick>, kTogether> ticks;
  const int first = number * kTogether, last = std::min(first + kTogether, size());
  const std::span<const int> block(order_.data() + first, order_.data() + last);
  for (std::size_t i = 0; i < block.size(); ++i) {
    const WalkModel& model = *models_[block[i]];
    ticks[i].emplace(Tick{model, params_[block[i]], dt_s, is_flat(*model.terrain)});
    plan_tick(*ticks[i], mode_, states_[block[i]], planned[i]);
  }
  pose_legs({planned.data(), block.size()}, mode_);
  Pose pose;
  for (std::size_t i = 0; i < block.size(); ++i) {
    finish_tick(planned[i], pose);
    store_pose(block[i], pose);
  }
}

void Crowd::advance(double dt_s) noexcept {
  for (int block = 0; block < blocks(); ++block) advance_block(block, dt_s);
}

}  // namespace gaitpad
