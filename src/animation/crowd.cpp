#include "gaitpad/crowd.h"

#include <algorithm>
#include <optional>

#include "animation/walk_parts.h"

namespace gaitpad {
namespace {

// Characters whose ticks run side by side: enough to fill the widest registers with their legs, and
// few enough for their plans to stay in the cache.
constexpr int kTogether = 8;

}  // namespace

Crowd::Crowd(std::span<const CrowdMember> members, const CrowdOptions& options)
    : options_(options),
      params_(members.size()),
      states_(members.size()),
      roots_m_(members.size()) {
  models_.reserve(members.size());
  first_joint_.reserve(members.size() + 1);
  for (const CrowdMember& member : members) {
    models_.push_back(member.model);
    first_joint_.push_back(first_joint_.back() + member.model->cycle.skeleton.joints.size());
  }
  local_.resize(first_joint_.back());
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

void Crowd::advance_block(int first, int last, double dt_s) noexcept {
  std::array<PlannedTick, kTogether> planned;
  std::array<std::optional<Tick>, kTogether> ticks;
  const int count = last - first;
  for (int i = 0; i < count; ++i) {
    const WalkModel& model = *models_[first + i];
    const Tick& tick =
        ticks[i].emplace(Tick{model, params_[first + i], dt_s, is_flat(*model.terrain)});
    plan_tick(tick, options_.ik, states_[first + i], planned[i]);
  }
  pose_legs({planned.data(), static_cast<std::size_t>(count)}, options_.ik);
  Pose pose;
  for (int i = 0; i < count; ++i) {
    finish_tick(planned[i], pose);
    store_pose(first + i, pose);
  }
}

void Crowd::advance(double dt_s) noexcept {
  for (int first = 0; first < size(); first += kTogether)
    advance_block(first, std::min(first + kTogether, size()), dt_s);
}

}  // namespace gaitpad
