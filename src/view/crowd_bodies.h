// The crowd as flat capsules: many characters, each in the colour of its style.
#pragma once
#include <vector>

#include "draw/theme.h"
#include "gaitpad/session_frame.h"
#include "view/mannequin.h"
#include "view/scene.h"

namespace gaitpad {

class CrowdBodies {
 public:
  CrowdBodies() = default;  // nobody
  explicit CrowdBodies(const Cast& cast);

  // Replaces the crowd in the scene: everybody between the two latest poses (share 0 .. 1).
  // `focus_m`: the place that the floor is drawn around. `terrain`: null if level at height 0.
  void fill(const FollowerPoses& poses, double share, const Theme& theme, const Terrain* terrain,
            const vec3& focus_m, SceneContent& content);

 private:
  struct Member {
    int mannequin = 0, style = 0, joints = 0;
  };
  void add(const Member& member, const Colour& colour, const Terrain* terrain, bool is_fine,
           SceneContent& content);

  std::vector<Mannequin> mannequins_;  // one for each build
  std::vector<Member> members_;
  std::size_t joints_ = 0;  // of all members
  Pose pose_;
  JointFrames frames_;
};

}  // namespace gaitpad
