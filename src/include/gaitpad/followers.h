// The crowd of a session: characters that walk behind the first one, in a formation, each with its
// own build and style.
//
// They walk at the first character's speed and turn rate, in their own steps, so the formation
// stays together. A member's number alone decides its build, its style and its place. Commands for
// styles and gait, zones of the terrain and fatigue act on the session's walkers, not on the crowd.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "gaitpad/control.h"
#include "gaitpad/crowd.h"
#include "gaitpad/result.h"
#include "gaitpad/style.h"
#include "gaitpad/walk.h"

namespace gaitpad {

class Workers;

// A member takes about 6 KB, twice in a replay, which keeps the beginning beside the present: 1.2
// GB for the largest crowd.
inline constexpr int kMaxFollowers = 100'000;
// Viewers get the poses of at most this many members, those nearest to the first character. More
// would take longer to draw than a fifth of a second without a graphics card.
inline constexpr int kMaxShownFollowers = 2000;
inline constexpr int kFollowerBuilds = 16;
inline constexpr int kMaxCrowdThreads = 1024;

// The build with this number, a variation on `first`: bones 0.88 to 1.12 as long, legs 0.95 to 1.05
// on top of that.
Character follower_build(const Character& first, int number);

// The poses of members 0, 1, ... for viewers; single precision is enough for a picture.
struct FollowerPoses {
  std::vector<vec3> root_before_m, root_m;  // places of joint 0 before and after this tick
  // Local rotations of the joints, one member after the other: x, y, z, w.
  std::vector<std::array<float, 4>> before, local;
};

class Followers {
 public:
  Followers() = default;  // Has no members.
  // Set by the caller. Places are in the world, within kFarthest_m.
  struct Options {
    int count = 0;  // number of members, 0 .. kMaxFollowers
    IkMode ik = IkMode::robust;
    int threads = 1;                 // most threads that advance() uses, 1 .. kMaxCrowdThreads
    int shown = kMaxShownFollowers;  // number of members with poses in shown(), 0 .. kMaxFollowers
    vec3 first_m{0.0};               // place of the first character at the beginning, facing +z
    vec3 middle_m{0.0};              // middle between the characters that the crowd follows
  };
  // Makes a crowd in which all members stand. Error: what check() refuses, no builds, a null build,
  // no styles.
  static Result<Followers> create(const Options& options,
                                  const std::vector<std::shared_ptr<const WalkModel>>& builds,
                                  const std::vector<Style>& styles);

  // A member's number is 0 .. size() - 1.
  int size() const noexcept { return crowd_.size(); }
  const Crowd& crowd() const noexcept { return crowd_; }
  // The index of the member's style in `styles`.
  int style(int member) const noexcept { return kinds_[kind_[member]].style; }
  const std::shared_ptr<const WalkModel>& model(int member) const noexcept {
    return builds_[kinds_[kind_[member]].build];
  }
  const vec3& start_m(int member) const noexcept { return start_m_[member]; }

  // Advances all members by one tick. Call it after the first character's tick, with its
  // parameters, WalkState::root and WalkFrame::speed_m_s.
  void advance(const GaitParams& first, const Placement& first_root, double first_m_s,
               double dt_s) noexcept;
  // Puts all members back to their places at the beginning.
  void restart() noexcept;
  // The poses of the first Options::shown members.
  const FollowerPoses& shown() const noexcept { return shown_; }
  std::size_t bytes() const noexcept;  // About the size of a copy, in bytes.

 private:
  Followers(const Options& options, const std::vector<std::shared_ptr<const WalkModel>>& builds,
            const std::vector<Style>& styles);
  struct Kind {  // a build in a style
    int build = 0, style = 0;
    StyleValues values;
    GaitLimits limits;
  };
  GaitParams params_of(int member, const GaitParams& first, const Placement& first_root,
                       double first_m_s, const vec3& ahead) const noexcept;
  void keep_shown() noexcept;

  Crowd crowd_;
  std::shared_ptr<Workers> workers_;  // null: advance on one thread; copies share the workers
  std::vector<std::shared_ptr<const WalkModel>> builds_;
  std::vector<Kind> kinds_;
  std::vector<std::uint16_t> kind_;  // index of each member's kind
  std::vector<vec3> start_m_;        // each member's place at the beginning
  vec3 first_m_{0.0};
  bool is_flat_ = true;
  FollowerPoses shown_;
};
// Errors read `Followers::Options: count is -1, outside [0, 100000]`.
std::optional<Error> check(const Followers::Options& options);

}  // namespace gaitpad
