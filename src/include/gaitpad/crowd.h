// Many characters that walk at once, each with its own build, motion, terrain, place and command.
//
//   Crowd crowd(members);
//   for (int i = 0; i < crowd.size(); ++i) crowd.params()[i] = gait_params(stick, style, limits);
//   crowd.advance(1.0 / 60.0);
//
// One call moves all of them on by one tick, to the same bits as advance() of gaitpad/walk.h moves
// each of them, whatever the width of the processor's registers and the number of threads.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "gaitpad/gait_params.h"
#include "gaitpad/result.h"
#include "gaitpad/walk.h"

namespace gaitpad {

class WalkBlock;  // walks that are computed side by side

struct CrowdMember {
  std::shared_ptr<const WalkModel> model;  // never null; members may share one
  vec3 place_m{0.0};  // place at the beginning, in the world, within kFarthest_m; it faces +z
};

// A crowd. The caller fills the members. They are told apart by their index, 0 .. size() - 1; a
// call with another index has no effect.
class Crowd {
 public:
  Crowd() noexcept;  // Has no members.
  // Makes a crowd in which all members stand. Error: `members[3].model is null`, or a place that is
  // not finite or too far.
  static Result<Crowd> create(std::span<const CrowdMember> members, IkMode mode = IkMode::robust);
  // Makes a crowd of members that create() would accept.
  explicit Crowd(std::span<const CrowdMember> members, IkMode mode = IkMode::robust);

  Crowd(const Crowd& from);
  Crowd& operator=(const Crowd& from);
  Crowd(Crowd&& from) noexcept;
  Crowd& operator=(Crowd&& from) noexcept;
  ~Crowd();

  int size() const noexcept { return static_cast<int>(models_.size()); }
  // The parameters of each member in the next ticks; at the beginning all stand.
  std::span<GaitParams> params() noexcept { return params_; }
  // A member's level of detail, at the beginning full. Another number counts as a bad input and
  // changes nothing. Set it between ticks: members of one detail are put side by side.
  Detail detail(int member) const noexcept { return details_[member]; }
  void set_detail(int member, Detail detail) noexcept;
  // Puts members of one model whose params() have the same style side by side. What a style costs
  // is then paid by those that have it, not by their neighbours as well. Changes no bit. Call it
  // between ticks, after styles have been given or changed.
  void group_by_style();
  // Advances all members by one tick of `dt_s` seconds, a constant of the run. No heap, lock or
  // clock.
  void advance(double dt_s) noexcept;
  // Advance in blocks instead of by advance(): each block once a tick, in any order and on any
  // threads.
  int blocks() const noexcept;
  void advance_block(int number, double dt_s) noexcept;

  const WalkModel& model(int member) const noexcept { return *models_[member]; }
  // The state that advance() of one would have. It is put together here: ask for it where it is
  // needed, not for each member in each tick.
  WalkState state(int member) const noexcept;
  // walk_frame() of a member.
  WalkFrame frame(int member) const noexcept;
  // WalkState::root of a member.
  Placement root(int member) const noexcept;
  // The pose of the last tick: the place of joint 0 in the world, and each joint's local rotation.
  const vec3& root_m(int member) const noexcept { return roots_m_[member]; }
  std::span<const quat> local(int member) const noexcept {
    const std::size_t first = first_joint_[member];
    return {local_.data() + first, first_joint_[member + 1] - first};
  }
  void copy_pose(int member, Pose& pose) const noexcept;
  // Puts a member back to the state at the beginning.
  void restart(int member, const vec3& place_m) noexcept;
  // These are move_walk() and put_walk() of gaitpad/walk.h for a member.
  void move(int member, const Placement& by) noexcept;
  void put(int member, const vec3& place_m, double heading_rad) noexcept;
  // These are nearest_step(), step_to() and push_walk() for a member. Call the last two between
  // ticks.
  std::optional<Placement> nearest_step(int member, const Placement& heel) const noexcept;
  bool step_to(int member, const Placement& heel) noexcept;
  bool push(int member, const vec3& velocity_m_s) noexcept;

  // Bytes of the members' states, parameters and poses.
  std::size_t bytes() const noexcept;

 private:
  // Where a member's walk is.
  struct Lane {
    int block = 0, lane = 0;
  };
  bool has(int member) const noexcept { return member >= 0 && member < size(); }
  void store_pose(int member, const Pose& pose) noexcept;
  void put_state(int member, const WalkState& state) noexcept;
  void exchange_lanes(int member, int other) noexcept;
  // Lets `work` place the state and the pose of a member.
  template <class Work>
  void place_anew(int member, const Work& work) noexcept;
  // Lets `request` change the state of a member. Returns what it returns.
  template <class Request>
  bool ask_step(int member, const Request& request) noexcept;

  IkMode mode_ = IkMode::robust;
  // Members of one model stand in blocks: first those that are computed in full, then the others.
  std::vector<std::unique_ptr<WalkBlock>> blocks_;
  std::vector<int> order_;        // members, by block and lane
  std::vector<int> block_begin_;  // index of each block's first entry in `order_`
  std::vector<Lane> lane_;
  std::vector<std::shared_ptr<const WalkModel>> models_;
  std::vector<GaitParams> params_;
  std::vector<Detail> details_;
  std::vector<Placement> placed_;
  std::vector<int> bad_inputs_;
  std::vector<vec3> roots_m_;
  std::vector<std::size_t> first_joint_{0};  // index of each member's first joint in `local_`, then
                                             // the end
  std::vector<quat> local_;
};

}  // namespace gaitpad
