#include "gaitpad/crowd.h"

#include <algorithm>

namespace gaitpad {

int widest_lanes() noexcept { return 2; }

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
  Pose pose;
  for (int i = first; i < last; ++i) {
    gaitpad::advance(*models_[i], params_[i], options_.ik, dt_s, states_[i], pose);
    store_pose(i, pose);
  }
}

void Crowd::advance(double dt_s) noexcept { advance_block(0, size(), dt_s); }

}  // namespace gaitpad
