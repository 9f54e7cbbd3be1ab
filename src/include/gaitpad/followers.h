// The crowd of a session: characters that walk behind the first one, in a formation, each with its
// own build and style.
//
// They follow the first character: its speed and turn rate are theirs, in their own steps, so the
// formation stays together. Who has which build and style, and where each stands, follows from the
// member's number alone. Commands for styles and gait, zones of the terrain and fatigue act on the
// session's walkers, not on them.
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

// A member takes about 6 KB, and a replay keeps the beginning beside the present: so many take 1.2
// GB.
inline constexpr int kMaxFollowers = 100'000;
// Viewers get the poses of so many, those nearest to the first character. A picture of more would
// take longer than a fifth of a second without a graphics card.
inline constexpr int kMaxShownFollowers = 2000;
inline constexpr int kFollowerBuilds = 16;
inline constexpr int kMaxCrowdThreads = 1024;

// The build with this number, a variation on `first`: bones 0.88 to 1.12 as long, legs 0.95 to 1.05
// on top of that.
Character follower_build(const Character& first, int number);

// The poses of members 0, 1, ... for viewers; single precision is enough for a picture.
struct FollowerPoses {
  std::vector<vec3> root_before_m, root_m;  // after the tick before and after this one
  // Local rotations of the joints of one member after the other: x, y, z, w.
  std::vector<std::array<float, 4>> before, local;
};

class Followers {
 public:
  Followers() = default;  // nobody
  // The caller fills it. Places are in the world, within kFarthest_m.
  struct Options {
    int count = 0;  // 0 .. kMaxFollowers
    IkMode ik = IkMode::robust;
    int threads = 1;                 // that advance() uses, at most; 1 .. kMaxCrowdThreads
    int shown = kMaxShownFollowers;  // so many have poses in shown(), 0 .. kMaxFollowers
    vec3 first_m{0.0};               // where the first character stands at first, facing +z
    vec3 middle_m{0.0};              // the middle of the characters that they stand behind
  };
  // Everybody stands. Error: what check() refuses, no builds, a null among them, no styles.
  static Result<Followers> create(const Options& options,
                                  const std::vector<std::shared_ptr<const WalkModel>>& builds,
                                  const std::vector<Style>& styles);

  // `member`: 0 .. size() - 1.
  int size() const noexcept { return crowd_.size(); }
  const Crowd& crowd() const noexcept { return crowd_; }
  int style(int member) const noexcept { return kinds_[kind_[member]].style; }  // index in `styles`
  const std::shared_ptr<const WalkModel>& model(int member) const noexcept {
    return builds_[kinds_[kind_[member]].build];
  }
  const vec3& start_m(int member) const noexcept { return start_m_[member]; }

  // Moves everybody on by one tick, after the first character has made it.
  void advance(const GaitParams& first, const WalkState& first_state, double dt_s) noexcept;
  // Everybody back to where it stands at first.
  void restart() noexcept;
  // Of the first Options::shown.
  const FollowerPoses& shown() const noexcept { return shown_; }
  std::size_t bytes() const noexcept;  // what a copy takes, about

 private:
  Followers(const Options& options, const std::vector<std::shared_ptr<const WalkModel>>& builds,
            const std::vector<Style>& styles);
  struct Kind {  // a build in a style
    int build = 0, style = 0;
    StyleValues values;
    GaitLimits limits;
  };
  GaitParams params_of(int member, const GaitParams& first, const WalkState& first_state,
                       const vec3& ahead) const noexcept;
  void keep_shown() noexcept;

  Crowd crowd_;
  std::shared_ptr<Workers> workers_;  // null: one thread; copies share them
  std::vector<std::shared_ptr<const WalkModel>> builds_;
  std::vector<Kind> kinds_;
  std::vector<std::uint16_t> kind_;  // by member
  std::vector<vec3> start_m_;        // by member
  vec3 first_m_{0.0};
  bool is_flat_ = true;
  FollowerPoses shown_;
};
// `Followers::Options: count is -1, outside [0, 100000]`.
std::optional<Error> check(const Followers::Options& options);

}  // namespace gaitpad
